# SPDX-License-Identifier: BSD-3-Clause
"""LAND: descends where it is, fast down to LAND_ALT_LOW and then at LAND_SPEED, until it has landed.

``descend`` is also the last part of RTL and of AUTO's land command.
"""

from __future__ import annotations

import math

from ....core.algebra import ZERO2, turned
from ....core.kernels import law
from ....core.scalars import constrain
from ....core.vectors import Vec2
from ...arming_checks import BY_LANDING
from ...control.shaping import sqrt_controller
from ...modes import ACCEPTED, REASON_THROTTLE_LAND_ESCAPE
from .. import pilot
from ..control import altitude, attitude, position, position_start
from ..control.state import DT, AltitudeState
from ..parameters.flight import Land
from ..state import Autopilot, Vehicle
from . import auto_yaw, ground
from .alt_hold import ALT_HOLD
from .loiter import LOITER
from .mode import CopterMode, never_arms, yes

LAND = 9

PAUSE_US = 4_000_000
"""A landing that a failsafe began waits so long, for the pilot to notice."""

_CANCEL_BEHAVIOUR = 2
"""PILOT_THR_BHV: a high throttle stick cancels the landing."""
_CANCEL_THROTTLE = 0.7
_REPOSITION_ACCEL = 0.5
"""The pilot's full stick is WPNAV_ACCEL times this many seconds of speed."""


@law
def start(v: Vehicle) -> int:
    """Enter; with position control when there is a position."""
    begin(v)
    v.autopilot.modes.land.with_position = v.autopilot.estimate.position_ok
    return ACCEPTED


@law
def begin(v: Vehicle) -> None:
    """Prepare a descent from the present motion."""
    ap = v.autopilot
    ground.set_waypoint_limits(ap)
    ground.continue_position_control(ap)
    ap.modes.land.start_us = v.time_us
    ap.modes.land.pause = False
    ap.modes.land.with_position = True
    auto_yaw.set_mode(ap, auto_yaw.HOLD)


@law
def run(v: Vehicle) -> None:
    """One tick of the mode LAND."""
    ap = v.autopilot
    auto_yaw.follow_pilot(ap)
    land = ap.modes.land
    if land.pause and v.time_us - land.start_us >= PAUSE_US:
        land.pause = False
    if land.with_position and not ap.estimate.position_ok:
        land.with_position = False
    finish(v)
    if ground.is_grounded(ap.arming):
        ground.rest(ap)
        return
    ap.control.motors.desired_spool = ground.UNLIMITED
    if is_cancelled(ap):
        ap.modes.wanted = (LOITER if ap.estimate.position_ok else ALT_HOLD) + 1
        ap.modes.wanted_reason = REASON_THROTTLE_LAND_ESCAPE
    elif land.with_position:
        descend(ap, land.pause)
    else:
        descend_blind(ap, land.pause)


@law
def finish(v: Vehicle) -> None:
    """Disarm when landed and the motors have come down to idle."""
    ap = v.autopilot
    if ap.arming.landed and ap.control.motors.spool_state == ground.IS_GROUND_IDLE:
        ground.disarm(v, BY_LANDING)


@law
def is_cancelled(ap: Autopilot) -> bool:
    """Whether the pilot's high throttle asks for LOITER (or ALT_HOLD) instead."""
    return (int(ap.params.PILOT.THR_BHV) & _CANCEL_BEHAVIOUR) != 0 and ap.modes.pilot.throttle > _CANCEL_THROTTLE


@law
def descend(ap: Autopilot, pause: bool) -> None:
    """One tick of a landing with position control; the sticks move the landing place (LAND_REPOSITION)."""
    vel = stick_velocity(ap)
    if ap.arming.landed_maybe:
        position_start.soften_for_landing_ne(ap.control.pos_ne, ap.estimate.pos)
    position.input_vel_accel_ne(ap.control.pos_ne, vel, ZERO2)
    sink(ap, pause)
    ground.fly(ap)


@law
def descend_blind(ap: Autopilot, pause: bool) -> None:
    """One tick of a landing without a position: the sticks lean the vehicle."""
    lean = attitude.Lean(0.0, 0.0)
    if ap.params.LAND.REPOSITION != 0.0:
        lean_max = math.radians(ap.params.ANGLE_MAX * 0.01)
        lean = pilot.lean_angles(ap.modes.pilot, lean_max, lean_max)
    sink(ap, pause)
    altitude.update_d(ap.control, ap.estimate, ap.params)
    attitude.input_euler_roll_pitch_yaw_rate(ap.control, ap.estimate, ap.params, lean, ap.modes.pilot.yaw_rate)


@law
def sink_rate(height: float, limits: AltitudeState, p: Land, pos_p: float) -> float:
    """Descent [m/s] at a height above home [m]: fast above LAND_ALT_LOW, then LAND_SPEED.

    ``pos_p``: gain of the position loop [1/s].
    """
    slow = abs(p.SPEED) * 0.01
    fast = p.SPEED_HIGH * 0.01
    if fast <= 0.0:
        fast = limits.speed_down
    fast = max(fast, slow)
    return constrain(sqrt_controller(height - height_low(p), pos_p, limits.accel_max, DT), slow, fast)


@law
def height_low(p: Land) -> float:
    """LAND_ALT_LOW, at least a metre [m]."""
    return max(p.ALT_LOW * 0.01, 1.0)


@law
def sink(ap: Autopilot, pause: bool) -> None:
    """Descent of this tick."""
    path = ap.control.pos_d
    if pause:
        altitude.land_at_rate_d(path, 0.0, False)
        return
    height = ap.home.pos.z - ap.estimate.pos.z
    near_ground = height < height_low(ap.params.LAND) or ap.arming.landed_maybe
    rate = sink_rate(height, path, ap.params.LAND, ap.params.PSC.POSZ_P)
    altitude.land_at_rate_d(path, rate, near_ground)


@law
def stick_velocity(ap: Autopilot) -> Vec2:
    """North and east [m/s] that the sticks ask for while landing; zero without LAND_REPOSITION."""
    sticks = ap.modes.pilot
    if ap.params.LAND.REPOSITION == 0.0 or (sticks.roll == 0.0 and sticks.pitch == 0.0):
        return Vec2(0.0, 0.0)
    speed_max = ap.params.WPNAV.ACCEL * 0.01 * _REPOSITION_ACCEL
    forward_right = pilot.limit_stick(Vec2(-sticks.pitch * speed_max, sticks.roll * speed_max), speed_max)
    return turned(forward_right, ap.estimate.euler.yaw)


MODE = CopterMode(
    number=LAND,
    name="LAND",
    start=start,
    run=run,
    standard_mode=7,
    uses_position=True,
    autonomous=True,
    may_arm=never_arms,
    is_landing=yes,
)
