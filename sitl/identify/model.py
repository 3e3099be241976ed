# SPDX-License-Identifier: BSD-3-Clause
"""The airframe that properties make of a shipped one."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from ..core.constants import GRAVITY
from ..vehicles import CopterAirframe
from .estimate import Estimate
from .expected import Conditions, Copter
from .shared import NOISES


class Model:
    """A shipped airframe that takes over one property after the other.

    Args:
        base: with the mass, drag and inertia scaled to it.
        parameters: of the log's firmware.
        conditions: of the log.
        found: a property of the log by its name.
        authority: effectiveness of roll, pitch, yaw where the logs do not show it.
    """

    def __init__(
        self,
        base: CopterAirframe,
        parameters: Mapping[str, float],
        conditions: Conditions,
        found: Callable[[str], Estimate],
        authority: Mapping[str, float],
    ) -> None:
        self.airframe = base
        self.notes: dict[str, str] = {}
        """Property of the airframe -> what it follows from."""
        self._parameters, self._conditions, self._found = parameters, conditions, found
        self._authority = authority
        self._drag()
        self._motors()
        self._inertia()
        self._yaw()
        self._balance()
        for name in NOISES:
            if (estimate := found(name)).is_observed:
                self._set(estimate, **{name: estimate.value})

    def _set(self, source: Estimate, **values: Any) -> None:
        self.airframe = replace(self.airframe, properties={**self.airframe.properties, **values})
        self.notes |= dict.fromkeys(values, f"identified, by {source}")

    def _assume(self, source: str, **values: Any) -> None:
        self.airframe = replace(self.airframe, properties={**self.airframe.properties, **values})
        self.notes |= dict.fromkeys(values, f"assumed, by {source}")

    def _value(self, name: str) -> float:
        return float(self.airframe.value(name))

    def _expected(self) -> dict[str, float]:
        return self._copter().properties()

    def _copter(self) -> Copter:
        return Copter(self.airframe, self._parameters, self._conditions)

    def _drag(self) -> None:
        if (estimate := self._found("drag_mcoef")).is_observed:
            scale = estimate.value / self._expected()["drag_mcoef"]
            self._set(estimate, momentum_drag=scale * self._value("momentum_drag"))
        area, mass = list(self.airframe.value("drag_area")), self._value("mass")
        for k, axis in enumerate("xy"):
            if (estimate := self._found(f"drag_bcoef_{axis}")).is_observed:
                area[k] = mass / estimate.value
                self._set(estimate, drag_area=tuple(area))

    def _motors(self) -> None:
        if (lag := self._found("motor_lag")).is_observed and lag.low > 0.0:
            self._set(lag, time_constant_up=lag.value, time_constant_down=lag.value)

    def _inertia(self) -> None:
        """Angular acceleration by output: inertia, since positions and thrust of the motors are given."""
        moments, expected = list(self.airframe.value("inertia")), self._expected()
        factors = []
        for k, axis in enumerate(("roll", "pitch")):
            if (estimate := self._found(f"{axis}_effectiveness")).is_observed:
                factors.append(expected[estimate.name] / estimate.value)
                moments[k] *= factors[-1]
        if factors:
            moments[2] *= sum(factors) / len(factors)
            self._set(self._found("roll_effectiveness"), inertia=tuple(moments))
        else:
            shares = [expected[f"{axis}_effectiveness"] / self._authority[axis] for axis in ("roll", "pitch")]
            self._assume(
                "ATC_RAT_RLL_P and _PIT_P: effectiveness by gain is the shipped airframe's",
                inertia=(moments[0] * shares[0], moments[1] * shares[1], moments[2] * sum(shares) / 2.0),
            )
        left = [
            self._found(f"{axis}_damping").value - self._expected()[f"{axis}_damping"] for axis in ("roll", "pitch")
        ]
        if factors and all(map(math.isfinite, left)):
            damping = max(self._value("angular_damping") + sum(left) / len(left), 0.0)
            self._set(self._found("roll_damping"), angular_damping=damping)

    def _yaw(self) -> None:
        if not (estimate := self._found("yaw_effectiveness")).is_observed:
            lever = self._value("yaw_lever") * self._authority["yaw"] / self._expected()[estimate.name]
            self._assume("ATC_RAT_YAW_P: effectiveness by gain is the shipped airframe's", yaw_lever=lever)
            return
        lever = self._value("yaw_lever") * estimate.value / self._expected()[estimate.name]
        self._set(estimate, yaw_lever=lever)
        spin_up = self._found("yaw_spin_up")
        if spin_up.is_observed and spin_up.low > 0.0 and self._value("time_constant_up") > 0.0:
            copter, at = self._copter(), self._copter().hover
            commands = [copter.command(copter.output(at + step)) for step in (-1e-3, 1e-3)]
            moments = [copter.moment(at + step) for step in (-1e-3, 1e-3)]
            slope = (moments[1] - moments[0]) / (commands[1] - commands[0])
            self._set(spin_up, rotor_inertia=spin_up.value * slope)

    def _balance(self) -> None:
        rotors = self.airframe.rotors
        reach = max(math.hypot(rotor.x, rotor.y) for rotor in rotors)
        for name, axis in (("balance_forward", "x"), ("balance_right", "y")):
            estimate = self._found(name)
            if estimate.is_observed and (estimate.low > 0.0 or estimate.high < 0.0):
                moved = -estimate.value * reach
                rotors = tuple(rotor._replace(**{axis: getattr(rotor, axis) + moved}) for rotor in rotors)
        self.airframe = replace(self.airframe, rotors=rotors)


def outflow(base: CopterAirframe, mass: float, command: float, expo: float, air_density: float) -> float:
    """Outflow speed at command 1 with which a command carries the weight [m/s]."""
    flow = 0.5 * air_density * float(base.value("outflow_area")) * len(base.rotors)
    return math.sqrt(mass * GRAVITY / (flow * command * (1.0 - expo + expo * command)))
