# SPDX-License-Identifier: BSD-3-Clause
"""The rover's arming checks. Modes that need a position check it; forcing skips all, as does ARMING_CHECK 0."""

from __future__ import annotations

from ...core.kernels import law
from .. import arming_checks as checks
from .. import radio_checks
from ..barometers import are_healthy
from ..fence import arming as fence_arming
from ..radio import ROLL, THROTTLE, YAW
from ..radio_checks import RC_MISSING
from ..sensor_calibration import NEEDS_LOCATION
from ..state import Estimate, Radio
from .control import servos
from .control.motors import is_skid
from .heights import HEIGHTS
from .modes.auto import AUTO
from .modes.mode_list import allows_arming, allows_arming_by_stick, requires_position, requires_velocity
from .modes.state import BIT_RADIO, Modes
from .parameters import Parameters
from .state import Vehicle

WAYPOINT_SPEED = 1 << 17
"""A bit that is another check of copters."""
TEXTS = {WAYPOINT_SPEED: "WP_SPEED too low"}
_ROLL_OFF, _THROTTLE_OFF = radio_checks.OFF_CENTRE[ROLL], radio_checks.OFF_CENTRE[THROTTLE]
_YAW_OFF = radio_checks.OFF_CENTRE[YAW]


@law
def estimate_checks(modes: Modes, estimate: Estimate, gps_fix: int, params: Parameters, state: int) -> int:
    """Failed checks of GPS and estimate, as far as the mode or ARMING_NEED_LOC (``state``) needs them; the first."""
    wanted = state & NEEDS_LOCATION != 0 or requires_position(modes.number)
    if not wanted and not requires_velocity(modes.number, is_skid(params)):
        return 0
    if gps_fix < 3 and checks.wants(params.ARMING, checks.CHECK_GPS):
        return checks.GPS_FIX
    if not estimate.position_ok:
        return checks.AHRS_TYPE
    return checks.EKF_FAILSAFE if modes.failsafe.ekf != 0 else 0


@law
def parameter_checks(p: Parameters) -> int:
    """Failed checks of outputs and parameters."""
    failed = 0
    if not (servos.is_assigned(p, servos.STEERING) or servos.is_assigned(p, servos.THROTTLE) or is_skid(p)):
        failed |= checks.NO_OUTPUTS
    if p.WP.SPEED <= 0.0 and checks.wants(p.ARMING, checks.CHECK_PARAMETERS):
        failed |= WAYPOINT_SPEED
    return failed


@law
def check(v: Vehicle) -> int:
    """Failed checks before arming, 0 when the vehicle is ready (in its present mode)."""
    ap = v.autopilot
    modes, p = ap.modes, ap.params
    sensors = checks.sensor_checks(v)
    sensors |= checks.calibration_checks(ap.calibrated.state, p.ARMING) | checks.parameter_checks(ap.calibrated.state)
    if p.ARMING.CHECK == 0.0:
        return sensors & checks.NOT_INITIALISED
    estimate = estimate_checks(modes, ap.estimate, v.sensors.gps_fix, p, ap.calibrated.state)
    if checks.wants(p.ARMING, checks.CHECK_GPS):
        sensors |= checks.receiver_checks(v.sensors, p)
    if checks.wants(p.ARMING, checks.CHECK_BARO) and not are_healthy(ap.baros, v.sensors, v.time_us):
        sensors |= checks.BAROMETER
    sensors |= checks.proximity_checks(ap.proximity, v.time_us)
    failed = sensors | estimate | checks.battery_checks(ap.battery, modes.failsafe.battery, p) | parameter_checks(p)
    if modes.number == AUTO and modes.mission_count < 2:
        failed |= checks.NO_MISSION
    if ap.arming.emergency_stop:
        failed |= checks.EMERGENCY_STOP
    if checks.wants(p.ARMING, checks.CHECK_RC):
        if modes.links.bad & BIT_RADIO != 0:
            failed |= checks.RADIO_FAILSAFE
        elif p.FS.THR_ENABLE > 0.0 and not ap.rc.receiver_ok:
            failed |= RC_MISSING
    failed |= fence_arming.refusal(ap.fence, ap.estimate, ap.home, p.FENCE, HEIGHTS) << checks.FENCE_SHIFT
    return failed if allows_arming(modes.number) else failed | checks.MODE


@law
def stick_checks(rc: Radio, p: Parameters, method: int) -> int:
    """Sticks that are not at rest; by stick the steering cannot be."""
    failed = radio_checks.off_centre(rc, p, THROTTLE, _THROTTLE_OFF) | radio_checks.off_centre(rc, p, YAW, _YAW_OFF)
    return failed if method == checks.ArmingMethod.RUDDER else failed | radio_checks.off_centre(rc, p, ROLL, _ROLL_OFF)


@law
def method_checks(modes: Modes, rc: Radio, method: int, p: Parameters, state: int) -> int:
    """Failed checks of arming at this moment by ``method``, besides those of ``check``.

    ``state``: of switches on channels (``Calibrated.state``).
    """
    failed = 0
    if rc.receiver_ok and checks.wants(p.ARMING, checks.CHECK_RC):
        failed |= stick_checks(rc, p, method) | checks.switch_checks(state, rc.receiver_ok)
    if method == checks.ArmingMethod.RUDDER:
        if p.ARMING.RUDDER < 1.0:
            failed |= checks.RUDDER_DISABLED
        if not allows_arming_by_stick(modes.number):
            failed |= checks.MODE_BY_RUDDER
    return failed
