# SPDX-License-Identifier: BSD-3-Clause
"""Where the copter is going, and what its controllers follow."""

from __future__ import annotations

from ...autopilot.copter.control.state import PositionState
from ...autopilot.copter.modes.auto import AUTO, is_guided
from ...autopilot.copter.modes.guided import GUIDED
from ...autopilot.copter.modes.loiter import LOITER
from ...autopilot.copter.modes.rtl import RTL
from ...autopilot.copter.modes.smart_rtl import SMART_RTL
from ...autopilot.copter.modes.zigzag import ZIGZAG
from ...autopilot.copter.navigation.waypoint import from_origin
from ...core.algebra import norm2
from ...core.elementary import atan2, hypot
from ...core.geodesy import add_offset
from ...core.kernels import law
from ...core.mavlink import MavFrame
from ...core.records import Floats
from ...core.vectors import Vec2, Vec3
from ...vehicle.copter import Copter
from ..services.setpoint_messages import ACCELERATION_IGNORED, POSITION_IGNORED, VELOCITY_IGNORED, YAWS_IGNORED
from ..telemetry.own import NavControllerOutput, PositionTargetGlobalInt
from ..telemetry.units import DEG, boot_ms, int16, int32, uint16
from ..wire.message import Message, consecutive

_FLY_TO_A_POSITION = (AUTO, GUIDED, RTL, SMART_RTL)
_FOLLOW_A_TRACK = (*_FLY_TO_A_POSITION, LOITER, ZIGZAG)


@law
def beside_track(c: PositionState, pos: Vec3) -> float:
    """Distance beside the track [m]: across the velocity wanted, or to the location where there is none."""
    error, along = c.pos_desired - Vec2(pos.x, pos.y), c.vel_desired
    speed = norm2(along)
    if speed == 0.0:
        return norm2(error)
    return abs(error.x * along.y - error.y * along.x) / speed


@law
def nav_controller_output(m: NavControllerOutput, v: Copter) -> bool:
    """NAV_CONTROLLER_OUTPUT: lean targets, bearings [deg], distance to the target and beside the track [m],
    altitude error [m], as ArduCopter 4.7 has it: negative below the target."""
    modes, control, pos = v.autopilot.modes, v.autopilot.control, v.autopilot.estimate.pos
    euler = control.attitude.target_euler
    if is_guided(modes):
        to = modes.guided.pos
    elif modes.number == AUTO or modes.number == SMART_RTL:
        to = modes.nav.target
    else:
        to = v.autopilot.home.pos
    if modes.number in _FLY_TO_A_POSITION:
        m.target_bearing = int16(atan2(to.y - pos.y, to.x - pos.x) * DEG)
        m.wp_dist = uint16(hypot(to.x - pos.x, to.y - pos.y))
    if modes.number in _FOLLOW_A_TRACK:
        m.xtrack_error = beside_track(control.pos_ne, pos)
    m.nav_roll = euler.roll * DEG
    m.nav_pitch = euler.pitch * DEG
    m.nav_bearing = int16(euler.yaw * DEG)
    m.alt_error = control.pos_d.pos_error
    return True


POSITION = VELOCITY_IGNORED | ACCELERATION_IGNORED | YAWS_IGNORED
TARGET_MASKS = (
    POSITION,  # TAKEOFF
    POSITION,  # POSITION
    YAWS_IGNORED,  # POS_VEL_ACCEL
    POSITION_IGNORED | YAWS_IGNORED,  # VELOCITY_ACCEL
    POSITION_IGNORED | VELOCITY_IGNORED | YAWS_IGNORED,  # ACCEL
)
"""By GUIDED's submode: what of the target does not count; others have no such target."""
LAST_BITS = 0xF000
"""ArduPilot sets what no bit of POSITION_TARGET_TYPEMASK is, too."""


class PositionTargetLocalNed(Message, name="POSITION_TARGET_LOCAL_NED"):
    time_boot_ms: int
    pos: Vec3 = consecutive("x", "y", "z")
    vel: Vec3 = consecutive("vx", "vy", "vz")
    acc: Vec3 = consecutive("afx", "afy", "afz")
    type_mask: int
    coordinate_frame: int


@law
def position_target_local(m: PositionTargetLocalNed, v: Copter) -> bool:
    """POSITION_TARGET_LOCAL_NED: the target of GUIDED; nothing in other modes."""
    guided = v.autopilot.modes.guided
    if not is_guided(v.autopilot.modes) or not 0 <= guided.submode < len(TARGET_MASKS):
        return False
    m.time_boot_ms = boot_ms(v.time_us)
    m.pos, m.vel, m.acc = guided.pos, guided.vel, guided.acc
    m.type_mask = TARGET_MASKS[guided.submode]
    m.coordinate_frame = MavFrame.LOCAL_NED
    return True


@law
def position_target_global(m: PositionTargetGlobalInt, v: Copter) -> bool:
    """POSITION_TARGET_GLOBAL_INT: where GUIDED and AUTO fly to (degE7, m above sea level); nothing in other modes."""
    modes, estimate = v.autopilot.modes, v.autopilot.estimate
    if not estimate.origin_set or (modes.number != AUTO and modes.number != GUIDED):
        return False
    to = from_origin(modes.nav, modes.guided.pos if is_guided(modes) else modes.nav.target)
    location = add_offset(estimate.origin_lat, estimate.origin_lon, to.x, to.y)
    m.time_boot_ms = boot_ms(v.time_us)
    m.lat_int = int32(location.lat)
    m.lon_int = int32(location.lon)
    m.alt = estimate.origin_alt - to.z
    m.type_mask = LAST_BITS | POSITION
    return True


class AttitudeTarget(Message, name="ATTITUDE_TARGET"):
    time_boot_ms: int
    q: Floats
    rates: Vec3 = consecutive("body_roll_rate", "body_pitch_rate", "body_yaw_rate")
    thrust: float


@law
def attitude_target(m: AttitudeTarget, v: Copter) -> bool:
    """ATTITUDE_TARGET: quaternion, body rates [rad/s], throttle 0..1 that the controllers follow."""
    control = v.autopilot.control
    q = control.attitude.target_q
    m.time_boot_ms = boot_ms(v.time_us)
    m.q[0] = q.w
    m.q[1] = q.x
    m.q[2] = q.y
    m.q[3] = q.z
    m.rates = control.attitude.rate_target
    m.thrust = control.motors.throttle_in
    return True


MESSAGES = (nav_controller_output, position_target_local, position_target_global, attitude_target)
