# SPDX-License-Identifier: BSD-3-Clause
"""ACRO: the sticks are turn rate (ACRO_TURN_RATE) and speed; without a known speed throttle is throttle."""

from __future__ import annotations

import math

from ....core.kernels import law
from .. import pilot
from ..control import motors
from ..control.steering import out_from_rate
from ..state import Vehicle
from . import drive
from .mode import RoverMode

ACRO = 1


@law
def run(v: Vehicle) -> None:
    """One period."""
    ap = v.autopilot
    control, p = ap.control, ap.params
    armed = ap.arming.armed
    if control.speed.forward_ok:
        wanted = pilot.steering_and_speed(ap.modes.pilot, control, p)
        steering = wanted.steering
        drive.at_speed(v, wanted.speed)
    else:
        sticks = pilot.limited_sticks(ap.modes.pilot, control.motors.throttle_last, p)
        steering = sticks.steering
        motors.set_throttle(control.motors, armed, sticks.throttle, p.MOT)
    turn_rate = steering * math.radians(p.ACRO_TURN_RATE)
    motors.set_steering(control.motors, out_from_rate(control, ap.estimate, turn_rate, p.ATC))


MODE = RoverMode(number=ACRO, name="ACRO", run=run, car_needs_velocity=True, manual_input=True)
