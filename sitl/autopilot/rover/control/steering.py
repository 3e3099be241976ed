# SPDX-License-Identifier: BSD-3-Clause
"""Steering: heading -> turn rate -> steering demand (ATC_STR_*, ATC_TURN_MAX_G).

A mode calls one ``out_*`` law a period and hands its result to ``motors.set_steering``. The demand is normally within
-1 .. 1 and is not cut here: the motors shrink it with speed first. Turn rates to the right are positive.
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import constrain, finite, wrap_pi
from ...control.pid import pid_gains, reset_filter, update_pid
from .forward_speed import yaw_rate
from .recent import now_tick, recent
from .state import DT, GRAVITY

_TIMEOUT = 10  # periods: 0.2 s, ArduPilot's
_SLOWEST = 1.0  # below it turns are computed as if this fast [m/s]: steady steering at the start
_LEAST_RATE = math.radians(1.0)


@law
def lat_accel_max(ap):
    """Lateral acceleration that turns may need [m/s^2] (ATC_TURN_MAX_G)."""
    return max(float(ap.params.ATC.TURN_MAX_G), 0.1) * GRAVITY


@law
def turn_rate_from_lat_accel(lat_accel, speed):
    """Turn rate [rad/s] that gives a lateral acceleration [m/s^2] at ``speed`` [m/s], backward negative."""
    if speed < 0.0:
        return lat_accel / min(speed, -_SLOWEST)
    return lat_accel / max(speed, _SLOWEST)


@law
def lat_accel(ap, turn_rate, speed):
    """Lateral acceleration [m/s^2] of a turn, within ATC_TURN_MAX_G."""
    most = lat_accel_max(ap)
    return constrain(turn_rate * speed, -most, most)


@law
def decel_max(ap):
    """Fastest decay of the desired turn rate [rad/s^2]; 0: no limit (ATC_STR_DEC_MAX, else ATC_STR_ACC_MAX)."""
    if ap.params.ATC.STR_DEC_MAX > 0.0:
        return math.radians(float(ap.params.ATC.STR_DEC_MAX))
    return math.radians(float(ap.params.ATC.STR_ACC_MAX))


@law
def is_active(ap):
    """Whether a steering law ran in the last 0.2 s."""
    return recent(ap, int(ap.control.steering.last_tick), _TIMEOUT)


@law
def desired_turn_rate(ap):
    """What the turn-rate loop follows [rad/s], for telemetry; 0 when it does not run."""
    return float(ap.control.steering.turn_rate) if is_active(ap) else 0.0


@law
def desired_lat_accel(ap):
    """Last lateral acceleration asked for [m/s^2], for telemetry; 0 when none was lately."""
    s = ap.control.steering
    return float(s.lat_accel) if recent(ap, int(s.lat_accel_tick), _TIMEOUT) else 0.0


@law
def _limited(s, rate, low, high):
    """``rate`` within its limits; at one, the flag says which way no more can be had."""
    if rate <= low:
        s.limit_left = 1
    if rate >= high:
        s.limit_right = 1
    return constrain(rate, low, high)


@law
def _limited_acceleration(ap, rate):
    s = ap.control.steering
    last = float(s.turn_rate)
    grow = math.radians(float(ap.params.ATC.STR_ACC_MAX))
    slowing = rate * last < 0.0 or abs(rate) < abs(last)
    most = decel_max(ap) if slowing else grow
    if most <= 0.0:
        return rate
    return _limited(s, rate, last - most * DT, last + most * DT)


@law
def out_from_rate(ap, turn_rate):
    """Steering demand for a turn rate [rad/s]. Limits in this order: acceleration, rate, lateral acceleration."""
    p = ap.params
    s = ap.control.steering
    motors = ap.control.motors
    measured = yaw_rate(ap)
    if not is_active(ap):
        reset_filter(s.rate)
        s.rate.integrator = 0.0
        s.turn_rate = measured if finite(measured) else 0.0
    s.last_tick = now_tick(ap)
    s.limit_left = motors.limit_left
    s.limit_right = motors.limit_right

    rate = turn_rate if finite(turn_rate) else 0.0
    rate = _limited_acceleration(ap, rate)
    most = math.radians(float(p.ATC.STR_RAT_MAX))
    if most > 0.0:
        rate = _limited(s, rate, -most, most)
    if ap.control.speed.forward_ok != 0:
        most = turn_rate_from_lat_accel(lat_accel_max(ap), abs(float(ap.control.speed.forward)))
        most = max(most, _LEAST_RATE)
        rate = _limited(s, rate, -most, most)
    s.turn_rate = rate

    return update_pid(
        s.rate, rate, measured, DT, motors.limit_left != 0 or motors.limit_right != 0, pid_gains(p.ATC.STR_RAT)
    )


@law
def turn_rate_from_heading(ap, heading, rate_max):
    """Turn rate [rad/s] towards ``heading`` [rad], able to stop there; ``rate_max`` [rad/s], 0 for none."""
    error = wrap_pi(heading - float(ap.estimate.euler[2]))
    rate = error * float(ap.params.ATC.STR_ANG_P)
    if rate_max > 0.0:
        rate = constrain(rate, -rate_max, rate_max)
    decel = decel_max(ap)
    if decel > 0.0:
        most = math.sqrt(2.0 * abs(error) * decel)
        rate = constrain(rate, -most, most)
    return rate


@law
def out_from_heading(ap, heading, rate_max):
    """Steering demand towards ``heading`` [rad]; ``rate_max`` [rad/s], 0 for ATC_STR_RAT_MAX."""
    if not finite(heading):
        return out_from_rate(ap, 0.0)
    return out_from_rate(ap, turn_rate_from_heading(ap, heading, rate_max))


@law
def out_from_lat_accel(ap, accel):
    """Steering demand for a lateral acceleration [m/s^2] to the right; 0 while the speed is not known."""
    s = ap.control.steering
    s.lat_accel_tick = now_tick(ap)
    s.lat_accel = accel if finite(accel) else 0.0
    if ap.control.speed.forward_ok == 0:
        return 0.0
    return out_from_rate(ap, turn_rate_from_lat_accel(float(s.lat_accel), float(ap.control.speed.forward)))


@law
def relax(ap):
    """Forget the trim of the turn-rate loop."""
    ap.control.steering.rate.integrator = 0.0
