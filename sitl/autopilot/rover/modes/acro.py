# SPDX-License-Identifier: BSD-3-Clause
"""ACRO: the sticks are turn rate (ACRO_TURN_RATE) and speed; without a known speed throttle is throttle."""

from __future__ import annotations

import math

from ....core.kernels import law
from .. import pilot
from ..control import motors, speed
from ..control.forward_speed import sense
from ..control.steering import out_from_rate
from ..state import Vehicle
from .mode import RoverMode

ACRO = 1


@law
def run(v: Vehicle) -> None:
    """One period."""
    ap = v.autopilot
    if sense(v).known:
        wanted = pilot.steering_and_speed(ap)
        steering = wanted.steering
        speed.drive(v, wanted.speed)
    else:
        sticks = pilot.limited_sticks(ap)
        steering = sticks.steering
        motors.set_throttle(ap, sticks.throttle)
    motors.set_steering(ap, out_from_rate(ap, steering * math.radians(ap.params.ACRO_TURN_RATE)))


MODE = RoverMode(number=ACRO, name="ACRO", run=run, car_needs_velocity=True, manual_input=True)
