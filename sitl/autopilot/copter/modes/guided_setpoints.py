# SPDX-License-Identifier: BSD-3-Clause
"""Set-points of GUIDED, as the MAVLink services write them.

Every law returns OK, or says why it left the record as it was (``commands``). Yaw arguments everywhere:
``use_yaw`` with ``yaw`` [rad], ``use_rate`` with ``yaw_rate`` [rad/s], ``relative`` != 0 when ``yaw``
counts from the present heading; without either the heading follows WP_YAW_BEHAVIOR.
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import constrain
from . import auto_yaw, guided
from .commands import NOT_FINITE, OK, OUT_OF_RANGE, WRONG_MODE, is_finite3
from .guided import ACCEL, ANGLE, GUIDED, POS_VEL_ACCEL, POSITION, VELOCITY_ACCEL

_THRUST_IS_THRUST = 8
"""GUID_OPTIONS: thrust of SET_ATTITUDE_TARGET is thrust, not climb rate."""


@law
def refusal(v, x, y, z, yaw, yaw_rate):
    """OK, or why a set-point with these numbers is not taken."""
    if not (is_finite3(x, y, z) and is_finite3(yaw, yaw_rate, 0.0)):
        return NOT_FINITE
    if v.autopilot.modes.number != GUIDED:
        return WRONG_MODE
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
        guided.start_submode(v, submode)
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
    """Come to a stop and hold (velocity zero). OK, or WRONG_MODE."""
    if v.autopilot.modes.number != GUIDED:
        return WRONG_MODE
    return set_velocity(v, 0.0, 0.0, 0.0, 0, 0.0, 0, 0.0, 0)
