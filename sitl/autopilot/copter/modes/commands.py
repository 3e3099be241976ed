# SPDX-License-Identifier: BSD-3-Clause
"""Commands of MAVLink to the mode under way: take off, turn, look at, fly slower, pause.

Every law returns OK, or says why it left the record as it was.
"""

from __future__ import annotations

from ....core.kernels import law
from ..control import altitude_start, position_start
from . import auto_yaw, guided, takeoff
from .auto import AUTO
from .guided import GUIDED
from .rtl import RTL
from .table import has_climb_stick

OK = 0
NOT_FINITE = 1  # NaN, infinite or so large that arithmetic with it would be
WRONG_MODE = 2
OUT_OF_RANGE = 3
NOT_ARMED = 4
ALREADY_FLYING = 5
TOO_LOW = 6

LARGEST = 1e7
"""Metres, metres a second, radians beyond this are refused."""

HORIZONTAL, CLIMB, DESCENT = 0, 1, 2
"""Kinds of speed that change_speed knows."""


@law
def is_finite3(x, y, z):
    """Whether all of them are usable numbers: neither NaN nor infinite nor absurdly large."""
    return abs(x) <= LARGEST and abs(y) <= LARGEST and abs(z) <= LARGEST


@law
def take_off(v, height):
    """MAV_CMD_NAV_TAKEOFF to ``height`` [m] above home."""
    ap = v.autopilot
    mode = ap.modes.number
    if not abs(height) <= LARGEST:
        return NOT_FINITE
    if ap.arming.armed == 0:
        return NOT_ARMED
    if ap.arming.landed == 0 and not (mode == GUIDED and guided.is_taking_off(v)):
        return ALREADY_FLYING
    if mode != GUIDED and not has_climb_stick(mode):
        return WRONG_MODE
    target_d = ap.home.pos.z - height
    if target_d >= ap.estimate.pos.z:
        return TOO_LOW
    if ap.arming.landed == 0:  # repeated in the climb: a client that missed the acknowledgement
        ap.modes.takeoff.target_d = target_d
        return OK
    if mode == GUIDED:
        guided.take_off(v, target_d)
    else:
        takeoff.begin_user(v, height)
    ap.arming.auto_armed = 1
    return OK


@law
def condition_yaw(v, angle, rate, direction, relative):
    """MAV_CMD_CONDITION_YAW in GUIDED and AUTO: angle [rad], rate [rad/s], direction -1, 0, 1."""
    if not is_finite3(angle, rate, 0.0):
        return NOT_FINITE
    mode = v.autopilot.modes.number
    if mode != GUIDED and mode != AUTO:
        return WRONG_MODE
    if rate < 0.0:
        return OUT_OF_RANGE
    auto_yaw.fixed(v, angle, rate, direction, relative)
    return OK


@law
def set_roi(v, n, e, d):
    """Keep the nose on a point, NED [m]."""
    if not is_finite3(n, e, d):
        return NOT_FINITE
    auto_yaw.look_at(v, n, e, d)
    return OK


@law
def clear_roi(v):
    """Give the heading back to WP_YAW_BEHAVIOR."""
    if v.autopilot.modes.auto_yaw.mode == auto_yaw.ROI:
        auto_yaw.set_default(v, 1 if v.autopilot.modes.number == RTL else 0)
    return OK


@law
def change_speed(v, kind, speed):
    """MAV_CMD_DO_CHANGE_SPEED: HORIZONTAL, CLIMB or DESCENT speed limit [m/s] until the mode or the
    kind of set-point changes.
    """
    if not is_finite3(speed, 0.0, 0.0):
        return NOT_FINITE
    if speed <= 0.0:
        return OUT_OF_RANGE
    ap = v.autopilot
    ne = ap.control.pos_ne
    d = ap.control.pos_d
    if kind == HORIZONTAL:
        position_start.set_max_speed_accel_ne(ap, speed, float(ne.accel_max))
    elif kind == CLIMB:
        altitude_start.set_max_speed_accel_d(ap, float(d.speed_down), speed, float(d.accel_max))
    elif kind == DESCENT:
        altitude_start.set_max_speed_accel_d(ap, speed, float(d.speed_up), float(d.accel_max))
    else:
        return OUT_OF_RANGE
    return OK


@law
def pause(v):
    """MAV_CMD_DO_PAUSE_CONTINUE 0 in GUIDED and AUTO: stop and hold. OK or WRONG_MODE."""
    modes = v.autopilot.modes
    if modes.number == GUIDED:
        modes.guided.paused = 1
        return OK
    if modes.number == AUTO:
        modes.nav.paused = 1
        return OK
    return WRONG_MODE


@law
def resume(v):
    """MAV_CMD_DO_PAUSE_CONTINUE 1: go on."""
    modes = v.autopilot.modes
    if modes.number == GUIDED:
        if modes.guided.paused != 0:
            modes.guided.paused = 0
        return OK
    if modes.number == AUTO:
        modes.nav.paused = 0
        return OK
    return WRONG_MODE
