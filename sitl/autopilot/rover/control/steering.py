# SPDX-License-Identifier: BSD-3-Clause
"""Steering: heading -> turn rate -> steering demand (ATC_STR_*, ATC_TURN_MAX_G).

A mode calls one ``out_*`` law a period and hands its result to ``motors.set_steering``. The demand is normally within
-1 .. 1 and is not cut here: the motors shrink it with speed first. Turn rates to the right are positive.
"""

from __future__ import annotations

import math

from ....core.constants import GRAVITY
from ....core.kernels import law
from ....core.scalars import constrain, finite, wrap_pi
from ...control.pid import pid_gains, reset_filter, update_pid
from ...state import Estimate
from ..parameters.control import Attitude
from .forward_speed import yaw_rate
from .state import DT, Control, SteeringState, current_tick, is_recent

TIMEOUT = 10
"""Periods after which a loop that did not run starts afresh: 0.2 s, ArduPilot's."""
SPEED_MIN = 1.0
"""Below it turns are computed as if this fast [m/s]: steady steering at the start."""
TURN_RATE_MIN = math.radians(1.0)
"""The lateral acceleration never limits turns below this rate [rad/s]."""


@law
def lat_accel_max(params: Attitude) -> float:
    """Lateral acceleration that turns may need [m/s^2] (ATC_TURN_MAX_G)."""
    return max(params.TURN_MAX_G, 0.1) * GRAVITY


@law
def turn_rate_from_lat_accel(lat_accel: float, speed: float) -> float:
    """Turn rate [rad/s] that gives a lateral acceleration [m/s^2] at ``speed`` [m/s], backward negative."""
    if speed < 0.0:
        return lat_accel / min(speed, -SPEED_MIN)
    return lat_accel / max(speed, SPEED_MIN)


@law
def turn_decel_max(params: Attitude) -> float:
    """Fastest decay of the desired turn rate [rad/s^2]; 0: no limit (ATC_STR_DEC_MAX, else ATC_STR_ACC_MAX)."""
    return math.radians(params.STR_DEC_MAX if params.STR_DEC_MAX > 0.0 else params.STR_ACC_MAX)


@law
def is_active(control: Control) -> bool:
    """Whether a steering law ran in the last 0.2 s."""
    return is_recent(control, control.steering.last_tick, TIMEOUT)


@law
def limited(s: SteeringState, rate: float, low: float, high: float) -> float:
    """``rate`` within its limits; at one, the flag says which way no more can be had."""
    if rate <= low:
        s.limit_left = True
    if rate >= high:
        s.limit_right = True
    return constrain(rate, low, high)


@law
def limited_acceleration(s: SteeringState, rate: float, params: Attitude) -> float:
    """``rate`` [rad/s] as near as the limits of its growth and decay let it come in this period."""
    last = s.turn_rate
    slowing = rate * last < 0.0 or abs(rate) < abs(last)
    change = turn_decel_max(params) if slowing else math.radians(params.STR_ACC_MAX)
    if change <= 0.0:
        return rate
    return limited(s, rate, last - change * DT, last + change * DT)


@law
def limited_turn_rate(control: Control, wanted: float, params: Attitude) -> float:
    """``wanted`` [rad/s] within its limits, in this order: acceleration, rate, lateral acceleration."""
    s = control.steering
    rate = limited_acceleration(s, wanted if finite(wanted) else 0.0, params)
    rate_max = math.radians(params.STR_RAT_MAX)
    if rate_max > 0.0:
        rate = limited(s, rate, -rate_max, rate_max)
    if control.speed.forward_ok:
        rate_max = turn_rate_from_lat_accel(lat_accel_max(params), abs(control.speed.forward))
        rate_max = max(rate_max, TURN_RATE_MIN)
        rate = limited(s, rate, -rate_max, rate_max)
    return rate


@law
def control_turn_rate(control: Control, turn_rate: float, measured: float, params: Attitude) -> float:
    """Steering demand for a turn rate at the measured one, both [rad/s]."""
    s = control.steering
    motors = control.motors
    if not is_active(control):
        reset_filter(s.rate)
        s.rate.integrator = 0.0
        s.turn_rate = measured if finite(measured) else 0.0
    s.last_tick = current_tick(control)
    s.limit_left = motors.limit_left
    s.limit_right = motors.limit_right
    s.turn_rate = limited_turn_rate(control, turn_rate, params)
    saturated = motors.limit_left or motors.limit_right
    return update_pid(s.rate, s.turn_rate, measured, DT, saturated, pid_gains(params.STR_RAT))


@law
def turn_rate_from_heading(error: float, rate_max: float, params: Attitude) -> float:
    """Turn rate [rad/s] that takes a heading error [rad] away, able to stop there; ``rate_max`` [rad/s], 0 for none."""
    rate = error * params.STR_ANG_P
    if rate_max > 0.0:
        rate = constrain(rate, -rate_max, rate_max)
    decel = turn_decel_max(params)
    if decel > 0.0:
        stoppable = math.sqrt(2.0 * abs(error) * decel)
        rate = constrain(rate, -stoppable, stoppable)
    return rate


@law
def out_from_rate(control: Control, estimate: Estimate, turn_rate: float, params: Attitude) -> float:
    """Steering demand for a turn rate [rad/s]."""
    return control_turn_rate(control, turn_rate, yaw_rate(estimate.q, estimate.rates), params)


@law
def out_from_heading(control: Control, estimate: Estimate, heading: float, params: Attitude) -> float:
    """Steering demand towards ``heading`` [rad]."""
    if not finite(heading):
        return out_from_rate(control, estimate, 0.0, params)
    error = wrap_pi(heading - estimate.yaw)
    return out_from_rate(control, estimate, turn_rate_from_heading(error, 0.0, params), params)


@law
def out_from_lat_accel(control: Control, estimate: Estimate, accel: float, params: Attitude) -> float:
    """Steering demand for a lateral acceleration [m/s^2] to the right; 0 while the speed is not known."""
    s = control.steering
    s.lat_accel_tick = current_tick(control)
    s.lat_accel = accel if finite(accel) else 0.0
    if not control.speed.forward_ok:
        return 0.0
    turn_rate = turn_rate_from_lat_accel(s.lat_accel, control.speed.forward)
    return out_from_rate(control, estimate, turn_rate, params)
