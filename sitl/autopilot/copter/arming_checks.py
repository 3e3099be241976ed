# SPDX-License-Identifier: BSD-3-Clause
"""The copter's arming checks. Forcing skips all but the estimate that the mode itself cannot do without."""

from __future__ import annotations

import math

from ...core.kernels import law
from ..arming_checks import (
    BY_MAVLINK,
    BY_RUDDER,
    CHECK_GPS,
    CHECK_RC,
    FRAME,
    GPS_FIX,
    LEANING,
    MODE,
    NEED_ALTITUDE,
    NEED_POSITION,
    RC_MISSING,
    RUDDER_DISABLED,
    THROTTLE_FAILSAFE,
    THROTTLE_HIGH,
    WAITING_FOR_HOME,
    battery_checks,
    sensor_checks,
    wants,
)
from ..radio import THROTTLE, stick_pulse
from . import pilot
from .modes.table import arms_at_any_throttle, has_manual_throttle, may_arm, requires_position
from .state import Vehicle

MANDATORY = NEED_POSITION | NEED_ALTITUDE
"""What forcing does not skip."""


@law
def lean_check(cos_lean: float, lean_max: float) -> int:
    """A vehicle must stand upright: lean at most ``lean_max`` [rad]."""
    return 0 if cos_lean >= math.cos(lean_max) else LEANING


@law
def estimate_checks(v: Vehicle) -> int:
    """Failed checks of position, height and home, as far as the mode needs them."""
    ap = v.autopilot
    gps = wants(ap.params.ARMING, CHECK_GPS)
    failed = 0
    mode = ap.modes.number
    if requires_position(mode):
        if not ap.home.is_set and gps:
            failed |= WAITING_FOR_HOME
        elif v.sensors.gps_fix < 3 and gps:
            failed |= GPS_FIX
        if not ap.estimate.position_ok:
            failed |= NEED_POSITION
    if not has_manual_throttle(mode) and not ap.estimate.attitude_ok:
        failed |= NEED_ALTITUDE
    return failed


@law
def equipment_checks(v: Vehicle) -> int:
    """Failed checks of radio, battery and frame."""
    ap = v.autopilot
    p = ap.params
    failed = battery_checks(ap.battery, ap.modes.failsafe.battery, p)
    if p.FS.THR_ENABLE > 0.0 and wants(p.ARMING, CHECK_RC):
        if not ap.rc.receiver_ok:
            failed |= RC_MISSING
        elif stick_pulse(ap.rc, p.RCMAP, THROTTLE) < p.FS.THR_VALUE:
            failed |= THROTTLE_FAILSAFE
    if p.FRAME.CLASS != 1.0:
        failed |= FRAME
    return failed


@law
def check(v: Vehicle) -> int:
    """Failed checks before arming, 0 when the vehicle is ready (in its present mode)."""
    ap = v.autopilot
    lean = lean_check(ap.control.attitude.cos_lean, math.radians(ap.params.ANGLE_MAX * 0.01))
    sensors = sensor_checks(v.time_us, v.sensors, ap.estimate.attitude_ok, ap.params.ARMING)
    return sensors | lean | estimate_checks(v) | equipment_checks(v)


@law
def arm_checks(v: Vehicle, method: int) -> int:
    """Failed checks that count only at the moment of arming."""
    ap = v.autopilot
    failed = 0
    mode = ap.modes.number
    if not may_arm(mode, v, method):
        failed |= MODE
    if method == BY_RUDDER and ap.params.ARMING.RUDDER < 1.0:
        failed |= RUDDER_DISABLED
    if method != BY_MAVLINK or not arms_at_any_throttle(mode):
        if has_manual_throttle(mode):
            if ap.modes.pilot.throttle > 0.0:
                failed |= THROTTLE_HIGH
        elif pilot.climb_rate(ap) > 0.0:
            failed |= THROTTLE_HIGH
    return failed


@law
def check_now(v: Vehicle, method: int) -> int:
    """All failed checks of arming at this moment by ``method``."""
    return check(v) | arm_checks(v, method)
