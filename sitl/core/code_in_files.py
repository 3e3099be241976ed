# SPDX-License-Identifier: BSD-3-Clause
"""Data files that reach outside of the process: refused unless the user says the same himself.

A policy, a recipe, a plan, a suite's table, a run's folder may name an airframe's Python file, a program to be started,
the address of a vehicle, a file to be read. To open somebody's file must do none of that, so a file may say only what
stands in one list (``FREE``). All else is taken only when the environment variable ``SITL_ALLOW_CODE`` is 1, or when
the user has said the same on the command line (``allow``). Processes that are started from this one have the same
permission.
"""

from __future__ import annotations

import ast
import json
import os
import re
import shlex
from collections.abc import Callable, Container, Iterable, Mapping
from pathlib import Path
from typing import Any

VARIABLE = "SITL_ALLOW_CODE"
_ALL = "1"
REACHED = ("tcp:", "udp:", "udpin:", "udpout:")
"""How the address of an autopilot that runs already begins, behind its kind; all else is a program to start."""
_ACTS = ("env", "frame", "autopilot", "autopilot_path", "reset", "guard")
"""Options that run code or act on a vehicle; others of those that are refused open a socket, a window or a file."""


MADE = ("forest", "rooms", "labyrinth", "track", "slalom", "car_park")
"""Worlds that are made from numbers (``sitl.worlds.generated``), which a text may have behind a colon."""
_NUMBER = r"[+-]?[0-9]+(\.[0-9]*)?([eE][+-]?[0-9]+)?"
_SEEDS = re.compile(r"(?<=[:,])(seed=[0-9]+)\.\.[0-9]+(?=,|$)")
_SETTINGS = re.compile(rf"(\w+={_NUMBER}(,\w+={_NUMBER})*)?")


def is_name(value: Any) -> bool:
    """Whether a value is a name that a table of this package knows, or "KIND:settings" of worlds that are made, and
    neither a file nor an address."""
    if not isinstance(value, str):
        return False
    kind, colon, settings = value.partition(":")
    if not colon:
        return bool(re.fullmatch(r"[\w -]*", value))
    return kind.lower().replace("-", "_") in MADE and bool(_SETTINGS.fullmatch(settings))


def are_worlds(value: Any) -> bool:
    """Whether a value is such a name, or many: a range of seeds ("rooms:seed=1..100"), or a list of both."""
    if isinstance(value, list | tuple):
        return all(is_name(one) or _is_range(one) for one in value)
    return is_name(value) or _is_range(value)


def _is_range(value: Any) -> bool:
    return isinstance(value, str) and is_name(_SEEDS.sub(r"\1", value, count=1))


def _are_processors(value: Any) -> bool:
    """Whether a number of threads is one that this machine has processors for."""
    return isinstance(value, int) and value <= (os.cpu_count() or 1)


def _is_one_of(*values: Any) -> Callable[[Any], bool]:
    return lambda value: any(value is one or (type(value) is type(one) and value == one) for one in values)


def _is_free(value: Any) -> bool:
    return True


FREE: Mapping[str, Callable[[Any], bool]] = {
    # what reaches outside with other values
    "autopilot": _is_one_of("native"),
    "autopilot_path": _is_one_of(None),
    "connection": _is_one_of("inprocess"),
    "frame": lambda value: is_name(value) and ":" not in value,
    "gcs": _is_one_of(None),
    "guard": _is_one_of(None),
    "params": lambda value: not isinstance(value, str),  # a text is a file of this machine
    "physics": lambda value: is_name(value) and ":" not in value,
    "render_mode": _is_one_of(None, "rgb_array"),
    "reset": _is_one_of("reboot"),
    "threads": _are_processors,
    "world": lambda value: value is None or are_worlds(value),
    # what is numbers, or names that are looked up in tables
    **dict.fromkeys(
        ("action", "autoreset_mode", "begin", "boots", "clip_actions", "costs", "faults", "home", "info", "judge",
         "latency", "max_episode_steps", "observation", "patience", "randomise", "robot", "sensors", "setpoint",
         "start", "step_time", "take_off", "task", "tiled", "wait"), _is_free,
    ),
}  # fmt: skip
"""All that a file may say of an environment of this package: name of the option -> whether a value is taken.

Of an option that is not here, and of environments of other packages, only numbers are.
"""


def _is_numbers(value: Any) -> bool:
    if isinstance(value, list | tuple):
        return all(map(_is_numbers, value))
    return value is None or isinstance(value, bool | int | float)


def code_of_options(options: Mapping[str, Any], is_ours: bool = True) -> list[str]:
    """What of an environment's options reaches outside of the process, each as "name = value".

    Args:
        options: by name.
        is_ours: whether the environment is one of this package.
    """
    free = FREE if is_ours else {}
    named = [name for name, value in options.items() if not free.get(name, _is_numbers)(value)]
    return [f"{name} = {options[name]!r}" for name in sorted(named, key=lambda name: name not in _ACTS)]


def lies_in(folder: str | Path, file: str | Path) -> bool:
    """Whether a file, as a file in ``folder`` names it, lies in that folder or below it: who is given a folder is given
    what is in it."""
    try:
        here = Path(folder).resolve()
        return (here / file).resolve().is_relative_to(here)
    except (OSError, ValueError, RuntimeError):
        return False


def allow(named: Iterable[str]) -> None:
    """The user has said this himself, not a file: it may stand in files from here on."""
    known = os.environ.get(VARIABLE, "").splitlines()
    new = [name.replace("\0", "") for name in named if name not in known]
    if new:
        os.environ[VARIABLE] = "\n".join([*known, *new])


def allow_options(options: Mapping[str, Any]) -> None:
    """The user has given these options of an environment on the command line, whatever its package is."""
    allow([*code_of_options(options, is_ours=False), *code_of_options(options)])


class _Every:
    def __contains__(self, name: object) -> bool:
        return True


EVERY: Container[str] = _Every()
"""Nothing that a file says of the environment is used."""


def without(options: Mapping[str, Any], replaced: Container[str]) -> dict[str, Any]:
    """Those options whose values in a file count: others come in the place of the rest."""
    return {name: value for name, value in options.items() if name not in replaced}


def refusal(file: Any, named: Iterable[str], say: str = "--option {name}={value}") -> str | None:
    """Why a file that names this is not opened; None when it may be.

    Args:
        file: what is to be opened.
        named: what reaches outside, each as "name = value".
        say: how the user says the same; "": no option does.
    """
    known = os.environ.get(VARIABLE, "").splitlines()
    strange = [] if _ALL in known else [name for name in named if name not in known]
    if not strange:
        return None
    acts = any(name.partition(" = ")[0] in _ACTS for name in strange)
    what = "names code that would be run, or acts on a vehicle" if acts else "reaches outside of this process"
    said = [_said(name, say) for name in strange if say and not name.startswith("env = ")]
    how = f"say the same on the command line ({' '.join(said)}), or " if said else ""
    return (
        f"{file} {what}: {'; '.join(strange)}. A file may do so only if you trust it: {how}set the environment "
        f"variable {VARIABLE}=1"
    )


def _said(name: str, say: str) -> str:
    option, _, value = name.partition(" = ")
    try:
        found = ast.literal_eval(value)
        plain = found if isinstance(found, str) else json.dumps(found)  # as the command line takes it
    except (ValueError, TypeError, SyntaxError):
        plain = value
    return say.format(name=option, value=shlex.quote(plain))
