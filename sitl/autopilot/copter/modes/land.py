# SPDX-License-Identifier: BSD-3-Clause
"""LAND: descends where it is, fast down to LAND_ALT_LOW and then at LAND_SPEED, until it has landed.

``descend`` is also the last part of RTL and of AUTO's land command.
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import constrain
from ....core.vectors import Vec2
from ...arming_checks import BY_LANDING
from ...control.shaping import sqrt_controller
from ...modes import REASON_THROTTLE_LAND_ESCAPE
from .. import pilot
from ..control import altitude, altitude_start, attitude, position, position_start
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
def start(v):
    """Enter LAND; with position control when there is a position. Returns 0."""
    ap = v.autopilot
    begin(v)
    ap.modes.land.with_position = 1 if ap.estimate.position_ok != 0 else 0
    return 0


@law
def begin(v):
    """Prepare a descent from the present motion."""
    ap = v.autopilot
    land = ap.modes.land
    ground.set_waypoint_limits(v)
    if not position_start.is_active_ne(ap.control):
        position_start.init_ne(ap)
    if not altitude_start.is_active_d(ap.control):
        altitude_start.init_d(ap)
    land.start_us = v.time_us
    land.pause = 0
    land.with_position = 1
    auto_yaw.set_mode(v, auto_yaw.HOLD)


@law
def run(v):
    """One tick of the mode LAND."""
    ap = v.autopilot
    auto_yaw.pilot(v)
    land = ap.modes.land
    if land.pause != 0 and v.time_us - land.start_us >= PAUSE_US:
        land.pause = 0
    if land.with_position != 0 and ap.estimate.position_ok == 0:
        land.with_position = 0
    finish(v)
    if ground.is_grounded(v):
        ground.handle(v)
        return
    ap.control.motors.desired_spool = ground.UNLIMITED
    if is_cancelled(v):
        return
    if land.with_position != 0:
        descend(v, int(land.pause))
    else:
        descend_blind(v, int(land.pause))


@law
def finish(v):
    """Disarm when landed and the motors have come down to idle."""
    ap = v.autopilot
    if ap.arming.landed != 0 and ap.control.motors.spool_state == ground.IS_GROUND_IDLE:
        ground.disarm(v, BY_LANDING)


@law
def is_cancelled(v):
    """Whether the pilot's high throttle asks for LOITER (or ALT_HOLD) instead."""
    ap = v.autopilot
    if (int(ap.params.PILOT.THR_BHV) & _CANCEL_BEHAVIOUR) == 0 or ap.modes.pilot.throttle <= _CANCEL_THROTTLE:
        return False
    ap.modes.wanted = (LOITER if ap.estimate.position_ok != 0 else ALT_HOLD) + 1
    ap.modes.wanted_reason = REASON_THROTTLE_LAND_ESCAPE
    return True


@law
def descend(v, pause):
    """One tick of a landing with position control; the sticks move the landing place (LAND_REPOSITION)."""
    ap = v.autopilot
    if ap.arming.landed_maybe != 0:
        position_start.soften_for_landing_ne(ap.control.pos_ne, ap.estimate.pos)
    position.input_vel_accel_ne(ap.control.pos_ne, stick_velocity(ap), Vec2(0.0, 0.0))
    sink(v, pause)
    ground.fly(v)


@law
def descend_blind(v, pause):
    """One tick of a landing without a position: the sticks lean the vehicle."""
    ap = v.autopilot
    roll, pitch = 0.0, 0.0
    if ap.params.LAND.REPOSITION != 0.0:
        most = math.radians(ap.params.ANGLE_MAX * 0.01)
        roll, pitch = pilot.lean_angles(ap, most, most)
    sink(v, pause)
    altitude.update_d(ap)
    attitude.input_euler_roll_pitch_yaw_rate(ap, roll, pitch, float(ap.modes.pilot.yaw_rate))


@law
def sink(v, pause):
    """Descent of this tick: fast above LAND_ALT_LOW (height above home), then LAND_SPEED."""
    ap = v.autopilot
    p = ap.params
    slow = abs(p.LAND.SPEED) * 0.01
    low = max(p.LAND.ALT_LOW * 0.01, 1.0)
    height = float(ap.home.pos[2] - ap.estimate.pos[2])
    if pause != 0:
        altitude.land_at_rate_d(ap.control.pos_d, 0.0, False)
        return
    fast = p.LAND.SPEED_HIGH * 0.01
    if fast <= 0.0:
        fast = float(ap.control.pos_d.speed_down)
    fast = max(fast, slow)
    down = sqrt_controller(height - low, p.PSC.POSZ_P, float(ap.control.pos_d.accel_max), 0.0025)
    rate = constrain(down, slow, fast)
    altitude.land_at_rate_d(ap.control.pos_d, rate, height < low or ap.arming.landed_maybe != 0)


@law
def stick_velocity(ap):
    """(north, east) [m/s] that the sticks ask for while landing; zero without LAND_REPOSITION."""
    sticks = ap.modes.pilot
    if ap.params.LAND.REPOSITION == 0.0 or (sticks.roll == 0.0 and sticks.pitch == 0.0):
        return Vec2(0.0, 0.0)
    most = ap.params.WPNAV.ACCEL * 0.01 * _REPOSITION_ACCEL
    forward, right = -float(sticks.pitch) * most, float(sticks.roll) * most
    size = math.sqrt(forward * forward + right * right)
    if size > most:
        forward *= most / size
        right *= most / size
    yaw = float(ap.estimate.euler[2])
    c, s = math.cos(yaw), math.sin(yaw)
    return Vec2(forward * c - right * s, forward * s + right * c)


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
