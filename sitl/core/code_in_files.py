# SPDX-License-Identifier: BSD-3-Clause
"""Data files that name code: refused unless the user allows it.

A suite's table, a recipe, a run's folder may name an airframe's Python file, a module with environments, or a program
to be started. To open somebody's file must not run it, so such a file is taken only when the environment variable
``SITL_ALLOW_CODE`` is 1, or when this user has named the same code himself (``allow``). Processes that are started from
this one have the same permission.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Any

VARIABLE = "SITL_ALLOW_CODE"
_ALL = "1"
REACHED = ("tcp:", "udp:", "udpin:", "udpout:")
"""How the place of an autopilot that runs already begins, behind its kind; all else is a program to start."""


def code_of_options(options: Mapping[str, Any]) -> list[str]:
    """What of an environment's options runs code of others, or acts on a vehicle, each as "name = value"."""
    frame, autopilot = options.get("frame"), options.get("autopilot", "native")
    starts = isinstance(autopilot, str) and autopilot != "native"
    if starts and autopilot.partition(":")[2].startswith(REACHED):
        starts = False
    return [
        f"{name} = {options[name]!r}"
        for name, runs in (
            ("frame", isinstance(frame, str) and frame.endswith(".py")),
            ("autopilot", starts),
            ("autopilot_path", options.get("autopilot_path") is not None),
            ("reset", options.get("reset", "reboot") != "reboot"),
            ("guard", options.get("guard") is not None),
            ("params", isinstance(options.get("params"), str)),  # a file of this machine
        )
        if runs
    ]


def allow(named: Iterable[str]) -> None:
    """The user has named this code himself, not a file: it may stand in files from here on."""
    known = os.environ.get(VARIABLE, "").splitlines()
    new = [name for name in named if name not in known]
    if new:
        os.environ[VARIABLE] = "\n".join([*known, *new])


def refusal(file: Any, named: Iterable[str]) -> str | None:
    """Why a file that names this code is not opened; None when it may be."""
    known = os.environ.get(VARIABLE, "").splitlines()
    strange = [] if _ALL in known else [name for name in named if name not in known]
    if not strange:
        return None
    return (
        f"{file} names code that would be run, or acts on a vehicle: {'; '.join(strange)}. A file may do so only if "
        f"you trust it: set the environment variable {VARIABLE}=1"
    )
