# SPDX-License-Identifier: BSD-3-Clause
"""The pilot's sticks, as the rover's modes understand them (PILOT_STEER_TYPE, STICK_MIXING).

Steering and throttle -1 .. 1, right and forward positive. A lost radio centres the sticks at once.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ...core.elementary import atan2
from ...core.kernels import law
from ...core.scalars import constrain, wrap_2pi
from ..radio import ROLL, THROTTLE, centred, receive, stick_channel, stick_position
from ..state import Radio, Sensors
from .control import motors, speed
from .control.state import Control
from .modes.state import PilotState
from .parameters import Parameters

THROTTLE_AT_REST = 1500
"""[us]"""
MIXING_RANGE = 400.0  # [us]
CRUISE_THROTTLE_MIN, CRUISE_THROTTLE_MAX = 5.0, 100.0
"""CRUISE_THROTTLE outside of this [%] says nothing about speeds."""

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


def init(pilot: PilotState, rc: Radio) -> None:
    """A receiver is fitted; channels are not known yet."""
    rc.has_receiver = True
    pilot.switch_position = -1
    pilot.switch_candidate = -1


@law
def read(pilot: PilotState, rc: Radio, sensors: Sensors, params: Parameters, time_us: int) -> None:
    """One frame: effective channels, then the sticks. Called at 50 Hz."""
    receive(rc, sensors, params, time_us, THROTTLE_AT_REST, params.RC_FS_TIMEOUT)
    pilot.steering = stick_position(rc, params, ROLL)
    pilot.throttle = whole_percent(stick_position(rc, params, THROTTLE))
    channel = stick_channel(params.RCMAP, ROLL)
    pilot.steering_pulse = min(abs(rc.channels[channel] - params.RC[channel].TRIM), MIXING_RANGE)
    pilot.left = paddle(rc, params, ROLL)
    pilot.right = paddle(rc, params, THROTTLE)


@law
def whole_percent(stick: float) -> float:
    """A stick -1 .. 1 cut to hundredths: the throttle stick counts in whole percent."""
    return float(int(100.0 * stick)) * 0.01


@law
def paddle(rc: Radio, params: Parameters, stick: int) -> float:
    """-1 .. 1 of a stick without dead zone."""
    channel = stick_channel(params.RCMAP, stick)
    pulse = rc.channels[channel]
    return centred(pulse, params.RC[channel], 0.0) if pulse != 0 else 0.0


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
def sticks(pilot: PilotState, params: Parameters) -> Sticks:
    """Steering and throttle of the sticks."""
    if pilot.lost:
        return Sticks(0.0, 0.0)
    return understood(pilot, int(params.PILOT_STEER_TYPE))


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
def limited_sticks(pilot: PilotState, throttle_last: float, params: Parameters) -> Sticks:
    """Steering and throttle within what a skid-steered vehicle has for both, and within MOT_SLEWRATE."""
    wanted = within_skid(sticks(pilot, params)) if motors.is_skid(params) else sticks(pilot, params)
    throttle = motors.slew_limited(wanted.throttle, throttle_last, params.MOT.SLEWRATE)
    return Sticks(turned_with(wanted.steering, wanted.throttle, throttle, int(params.PILOT_STEER_TYPE)), throttle)


@law
def steering_and_speed(pilot: PilotState, control: Control, params: Parameters) -> SteeringAndSpeed:
    """Steering, and a speed within the acceleration limits."""
    wanted = sticks(pilot, params)
    asked = wanted.throttle * speed.speed_max(params)
    given = speed.accel_limited(control, asked, params.ATC)
    return SteeringAndSpeed(turned_with(wanted.steering, asked, given, int(params.PILOT_STEER_TYPE)), given)


@law
def pointed(pilot: PilotState, steer_type: int, speed_max: float) -> HeadingAndSpeed:
    """Direction of the stick, and a speed up to ``speed_max`` [m/s] by how far it is pushed."""
    steering, throttle = pilot.steering, pilot.throttle
    if steer_type == TWO_PADDLES:
        steering, throttle = 0.5 * (steering - throttle), 0.5 * (steering + throttle)
    pushed = min(math.sqrt(steering * steering + throttle * throttle), 1.0)
    return HeadingAndSpeed(wrap_2pi(atan2(steering, throttle)), pushed * speed_max)


@law
def heading_and_speed(pilot: PilotState, params: Parameters) -> HeadingAndSpeed:
    """Where the stick points, and how fast."""
    if pilot.lost:
        return HeadingAndSpeed(0.0, 0.0)
    return pointed(pilot, int(params.PILOT_STEER_TYPE), speed.speed_max(params))


@law
def mixed(pilot: PilotState, demand: float, enabled: float) -> float:
    """``demand`` -1 .. 1 and the steering stick; the further it is out, the less of ``demand`` is left.

    ``enabled``: STICK_MIXING. Without the stick, ``demand`` is not cut at -1 .. 1: the motors shrink it with speed
    first, as recorded ArduRovers do.
    """
    if pilot.lost or not enabled > 0.0:
        return demand
    return constrain(demand * (1.0 - pilot.steering_pulse / MIXING_RANGE) + pilot.steering, -1.0, 1.0)


@law
def stick_speed(pilot: PilotState, backward: bool, params: Parameters) -> float:
    """Speed [m/s] that the throttle stick asks for in the direction of travel; 0 when it pulls the other way.

    ``backward``: the vehicle drives backwards on purpose.
    """
    if not CRUISE_THROTTLE_MIN <= params.CRUISE.THROTTLE <= CRUISE_THROTTLE_MAX:
        return 0.0
    asked = sticks(pilot, params).throttle * speed.speed_max(params)
    return min(asked, 0.0) if backward else max(asked, 0.0)


@law
def nudged(pilot: PilotState, wanted: float, params: Parameters) -> float:
    """``wanted`` [m/s], or the stick's speed when that is faster in the same direction."""
    if wanted < 0.0:
        return min(wanted, stick_speed(pilot, True, params))
    return max(wanted, stick_speed(pilot, False, params))
