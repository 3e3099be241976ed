# SPDX-License-Identifier: BSD-3-Clause
"""The rover's arming checks. Modes that need a position check it; forcing skips all, as does ARMING_CHECK 0."""

from __future__ import annotations

from ...core.kernels import law
from ..arming_checks import (
    AHRS_TYPE,
    BY_RUDDER,
    CHECK_GPS,
    CHECK_PARAMETERS,
    CHECK_RC,
    EKF_FAILSAFE,
    EMERGENCY_STOP,
    FENCE_SHIFT,
    GPS_FIX,
    MODE,
    MODE_BY_RUDDER,
    NO_MISSION,
    NO_OUTPUTS,
    NOT_INITIALISED,
    RUDDER_DISABLED,
    STEERING_OFF_CENTRE,
    THROTTLE_OFF_CENTRE,
    WAYPOINT_SPEED,
    battery_checks,
    calibration_checks,
    proximity_checks,
    radio_checks,
    sensor_checks,
    wants,
)
from ..fence import arming as fence_arming
from ..params.system import Arming
from ..state import Estimate
from .control import servos
from .control.motors import is_skid
from .heights import HEIGHTS
from .modes.auto import AUTO
from .modes.state import Modes, PilotState
from .modes.table import allows_arming, allows_arming_by_stick, requires_position, requires_velocity
from .parameters import Parameters
from .state import Vehicle


@law
def estimate_checks(modes: Modes, estimate: Estimate, gps_fix: int, params: Parameters) -> int:
    """Failed checks of GPS and estimate, as far as the mode needs them; the first of them."""
    if not requires_position(modes.number) and not requires_velocity(modes.number, is_skid(params)):
        return 0
    if gps_fix < 3 and wants(params.ARMING, CHECK_GPS):
        return GPS_FIX
    if not estimate.position_ok:
        return AHRS_TYPE
    return EKF_FAILSAFE if modes.failsafe.ekf != 0 else 0


@law
def parameter_checks(p: Parameters) -> int:
    """Failed checks of outputs and parameters."""
    failed = 0
    if not (servos.is_assigned(p, servos.STEERING) or servos.is_assigned(p, servos.THROTTLE) or is_skid(p)):
        failed |= NO_OUTPUTS
    if p.WP.SPEED <= 0.0 and wants(p.ARMING, CHECK_PARAMETERS):
        failed |= WAYPOINT_SPEED
    return failed


@law
def check(v: Vehicle) -> int:
    """Failed checks before arming, 0 when the vehicle is ready (in its present mode)."""
    ap = v.autopilot
    modes, p = ap.modes, ap.params
    sensors = sensor_checks(v.time_us, v.sensors, ap.estimate.attitude_ok, p)
    sensors |= calibration_checks(ap.calibrated.state, p.ARMING)
    if p.ARMING.CHECK == 0.0:
        return sensors & NOT_INITIALISED
    estimate = estimate_checks(modes, ap.estimate, v.sensors.gps_fix, p)
    sensors |= proximity_checks(ap.proximity, v.time_us)
    failed = sensors | estimate | battery_checks(ap.battery, modes.failsafe.battery, p) | parameter_checks(p)
    if modes.number == AUTO and modes.mission_count < 2:
        failed |= NO_MISSION
    if ap.arming.emergency_stop:
        failed |= EMERGENCY_STOP
    if p.FS.THR_ENABLE > 0.0 and wants(p.ARMING, CHECK_RC):
        failed |= radio_checks(ap.rc, p.RCMAP, p.FS.THR_VALUE)
    failed |= fence_arming.refusal(ap.fence, ap.estimate, ap.home, p.FENCE, HEIGHTS) << FENCE_SHIFT
    return failed if allows_arming(modes.number) else failed | MODE


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
def method_checks(modes: Modes, receiver_ok: bool, method: int, params: Arming) -> int:
    """Failed checks of arming at this moment by ``method``, besides those of ``check``."""
    failed = 0
    if receiver_ok and wants(params, CHECK_RC):
        failed |= stick_checks(modes.pilot, method)
    if method == BY_RUDDER:
        if params.RUDDER < 1.0:
            failed |= RUDDER_DISABLED
        if not allows_arming_by_stick(modes.number):
            failed |= MODE_BY_RUDDER
    return failed
