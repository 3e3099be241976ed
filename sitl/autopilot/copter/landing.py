# SPDX-License-Identifier: BSD-3-Clause
"""Landing detector, and how much of the throttle attitude control may claim.

Landed: for one second the motors are at their least, attitude has given the throttle back, nothing leans
far, and the vehicle neither accelerates nor climbs nor sinks. It deliberately asks neither height nor
position. Where the vehicle is meant to land, leaning does not count: in strong wind the position controller
goes on asking for it on the ground.
"""

from __future__ import annotations

import math

from ...core.kernels import law
from ..events import LANDED, emit
from .control import throttle_mix
from .control.motors import hover_throttle
from .modes import ground, table

TRIGGER_TICKS = 400
"""1 s."""
MAYBE_TICKS = 80
"""0.2 s: controllers stop pushing against the ground."""
ACCEL_MAX = 1.0  # [m/s^2]
SPEED_MAX = 1.0  # [m/s]
LEAN_REQUEST_MAX = math.radians(15.0)
LEAN_ERROR_MAX = math.radians(30.0)
ACCEL_MOVING = 3.0  # [m/s^2]
_FILTER = 0.0025 / (0.0025 + 1.0 / (2.0 * math.pi))
"""Gain of a 1 Hz low-pass at 400 Hz."""
_MIX_AT_MIN = 1.25
_STOPPED = 0.1  # [m/s]


@law
def is_taking_off(v):
    """Whether the mode raises the throttle from the ground by itself and tells when it flies."""
    ap = v.autopilot
    return ap.modes.takeoff.user_active != 0 or table.is_taking_off(ap.modes.number, v)


@law
def acceleration(v):
    """Filtered acceleration [m/s^2]."""
    acc = v.autopilot.modes.landing.acc
    return math.sqrt(acc[0] * acc[0] + acc[1] * acc[1] + acc[2] * acc[2])


@law
def leans_far(ap):
    """(a lean over 15 degrees is asked for, the lean is off by more than 30 degrees)"""
    target = ap.control.attitude.target_euler
    asked = target.roll * target.roll + target.pitch * target.pitch > LEAN_REQUEST_MAX * LEAN_REQUEST_MAX
    return (asked, ap.control.attitude.thrust_error_angle > LEAN_ERROR_MAX)


@law
def update(v):
    """One tick of the detector."""
    ap = v.autopilot
    arming = ap.arming
    landing = ap.modes.landing
    for k in range(3):
        landing.acc[k] += _FILTER * (ap.estimate.acc_ned[k] - landing.acc[k])
    landing.landing = 1 if table.is_landing(ap.modes.number, v) else 0
    if arming.armed == 0:
        arming.landed = 1
        arming.landed_maybe = 1
        arming.landed_ticks = 0
        return
    if arming.landed != 0:
        motors = ap.control.motors
        pushes = motors.throttle > 0.5 * hover_throttle(ap.params.MOT) and motors.spool_state == ground.IS_UNLIMITED
        if pushes and not is_taking_off(v):
            ground.set_landed(v, 0)
        return
    if is_at_rest(v):
        arming.landed_ticks += 1
        if arming.landed_ticks >= TRIGGER_TICKS:
            ground.set_landed(v, 1)
            emit(ap.events, v.time_us, LANDED, 0.0, 0.0)
    else:
        arming.landed_ticks = 0
    arming.landed_maybe = 1 if arming.landed != 0 or arming.landed_ticks >= MAYBE_TICKS else 0


@law
def is_meant_to_land(ap):
    """Whether the mode lands, or the pilot's closed throttle asks for a descent that the ground has stopped."""
    if ap.modes.landing.landing != 0:
        return True
    if not table.has_climb_stick(ap.modes.number):
        return False
    stopped = ap.control.motors.limit_throttle_lower and abs(ap.estimate.vel[2]) < _STOPPED
    return ap.modes.pilot.throttle_zero != 0 and stopped


@law
def is_at_rest(v):
    """Whether everything in this tick speaks for the ground."""
    ap = v.autopilot
    if not ap.control.motors.limit_throttle_lower:
        return False
    if ap.control.attitude.mix >= _MIX_AT_MIN * ap.params.ATC.THR_MIX_MIN:
        return False
    asked, off = leans_far(ap)
    if (asked or off) and not is_meant_to_land(ap):
        return False
    return abs(ap.estimate.vel[2]) < SPEED_MAX and acceleration(v) <= ACCEL_MAX


@law
def update_mix(v):
    """Attitude first in the air, throttle first on and near the ground."""
    ap = v.autopilot
    if ap.arming.armed == 0 or ap.arming.landed != 0:
        throttle_mix.set_mix_min(ap.control.attitude, ap.params.ATC)
    elif table.has_manual_throttle(ap.modes.number):
        if ap.modes.pilot.throttle <= 0.0:
            throttle_mix.set_mix_min(ap.control.attitude, ap.params.ATC)
        else:
            throttle_mix.set_mix_man(ap.control.attitude, ap.params.ATC)
    else:
        asked, off = leans_far(ap)
        level = ap.control.pos_d.vel_desired <= 0.0
        busy = asked or off or level or acceleration(v) > ACCEL_MOVING
        if busy and not is_meant_to_land(ap):
            throttle_mix.set_mix_max(ap.control.attitude, ap.params.ATC, ap.control.pos_d.control_ratio)
        else:
            throttle_mix.set_mix_min(ap.control.attitude, ap.params.ATC)
