# SPDX-License-Identifier: BSD-3-Clause
"""MANUAL: the sticks are steering and throttle (MANUAL_OPTIONS, MANUAL_STR_EXPO)."""

from __future__ import annotations

from ....core.kernels import law
from ...radio import expo
from .. import pilot
from ..control import motors
from ..state import Vehicle
from .mode import RoverMode

MANUAL = 0

_SCALED = 1
"""MANUAL_OPTIONS: steering shrinks with speed."""


@law
def run(v: Vehicle) -> None:
    """One period."""
    ap = v.autopilot
    m = ap.control.motors
    sticks = pilot.limited_sticks(ap.modes.pilot, m.throttle_last, ap.params)
    steering = expo(sticks.steering, ap.params.MANUAL.STR_EXPO)
    motors.set_throttle(m, ap.arming.armed, sticks.throttle, ap.params.MOT)
    if (int(ap.params.MANUAL.OPTIONS) & _SCALED) != 0:
        motors.set_steering(m, steering)
    else:
        motors.set_steering_unscaled(m, steering)


MODE = RoverMode(number=MANUAL, name="MANUAL", run=run, manual_input=True, controlled=False)
