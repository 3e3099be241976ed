# SPDX-License-Identifier: BSD-3-Clause
"""STEERING: the sticks are lateral acceleration and speed.

Full stick is the acceleration of the tightest turn (TURN_RADIUS) at this speed, at most ATC_TURN_MAX_G. A skid-steered
vehicle that stands turns on the spot.
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import constrain
from .. import pilot
from ..control import motors, speed
from ..control.forward_speed import sense
from ..control.steering import lat_accel_max, out_from_lat_accel, out_from_rate
from ..state import Vehicle
from .mode import RoverMode

STEERING = 3

ACCEL_MIN = 0.1  # [m/s^2]
RADIUS_MIN = 0.1  # [m]


@law
def full_stick_accel(speed: float, turn_radius: float, accel_max: float) -> float:
    """Lateral acceleration [m/s^2] of a full stick at ``speed`` [m/s], for a tightest turn of ``turn_radius`` [m]."""
    return constrain(speed * speed / max(turn_radius, RADIUS_MIN), ACCEL_MIN, max(accel_max, ACCEL_MIN))


@law
def run(v: Vehicle) -> None:
    """One period; without a known speed the motors rest."""
    ap = v.autopilot
    p = ap.params
    forward = sense(v)
    if not forward.known:
        motors.set_throttle(ap, 0.0)
        motors.set_steering(ap, 0.0)
        return
    wanted = pilot.steering_and_speed(ap)
    if wanted.speed == 0.0 and motors.is_skid(p):
        motors.set_steering(ap, out_from_rate(ap, wanted.steering * math.radians(p.ACRO_TURN_RATE)))
    else:
        accel_max = lat_accel_max(p.ATC)
        accel = full_stick_accel(forward.speed, p.TURN_RADIUS, accel_max) * wanted.steering
        accel = constrain(-accel if wanted.speed < 0.0 else accel, -accel_max, accel_max)
        motors.set_steering(ap, out_from_lat_accel(ap, accel))
    speed.drive(v, wanted.speed)


MODE = RoverMode(number=STEERING, name="STEERING", run=run, needs_velocity=True, manual_input=True)
