# SPDX-License-Identifier: BSD-3-Clause
"""The rover's arming checks. Modes that need a position check it; forcing skips all, as does ARMING_CHECK 0."""

from __future__ import annotations

from ...core.kernels import law
from ..arming_checks import (
    AHRS_TYPE,
    BY_RUDDER,
    CHECK_GPS,
    CHECK_RC,
    EKF_FAILSAFE,
    GPS_FIX,
    MODE,
    MODE_BY_RUDDER,
    NO_OUTPUTS,
    NOT_INITIALISED,
    RC_MISSING,
    RUDDER_DISABLED,
    STEERING_OFF_CENTRE,
    THROTTLE_FAILSAFE,
    THROTTLE_OFF_CENTRE,
    WAYPOINT_SPEED,
    battery_checks,
    sensor_checks,
    wants,
)
from ..radio import THROTTLE, stick_pulse
from .control import servos
from .control.motors import is_skid
from .modes.numbers import allows_arming, allows_arming_by_stick, requires_position, requires_velocity

CHECK_PARAMETERS = 32
"""ARMING_CHECK"""


@law
def estimate_checks(v):
    """Failed checks of GPS and estimate, as far as the mode needs them; the first of them."""
    ap = v.autopilot
    mode = int(ap.modes.number)
    if not requires_position(mode) and not requires_velocity(mode, is_skid(ap.params)):
        return 0
    if v.sensors.gps_fix < 3 and wants(ap.params.ARMING, CHECK_GPS):
        return GPS_FIX
    if ap.estimate.position_ok == 0:
        return AHRS_TYPE
    return EKF_FAILSAFE if ap.modes.failsafe.ekf != 0 else 0


@law
def equipment_checks(v):
    """Failed checks of radio, battery and outputs."""
    ap = v.autopilot
    p = ap.params
    failed = battery_checks(ap.battery, ap.modes.failsafe.battery, p)
    if p.FS.THR_ENABLE > 0.0 and wants(p.ARMING, CHECK_RC):
        if ap.rc.receiver_ok == 0:
            failed |= RC_MISSING
        elif stick_pulse(ap.rc, p.RCMAP, THROTTLE) < p.FS.THR_VALUE:
            failed |= THROTTLE_FAILSAFE
    drives = servos.is_assigned(ap.params, servos.STEERING) or servos.is_assigned(ap.params, servos.THROTTLE)
    if not drives and not is_skid(ap.params):
        failed |= NO_OUTPUTS
    if p.WP.SPEED <= 0.0 and wants(p.ARMING, CHECK_PARAMETERS):
        failed |= WAYPOINT_SPEED
    return failed


@law
def check(v):
    """Failed checks before arming, 0 when the vehicle is ready (in its present mode)."""
    ap = v.autopilot
    sensors = sensor_checks(v.time_us, v.sensors, ap.estimate.attitude_ok, ap.params.ARMING)
    if ap.params.ARMING.CHECK == 0.0:
        return sensors & NOT_INITIALISED
    mode = 0 if allows_arming(int(ap.modes.number)) else MODE
    return sensors | estimate_checks(v) | equipment_checks(v) | mode


@law
def stick_checks(v, method):
    """Sticks that are not centred; by stick the steering cannot be."""
    ap = v.autopilot
    if ap.rc.receiver_ok == 0 or not wants(ap.params.ARMING, CHECK_RC):
        return 0
    failed = 0
    if ap.modes.pilot.throttle != 0.0:
        failed |= THROTTLE_OFF_CENTRE
    if method != BY_RUDDER and ap.modes.pilot.steering != 0.0:
        failed |= STEERING_OFF_CENTRE
    return failed


@law
def check_now(v, method):
    """All failed checks of arming at this moment by ``method``."""
    ap = v.autopilot
    failed = check(v) | stick_checks(v, method)
    if method == BY_RUDDER:
        if ap.params.ARMING.RUDDER < 1.0:
            failed |= RUDDER_DISABLED
        if not allows_arming_by_stick(int(ap.modes.number)):
            failed |= MODE_BY_RUDDER
    return failed
