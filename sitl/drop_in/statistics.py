# SPDX-License-Identifier: BSD-3-Clause
"""STAT_: boots, time of running and of flight. Source: https://ardupilot.org/copter/docs/parameters.html#stat-parameters"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..simulation import Simulation

SINCE_S = 1_451_606_400
"""2016-01-01 [s, Unix]."""
_EVERY_US = 1_000_000
_KEPT_EVERY_S = 30


class Statistics:
    """Counts for one vehicle, and keeps the parameters up to date.

    Args:
        simulation: the vehicle, just powered on.
        keep: told name and value of each parameter that changes.
    """

    def __init__(self, simulation: Simulation, keep: Callable[[str, float], None]) -> None:
        self._simulation, self._keep = simulation, keep
        self._due_us = 0
        self._running_s = self._flying_s = 0
        """Not in the parameters yet."""
        self._boot_us = -1
        self.follow()

    def follow(self) -> None:
        """To be called now and then: counts a boot, and each simulated second."""
        simulation = self._simulation
        if simulation.before_boot_us != self._boot_us:
            self._boot_us = simulation.before_boot_us
            self._due_us = simulation.time_us + _EVERY_US
            self._add("BOOTCNT", 1)
        if simulation.time_us >= self._due_us:
            self._second()
            self._due_us += _EVERY_US

    def _second(self) -> None:
        arming: Any = self._simulation.v.autopilot.arming
        self._running_s += 1
        self._flying_s += bool(arming.armed and not arming.landed)
        if self._value("RESET") == 0.0:
            unix_us = self._simulation.bridge.epoch_us + self._simulation.time_us
            self._set("RESET", unix_us // 1_000_000 - SINCE_S)
            self._running_s = self._flying_s = 0
            for name in ("BOOTCNT", "FLTTIME", "RUNTIME"):
                self._set(name, 0)
        elif self._running_s >= _KEPT_EVERY_S:
            self._add("RUNTIME", self._running_s)
            self._add("FLTTIME", self._flying_s)
            self._running_s = self._flying_s = 0

    def _value(self, name: str) -> float:
        return float(self._simulation.v.autopilot.params[f"STAT_{name}"])

    def _add(self, name: str, value: int) -> None:
        self._set(name, self._value(name) + value)

    def _set(self, name: str, value: float) -> None:
        self._simulation.v.autopilot.params[f"STAT_{name}"] = float(value)
        self._keep(f"STAT_{name}", float(value))
