# SPDX-License-Identifier: BSD-3-Clause
"""Position: target -> velocity -> acceleration -> desired speed and turn rate (PSC_POS_P, PSC_VEL_*, TURN_RADIUS).

NED metres from the estimator's origin. A mode calls ``init`` once, then one ``input_*`` or ``set_*`` law and ``update``
every period; it reads ``desired_speed``, ``desired_turn_rate`` (or ``desired_lat_accel``) and hands them to ``speed``
and ``steering``. The acceleration wanted across the nose becomes a turn, what is wanted along it a speed. A car cannot
turn on the spot: while it is slower than its tightest turn allows, it keeps moving at that speed, or at the target's if
that is less. Targets that are not finite are not taken over.
"""

from __future__ import annotations

import math

from ....core.algebra import limit_length, vec2_of
from ....core.kernels import law
from ....core.scalars import finite
from ....core.vectors import Vec2
from ...control.pid import lowpass_gain
from ...control.shaping import (
    Limits2,
    Motion2,
    advance_2d,
    inverse_sqrt_controller,
    shape_pos_vel_accel_2d,
    sqrt_controller_2d,
)
from .motors import is_skid
from .recent import now_tick, recent
from .speed import desired_speed_accel_limited
from .state import DT
from .steering import lat_accel_max, turn_rate_from_lat_accel

_TIMEOUT = 5  # periods: 0.1 s, ArduPilot's
_BACK = 0.3  # least speed of a way back that counts as one [m/s]; of slow vehicles a share of their speed
_BACK_SHARE = 0.5
_STANDING = 1e-9  # speed that has a direction only [m/s]
_ASIDE = 0.01  # lateral acceleration that leaves the line of a way straight back [m/s^2]


@law
def is_active(ap):
    """Whether ``update`` ran in the last 0.1 s."""
    return recent(ap, int(ap.control.position.last_tick), _TIMEOUT)


@law
def set_limits(ap, speed_max, accel_max, lat_accel_max, jerk_max):
    """Limits of the correction and of shaped targets [m/s, m/s^2, m/s^2, m/s^3]."""
    c = ap.control.position
    c.speed_max = max(speed_max, 0.0)
    c.accel_max = max(accel_max, 0.0)
    c.lat_accel_max = max(lat_accel_max, 0.0)
    c.jerk_max = max(jerk_max, 0.0)


@law
def set_reversed(ap, backward):
    """Drive backwards (1) or forwards (0); ``init`` sets forwards."""
    ap.control.position.reversed = backward


@law
def init(ap):
    """Targets to where the vehicle is and how it moves; 1, or 0 without a position estimate."""
    est = ap.estimate
    c = ap.control.position
    if est.position_ok == 0:
        return 0
    for k in range(2):
        c.pos_target[k] = est.pos[k]
        c.vel_desired[k] = est.vel[k]
        c.accel_desired[k] = est.acc_ned[k]
        c.pos_error[k] = 0.0
        c.vel_target[k] = 0.0
        c.accel_target[k] = 0.0
    c.reversed = 0
    c.reset_count = est.reset_ne_count
    return 1


@law
def set_pos_vel_accel(ap, pn, pe, vn, ve, an, ae):
    """Follow a path that is already smooth: position [m], velocity [m/s], acceleration [m/s^2]."""
    if not (finite(pn + pe) and finite(vn + ve) and finite(an + ae)):
        return
    c = ap.control.position
    c.pos_target[0], c.pos_target[1] = pn, pe
    c.vel_desired[0], c.vel_desired[1] = vn, ve
    c.accel_desired[0], c.accel_desired[1] = an, ae


@law
def input_pos_vel_accel(ap, pn, pe, vn, ve, an, ae):
    """Pull the target, shaped, towards a point at (pn, pe) that moves with (vn, ve) and (an, ae)."""
    if not (finite(pn + pe) and finite(vn + ve) and finite(an + ae)):
        return
    c = ap.control.position
    now = Motion2(vec2_of(c.pos_target), vec2_of(c.vel_desired), vec2_of(c.accel_desired))
    free = Vec2(0.0, 0.0)
    now = advance_2d(now, DT, free, free, free)
    c.pos_target[0], c.pos_target[1] = now.pos.x, now.pos.y
    c.vel_desired[0], c.vel_desired[1] = now.vel.x, now.vel.y
    accel = min(float(c.accel_max), float(c.lat_accel_max))
    if accel <= 0.0 or c.jerk_max <= 0.0:
        return
    target = Motion2(Vec2(pn, pe), Vec2(vn, ve), Vec2(an, ae))
    shaped = shape_pos_vel_accel_2d(target, now, Limits2(c.speed_max, accel, c.jerk_max), DT)
    c.accel_desired[0], c.accel_desired[1] = shaped.x, shaped.y


@law
def input_pos(ap, pn, pe):
    """The same towards a point that stands."""
    input_pos_vel_accel(ap, pn, pe, 0.0, 0.0, 0.0, 0.0)


@law
def pos_error(ap):
    """(north, east) from the vehicle to the target [m]; zero when the controller rests."""
    c = ap.control.position
    if not is_active(ap) or ap.estimate.position_ok == 0:
        return (0.0, 0.0)
    return (
        float(c.pos_target[0]) - float(ap.estimate.pos[0]),
        float(c.pos_target[1]) - float(ap.estimate.pos[1]),
    )


@law
def _follow_reset(ap):
    """When the estimate jumps, the target jumps with it."""
    c = ap.control.position
    if c.reset_count == ap.estimate.reset_ne_count:
        return
    c.reset_count = ap.estimate.reset_ne_count
    for k in range(2):
        c.pos_target[k] = float(ap.estimate.pos[k]) + float(c.pos_error[k])
        c.vel_desired[k] = float(ap.estimate.vel[k]) + float(c.vel_error[k])


@law
def _position_loop(ap):
    """Velocity (north, east) that takes the position error away; a target too far ahead waits."""
    c = ap.control.position
    kp = float(ap.params.PSC.POS_P)
    accel = min(float(c.accel_max), float(c.lat_accel_max))
    if c.jerk_max > 0.0 and kp > 0.0:
        accel = min(accel, float(c.jerk_max) / kp)
    n, e = float(ap.estimate.pos[0]), float(ap.estimate.pos[1])
    en, ee = float(c.pos_target[0]) - n, float(c.pos_target[1]) - e
    if c.speed_max > 0.0 and kp > 0.0:
        most = inverse_sqrt_controller(float(c.speed_max), kp, accel)
        if en * en + ee * ee > most * most:
            limited = limit_length(Vec2(en, ee), most)
            en, ee = limited.x, limited.y
            c.pos_target[0], c.pos_target[1] = n + en, e + ee
    c.pos_error[0], c.pos_error[1] = en, ee
    return sqrt_controller_2d(Vec2(en, ee), kp, accel, 0.0)


@law
def _velocity_loop(ap):
    """Acceleration (north, east) [m/s^2] that the velocity PID asks for."""
    c = ap.control.position
    p = ap.params
    kp, ki, kd, kff = float(p.PSC.VEL.P), float(p.PSC.VEL.I), float(p.PSC.VEL.D), float(p.PSC.VEL.FF)
    gain_e, gain_d = lowpass_gain(float(p.PSC.VEL.FLTE), DT), lowpass_gain(float(p.PSC.VEL.FLTD), DT)
    for k in range(2):
        error = float(c.vel_target[k]) - float(ap.estimate.vel[k])
        if c.started == 0:
            c.vel_error[k] = error
            c.vel_derivative[k] = 0.0
        else:
            last = float(c.vel_error[k])
            c.vel_error[k] = last + gain_e * (error - last)
            c.vel_derivative[k] += gain_d * ((float(c.vel_error[k]) - last) / DT - float(c.vel_derivative[k]))
    c.started = 1
    i_n = float(c.vel_integrator[0]) + float(c.vel_error[0]) * ki * DT
    i_e = float(c.vel_integrator[1]) + float(c.vel_error[1]) * ki * DT
    integrator = limit_length(Vec2(i_n, i_e), p.PSC.VEL.IMAX)
    i_n, i_e = integrator.x, integrator.y
    if ki == 0.0:
        i_n, i_e = 0.0, 0.0
    c.vel_integrator[0], c.vel_integrator[1] = i_n, i_e
    return (
        kp * float(c.vel_error[0]) + i_n + kd * float(c.vel_derivative[0]) + kff * float(c.vel_target[0]),
        kp * float(c.vel_error[1]) + i_e + kd * float(c.vel_derivative[1]) + kff * float(c.vel_target[1]),
    )


@law
def turn_radius(ap):
    """Radius of the tightest turn [m]: TURN_RADIUS, 0 for a skid-steered vehicle."""
    return 0.0 if is_skid(ap) else max(float(ap.params.TURN_RADIUS), 0.0)


@law
def _brake(ap):
    c = ap.control.position
    c.desired_speed = desired_speed_accel_limited(ap, 0.0)
    c.desired_turn_rate = 0.0
    c.desired_lat_accel = 0.0


@law
def _aside(c, along, size, lateral):
    """``lateral`` acceleration [m/s^2]; where the way leads straight back, nothing would turn a car: then to the right.

    ``along``: of the wanted velocity of ``size`` along the nose [m/s].
    """
    away = along > 0.0 if c.reversed != 0 else along < 0.0
    if away and size > min(_BACK, _BACK_SHARE * float(c.speed_max)) and abs(lateral) < _ASIDE:
        return _ASIDE
    return lateral


@law
def update(v):
    """One period of the cascade. Disarmed or without a position the outputs brake."""
    ap = v.autopilot
    est = ap.estimate
    c = ap.control.position
    if ap.arming.armed == 0 or est.position_ok == 0 or not finite(est.pos[0] + est.pos[1] + est.vel[0] + est.vel[1]):
        _brake(ap)
        return
    _follow_reset(ap)
    if not is_active(ap):
        c.started = 0
        c.vel_integrator[0] = 0.0
        c.vel_integrator[1] = 0.0
    c.last_tick = now_tick(ap)

    vel = limit_length(_position_loop(ap) + vec2_of(c.vel_desired), c.speed_max)
    vn, ve = vel.x, vel.y
    c.vel_target[0], c.vel_target[1] = vn, ve
    an, ae = _velocity_loop(ap)
    an, ae = an + float(c.accel_desired[0]), ae + float(c.accel_desired[1])
    c.accel_target[0], c.accel_target[1] = an, ae

    cosine, sine = math.cos(float(est.euler[2])), math.sin(float(est.euler[2]))
    along = vn * cosine + ve * sine
    size = math.sqrt(vn * vn + ve * ve)
    least = min(size, math.sqrt(0.5 * lat_accel_max(ap) * turn_radius(ap)))
    wanted = min(-least, along) if c.reversed != 0 else max(least, along)
    c.desired_speed = desired_speed_accel_limited(ap, wanted)
    c.desired_lat_accel = _aside(c, along, size, ae * cosine - an * sine)
    speed = float(c.desired_speed)
    if speed == 0.0 and c.reversed != 0:
        speed = -_STANDING  # towards where it is about to go
    c.desired_turn_rate = turn_rate_from_lat_accel(float(c.desired_lat_accel), speed)
