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
from ..control.steering import lat_accel_max
from . import drive

LEAST_ACCEL = 0.1  # [m/s^2]
LEAST_RADIUS = 0.1  # [m]


@law
def full_stick_accel(ap, forward):
    """Lateral acceleration [m/s^2] of a full stick at a speed [m/s]."""
    most = max(lat_accel_max(ap.params.ATC), LEAST_ACCEL)
    return constrain(forward * forward / max(float(ap.params.TURN_RADIUS), LEAST_RADIUS), LEAST_ACCEL, most)


@law
def run(v):
    """One period; without a known speed the motors rest."""
    ap = v.autopilot
    known, forward = sense(v)
    if not known:
        motors.set_throttle(ap, 0.0)
        motors.set_steering(ap, 0.0)
        return
    stick, wanted = pilot.steering_and_speed(ap)
    if wanted == 0.0 and motors.is_skid(ap.params):
        drive.turn(v, stick * math.radians(ap.params.ACRO_TURN_RATE))
    else:
        accel = full_stick_accel(ap, forward) * stick
        drive.accelerate_sideways(v, -accel if wanted < 0.0 else accel)
    speed.drive(v, wanted)
