# SPDX-License-Identifier: BSD-3-Clause
"""Flights whose logs are compared byte by byte."""

from __future__ import annotations

import hashlib
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from . import tree
from .pilot import Pilot


class Logged(Pilot):
    """A pilot whose flight is logged, too."""

    def __init__(self, frame: str, kind: str, **options: Any) -> None:
        super().__init__(frame, kind, **options)
        self._folder = tempfile.TemporaryDirectory(prefix="digests-")
        tree.open_log(self.simulation, Path(self._folder.name))

    def result(self) -> dict[str, Any]:
        digests = super().result()
        files = sorted(Path(self._folder.name).iterdir())
        digests["files"] = {file.suffix: hashlib.sha256(file.read_bytes()).hexdigest() for file in files}
        self._folder.cleanup()
        return digests


def copter(seconds: float) -> Pilot:
    """A hover, a velocity, LAND."""
    pilot = Logged("erle_copter", "copter", seed=1)
    pilot.hover()
    pilot.stream(seconds, 0xDC7, vx=2.0)
    pilot.set_mode("LAND")
    pilot.fly(40.0, lambda: not pilot.armed)
    return pilot


def rover(seconds: float) -> Pilot:
    """A velocity, RTL."""
    pilot = Logged("erle_rover", "rover", seed=1)
    pilot.boot()
    pilot.arm()
    pilot.stream(seconds, 0xDC7, vx=1.0)
    pilot.set_mode("RTL", 10.0)
    return pilot


def power_on(frame: str, kind: str, **options: Any) -> Pilot:
    """The first seconds only: short enough for plain Python (NUMBA_DISABLE_JIT=1)."""
    pilot = Pilot(frame, kind, **{"seed": 1, **options})
    pilot.fly(0.5)
    pilot.look()
    pilot.fly(0.5)
    return pilot


def flights() -> dict[str, Callable[[], Pilot]]:
    """All of them, by name."""
    return {
        "native/log/copter": partial(copter, 10.0),
        "native/log/rover": partial(rover, 10.0),
        "native/power_on/copter": partial(power_on, "erle_copter", "copter"),
        "native/power_on/rover": partial(power_on, "erle_rover", "rover"),
    }
