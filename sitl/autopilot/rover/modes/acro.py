# SPDX-License-Identifier: BSD-3-Clause
"""ACRO: the sticks are turn rate (ACRO_TURN_RATE) and speed; without a known speed throttle is throttle."""

from __future__ import annotations

import math

from ....core.kernels import law
from .. import pilot
from ..control import motors, speed
from ..control.forward_speed import sense
from . import drive


@law
def run(v):
    """One period."""
    ap = v.autopilot
    known, _ = sense(v)
    if not known:
        steering, throttle = pilot.steering_and_limited_throttle(ap)
        motors.set_throttle(ap, throttle)
    else:
        steering, wanted = pilot.steering_and_speed(ap)
        speed.drive(v, wanted)
    drive.turn(v, steering * math.radians(ap.params.ACRO_TURN_RATE))
