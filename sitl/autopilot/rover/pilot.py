# SPDX-License-Identifier: BSD-3-Clause
"""The pilot's sticks, as the rover's modes understand them (PILOT_STEER_TYPE, STICK_MIXING).

Steering and throttle -1 .. 1, right and forward positive. A lost radio centres the sticks at once.
"""

from __future__ import annotations

import math

from ...core.kernels import law
from ...core.scalars import constrain, wrap_2pi
from ..radio import ROLL, THROTTLE, centred, receive, stick_channel, stick_position
from .control import motors, speed

RECEIVER_TIMEOUT_S = 0.5
"""Silence of the receiver that counts as lost (ArduRover's)."""
THROTTLE_AT_REST = 1500
"""[us]"""
_MIXING_RANGE = 500.0  # [us]

# PILOT_STEER_TYPE
TURNS_ROUND, TWO_PADDLES, TURNS_ROUND_TOO, STAYS = 0, 1, 2, 3


@law
def init(v):
    """A receiver is fitted; channels are not known yet."""
    v.autopilot.rc.has_receiver = 1
    pilot = v.autopilot.modes.pilot
    pilot.switch_position = -1
    pilot.switch_candidate = -1


@law
def read(v):
    """One frame: effective channels, then the sticks. Called at 50 Hz."""
    ap = v.autopilot
    receive(ap.rc, v.sensors, ap.params, v.time_us, THROTTLE_AT_REST, RECEIVER_TIMEOUT_S)
    sticks = ap.modes.pilot
    sticks.steering = stick_position(ap.rc, ap.params, ROLL)
    sticks.throttle = stick_position(ap.rc, ap.params, THROTTLE)
    sticks.left = paddle(ap, ROLL)
    sticks.right = paddle(ap, THROTTLE)


@law
def paddle(ap, axis):
    """-1 .. 1 of a stick without dead zone."""
    channel = stick_channel(ap.params.RCMAP, axis)
    pulse = ap.rc.channels[channel]
    return centred(pulse, ap.params.RC[channel], 0.0) if pulse != 0 else 0.0


@law
def is_lost(ap):
    """Whether the sticks say nothing."""
    return ap.modes.failsafe.radio != 0 or ap.rc.receiver_ok == 0


@law
def steering_and_throttle(ap):
    """(steering, throttle) of the sticks. Backing up a car, right turns the nose left, as with a real wheel."""
    if is_lost(ap):
        return (0.0, 0.0)
    sticks = ap.modes.pilot
    kind = int(ap.params.PILOT_STEER_TYPE)
    if kind == TWO_PADDLES:
        left, right = float(sticks.left), float(sticks.right)
        return (0.5 * (left - right), 0.5 * (left + right))
    steering, throttle = float(sticks.steering), float(sticks.throttle)
    if kind != STAYS and throttle < 0.0:
        steering = -steering
    return (steering, throttle)


@law
def _is_turned(ap, asked, given):
    """Whether a limiter still gives the other direction, so that steering must be turned round, too."""
    kind = int(ap.params.PILOT_STEER_TYPE)
    return kind in (TURNS_ROUND, TURNS_ROUND_TOO) and (asked < 0.0) != (given < 0.0)


@law
def steering_and_limited_throttle(ap):
    """(steering, throttle) within what a skid-steered vehicle has for both, and within MOT_SLEWRATE."""
    steering, throttle = steering_and_throttle(ap)
    if motors.is_skid(ap.params):
        both = abs(steering) + abs(throttle)
        if both > 1.0:
            steering /= both
            throttle /= both
    limited = motors.slew_limited(throttle, ap.control.motors.throttle_last, ap.params.MOT.SLEWRATE)
    if _is_turned(ap, throttle, limited):
        steering = -steering
    return (steering, limited)


@law
def steering_and_speed(ap):
    """(steering, speed [m/s] within the acceleration limits)."""
    steering, throttle = steering_and_throttle(ap)
    asked = throttle * speed.speed_max(ap.params)
    limited = speed.accel_limited(ap.control, asked, ap.params.ATC)
    if _is_turned(ap, asked, limited):
        steering = -steering
    return (steering, limited)


@law
def heading_and_speed(ap):
    """(direction of the stick [rad, 0 forwards, right positive], speed [m/s] by how far it is pushed)."""
    if is_lost(ap):
        return (0.0, 0.0)
    sticks = ap.modes.pilot
    steering, throttle = float(sticks.steering), float(sticks.throttle)
    if int(ap.params.PILOT_STEER_TYPE) == TWO_PADDLES:
        steering, throttle = 0.5 * (steering - throttle), 0.5 * (steering + throttle)
    pushed = min(math.sqrt(steering * steering + throttle * throttle), 1.0)
    return (wrap_2pi(math.atan2(steering, throttle)), pushed * speed.speed_max(ap.params))


@law
def mixed(ap, demand):
    """``demand`` -1 .. 1 and the steering stick; the further the stick is out, the less of ``demand`` is left."""
    if is_lost(ap):
        return demand
    channel = stick_channel(ap.params.RCMAP, ROLL)
    out = min(abs(ap.rc.channels[channel] - ap.params.RC[channel].TRIM), _MIXING_RANGE)
    return constrain(demand * (1.0 - out / _MIXING_RANGE) + float(ap.modes.pilot.steering), -1.0, 1.0)
