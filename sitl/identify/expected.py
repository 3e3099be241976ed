# SPDX-License-Identifier: BSD-3-Clause
"""What the properties of an airframe would be in a log: to set its inertia by them, and to judge estimates."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from ..autopilot.copter.control.frames import FRAMES
from ..autopilot.copter.control.thrust_curve import air_density_ratio, command_from_thrust
from ..core.constants import GRAVITY
from ..physics.native.atmosphere import density
from ..vehicles import CopterAirframe
from ..vehicles.properties.multicopter import THRUST_MOMENTUM

Array = np.ndarray[Any, Any]

_STEP = 1e-3


def slope_of(expo: float, command: float) -> float:
    """d ln thrust / d ln command."""
    return 1.0 + expo * command / (1.0 - expo + expo * command)


def exponent(slope: float, command: float) -> float:
    """The exponent with this slope at this command."""
    extra = slope - 1.0
    return extra / (command + extra * (1.0 - command))


class Conditions(NamedTuple):
    """In which a log was flown; means over the time in the air."""

    voltage: float
    """Of the battery under load [V]; nan: full."""
    lift: float
    """Thrust that the firmware believes is left of the full battery's (MOTB.LiftMax)."""
    altitude: float
    """Above sea level [m]."""


class Copter:
    """A copter of an airframe under a firmware's parameters.

    Args:
        airframe: the airframe.
        parameters: of the firmware.
        conditions: voltage, altitude.
    """

    def __init__(self, airframe: CopterAirframe, parameters: Mapping[str, float], conditions: Conditions) -> None:
        self.airframe = airframe
        self.count = len(airframe.rotors)
        self.density = density(conditions.altitude)
        full = float(airframe.value("battery_voltage_full"))
        self.share = conditions.voltage / full if math.isfinite(conditions.voltage) else 1.0
        self.expo = parameters.get("MOT_THST_EXPO", 0.65)
        self.spin = parameters.get("MOT_SPIN_MIN", 0.15), parameters.get("MOT_SPIN_MAX", 0.95)
        self.lift = conditions.lift
        e = self.expo
        self.ratio = (e - 1.0 + math.sqrt((1.0 - e) ** 2 + 4.0 * e * self.lift)) / (2.0 * e) if e else self.lift
        self.gain = 1.0 / self.lift / air_density_ratio(conditions.altitude)
        self.frame = FRAMES[int(parameters["FRAME_CLASS"]), int(parameters["FRAME_TYPE"])]

    def output(self, demand: float) -> float:
        """Motor output 0 .. 1 of a demanded thrust 0 .. 1."""
        low, high = self.spin
        return low + (high - low) * command_from_thrust(demand * self.gain, self.expo, self.lift, self.ratio)

    def command(self, output: float) -> float:
        """Of the airframe's motors."""
        low, high = float(self.airframe.value("control_min")), float(self.airframe.value("control_max"))
        return min(max((output - low) / (high - low), 0.0), 1.0)

    def thrust(self, demand: float) -> float:
        """Of a motor [N]."""
        a, c = self.airframe, self.command(self.output(demand))
        if a.value("thrust_model") == THRUST_MOMENTUM:
            e, outflow = float(a.value("thrust_expo")), float(a.value("outflow_speed_max")) * self.share
            half = 0.5 * self.density * float(a.value("outflow_area"))
            return half * outflow * outflow * c * (1.0 - e + e * c)
        speed = float(a.value("speed_max")) * c
        if a.value("speed_voltage") > 0.0:
            top = float(a.value("battery_voltage_full")) * self.share / float(a.value("speed_voltage"))
            speed = min(speed, float(a.value("speed_max")) * top)
        return float(a.value("thrust_coefficient")) * speed * speed

    def moment(self, demand: float) -> float:
        """Of a motor about its axis [N m]."""
        if self.airframe.value("thrust_model") == THRUST_MOMENTUM:
            lever = float(self.airframe.value("yaw_lever")) * self.command(self.output(demand))
        else:
            lever = float(self.airframe.value("moment_coefficient"))
        return lever * self.thrust(demand)

    def _expo(self, slope: float) -> float:
        """MOT_THST_EXPO that makes this one slope d ln thrust / d ln demand 1, the battery's sag counted."""
        a = self.airframe
        if a.value("thrust_model") == THRUST_MOMENTUM and a.value("battery_capacity") > 0.0:
            volts = float(a.value("battery_voltage_full")) * self.share
            current = float(a.value("power_by_thrust")) * float(a.value("mass")) * GRAVITY / volts
            slope /= 1.0 + 2.0 * float(a.value("battery_resistance")) * current / volts
        low, high = self.spin
        command = (self.output(self.hover) - low) / (high - low)
        return exponent(slope * slope_of(self.expo, command), command)

    @property
    def hover(self) -> float:
        """Demand that carries the weight."""
        weight = float(self.airframe.value("mass")) * GRAVITY / self.count
        low, high = 0.0, 1.0
        for _ in range(50):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self.thrust(middle) < weight else (low, middle)
        return low

    def properties(self) -> dict[str, float]:
        """By the names of the properties."""
        a, at = self.airframe, self.hover
        slope = (self.thrust(at + _STEP) - self.thrust(at - _STEP)) / (2.0 * _STEP)
        twist = (self.moment(at + _STEP) - self.moment(at - _STEP)) / (2.0 * _STEP)
        forward, right, yaw = (np.array([getattr(m, k) for m in self.frame]) for k in ("forward", "right", "yaw"))
        x, y, turns = (np.array([getattr(r, k) for r in a.rotors]) for k in ("x", "y", "direction"))
        moments = a.value("inertia")
        roll = float(0.5 * slope * (y @ right) / np.abs(right).max() / moments[0])
        pitch = float(0.5 * slope * (x @ forward) / np.abs(forward).max() / moments[1])
        turn = float(0.5 * twist * (turns @ yaw) / np.abs(yaw).max() / moments[2])
        damping = float(a.value("angular_damping"))
        mass = float(a.value("mass"))
        flow = 0.0  # drag of a rotor by the speed of the air that it sees [N/(m/s)]
        if a.value("thrust_model") == THRUST_MOMENTUM:
            flow = float(a.value("momentum_drag")) * math.sqrt(
                self.density * float(a.value("disc_area")) * mass * GRAVITY / self.count
            )
            axial, across = flow, flow
        else:
            spin = math.sqrt(mass * GRAVITY / self.count / float(a.value("thrust_coefficient")))
            axial, across = 0.0, float(a.value("rotor_drag")) * spin
        area = a.value("drag_area")
        found = {
            "hover_output": self.output(at),
            "roll_effectiveness": roll,
            "pitch_effectiveness": pitch,
            "yaw_effectiveness": turn,
            "roll_damping": damping + axial * float(y @ y) / moments[0],
            "pitch_damping": damping + axial * float(x @ x) / moments[1],
            "yaw_damping": damping + across * float(x @ x + y @ y) / moments[2],
            "thrust_expo": self._expo(slope * at / self.thrust(at)),
            "drag_mcoef": across * self.count / mass,
            "motor_lag": _lag(float(a.value("time_constant_up")), float(a.value("time_constant_down"))),
        }
        for axis, size in zip("xy", area):
            found[f"drag_bcoef_{axis}"] = mass / size if size else math.inf
        return found


def _lag(up: float, down: float) -> float:
    """One time constant for rotors that speed up faster than they slow down: of the first harmonic of a movement."""
    if up <= 0.0 or down <= 0.0:
        return max(up, down)
    mean, skew = 0.5 * (1.0 / up + 1.0 / down), (1.0 / up - 1.0 / down) / (1.0 / up + 1.0 / down)
    return 1.0 / (mean * (1.0 - 8.0 / math.pi**2 * skew * skew))
