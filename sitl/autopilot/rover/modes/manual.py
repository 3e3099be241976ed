# SPDX-License-Identifier: BSD-3-Clause
"""MANUAL: the sticks are steering and throttle (MANUAL_OPTIONS, MANUAL_STR_EXPO)."""

from __future__ import annotations

from ....core.kernels import law
from ...radio import expo
from .. import pilot
from ..control import motors

_SCALED = 1
"""MANUAL_OPTIONS: steering shrinks with speed."""


@law
def run(v):
    """One period."""
    ap = v.autopilot
    steering, throttle = pilot.steering_and_limited_throttle(ap)
    steering = expo(steering, ap.params.MANUAL.STR_EXPO)
    motors.set_throttle(ap, throttle)
    if (int(ap.params.MANUAL.OPTIONS) & _SCALED) != 0:
        motors.set_steering(ap, steering)
    else:
        motors.set_steering_unscaled(ap, steering)
