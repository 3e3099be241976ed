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
from ..radio import stick_channel
from .control import servos
from .control.motors import is_skid
from .modes.table import allows_arming, allows_arming_by_stick, requires_position, requires_velocity
from .state import Vehicle

CHECK_PARAMETERS = 32
"""ARMING_CHECK"""


@law
def estimate_checks(v: Vehicle) -> int:
    """Failed checks of GPS and estimate, as far as the mode needs them; the first of them."""
    ap = v.autopilot
    mode = ap.modes.number
    if not requires_position(mode) and not requires_velocity(mode, is_skid(ap.params)):
        return 0
    if v.sensors.gps_fix < 3 and wants(v, CHECK_GPS):
        return GPS_FIX
    if not ap.estimate.position_ok:
        return AHRS_TYPE
    return EKF_FAILSAFE if ap.modes.failsafe.ekf != 0 else 0


@law
def equipment_checks(v: Vehicle) -> int:
    """Failed checks of radio, battery and outputs."""
    ap = v.autopilot
    p = ap.params
    failed = battery_checks(v)
    if p.FS.THR_ENABLE > 0.0 and wants(v, CHECK_RC):
        if not ap.rc.receiver_ok:
            failed |= RC_MISSING
        elif ap.rc.channels[stick_channel(p, 2) - 1] < p.FS.THR_VALUE:
            failed |= THROTTLE_FAILSAFE
    if not (servos.is_assigned(p, servos.STEERING) or servos.is_assigned(p, servos.THROTTLE) or is_skid(p)):
        failed |= NO_OUTPUTS
    if p.WP.SPEED <= 0.0 and wants(v, CHECK_PARAMETERS):
        failed |= WAYPOINT_SPEED
    return failed


@law
def check(v: Vehicle) -> int:
    """Failed checks before arming, 0 when the vehicle is ready (in its present mode)."""
    if v.autopilot.params.ARMING.CHECK == 0.0:
        return sensor_checks(v) & NOT_INITIALISED
    mode = 0 if allows_arming(v.autopilot.modes.number) else MODE
    return sensor_checks(v) | estimate_checks(v) | equipment_checks(v) | mode


@law
def stick_checks(v: Vehicle, method: int) -> int:
    """Sticks that are not centred; by stick the steering cannot be."""
    ap = v.autopilot
    if not ap.rc.receiver_ok or not wants(v, CHECK_RC):
        return 0
    failed = 0
    if ap.modes.pilot.throttle != 0.0:
        failed |= THROTTLE_OFF_CENTRE
    if method != BY_RUDDER and ap.modes.pilot.steering != 0.0:
        failed |= STEERING_OFF_CENTRE
    return failed


@law
def check_now(v: Vehicle, method: int) -> int:
    """All failed checks of arming at this moment by ``method``."""
    ap = v.autopilot
    failed = check(v) | stick_checks(v, method)
    if method == BY_RUDDER:
        if ap.params.ARMING.RUDDER < 1.0:
            failed |= RUDDER_DISABLED
        if not allows_arming_by_stick(ap.modes.number):
            failed |= MODE_BY_RUDDER
    return failed
