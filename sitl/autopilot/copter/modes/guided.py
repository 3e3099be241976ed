# SPDX-License-Identifier: BSD-3-Clause
"""Set-points of GUIDED, as the MAVLink services write them.

Every law returns OK, or says why it left the record as it was (``guided_state``). Yaw arguments everywhere:
``use_yaw`` with ``yaw`` [rad], ``use_rate`` with ``yaw_rate`` [rad/s], ``relative`` != 0 when ``yaw``
counts from the present heading; without either the heading follows WP_YAW_BEHAVIOR.
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import constrain
from ..control import altitude_start, position_start
from . import auto_yaw, guided_flight
from .guided_state import (
    ACCEL,
    ANGLE,
    LARGEST,
    NOT_FINITE,
    NOT_IN_GUIDED,
    OK,
    OUT_OF_RANGE,
    POS_VEL_ACCEL,
    POSITION,
    VELOCITY_ACCEL,
)
from .numbers import AUTO, GUIDED, RTL

_THRUST_IS_THRUST = 8
"""GUID_OPTIONS: thrust of SET_ATTITUDE_TARGET is thrust, not climb rate."""

HORIZONTAL, CLIMB, DESCENT = 0, 1, 2
"""Kinds of speed that change_speed knows."""


@law
def is_finite3(x, y, z):
    """Whether all of them are usable numbers: neither NaN nor infinite nor absurdly large."""
    return abs(x) <= LARGEST and abs(y) <= LARGEST and abs(z) <= LARGEST


@law
def refusal(v, x, y, z, yaw, yaw_rate):
    """OK, or why a set-point with these numbers is not taken."""
    if not (is_finite3(x, y, z) and is_finite3(yaw, yaw_rate, 0.0)):
        return NOT_FINITE
    if v.autopilot.modes.number != GUIDED:
        return NOT_IN_GUIDED
    return OK


@law
def set_yaw(v, use_yaw, yaw, use_rate, yaw_rate, relative):
    """Heading that goes with a set-point."""
    if use_yaw != 0 and relative != 0:
        auto_yaw.fixed(v, yaw, 0.0, 0, 1)
    elif use_yaw != 0:
        auto_yaw.angle_rate(v, yaw, yaw_rate if use_rate != 0 else 0.0)
    elif use_rate != 0:
        auto_yaw.turn_rate(v, yaw_rate)
    else:
        auto_yaw.set_default(v, 0)


@law
def begin(v, submode):
    """Prepare for a set-point of this kind and note when it came."""
    modes = v.autopilot.modes
    if modes.guided.submode != submode:
        guided_flight.start_submode(v, submode)
    modes.guided.paused = 0
    modes.guided.update_us = v.time_us


@law
def write(target, x, y, z):
    """Three numbers into a vector of the record."""
    target[0], target[1], target[2] = x, y, z


@law
def set_position(v, n, e, d, use_yaw, yaw, use_rate, yaw_rate, relative):
    """Fly to a point, NED [m] from the origin, and stay."""
    code = refusal(v, n, e, d, yaw, yaw_rate)
    if code == OK:
        begin(v, POSITION)
        write(v.autopilot.modes.guided.pos, n, e, d)
        set_yaw(v, use_yaw, yaw, use_rate, yaw_rate, relative)
    return code


@law
def set_velocity(v, vn, ve, vd, use_yaw, yaw, use_rate, yaw_rate, relative):
    """Fly a velocity, NED [m/s]."""
    return set_velocity_accel(v, vn, ve, vd, 0.0, 0.0, 0.0, use_yaw, yaw, use_rate, yaw_rate, relative)


@law
def set_velocity_accel(v, vn, ve, vd, an, ae, ad, use_yaw, yaw, use_rate, yaw_rate, relative):
    """Fly a velocity [m/s] that changes with an acceleration [m/s^2], NED."""
    code = refusal(v, vn, ve, vd, yaw, yaw_rate)
    if code == OK and not is_finite3(an, ae, ad):
        code = NOT_FINITE
    if code == OK:
        begin(v, VELOCITY_ACCEL)
        write(v.autopilot.modes.guided.vel, vn, ve, vd)
        write(v.autopilot.modes.guided.acc, an, ae, ad)
        set_yaw(v, use_yaw, yaw, use_rate, yaw_rate, relative)
    return code


@law
def set_accel(v, an, ae, ad, use_yaw, yaw, use_rate, yaw_rate, relative):
    """Fly an acceleration, NED [m/s^2]."""
    code = refusal(v, an, ae, ad, yaw, yaw_rate)
    if code == OK:
        begin(v, ACCEL)
        write(v.autopilot.modes.guided.acc, an, ae, ad)
        set_yaw(v, use_yaw, yaw, use_rate, yaw_rate, relative)
    return code


@law
def set_pos_vel_accel(v, n, e, d, vn, ve, vd, an, ae, ad, use_yaw, yaw, use_rate, yaw_rate, relative):
    """Follow a point (NED [m]) that moves with a velocity [m/s] and an acceleration [m/s^2]."""
    code = refusal(v, n, e, d, yaw, yaw_rate)
    if code == OK and not (is_finite3(vn, ve, vd) and is_finite3(an, ae, ad)):
        code = NOT_FINITE
    if code == OK:
        begin(v, POS_VEL_ACCEL)
        write(v.autopilot.modes.guided.pos, n, e, d)
        write(v.autopilot.modes.guided.vel, vn, ve, vd)
        write(v.autopilot.modes.guided.acc, an, ae, ad)
        set_yaw(v, use_yaw, yaw, use_rate, yaw_rate, relative)
    return code


@law
def set_attitude(v, use_attitude, qw, qx, qy, qz, p, q, r, thrust):
    """Fly an attitude (quaternion body to NED) turning with body rates p, q, r [rad/s], or the rates alone.

    ``thrust`` 0 .. 1 is a climb rate around 0.5 (0: WPNAV_SPEED_DN down, 1: WPNAV_SPEED_UP up), or with
    GUID_OPTIONS bit 8 the thrust.
    """
    ap = v.autopilot
    code = refusal(v, p, q, r, thrust, 0.0)
    norm = 1.0
    if code == OK and use_attitude != 0:
        norm = math.sqrt(qw * qw + qx * qx + qy * qy + qz * qz)
        if norm != norm:
            code = NOT_FINITE
        elif norm < 0.5 or norm > 2.0:
            code = OUT_OF_RANGE
    if code != OK:
        return code
    begin(v, ANGLE)
    target = ap.modes.guided
    target.use_attitude = 1 if use_attitude != 0 else 0
    if use_attitude != 0:
        target.q[0], target.q[1], target.q[2], target.q[3] = qw / norm, qx / norm, qy / norm, qz / norm
    write(target.rates, p, q, r)
    share = constrain(thrust, 0.0, 1.0)
    target.use_thrust = 1 if (int(ap.params.GUID.OPTIONS) & _THRUST_IS_THRUST) != 0 else 0
    target.thrust = share
    if share >= 0.5:
        target.climb_rate = (share - 0.5) * 2.0 * ap.control.pos_d.speed_up
    else:
        target.climb_rate = (share - 0.5) * 2.0 * ap.control.pos_d.speed_down
    return code


@law
def stop(v):
    """Come to a stop and hold (velocity zero). OK, or NOT_IN_GUIDED."""
    if v.autopilot.modes.number != GUIDED:
        return NOT_IN_GUIDED
    return set_velocity(v, 0.0, 0.0, 0.0, 0, 0.0, 0, 0.0, 0)


@law
def condition_yaw(v, angle, rate, direction, relative):
    """MAV_CMD_CONDITION_YAW in GUIDED and AUTO: angle [rad], rate [rad/s], direction -1, 0, 1."""
    if not is_finite3(angle, rate, 0.0):
        return NOT_FINITE
    mode = v.autopilot.modes.number
    if mode != GUIDED and mode != AUTO:
        return NOT_IN_GUIDED
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
    """MAV_CMD_DO_PAUSE_CONTINUE 0 in GUIDED and AUTO: stop and hold. OK or NOT_IN_GUIDED."""
    modes = v.autopilot.modes
    if modes.number == GUIDED:
        modes.guided.paused = 1
        return OK
    if modes.number == AUTO:
        modes.nav.paused = 1
        return OK
    return NOT_IN_GUIDED


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
    return NOT_IN_GUIDED
