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
from .modes.state import PilotState
from .modes.table import allows_arming, allows_arming_by_stick, requires_position, requires_velocity
from .state import Autopilot, Vehicle

CHECK_PARAMETERS = 32
"""ARMING_CHECK"""


@law
def estimate_checks(ap: Autopilot, gps_fix: int) -> int:
    """Failed checks of GPS and estimate, as far as the mode needs them; the first of them."""
    mode = ap.modes.number
    if not requires_position(mode) and not requires_velocity(mode, is_skid(ap.params)):
        return 0
    if gps_fix < 3 and wants(ap.params.ARMING, CHECK_GPS):
        return GPS_FIX
    if not ap.estimate.position_ok:
        return AHRS_TYPE
    return EKF_FAILSAFE if ap.modes.failsafe.ekf != 0 else 0


@law
def equipment_checks(ap: Autopilot) -> int:
    """Failed checks of radio, battery and outputs."""
    p = ap.params
    failed = battery_checks(ap.battery, ap.modes.failsafe.battery, p)
    if p.FS.THR_ENABLE > 0.0 and wants(p.ARMING, CHECK_RC):
        if not ap.rc.receiver_ok:
            failed |= RC_MISSING
        elif stick_pulse(ap.rc, p.RCMAP, THROTTLE) < p.FS.THR_VALUE:
            failed |= THROTTLE_FAILSAFE
    if not (servos.is_assigned(p, servos.STEERING) or servos.is_assigned(p, servos.THROTTLE) or is_skid(p)):
        failed |= NO_OUTPUTS
    if p.WP.SPEED <= 0.0 and wants(p.ARMING, CHECK_PARAMETERS):
        failed |= WAYPOINT_SPEED
    return failed


@law
def check(v: Vehicle) -> int:
    """Failed checks before arming, 0 when the vehicle is ready (in its present mode)."""
    ap = v.autopilot
    sensors = sensor_checks(v.time_us, v.sensors, ap.estimate.attitude_ok, ap.params.ARMING)
    if ap.params.ARMING.CHECK == 0.0:
        return sensors & NOT_INITIALISED
    mode = 0 if allows_arming(ap.modes.number) else MODE
    return sensors | estimate_checks(ap, v.sensors.gps_fix) | equipment_checks(ap) | mode


@law
def stick_checks(pilot: PilotState, method: int) -> int:
    """Sticks that are not centred; by stick the steering cannot be."""
    failed = 0
    if pilot.throttle != 0.0:
        failed |= THROTTLE_OFF_CENTRE
    if method != BY_RUDDER and pilot.steering != 0.0:
        failed |= STEERING_OFF_CENTRE
    return failed


@law
def check_now(v: Vehicle, method: int) -> int:
    """All failed checks of arming at this moment by ``method``."""
    ap = v.autopilot
    failed = check(v)
    if ap.rc.receiver_ok and wants(ap.params.ARMING, CHECK_RC):
        failed |= stick_checks(ap.modes.pilot, method)
    if method == BY_RUDDER:
        if ap.params.ARMING.RUDDER < 1.0:
            failed |= RUDDER_DISABLED
        if not allows_arming_by_stick(ap.modes.number):
            failed |= MODE_BY_RUDDER
    return failed
