# SPDX-License-Identifier: BSD-3-Clause
"""What one vehicle has of all that can fail: the motors and outputs of its airframe, and the sensors that it carries.

A fault of what is not there would be taken and do nothing, and a test of it would pass without a failure.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ..errors import OptionError
from ..vehicles import Airframe
from .faults import Failure
from .kind import Kind

Value = Callable[[str], float]
"""The present value of a parameter."""
SWITCHES = ("_ENABLE", "_COUNT")
"""Ends of the parameters by which sensors come and go."""
OUTPUTS = ("motor", "servo")
_SENSORS = {
    "SIM_GPS1_": ("gps", 1), "SIM_GPS2_": ("gps", 2), "SIM_BARO_": ("baro", 1), "SIM_BAR2_": ("baro", 2),
    "SIM_FLOW_": ("optical_flow", 1), "SIM_SONAR_": ("distance_sensor", 1), "SIM_LIDAR_": ("avoidance", 1),
}  # fmt: skip
"""Beginning of parameters -> the sensor that they spoil."""
_MASKS = ("SIM_ENGINE_FAIL", "SIM_ENGINE_STUCK")
"""Parameters whose bits are outputs."""
_TWO_SENSORS = {"SIM_ACC_FAIL_MSK": 3, "SIM_GYR_FAIL_MSK": 3}
"""Parameters whose bits are sensors -> those that there are."""


@dataclass(frozen=True)
class Equipment:
    """Of one vehicle.

    Args:
        kind, airframe: of it.
        has_world: it is in a world that its lidar can see.
        is_remote: its sensors are at the other end of a link.
    """

    kind: Kind
    airframe: Airframe
    has_world: bool = False
    is_remote: bool = False

    def numbers(self, unit: str, instances: int) -> list[int]:
        """Which of a unit's instances it has; sensors that parameters switch on count as there."""
        outputs = self.kind.outputs(self.airframe) if unit in OUTPUTS and instances > 1 else None
        return list(range(1, instances + 1)) if outputs is None else [n for n in outputs if n <= instances]

    def bits(self, parameter: str) -> int | None:
        """Bits of a parameter that stand for something that it has; None: it is no mask, or nothing is known."""
        if parameter in _MASKS:
            return sum(1 << (n - 1) for n in self.numbers("motor", 32))
        return _TWO_SENSORS.get(parameter)

    def check(self, failure: Failure, value: Value | None = None) -> None:
        """OptionError when it has nothing of what fails.

        Args:
            failure: one that the firmware has (``Failure.checked``).
            value: gives parameters as they are without faults; None: sensors that depend on them are not looked at.
        """
        name = f"fault {failure.unit}"
        for parameter in failure.values(self.kind.firmware.table, {}):
            if parameter.startswith(self.kind.idle_parameters(self.airframe)):
                raise OptionError(f"{name}: {parameter} does nothing to {self._words}")
        if failure.is_parameter:
            self._check_parameter(failure, value)
            return
        effect = failure.effect(self.kind.firmware.table)
        has = self.numbers(failure.unit, effect.instances)
        if failure.instance and failure.instance not in has:
            there_are = ", ".join(map(str, has))
            raise OptionError(
                f"{name}: there is no number {failure.instance}; {self._words} has {there_are}, and 0 for all"
            )
        lacks = [self.lacks(failure.unit, n, value) for n in ([failure.instance] if failure.instance else has)]
        if value is not None and all(lacks):
            raise OptionError(f"{name}: {lacks[0]}")

    def _check_parameter(self, failure: Failure, value: Value | None) -> None:
        name, bits = failure.unit, int(failure.amount or 0.0)
        if name in _MASKS and bits and not any(bits >> (n - 1) & 1 for n in self.numbers("motor", 32)):
            there_are = ", ".join(str(1 << (n - 1)) for n in self.numbers("motor", 32))
            raise OptionError(f"fault {name}: {bits} is no output of {self._words}, whose bits are {there_are}")
        sensor = next((found for prefix, found in _SENSORS.items() if name.startswith(prefix)), None)
        if sensor is not None and not name.endswith(SWITCHES) and (text := self.lacks(*sensor, value)):
            raise OptionError(f"fault {name}: {text}")

    def lacks(self, unit: str, number: int, value: Value | None) -> str:
        """Why it has no such sensor; "": it has one, or nothing is known against it."""
        if value is None or self.is_remote:
            return ""
        switches: dict[str, float] = {}
        if unit == "gps":
            switches = {f"GPS{number}_TYPE": 1.0, f"SIM_GPS{number}_ENABLE": 1.0}
        elif unit == "baro":
            switches = {"SIM_BARO_COUNT": float(number)}
        elif unit == "optical_flow":
            switches = {"SIM_FLOW_ENABLE": 1.0}
        elif unit == "distance_sensor" and not (self.has_world and self.airframe.value("rangefinder_max") > 0.0):
            switches = {"RNGFND1_TYPE": 1.0}
        elif unit == "avoidance" and not (self.has_world and self.airframe.value("lidar_samples") > 0):
            return f"{self._words} has no lidar in a world"
        for name, least in switches.items():
            if value(name) < least:
                return f"{self._words} has no {unit} {number}: {name} is {value(name):g}, not {least:g}"
        return ""

    @property
    def _words(self) -> str:
        return f"airframe {self.airframe.name}"
