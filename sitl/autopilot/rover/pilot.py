# SPDX-License-Identifier: BSD-3-Clause
"""The pilot's sticks, as the rover's modes understand them (PILOT_STEER_TYPE, STICK_MIXING).

Steering and throttle -1 .. 1, right and forward positive. A lost radio centres the sticks at once.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ...core.kernels import law
from ...core.scalars import constrain, wrap_2pi
from ..radio import ROLL, THROTTLE, centred, receive, stick_channel, stick_position
from ..state import Radio
from .control import motors, speed
from .modes.state import PilotState
from .parameters import Parameters
from .state import Autopilot, Vehicle

RECEIVER_TIMEOUT_S = 0.5
"""Silence of the receiver that counts as lost (ArduRover's)."""
THROTTLE_AT_REST = 1500
"""[us]"""
MIXING_RANGE = 500.0  # [us]

# PILOT_STEER_TYPE
TURNS_ROUND, TWO_PADDLES, TURNS_ROUND_TOO, STAYS = 0, 1, 2, 3


class Sticks(NamedTuple):
    """What the sticks ask of the motors."""

    steering: float  # -1 .. 1, right positive
    throttle: float  # -1 .. 1


class SteeringAndSpeed(NamedTuple):
    """What the sticks ask of modes that control the speed."""

    steering: float  # -1 .. 1, right positive
    speed: float  # backward negative [m/s]


class HeadingAndSpeed(NamedTuple):
    """Where one stick points, and how far it is pushed."""

    heading: float  # 0 forwards, right positive [rad]
    speed: float  # [m/s]


@law
def init(ap: Autopilot) -> None:
    """A receiver is fitted; channels are not known yet."""
    ap.rc.has_receiver = True
    ap.modes.pilot.switch_position = -1
    ap.modes.pilot.switch_candidate = -1


@law
def read(v: Vehicle) -> None:
    """One frame: effective channels, then the sticks. Called at 50 Hz."""
    ap = v.autopilot
    receive(ap.rc, v.sensors, ap.params, v.time_us, THROTTLE_AT_REST, RECEIVER_TIMEOUT_S)
    pilot = ap.modes.pilot
    pilot.steering = stick_position(ap.rc, ap.params, ROLL)
    pilot.throttle = stick_position(ap.rc, ap.params, THROTTLE)
    pilot.left = paddle(ap.rc, ap.params, ROLL)
    pilot.right = paddle(ap.rc, ap.params, THROTTLE)


@law
def paddle(rc: Radio, params: Parameters, stick: int) -> float:
    """-1 .. 1 of a stick without dead zone."""
    channel = stick_channel(params.RCMAP, stick)
    pulse = rc.channels[channel]
    return centred(pulse, params.RC[channel], 0.0) if pulse != 0 else 0.0


@law
def is_lost(ap: Autopilot) -> bool:
    """Whether the sticks say nothing."""
    return ap.modes.failsafe.radio or not ap.rc.receiver_ok


@law
def understood(pilot: PilotState, steer_type: int) -> Sticks:
    """Steering and throttle by PILOT_STEER_TYPE.

    Backing up a car, right turns the nose left, as with a real wheel.
    """
    if steer_type == TWO_PADDLES:
        return Sticks(0.5 * (pilot.left - pilot.right), 0.5 * (pilot.left + pilot.right))
    if steer_type != STAYS and pilot.throttle < 0.0:
        return Sticks(-pilot.steering, pilot.throttle)
    return Sticks(pilot.steering, pilot.throttle)


@law
def sticks(ap: Autopilot) -> Sticks:
    """Steering and throttle of the sticks."""
    if is_lost(ap):
        return Sticks(0.0, 0.0)
    return understood(ap.modes.pilot, int(ap.params.PILOT_STEER_TYPE))


@law
def turned_with(steering: float, asked: float, given: float, steer_type: int) -> float:
    """``steering``, turned round when a limiter still gives the other direction than was asked for."""
    turns = steer_type in (TURNS_ROUND, TURNS_ROUND_TOO)
    return -steering if turns and (asked < 0.0) != (given < 0.0) else steering


@law
def within_skid(wanted: Sticks) -> Sticks:
    """Within what the motors of a skid-steered vehicle have for both together."""
    both = abs(wanted.steering) + abs(wanted.throttle)
    if both > 1.0:
        return Sticks(wanted.steering / both, wanted.throttle / both)
    return wanted


@law
def limited_sticks(ap: Autopilot) -> Sticks:
    """Steering and throttle within what a skid-steered vehicle has for both, and within MOT_SLEWRATE."""
    p = ap.params
    wanted = within_skid(sticks(ap)) if motors.is_skid(p) else sticks(ap)
    throttle = motors.slew_limited(wanted.throttle, ap.control.motors.throttle_last, p.MOT.SLEWRATE)
    return Sticks(turned_with(wanted.steering, wanted.throttle, throttle, int(p.PILOT_STEER_TYPE)), throttle)


@law
def steering_and_speed(ap: Autopilot) -> SteeringAndSpeed:
    """Steering, and a speed within the acceleration limits."""
    p = ap.params
    wanted = sticks(ap)
    asked = wanted.throttle * speed.speed_max(p)
    given = speed.accel_limited(ap.control, asked, p.ATC)
    return SteeringAndSpeed(turned_with(wanted.steering, asked, given, int(p.PILOT_STEER_TYPE)), given)


@law
def pointed(pilot: PilotState, steer_type: int, speed_max: float) -> HeadingAndSpeed:
    """Direction of the stick, and a speed up to ``speed_max`` [m/s] by how far it is pushed."""
    steering, throttle = pilot.steering, pilot.throttle
    if steer_type == TWO_PADDLES:
        steering, throttle = 0.5 * (steering - throttle), 0.5 * (steering + throttle)
    pushed = min(math.sqrt(steering * steering + throttle * throttle), 1.0)
    return HeadingAndSpeed(wrap_2pi(math.atan2(steering, throttle)), pushed * speed_max)


@law
def heading_and_speed(ap: Autopilot) -> HeadingAndSpeed:
    """Where the stick points, and how fast."""
    if is_lost(ap):
        return HeadingAndSpeed(0.0, 0.0)
    return pointed(ap.modes.pilot, int(ap.params.PILOT_STEER_TYPE), speed.speed_max(ap.params))


@law
def mixed(ap: Autopilot, demand: float) -> float:
    """``demand`` -1 .. 1 and the steering stick; the further the stick is out, the less of ``demand`` is left."""
    if is_lost(ap):
        return demand
    channel = stick_channel(ap.params.RCMAP, ROLL)
    out = min(abs(ap.rc.channels[channel] - ap.params.RC[channel].TRIM), MIXING_RANGE)
    return constrain(demand * (1.0 - out / MIXING_RANGE) + ap.modes.pilot.steering, -1.0, 1.0)
