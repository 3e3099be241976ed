# SPDX-License-Identifier: BSD-3-Clause
"""``python -m tests.public_surface``: writes public_surface.txt, all that versions promise to keep.

Names with their arguments, commands with their options, ids of environments, groups of entry points. The page
docs/reference/versioning.md says what follows from a change.
"""

from __future__ import annotations

import argparse
import inspect
from collections.abc import Iterator
from enum import IntEnum
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import gymnasium

from sitl import cli
from sitl.cli import parser, plugins
from sitl.cli.command_list import COMMANDS

FILE = Path(__file__).with_name("public_surface.txt")
MODULES = (
    "sitl",
    "sitl.client",
    "sitl.deprecation",
    "sitl.envs",
    "sitl.envs.swarm",
    "sitl.errors",
    "sitl.missions.files",
    "sitl.missions.testing",
    "sitl.recording",
    "sitl.vehicles",
    "sitl.warp",
    "sitl.worlds",
)
"""Public modules: what is in their ``__all__`` is public."""


def lines() -> list[str]:
    """The surface, one promise a line."""
    found = [line for name in MODULES for line in of_module(import_module(name))]
    found += [f"command {line}" for line in of_commands()]
    found += [f"environment {name}" for name in sorted(gymnasium.registry) if is_ours(name)]
    found += [f"entry points {group}" for group in (cli.GROUP, plugins.GROUP)]
    return found


def is_ours(name: str) -> bool:
    """Whether an environment's id is one of this package."""
    return str(gymnasium.registry[name].entry_point).startswith("sitl.")


def of_module(module: ModuleType) -> Iterator[str]:
    """The names of ``__all__``, with their arguments; of classes the public methods and properties, too."""
    for name in sorted(module.__all__):
        value = getattr(module, name)
        path = f"{module.__name__}.{name}"
        if inspect.isclass(value):
            yield path + arguments(value)
            ours = [base for base in reversed(value.__mro__) if base.__module__.startswith("sitl.")]
            attributes = {key: one for base in ours for key, one in vars(base).items() if not key.startswith("_")}
            for key in sorted(attributes):
                yield f"{path}.{key}{arguments(attributes[key])}"
        else:
            yield path + arguments(value)


def arguments(value: Any) -> str:
    """ "(a, b=1, *, c=...)" of what can be called; empty for other values, and where Python does not know."""
    if isinstance(value, staticmethod | classmethod):
        value = value.__func__
    if not callable(value) or (inspect.isclass(value) and issubclass(value, BaseException)):
        return ""
    try:
        signature = inspect.signature(value)
    except (TypeError, ValueError):
        return ""
    plain = [
        one.replace(annotation=one.empty, default=one.default if one.default is one.empty else _Shown(one.default))
        for one in signature.parameters.values()
    ]
    return str(signature.replace(parameters=plain, return_annotation=signature.empty))


class _Shown:
    """A default; only plain values are part of the promise."""

    def __init__(self, value: Any) -> None:
        self._value = value

    def __repr__(self) -> str:
        if isinstance(self._value, IntEnum):
            return repr(int(self._value))  # versions of Python name choices in ways of their own
        return repr(self._value) if isinstance(self._value, bool | int | float | str | None) else "..."


def of_commands() -> Iterator[str]:
    """Each command, with its arguments and options."""
    yield from _of_parser("sitl", parser(), 0)


def _of_parser(name: str, of: argparse.ArgumentParser, level: int) -> Iterator[str]:
    for action in of._actions:
        if isinstance(action, argparse._SubParsersAction):
            for word, below in action.choices.items():
                if level or word in COMMANDS:
                    yield from _of_parser(f"{name} {word}", below, level + 1)
        elif action.option_strings:
            yield f"{name} {' '.join(action.option_strings)}"
        else:
            yield f"{name} {action.metavar or action.dest}"


def main() -> None:
    """Write the file."""
    FILE.write_text("\n".join(lines()) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
