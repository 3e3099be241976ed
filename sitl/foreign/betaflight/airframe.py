# SPDX-License-Identifier: BSD-3-Clause
"""What Betaflight has to be told of an airframe of ours: gains, and what a throttle is."""

from __future__ import annotations

from typing import Any

from ...autopilot.copter.control.thrust_curve import command_from_thrust
from ...errors import OptionError
from ...plants.local import LocalPlant
from ...vehicles import Airframe, CopterAirframe
from . import wire

IDLE = 0.055
"""Part of the motors' range at the lowest throttle (``motor_idle``)."""
LEAST_THROTTLE, GREATEST_THROTTLE = 1050, 2000
"""Pulses of the lowest throttle (``min_check``), up to which it arms, and of the highest [us]."""
_GAIN = 290.0
"""Its P for ArduPilot's P of the same axis, which is a torque of the same motors for a rate."""
_MOST = 250


def check(airframe: Airframe) -> None:
    """Whether Betaflight can fly this airframe here.

    Raises:
        OptionError: it cannot: its simulator has four motors, those of an X.
    """
    rotors = airframe.rotors if isinstance(airframe, CopterAirframe) else ()
    if len(rotors) != wire.MOTORS:
        raise OptionError(
            f"airframe {airframe.name} is a {airframe.kind} with {len(rotors)} rotors: betaflight flies copters with "
            f"{wire.MOTORS} here"
        )
    found = [(rotor.x > 0.0, rotor.y > 0.0) for rotor in rotors]
    if found != [(True, True), (False, False), (True, False), (False, True)]:
        raise OptionError(
            f"airframe {airframe.name}: its rotors are not front right, rear left, front left, rear right, as "
            "betaflight's motors are here"
        )


def throttle(thrust: float, motors: Any) -> float:
    """Part of the throttle's way, 0 .. 1, for a part of the greatest thrust, by the airframe's thrust curve: Betaflight
    makes a motor's command of it, from its idle on.

    Args:
        thrust: 0 .. 1
        motors: MOT_ parameters of the airframe.
    """
    share = command_from_thrust(thrust, motors.THST_EXPO, 1.0, 1.0)
    command = motors.SPIN_MIN + (motors.SPIN_MAX - motors.SPIN_MIN) * share
    return min(max(float((command - IDLE) / (1.0 - IDLE)), 0.0), 1.0)


def pulse_of(share: float) -> int:
    """Pulse of a throttle, 0 .. 1 [us]."""
    return round(LEAST_THROTTLE + (GREATEST_THROTTLE - LEAST_THROTTLE) * min(max(share, 0.0), 1.0))


def lines(plant: LocalPlant) -> list[str]:
    """Lines of the command line that suit a plant's airframe: P as ArduPilot's, I a third and D a half of it."""
    given = plant.vehicle.airframe.parameters
    found = []
    for axis, theirs in (("roll", "RLL"), ("pitch", "PIT"), ("yaw", "YAW")):
        p = given.get(f"ATC_RAT_{theirs}_P")
        if p is None:
            continue
        gain = min(round(_GAIN * float(p)), _MOST)
        found += [f"set p_{axis} = {gain}", f"set i_{axis} = {gain // 3}"]
        if axis != "yaw":
            found += [f"set d_{axis} = {gain // 2}", f"set d_max_{axis} = {gain // 2}"]
    return found
