# SPDX-License-Identifier: BSD-3-Clause
"""FOLLOW: follows another vehicle by its position messages (FOLL_*); holds its position without them."""

from __future__ import annotations

from ....core.algebra import horizontal, norm2
from ....core.elementary import atan2
from ....core.kernels import law
from ....core.vectors import Vec3
from ... import followed_vehicle as lead_motion
from ...control.shaping import Motion, Motion2
from ...events import emit
from ...followed_vehicle import FOLLOW_OFF, FOLLOW_OFFSET
from ...modes import ModeResult
from ...state import FollowState
from ..control import altitude, position
from ..control.spool import DesiredSpoolState
from ..control.state import DT
from ..state import Vehicle
from . import auto_yaw, ground
from .mode import CopterMode, never_arms
from .state import AutoYaw

FOLLOW = 23

# FOLL_YAW_BEHAVE
_KEEP, _FACE_LEAD, _AS_LEAD, _ALONG = 0, 1, 2, 3


@law
def start(v: Vehicle) -> int:
    """Enter: FOLL_ENABLE must be set."""
    ap = v.autopilot
    if ap.params.FOLL.ENABLE == 0.0:
        emit(ap.events, v.time_us, FOLLOW_OFF, 0.0, 0.0)
        return ModeResult.INIT_FAILED
    lead_motion.begin(ap.modes.follow)
    auto_yaw.set_default(ap.modes.auto_yaw, ap.params.WP, False, ap.control.attitude, ap.estimate)
    ground.start_position_control(ap.control, ap.estimate, ap.params)
    return ModeResult.ACCEPTED


@law
def look(yaw: AutoYaw, lead: FollowState, pos: Vec3, behaviour: int) -> None:
    """Point the nose as FOLL_YAW_BEHAVE says; where that says nothing, it stays; ``pos``: the vehicle's [m]."""
    direction = horizontal(lead.pos - pos) if behaviour == _FACE_LEAD else horizontal(lead.vel)
    if behaviour == _AS_LEAD:
        auto_yaw.follow_angle(yaw, lead.heading, lead.heading_rate)
    elif behaviour in (_FACE_LEAD, _ALONG) and norm2(direction) > 1.0:
        auto_yaw.follow_angle(yaw, atan2(direction.y, direction.x), 0.0)


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    control, est, p, lead = ap.control, ap.estimate, ap.params, ap.modes.follow
    if ground.is_grounded(ap.arming):
        ground.rest(ap.arming.armed, control, est, p)
        return
    control.motors.desired_spool = DesiredSpoolState.THROTTLE_UNLIMITED
    auto_yaw.follow_angle(ap.modes.auto_yaw, control.attitude.target_euler.yaw, 0.0)
    if lead_motion.follow(lead, p.FOLL, est.pos, v.time_us, DT):
        if lead_motion.keep_distance(lead, p.FOLL, est.pos):
            emit(ap.events, v.time_us, FOLLOW_OFFSET, p.FOLL.OFS_TYPE, 0.0)
        pos, vel, acc = lead.pos + lead_motion.offset(lead, p.FOLL), lead.vel, lead.acc
        position.input_pos_vel_accel_ne(control.pos_ne, Motion2(horizontal(pos), horizontal(vel), horizontal(acc)))
        altitude.input_pos_vel_accel_d(control.pos_d, Motion(pos.z, vel.z, acc.z))
        look(ap.modes.auto_yaw, lead, est.pos, int(p.FOLL.YAW_BEHAVE))
    else:
        ground.brake(control)
    ground.fly(ap.modes.auto_yaw, control, est, p)


MODE = CopterMode(
    number=FOLLOW, name="FOLLOW", start=start, run=run, needs_position=True, autonomous=True, may_arm=never_arms
)
