# SPDX-License-Identifier: BSD-3-Clause
"""Vertical position: shaped path -> position P -> velocity PID -> acceleration PID -> throttle (PSC_POSZ_P,
PSC_VELZ_*, PSC_ACCZ_*, PSC_JERK_Z).

Down is positive throughout, as in NED. PSC_ACCZ_* gains turn cm/s^2 into thousandths of throttle: one of them
is 0.1 of throttle for 1 m/s^2. A mode calls one ``input_*`` (or ``set_pos_vel_accel_d``) law and then
``update_d`` every tick.
"""

from __future__ import annotations

from typing import NamedTuple

from ....core.kernels import inlined, law
from ....core.scalars import constrain, finite, sign
from ...control.pid import Blocked, Gains, basic_gains, update_pid, update_pid_directional
from ...control.shaping import (
    Limits,
    Motion,
    advance,
    inverse_sqrt_controller,
    shape_pos_vel_accel,
    shape_vel_accel,
    sqrt_controller,
)
from ...state import Estimate
from ..parameters import Parameters
from ..parameters.control import Position
from .altitude_start import ACCZ_UNIT, init_d, is_active_d
from .motors import hover_throttle
from .state import DT, AltitudeState, Control
from .throttle_mix import set_throttle_out
from .vibration_compensation import throttle_without_acceleration

_ACCZ_IMAX_UNIT = 0.001
_THROTTLE_HZ = 2.0  # low-pass of the throttle [Hz]
_FALL_ACCEL_MAX = 7.5  # downward acceleration is kept below gravity [m/s^2]
_OVERSPEED_GAIN = 2.0


class AltitudeGains(NamedTuple):
    """Gains of the cascade."""

    pos_p: float  # [1/s]
    vel: Gains  # [m/s] to [m/s^2]
    acc: Gains  # [m/s^2] to throttle


@inlined
def overspeed_gain(c: AltitudeState) -> float:
    """How much faster the shaping may brake while it is above its speed limits; 1 below them."""
    v = c.vel_desired
    if v > c.speed_down and c.speed_down > 0.0:
        return _OVERSPEED_GAIN * v / c.speed_down
    if v < -c.speed_up and c.speed_up > 0.0:
        return -_OVERSPEED_GAIN * v / c.speed_up
    return 1.0


@inlined
def shaping_limits_d(c: AltitudeState, speed_up: float, speed_down: float) -> Limits:
    """Limits of the shaping with these speeds [m/s], both positive."""
    gain = overspeed_gain(c)
    up = c.accel_max * gain
    return Limits(-speed_up, speed_down, -up, min(up, _FALL_ACCEL_MAX), c.jerk_max * gain)


@inlined
def desired_motion_d(c: AltitudeState) -> Motion:
    """The desired path of this tick."""
    return Motion(c.pos_desired, c.vel_desired, c.accel_desired)


@inlined
def advance_d(c: AltitudeState) -> None:
    """Move the desired path on by one tick."""
    moved = advance(desired_motion_d(c), DT, sign(c.limit), c.pos_error, c.vel.error)
    c.pos_desired = moved.pos
    c.vel_desired = moved.vel


@inlined
def shape_pos_d(c: AltitudeState, target: Motion, speed_up: float, speed_down: float) -> None:
    """New desired acceleration towards a moving altitude."""
    c.accel_desired = shape_pos_vel_accel(target, desired_motion_d(c), shaping_limits_d(c, speed_up, speed_down), DT)


@law
def input_pos_vel_accel_d(c: AltitudeState, target: Motion) -> None:
    """Follow a moving altitude [m, m/s, m/s^2], shaped."""
    if finite(target.pos) and finite(target.vel) and finite(target.acc):
        advance_d(c)
        shape_pos_d(c, target, c.speed_up, c.speed_down)
    else:
        input_vel_accel_d(c, 0.0, 0.0)


@law
def input_vel_accel_d(c: AltitudeState, vel: float, acc: float) -> None:
    """Move at ``vel`` [m/s], which changes with ``acc`` [m/s^2], shaped."""
    if not (finite(vel) and finite(acc)):
        vel, acc = 0.0, 0.0
    limits = shaping_limits_d(c, 0.0, 0.0)
    advance_d(c)
    c.accel_desired = shape_vel_accel(vel, acc, desired_motion_d(c), limits, DT)


@law
def land_at_rate_d(c: AltitudeState, vel: float, ignore_descent_limit: bool) -> None:
    """Descend at ``vel`` [m/s]; the target may be told to go on although throttle is at its least."""
    if ignore_descent_limit:
        c.limit = min(c.limit, 0.0)
    input_vel_accel_d(c, vel, 0.0)


@law
def set_pos_vel_accel_d(c: AltitudeState, target: Motion) -> None:
    """Desired path given outright, for trajectories that are already smooth."""
    if finite(target.pos) and finite(target.vel) and finite(target.acc):
        c.pos_desired = target.pos
        c.vel_desired = target.vel
        c.accel_desired = target.acc
    else:
        input_vel_accel_d(c, 0.0, 0.0)


@inlined
def control_altitude(c: AltitudeState, pos: float, p: float) -> float:
    """Velocity [m/s] that takes the error of altitude away; the path waits for a vehicle that cannot keep up."""
    error = c.pos_desired - pos
    if not finite(error):
        error = 0.0
    accel = c.correction_accel
    if p > 0.0:
        limited = error
        if c.correction_speed_down > 0.0:
            limited = min(limited, inverse_sqrt_controller(c.correction_speed_down, p, accel))
        if c.correction_speed_up > 0.0:
            limited = max(limited, -inverse_sqrt_controller(c.correction_speed_up, p, accel))
        if limited != error:
            error = limited
            c.pos_desired = pos + error
    c.pos_error = error
    return sqrt_controller(error, p, accel, 0.0)


@inlined
def aim_vertical(c: AltitudeState, now: Motion, blocked: Blocked, gains: AltitudeGains) -> None:
    """Acceleration that the errors of height and speed ask for (``accel_target``)."""
    c.vel_target = control_altitude(c, now.pos, gains.pos_p) + c.vel_desired
    # More throttle is less acceleration downward.
    accel = update_pid_directional(c.vel, c.vel_target, now.vel, DT, Blocked(blocked.up, blocked.down), gains.vel)
    c.accel_target = c.accel_desired + accel


@inlined
def note_limits(c: AltitudeState, blocked: Blocked) -> None:
    """How well the descent is held, and where there is no more thrust."""
    if c.speed_down > 0.0:
        ratio = c.vel.error / c.speed_down
        c.control_ratio = constrain(c.control_ratio + 0.1 * DT * (0.5 + ratio), 0.0, 2.0)
    c.limit = -1.0 if blocked.up else (1.0 if blocked.down else 0.0)


@inlined
def control_vertical(c: AltitudeState, now: Motion, blocked: Blocked, gains: AltitudeGains) -> float:
    """One tick of the cascade for the measured motion: throttle to be taken off that of hovering.

    ``blocked``: throttle is at its greatest (up), or at its least (down: nothing more to take off).
    """
    aim_vertical(c, now, blocked, gains)
    taken_off = update_pid(c.accel, c.accel_target, now.acc, DT, blocked.down or blocked.up, gains.acc)
    note_limits(c, blocked)
    return taken_off


@law
def control_vibrating(c: AltitudeState, now: Motion, blocked: Blocked, gains: AltitudeGains, hover: float) -> float:
    """The same where the measured acceleration is wrong; ``hover``: throttle."""
    aim_vertical(c, now, blocked, gains)
    error = c.vel_target - now.vel
    taken_off = throttle_without_acceleration(c.accel, error, c.accel_target, gains.vel.p, hover, blocked)
    note_limits(c, blocked)
    return taken_off


@inlined
def follow_reset_d(c: AltitudeState, pos: float, jump: float, count: int) -> None:
    """When the estimate jumps to ``pos``, its velocity by ``jump``, the path jumps with it; ``count``: of the jumps."""
    if c.reset_count != count:
        c.reset_count = count
        c.pos_desired = pos + c.pos_error
        c.vel_desired += jump


@inlined
def altitude_gains(p: Position, hover: float) -> AltitudeGains:
    """PSC_POSZ_P, PSC_VELZ_*, PSC_ACCZ_*; the integrator may take off all of the throttle that hovers."""
    a = p.ACCZ
    acc = Gains(
        a.P * ACCZ_UNIT, a.I * ACCZ_UNIT, a.D * ACCZ_UNIT, a.FF * ACCZ_UNIT, a.D_FF * ACCZ_UNIT,
        max(a.IMAX * _ACCZ_IMAX_UNIT, hover), a.PDMX * _ACCZ_IMAX_UNIT, a.FLTT, a.FLTE, a.FLTD,
    )  # fmt: skip
    return AltitudeGains(p.POSZ_P, basic_gains(p.VELZ, p.VELZ.IMAX * 0.01), acc)


@law
def update_d(control: Control, est: Estimate, p: Parameters) -> None:
    """One tick of the cascade; sets the throttle."""
    c = control.pos_d
    motors = control.motors
    if not is_active_d(control):
        init_d(control, est, p)
    follow_reset_d(c, est.pos.z, est.reset_vel.z, est.reset_d_count)
    c.last_tick = control.tick
    blocked = Blocked(motors.limit_throttle_lower, motors.limit_throttle_upper)
    hover = hover_throttle(p.MOT)
    gains = altitude_gains(p.PSC, hover)
    vibration = control.vibration
    if vibration.found:
        now = Motion(est.pos.z, vibration.vel, 0.0)
        taken_off = control_vibrating(c, now, blocked, gains, hover)
    else:
        taken_off = control_vertical(c, Motion(est.pos.z, est.vel.z, est.acc_ned.z), blocked, gains)
    set_throttle_out(control, p, hover - taken_off, True, _THROTTLE_HZ)
