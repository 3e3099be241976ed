# SPDX-License-Identifier: BSD-3-Clause
"""Mixer: roll, pitch, yaw and throttle demands to thrusts, giving way in a fixed order when they do not fit.

Roll and pitch come first, then yaw within its head-room (MOT_YAW_HEADROOM), then throttle, which may be
raised up to ``throttle_avg_max`` to make room for attitude (ATC_THR_MIX_*). ``frames`` has the motors' parts.

When thrust is being lost (``boosting``), the strongest motor is taken for the one that fails: as ``boost_ratio`` rises,
it limits the others no more, throttle may rise to its end and yaw keeps half of the range. Six motors at least are
needed to fly on so; with fewer the ratio stays 0.
"""

from __future__ import annotations

from typing import NamedTuple

from ....core.kernels import inlined, law
from ....core.scalars import constrain
from .state import DT, MotorsState

BOOST_MOTORS = 6
"""Motors at least for which one may be left out."""
_BOOST_HEADROOM = 0.5
_UNBALANCED, _BALANCED = 1.5, 1.25  # strongest motor over the mean
_SLOW_GAIN = DT / (DT + 0.5)
_STRONG = 0.9  # thrust of the strongest motor at which boosting goes on


class Demands(NamedTuple):
    """What the controllers ask of the mixer."""

    roll: float  # -1 .. 1: a motor takes half of each at most
    pitch: float
    yaw: float
    throttle: float  # 0 .. 1
    throttle_avg_max: float  # 0 .. 1: how far throttle may be raised for attitude
    throttle_max: float  # 0 .. 1


@inlined
def between(ratio: float, boosted: float, normal: float) -> float:
    """From ``normal`` at a ratio of 0 to ``boosted`` at 1."""
    return ratio * boosted + (1.0 - ratio) * normal


@inlined
def motor_headroom(motors: MotorsState, k: int, yaw: float, middle: float) -> float:
    """How much of a yaw demand motor ``k`` has room for, at a thrust of ``middle``."""
    left = 1.0 - middle if yaw * motors.yaw_factor[k] > 0.0 else middle
    return max(left, 0.0) * motors.yaw_range[k]


class Boost(NamedTuple):
    """How thrust is boosted."""

    failing: int  # motor that is taken to fail; -1 none
    ratio: float  # 0 .. 1: how far it is left out


@inlined
def mix(motors: MotorsState, count: int, demands: Demands, yaw_headroom: float, boosted: Boost) -> float:
    """Fill ``motors.thrust`` of the first ``count`` and raise the limit flags; returns the throttle (mean thrust) that
    came out.

    ``yaw_headroom`` 0 .. 1: thrust kept for yaw even where roll and pitch want it all.
    """
    roll, pitch, yaw, throttle = demands.roll, demands.pitch, demands.yaw, demands.throttle
    failing, boost = boosted.failing, boosted.ratio
    throttle_max = between(boost, 1.0, demands.throttle_max)
    if throttle <= 0.0:
        throttle = 0.0
        motors.limit_throttle_lower = True
    if throttle >= throttle_max:
        throttle = throttle_max
        motors.limit_throttle_upper = True
    throttle_avg_max = constrain(demands.throttle_avg_max, throttle, throttle_max)

    # What yaw may use: the room of the tightest motor with the throttle where roll and pitch have most of it.
    centre = min(0.5, throttle_avg_max)
    headroom = 1.0
    for k in range(count):
        thrust = roll * motors.roll_factor[k] + pitch * motors.pitch_factor[k]
        motors.thrust[k] = thrust
        if k != failing:
            headroom = min(headroom, motor_headroom(motors, k, yaw, centre + thrust))
    headroom = max(headroom, between(boost, _BOOST_HEADROOM, yaw_headroom))
    if failing >= 0:
        tight = motor_headroom(motors, failing, yaw, centre + motors.thrust[failing])
        headroom = between(boost, headroom, min(headroom, tight))
    if abs(yaw) > headroom:
        yaw = constrain(yaw, -headroom, headroom)
        motors.limit_yaw = True

    low = 1.0
    high = -1.0
    for k in range(count):
        thrust = motors.thrust[k] + yaw * motors.yaw_factor[k]
        motors.thrust[k] = thrust
        low = min(low, thrust)
        if k != failing:
            high = max(high, thrust)
    if failing >= 0 and motors.thrust[failing] > high:
        high = between(boost, high, motors.thrust[failing])

    # Shrink attitude as a whole if it does not fit between nothing and full thrust.
    scale = 1.0
    if high - low > 1.0:
        scale = 1.0 / (high - low)
    if throttle_avg_max + low < 0.0:
        scale = min(scale, -throttle_avg_max / low)
    low *= scale
    base = -low
    rise = throttle - base
    if scale < 1.0:
        motors.limit_roll = True
        motors.limit_pitch = True
        motors.limit_yaw = True
        if rise > 0.0:
            motors.limit_throttle_upper = True
        rise = 0.0
    elif rise < 0.0:
        rise = 0.0
    elif rise > 1.0 - (base + high):
        rise = 1.0 - (base + high)
        motors.limit_throttle_upper = True
    for k in range(count):
        motors.thrust[k] = base + rise + scale * motors.thrust[k]
    return base + rise


@law
def mix_many(motors: MotorsState, demands: Demands, yaw_headroom: float) -> float:
    """``mix`` of so many motors that one may be left out."""
    boosted = Boost(motors.strongest if motors.boosting else -1, motors.boost_ratio)
    out = mix(motors, motors.count, demands, yaw_headroom, boosted)
    watch_balance(motors, out, demands.throttle_max)
    return out


@law
def watch_balance(motors: MotorsState, out: float, throttle_max: float) -> None:
    """Which motor works hardest, and whether boosting may end; ``out``: what ``mix`` gave, ``throttle_max``: 0 .. 1."""
    largest, total = 0.0, 0.0
    for k in range(motors.count):
        thrust = motors.thrust_slow[k] + _SLOW_GAIN * (motors.thrust[k] - motors.thrust_slow[k])
        motors.thrust_slow[k] = thrust
        total += thrust
        if thrust > largest:
            largest = thrust
            if not motors.boosting:
                motors.strongest = k
    balance = largest * motors.count / total if total > 0.1 else 1.0
    if motors.count >= BOOST_MOTORS and balance >= _UNBALANCED:
        motors.unbalanced = True
    elif balance <= _BALANCED:
        motors.unbalanced = False
    if throttle_max > out and largest < _STRONG and not motors.unbalanced:
        motors.boosting = False


@law
def follow_boost(motors: MotorsState, up: float, down: float) -> None:
    """Move ``boost_ratio`` by at most ``up`` or ``down`` while the motors follow the mixer without limit."""
    if motors.boosting and motors.unbalanced:
        motors.boost_ratio = min(motors.boost_ratio + up, 1.0)
    else:
        motors.boost_ratio = max(motors.boost_ratio - down, 0.0)
