# SPDX-License-Identifier: BSD-3-Clause
"""STAT_: boots, flights, their time and length. Source: https://ardupilot.org/copter/docs/parameters.html#stat-parameters"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..core.algebra import norm
from ..core.vectors import Vec3
from ..simulation import Simulation

SINCE_S = 1_451_606_400
"""2016-01-01 [s, Unix]."""
_EVERY_US = 1_000_000
_KEPT_EVERY_S = 30
_LEAST_M, _MOST_M = 0.5, 300.0
"""What counts of a second's distance: less is noise."""
_RESET = ("BOOTCNT", "FLTTIME", "RUNTIME", "FLTCNT", "DISTFLWN")


class Statistics:
    """Counts for one vehicle, and keeps the parameters up to date: every half minute, and after each flight.

    Args:
        simulation: the vehicle, just powered on.
        keep: called with name and value of each parameter that changes.
    """

    def __init__(self, simulation: Simulation, keep: Callable[[str, float], None]) -> None:
        self._simulation, self._keep = simulation, keep
        self._due_us = 0
        self._running_s = 0
        """Since the parameters were updated."""
        self._pending = dict.fromkeys(_RESET, 0.0)
        """Not in the parameters yet."""
        self._flies = False
        self._was: Vec3 | None = None
        """Where it was in flight a second ago."""
        self._boot_us = -1
        self.follow()

    def follow(self) -> None:
        """To be called now and then: counts a boot, and each simulated second."""
        simulation = self._simulation
        if simulation.before_boot_us != self._boot_us:
            self._boot_us = simulation.before_boot_us
            self._due_us = simulation.time_us + _EVERY_US
            self._flies, self._was = False, None
            self._pending = {**dict.fromkeys(_RESET, 0.0), "BOOTCNT": 1.0}
            self._update()
        if simulation.time_us >= self._due_us:
            self._second()
            self._due_us += _EVERY_US

    def _second(self) -> None:
        has_landed = self._count()
        self._running_s += 1
        if self._value("RESET") == 0.0:
            unix_us = self._simulation.bridge.epoch_us + self._simulation.time_us
            self._set("RESET", unix_us // 1_000_000 - SINCE_S)
            self._pending = dict.fromkeys(_RESET, 0.0)
            self._running_s = 0
            for name in _RESET:
                self._set(name, 0.0)
        elif self._running_s >= _KEPT_EVERY_S or has_landed:
            self._update()

    def _count(self) -> bool:
        """Count a second; returns whether a flight has ended."""
        ap: Any = self._simulation.v.autopilot
        before, self._flies = self._flies, bool(ap.arming.armed and not ap.arming.landed)
        pending = self._pending
        pending["RUNTIME"] += 1.0
        if self._flies:
            pending["FLTTIME"] += 1.0
            pending["FLTCNT"] += not before
            here = ap.estimate.pos
            here = Vec3(float(here.x), float(here.y), float(here.z))
            if self._was is not None and (distance := norm(here - self._was)) >= _LEAST_M:
                pending["DISTFLWN"] += min(distance, _MOST_M)
            self._was = here
        else:
            self._was = None
        return before and not self._flies

    def _update(self) -> None:
        for name, more in self._pending.items():
            if more:
                self._set(name, self._value(name) + more)
        self._pending = dict.fromkeys(_RESET, 0.0)
        self._running_s = 0

    def _value(self, name: str) -> float:
        return self._simulation.parameters[f"STAT_{name}"]

    def _set(self, name: str, value: float) -> None:
        name, simulation = f"STAT_{name}", self._simulation
        simulation.parameters[name] = float(value)
        self._keep(name, float(value))
