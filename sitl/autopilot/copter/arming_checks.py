# SPDX-License-Identifier: BSD-3-Clause
"""The copter's arming checks. Forcing skips all but the estimate that the mode itself cannot do without."""

from __future__ import annotations

import math

from ...core.elementary import cos
from ...core.kernels import law
from ...core.vectors import Vec3
from .. import arming_checks as checks
from .. import radio, radio_checks
from ..barometers import are_healthy
from ..estimation.status import GPS_GLITCHING
from ..fence import arming as fence_arming
from ..params.system import Arming
from ..radio import PITCH, ROLL, THROTTLE, YAW
from ..sensor_calibration import NEEDS_LOCATION
from ..state import Estimate, Radio
from . import pilot
from .modes.auto import AUTO
from .modes.mode_list import arms_at_any_throttle, has_manual_throttle, may_arm, requires_position
from .modes.state import Modes
from .parameters import Parameters
from .state import Vehicle
from .terrain_following import has_range

TERRAIN_OFF, TERRAIN_WAITS, RTL_TERRAIN_OFF, DOUBTFUL = 1 << 20, 1 << 21, 1 << 22, 1 << 26
"""Bits that are other checks of rovers."""
TEXTS = {
    TERRAIN_OFF: "terrain disabled",
    TERRAIN_WAITS: "waiting for terrain data",
    RTL_TERRAIN_OFF: "RTL_ALT_TYPE is above-terrain but no terrain data",
}
MANDATORY = checks.NEED_POSITION | checks.NEED_ALTITUDE | DOUBTFUL
"""What forcing does not skip."""
_ROLL_OFF, _PITCH_OFF = radio_checks.OFF_CENTRE[ROLL], radio_checks.OFF_CENTRE[PITCH]
_THROTTLE_OFF, _YAW_OFF = radio_checks.OFF_CENTRE[THROTTLE], radio_checks.OFF_CENTRE[YAW]


@law
def lean_check(cos_lean: float, lean_max: float) -> int:
    """A vehicle must stand upright: lean at most ``lean_max`` [rad]."""
    return 0 if cos_lean >= cos(lean_max) else checks.LEANING


@law
def estimate_checks(mode: int, estimate: Estimate, home_set: bool, needs_fix: bool, p: Arming) -> int:
    """Failed checks of position, height and home, as far as the mode needs them.

    ``needs_fix``: there is a GPS receiver without a fix.
    """
    gps = checks.wants(p, checks.CHECK_GPS)
    failed = 0
    if requires_position(mode):
        if not home_set and gps and not (needs_fix and estimate.position_ok):
            failed |= checks.WAITING_FOR_HOME
        elif needs_fix and gps:
            failed |= checks.GPS_FIX
        if not estimate.position_ok:
            failed |= checks.NEED_POSITION
    if not has_manual_throttle(mode) and not estimate.attitude_ok:
        failed |= checks.NEED_ALTITUDE
    return failed


@law
def doubt(estimate: Estimate, limit: float) -> int:
    """DOUBTFUL when fixes are not believed, or a variance is above FS_EKF_THRESH (``limit``)."""
    worst = max(max(estimate.variance_mag, estimate.variance_pos), max(estimate.variance_vel, estimate.variance_hgt))
    bad = estimate.status_flags & GPS_GLITCHING != 0 or (limit > 0.0 and worst >= limit)
    return DOUBTFUL if bad else 0


def doubt_text(estimate: Estimate, limit: float) -> str:
    """Status text of DOUBTFUL."""
    variances = {
        "compass": estimate.variance_mag, "position": estimate.variance_pos, "velocity": estimate.variance_vel,
        "height": estimate.variance_hgt,
    }  # fmt: skip
    for name, value in variances.items():
        if estimate.status_flags & GPS_GLITCHING == 0 and value >= limit:
            return f"EKF {name} variance"
    return "GPS glitching"


@law
def failsafe_checks(modes: Modes, p: Parameters) -> int:
    """Failsafes that are on."""
    failed = checks.RADIO_FAILSAFE if modes.failsafe.radio and checks.wants(p.ARMING, checks.CHECK_RC) else 0
    return failed | (checks.GCS_FAILSAFE if modes.failsafe.gcs and p.ARMING.CHECK != 0.0 else 0)


@law
def location_checks(v: Vehicle) -> int:
    """Failed checks of the position where a mode, a fence or ARMING_NEED_LOC needs it."""
    ap = v.autopilot
    by_mode = requires_position(ap.modes.number)
    by_fence = fence_arming.needs_position(ap.fence, ap.params.FENCE)
    wanted = ap.calibrated.state & NEEDS_LOCATION != 0
    if not (by_mode or by_fence or wanted):
        return 0
    if ap.estimate.position_ok:
        return doubt(ap.estimate, ap.params.FS.EKF_THRESH)
    if wanted:
        return checks.NEED_POSITION
    return 0 if by_mode else checks.FENCE_POSITION  # of modes: ``estimate_checks``


@law
def check(v: Vehicle) -> int:
    """Failed checks before arming, 0 when the vehicle is ready (in its present mode)."""
    ap = v.autopilot
    p = ap.params
    failed = checks.sensor_checks(v)
    failed |= checks.calibration_checks(ap.calibrated.state, p.ARMING) | checks.parameter_checks(ap.calibrated.state)
    failed |= failsafe_checks(ap.modes, p) | location_checks(v)
    needs_fix = p.GPS1_TYPE != 0 and v.sensors.gps_fix < 3
    failed |= estimate_checks(ap.modes.number, ap.estimate, ap.home.is_set, needs_fix, p.ARMING)
    if requires_position(ap.modes.number) and checks.wants(p.ARMING, checks.CHECK_GPS):
        failed |= checks.receiver_checks(v.sensors, p)
    if checks.wants(p.ARMING, checks.CHECK_BARO) and not are_healthy(ap.baros, v.sensors, v.time_us):
        failed |= checks.BAROMETER
    failed |= checks.battery_checks(ap.battery, ap.modes.failsafe.battery, p)
    failed |= checks.proximity_checks(ap.proximity, v.time_us)
    if ap.avoid.obstacles and checks.wants(p.ARMING, checks.CHECK_PARAMETERS):
        failed |= checks.obstacle_check(ap.proximity, v.time_us)
    if ap.modes.number == AUTO and ap.modes.mission_count < 2:
        failed |= checks.NO_MISSION
    if checks.wants(p.ARMING, checks.CHECK_RC):
        if p.FS.THR_ENABLE > 0.0:
            failed |= radio_checks.receiver(ap.rc, p.RCMAP, p.FS.THR_VALUE)
    if ap.arming.interlock_used and ap.arming.interlock_on:
        failed |= checks.INTERLOCK
    if ap.arming.emergency_stop:
        failed |= checks.EMERGENCY_STOP
    if ap.arming.parachute_released:
        failed |= checks.PARACHUTE_RELEASED
    if ap.modes.mission_over_ground or p.RTL.ALT_TYPE > 0.0:
        failed |= terrain_check(v)
    fence = p.FENCE
    limits = Vec3(fence.ALT_MAX, fence.ALT_MIN, fence.AUTOENABLE)
    failed |= fence_arming.refusal(ap.fence, ap.estimate, ap.home, fence, limits) << checks.FENCE_SHIFT
    return failed if ap.control.motors.count > 0 else failed | checks.FRAME


@law
def terrain_check(v: Vehicle) -> int:
    """Failed check of the heights of the ground, where a mission or RTL needs them."""
    if has_range(v):
        return 0
    if v.autopilot.params.TERRAIN.ENABLE <= 0.0:
        return TERRAIN_OFF if v.autopilot.modes.mission_over_ground else RTL_TERRAIN_OFF
    return TERRAIN_WAITS if v.autopilot.terrain.pending > 0 else 0


@law
def arm_checks(modes: Modes, rc: Radio, p: Parameters, method: int, cos_lean: float) -> int:
    """Failed checks that count only at the moment of arming by ``method``; ``cos_lean``: cosine of the lean."""
    failed, mode = 0, modes.number
    if checks.wants(p.ARMING, checks.CHECK_INS):
        failed |= lean_check(cos_lean, math.radians(p.ANGLE_MAX * 0.01))
    if not may_arm(mode, p, method):
        failed |= checks.MODE
    if method == checks.ArmingMethod.RUDDER and p.ARMING.RUDDER < 1.0:
        failed |= checks.RUDDER_DISABLED
    if method != checks.ArmingMethod.MAVLINK or not arms_at_any_throttle(mode):
        if has_manual_throttle(mode):
            if modes.pilot.throttle > 0.0:
                failed |= checks.THROTTLE_HIGH
        elif pilot.climb_rate(modes, rc, p) > 0.0:
            failed |= checks.THROTTLE_HIGH
    return failed


@law
def stick_checks(rc: Radio, p: Parameters, method: int, state: int) -> int:
    """Sticks that are not at rest when all else allows to arm by ``method``; by stick the yaw cannot be.

    ``state``: of switches on other channels (``Calibrated.state``).
    """
    if not rc.receiver_ok or not checks.wants(p.ARMING, checks.CHECK_RC):
        return 0
    failed = radio_checks.off_centre(rc, p, ROLL, _ROLL_OFF) | radio_checks.off_centre(rc, p, PITCH, _PITCH_OFF)
    if method != checks.ArmingMethod.RUDDER:
        failed |= radio_checks.off_centre(rc, p, YAW, _YAW_OFF)
    channel = radio.stick_channel(p.RCMAP, THROTTLE)
    failed |= checks.switch_checks(state, rc.receiver_ok)
    return failed | (_THROTTLE_OFF if radio.ranged(rc.channels[channel], p.RC[channel]) > 0.0 else 0)
