# SPDX-License-Identifier: BSD-3-Clause
"""A descent onto a target that a sensor sees (PLND_*), and what happens without one: PLND_STRICT."""

from __future__ import annotations

from ....core.algebra import ZERO2, horizontal, with_down
from ....core.kernels import law
from ....core.vectors import Vec2, Vec3
from ...control.shaping import Motion, Motion2
from ...events import Events, emit
from ...landing_target.estimator import distance, target_position
from ...landing_target.state import (
    FOUND,
    LANDING_TARGET_DID,
    LOST,
    OUT_OF_RANGE,
    SAID_FAILSAFE,
    SAID_RETRIED,
    SAID_RETRY,
    LandingTarget,
)
from ...params.precision_landing import PrecisionLanding
from ...state import Estimate
from ..control import altitude, position, position_start
from ..parameters import Parameters
from ..state import Vehicle
from ..terrain_following import height_over_ground
from . import descent, ground
from .state import LandState

DESCENDING, CLIMBING, RETURNING, GIVEN_UP = range(4)
"""Stages: on the way down; up to try again, and back to where the target was seen; a failsafe."""
GO_DOWN, STAY, TRY_AGAIN = range(3)

HOLD_US = 7_000_000
"""A vehicle that gave up hovers so long before it lands."""
RETRY_CLIMB = 1.5
"""It tries again from so far above where it saw the target [m]."""
NEAR = 0.75
"""And is there when it is so near [m]."""
SLOW_FROM, SLOW_TO = 2.0, 0.35
"""Heights over the target between which the descent is slow [m]."""
SLOWEST, ERROR_MAX = 0.1, 0.15
"""That descent is half of LAND_SPEED over the target, and so slow [m/s] from so far aside [m] on."""

# PLND_OPTIONS
_MOVES, _AFTER_STICKS, _FAST = 1, 2, 4
_LANDS, _HOVERS = 0, 2
"""PLND_STRICT"""


@law
def has_option(p: PrecisionLanding, option: int) -> bool:
    """Whether a bit of PLND_OPTIONS is set."""
    return (int(p.OPTIONS) & option) != 0


@law
def descend(v: Vehicle) -> None:
    """One tick of a landing with position control."""
    ap = v.autopilot
    modes, est, p = ap.modes, ap.estimate, ap.params
    height = height_over_ground(v)
    if p.PLND.ENABLED == 0.0:
        descent.descend(modes, height, ap.arming.landed_maybe, ap.control, est, p)
        return
    sticks = descent.stick_velocity(modes.pilot, est.yaw, p)
    if sticks.x != 0.0 or sticks.y != 0.0:
        modes.land.repositioned = True
    elif has_option(p.PLND, _AFTER_STICKS):
        modes.land.repositioned = False
    action = choose(modes.land, ap.landing_target, est.pos, ap.events, v.time_us, p.PLND)
    if action == TRY_AGAIN:
        fly_back(v)
    else:
        follow(v, sticks, height, action == STAY)


@law
def choose(land: LandState, t: LandingTarget, pos: Vec3, events: Events, time_us: int, p: PrecisionLanding) -> int:
    """What to do in this tick of a vehicle at ``pos``: GO_DOWN, STAY or TRY_AGAIN."""
    if land.pause or land.repositioned:
        return GO_DOWN
    if t.status == FOUND:
        land.stage = DESCENDING
        return GO_DOWN
    if t.status == OUT_OF_RANGE or p.STRICT == _LANDS:
        return GO_DOWN
    if t.status != LOST:
        return give_up(land, events, time_us, p)
    if land.stage == DESCENDING:
        if time_us - t.lost_us < p.TIMEOUT * 1e6:
            return GO_DOWN
        if land.tries < p.RET_MAX:
            land.tries += 1
            land.stage = CLIMBING
            emit(events, time_us, LANDING_TARGET_DID, float(SAID_RETRY), 0.0)
    elif land.stage == CLIMBING:
        if is_near(pos, position_to_try(land, t, p)):
            land.stage = RETURNING
    elif land.stage == RETURNING and is_near(pos, position_to_try(land, t, p)):
        emit(events, time_us, LANDING_TARGET_DID, float(SAID_RETRIED), 0.0)
        return give_up(land, events, time_us, p)
    return TRY_AGAIN if land.stage == CLIMBING or land.stage == RETURNING else give_up(land, events, time_us, p)


@law
def give_up(land: LandState, events: Events, time_us: int, p: PrecisionLanding) -> int:
    """There is no target: hover, and land after a while unless PLND_STRICT forbids it."""
    if land.stage != GIVEN_UP:
        land.stage, land.since_us = GIVEN_UP, time_us
        emit(events, time_us, LANDING_TARGET_DID, float(SAID_FAILSAFE), 0.0)
    return STAY if p.STRICT == _HOVERS or time_us - land.since_us < HOLD_US else GO_DOWN


@law
def position_to_try(land: LandState, t: LandingTarget, p: PrecisionLanding) -> Vec3:
    """Where to look for the target again, from the origin [m]."""
    over = t.seen_from if p.RET_BEHAVE == 0.0 else t.last_pos
    return with_down(horizontal(over), t.seen_from.z - (RETRY_CLIMB if land.stage == CLIMBING else 0.0))


@law
def is_near(pos: Vec3, goal: Vec3) -> bool:
    """Whether a vehicle at ``pos`` is at a position [m]."""
    away = goal - pos
    return away.x * away.x + away.y * away.y + away.z * away.z < NEAR * NEAR


@law
def fly_back(v: Vehicle) -> None:
    """One tick of the way to where the target was seen."""
    ap = v.autopilot
    goal = position_to_try(ap.modes.land, ap.landing_target, ap.params.PLND)
    position.input_pos_vel_accel_ne(ap.control.pos_ne, Motion2(horizontal(goal), ZERO2, ZERO2))
    altitude.input_pos_vel_accel_d(ap.control.pos_d, Motion(goal.z, 0.0, 0.0))
    ground.fly(ap.modes.auto_yaw, ap.control, ap.estimate, ap.params)


@law
def follow(v: Vehicle, sticks: Vec2, height: float, stay: bool) -> None:
    """One tick of the descent from ``height`` above home [m], over the target while it is seen; ``stay``: hover.

    ``sticks``: velocity that they ask for [m/s].
    """
    ap = v.autopilot
    modes, control, est, t = ap.modes, ap.control, ap.estimate, ap.landing_target
    on_target = hold_position(v, sticks)
    if on_target and not stay and not modes.land.pause:
        near_ground = height < descent.height_low(ap.params.LAND) or ap.arming.landed_maybe
        rate = descent.sink_rate(height, control.pos_d, ap.params.LAND, ap.params.PSC.POSZ_P)
        altitude.land_at_rate_d(control.pos_d, over_target(t, rate, ap.params), near_ground)
    elif stay:
        altitude.land_at_rate_d(control.pos_d, 0.0, False)
    else:
        descent.sink(control.pos_d, modes.land, height, ap.arming.landed_maybe, ap.params)
    ground.fly(modes.auto_yaw, control, est, ap.params)


@law
def hold_position(v: Vehicle, sticks: Vec2) -> bool:
    """One tick over the target while it is seen, else where it is; whether it is over the target.

    ``sticks``: velocity that they ask for [m/s].
    """
    ap = v.autopilot
    control, est, t = ap.control, ap.estimate, ap.landing_target
    on_target = t.acquired and not ap.modes.land.repositioned
    if ap.arming.landed_maybe:
        position_start.soften_for_landing_ne(control.pos_ne, est.pos)
    if on_target:
        position.input_pos_vel_accel_ne(control.pos_ne, target_motion(t, est, ap.params.PLND))
    else:
        position.input_vel_accel_ne(control.pos_ne, sticks, ZERO2)
    return on_target


@law
def target_motion(t: LandingTarget, est: Estimate, p: PrecisionLanding) -> Motion2:
    """Where the target is and how it moves, from the origin; one that is not said to move stands."""
    vel = t.closing + horizontal(est.vel) if has_option(p, _MOVES) else ZERO2
    return Motion2(target_position(t, est), vel, ZERO2)


@law
def over_target(t: LandingTarget, rate: float, p: Parameters) -> float:
    """Descent [m/s] in place of ``rate``: none while the target is far aside, slow shortly above it."""
    aside = distance(t)
    if aside > p.PLND.XY_DIST_MAX > 0.0:
        return 0.0
    if SLOW_TO < t.measured_pos.z < SLOW_FROM and not has_option(p.PLND, _FAST):
        half = 0.5 * abs(p.LAND.SPEED) * 0.01
        return max(SLOWEST, half - half * aside / ERROR_MAX)
    return rate
