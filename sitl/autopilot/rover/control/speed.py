# SPDX-License-Identifier: BSD-3-Clause
"""Speed: desired speed -> throttle demand (ATC_SPEED_*, ATC_ACCEL_MAX, ATC_DECEL_MAX, ATC_BRAKE, CRUISE_*).

A mode calls ``drive`` or ``stop`` once a period (or ``throttle_*`` and ``motors.set_throttle`` itself). The desired
speed changes no faster than the acceleration limits; CRUISE_THROTTLE over CRUISE_SPEED is fed forward, the loop
corrects the rest. Backward speeds are negative.
"""

from __future__ import annotations

from ....core.kernels import law
from ....core.scalars import constrain, finite
from ...control.pid import pid_gains, reset_filter, update_pid
from . import motors
from .forward_speed import forward_speed
from .recent import now_tick, recent
from .state import DT

_TIMEOUT = 10  # periods: 0.2 s, ArduPilot's
MIN_DECEL = 0.01
"""Floor of the deceleration that a stop is planned with [m/s^2], whatever parameters say."""
_STANDS = 14  # periods: what stood less than 0.3 s ago still stands


@law
def is_active(ap):
    """Whether the speed loop ran in the last 0.2 s."""
    return recent(ap, int(ap.control.speed.last_tick), _TIMEOUT)


@law
def desired_speed(ap):
    """What the speed loop follows [m/s], for telemetry; 0 when it does not run."""
    return float(ap.control.speed.desired) if is_active(ap) else 0.0


@law
def decel_max(ap):
    """Fastest deceleration of the desired speed [m/s^2]; 0: no limit."""
    if ap.params.ATC.DECEL_MAX > 0.0:
        return float(ap.params.ATC.DECEL_MAX)
    return float(ap.params.ATC.ACCEL_MAX)


@law
def desired_speed_accel_limited(ap, desired):
    """``desired`` [m/s] as near as the acceleration limits let this period come; itself while the loop rests."""
    s = ap.control.speed
    if not is_active(ap) or ap.params.ATC.ACCEL_MAX <= 0.0:
        return desired
    last = float(s.desired)
    most = (decel_max(ap) if abs(desired) < abs(last) else float(ap.params.ATC.ACCEL_MAX)) * DT
    return constrain(desired, last - most, last + most)


@law
def stopping_distance(ap, speed):
    """Distance [m] in which ``speed`` [m/s] can be taken away; 0 without a limit of deceleration."""
    decel = decel_max(ap)
    if decel <= 0.0:
        return 0.0
    return 0.5 * speed * speed / max(decel, MIN_DECEL)


@law
def speed_max(ap):
    """Speed at full throttle [m/s]: SPEED_MAX, else extrapolated from CRUISE_SPEED; at most 30."""
    cruise = float(ap.params.CRUISE.SPEED)
    throttle = float(ap.params.CRUISE.THROTTLE) * 0.01
    most = cruise
    if 0.05 <= throttle <= 1.0:
        most = float(ap.params.SPEED_MAX) if ap.params.SPEED_MAX > 0.0 else cruise / throttle
    return constrain(most, 0.0, 30.0)


@law
def cruise_throttle(ap, speed):
    """Throttle -1 .. 1 that ``speed`` [m/s] needs by CRUISE_SPEED and CRUISE_THROTTLE."""
    cruise = float(ap.params.CRUISE.SPEED)
    if cruise <= 0.0:
        return 0.0
    return speed * float(ap.params.CRUISE.THROTTLE) * 0.01 / cruise


@law
def throttle_for_speed(v, desired):
    """Throttle demand for a speed [m/s]; 0 while the speed is not known."""
    ap = v.autopilot
    p = ap.params
    s = ap.control.speed
    m = ap.control.motors
    ok, speed = forward_speed(v)
    if ok == 0:
        return 0.0
    if not is_active(ap):
        reset_filter(s.loop)
        s.loop.integrator = 0.0
        s.desired = speed
    s.last_tick = now_tick(ap)
    s.desired = desired_speed_accel_limited(ap, desired if finite(desired) else 0.0)

    saturated = m.limit_lower != 0 or m.limit_upper != 0 or s.limit_low != 0 or s.limit_high != 0
    throttle = cruise_throttle(ap, s.desired) + update_pid(
        s.loop, s.desired, speed, DT, saturated, pid_gains(p.ATC.SPEED)
    )
    s.limit_low = 0
    s.limit_high = 0
    if p.ATC.BRAKE == 0.0:
        if s.desired >= 0.0 and throttle <= 0.0:
            throttle = 0.0
            s.limit_low = 1
        elif s.desired <= 0.0 and throttle >= 0.0:
            throttle = 0.0
            s.limit_high = 1
    return throttle


@law
def throttle_for_stop(v):
    """(throttle demand, stands 0 or 1) of a controlled stop; throttle 0 once standing (ATC_STOP_SPEED)."""
    ap = v.autopilot
    s = ap.control.speed
    stands = recent(ap, int(s.stop_tick), _STANDS)
    limited = desired_speed_accel_limited(ap, 0.0)
    ok, speed = forward_speed(v)
    if ok == 0 or (limited == 0.0 and abs(speed) <= abs(float(ap.params.ATC.STOP_SPEED))):
        stands = True
    if stands:
        s.stop_tick = now_tick(ap)
        s.last_tick = s.stop_tick
        reset_filter(s.loop)
        s.loop.integrator = 0.0
        s.desired = 0.0
        return (0.0, 1)
    s.stop_tick = 0
    return (throttle_for_speed(v, limited), 0)


@law
def drive(v, desired):
    """Drive at ``desired`` [m/s] this period; 0 makes a controlled stop."""
    ap = v.autopilot
    limited = desired_speed_accel_limited(ap, desired if finite(desired) else 0.0)
    if limited == 0.0:
        throttle, _ = throttle_for_stop(v)
    else:
        throttle = throttle_for_speed(v, limited)
    motors.set_throttle(ap, throttle)


@law
def stop(v):
    """Stop with straight wheels; 1 once standing."""
    ap = v.autopilot
    throttle, stands = throttle_for_stop(v)
    motors.set_throttle(ap, throttle)
    motors.set_steering(ap, 0.0)
    return stands


@law
def relax(ap):
    """Forget the trim of the speed loop."""
    ap.control.speed.loop.integrator = 0.0
