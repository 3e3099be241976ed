# SPDX-License-Identifier: BSD-3-Clause
"""Speed: desired speed -> throttle demand (ATC_SPEED_*, ATC_ACCEL_MAX, ATC_DECEL_MAX, ATC_BRAKE, CRUISE_*).

A mode calls ``drive`` or ``stop`` once a period, after ``forward_speed.sense``. The desired
speed changes no faster than the acceleration limits; CRUISE_THROTTLE over CRUISE_SPEED is fed forward, the loop
corrects the rest. Backward speeds are negative.
"""

from __future__ import annotations

from typing import NamedTuple

from ....core.kernels import law
from ....core.scalars import constrain, finite
from ...control.pid import pid_gains, reset_filter, update_pid
from ..parameters import Parameters
from ..parameters.control import Attitude
from ..parameters.driving import Cruise
from . import motors
from .state import DT, Control, SpeedState, current_tick, is_recent

TIMEOUT = 10
"""Periods after which a loop that did not run starts afresh: 0.2 s, ArduPilot's."""
DECEL_MIN = 0.01
"""Floor of the deceleration that a stop is planned with [m/s^2], whatever parameters say."""
STANDING = 14
"""Periods: what stood less than 0.3 s ago still stands."""


class Stop(NamedTuple):
    """One period of a controlled stop."""

    throttle: float  # demand
    stands: bool


@law
def is_active(control: Control) -> bool:
    """Whether the speed loop ran in the last 0.2 s."""
    return is_recent(control, control.speed.last_tick, TIMEOUT)


@law
def decel_max(params: Attitude) -> float:
    """Fastest deceleration of the desired speed [m/s^2]; 0: no limit."""
    return params.DECEL_MAX if params.DECEL_MAX > 0.0 else params.ACCEL_MAX


@law
def accel_limited(control: Control, desired: float, params: Attitude) -> float:
    """``desired`` [m/s] as near as the acceleration limits let this period come; itself while the loop rests."""
    if not is_active(control) or params.ACCEL_MAX <= 0.0:
        return desired
    last = control.speed.desired
    change = (decel_max(params) if abs(desired) < abs(last) else params.ACCEL_MAX) * DT
    return constrain(desired, last - change, last + change)


@law
def stopping_distance(speed: float, params: Attitude) -> float:
    """Distance [m] in which ``speed`` [m/s] can be taken away; 0 without a limit of deceleration."""
    decel = decel_max(params)
    if decel <= 0.0:
        return 0.0
    return 0.5 * speed * speed / max(decel, DECEL_MIN)


@law
def speed_max(params: Parameters) -> float:
    """Speed at full throttle [m/s]: SPEED_MAX, else extrapolated from CRUISE_SPEED; at most 30."""
    fastest = params.CRUISE.SPEED
    throttle = params.CRUISE.THROTTLE * 0.01
    if 0.05 <= throttle <= 1.0:
        fastest = params.SPEED_MAX if params.SPEED_MAX > 0.0 else fastest / throttle
    return constrain(fastest, 0.0, 30.0)


@law
def cruise_throttle(speed: float, params: Cruise) -> float:
    """Throttle -1 .. 1 that ``speed`` [m/s] needs by CRUISE_SPEED and CRUISE_THROTTLE."""
    if params.SPEED <= 0.0:
        return 0.0
    return speed * params.THROTTLE * 0.01 / params.SPEED


@law
def without_brake(s: SpeedState, throttle: float) -> float:
    """``throttle`` that does not work against the motion (ATC_BRAKE 0); the flags say what was taken away."""
    if s.desired >= 0.0 and throttle <= 0.0:
        s.limit_low = True
        return 0.0
    if s.desired <= 0.0 and throttle >= 0.0:
        s.limit_high = True
        return 0.0
    return throttle


@law
def control_speed(control: Control, desired: float, params: Parameters) -> float:
    """Throttle demand for a speed [m/s]; 0 while the present speed is not known."""
    s = control.speed
    m = control.motors
    if not s.forward_ok:
        return 0.0
    if not is_active(control):
        reset_filter(s.loop)
        s.loop.integrator = 0.0
        s.desired = s.forward
    s.last_tick = current_tick(control)
    s.desired = accel_limited(control, desired if finite(desired) else 0.0, params.ATC)
    saturated = m.limit_lower or m.limit_upper or s.limit_low or s.limit_high
    correction = update_pid(s.loop, s.desired, s.forward, DT, saturated, pid_gains(params.ATC.SPEED))
    throttle = cruise_throttle(s.desired, params.CRUISE) + correction
    s.limit_low = False
    s.limit_high = False
    return without_brake(s, throttle) if params.ATC.BRAKE == 0.0 else throttle


@law
def control_stop(control: Control, params: Parameters) -> Stop:
    """Throttle demand of a controlled stop, 0 once standing (ATC_STOP_SPEED)."""
    s = control.speed
    limited = accel_limited(control, 0.0, params.ATC)
    slow = limited == 0.0 and abs(s.forward) <= abs(params.ATC.STOP_SPEED)
    if is_recent(control, s.stop_tick, STANDING) or not s.forward_ok or slow:
        s.stop_tick = current_tick(control)
        s.last_tick = s.stop_tick
        reset_filter(s.loop)
        s.loop.integrator = 0.0
        s.desired = 0.0
        return Stop(0.0, True)
    s.stop_tick = 0
    return Stop(control_speed(control, limited, params), False)


@law
def drive(control: Control, armed: bool, desired: float, params: Parameters) -> None:
    """Drive at ``desired`` [m/s] this period; 0 makes a controlled stop."""
    limited = accel_limited(control, desired if finite(desired) else 0.0, params.ATC)
    if limited == 0.0:
        throttle = control_stop(control, params).throttle
    else:
        throttle = control_speed(control, limited, params)
    motors.set_throttle(control.motors, armed, throttle, params.MOT)


@law
def stop(control: Control, armed: bool, params: Parameters) -> bool:
    """Stop with straight wheels; whether it stands."""
    out = control_stop(control, params)
    motors.set_throttle(control.motors, armed, out.throttle, params.MOT)
    motors.set_steering(control.motors, 0.0)
    return out.stands
