# SPDX-License-Identifier: BSD-3-Clause
"""Mixer of a quad: roll, pitch, yaw and throttle demands to four thrusts, giving way in a fixed order when
they do not fit.

Roll and pitch come first, then yaw within its head-room (MOT_YAW_HEADROOM), then throttle, which may be
raised up to ``throttle_avg_max`` to make room for attitude (ATC_THR_MIX_*). Motor numbers and directions are
ArduPilot's: plus (FRAME_TYPE 0): 1 right, 2 left (both counter-clockwise), 3 front, 4 back (clockwise); X
(FRAME_TYPE 1): 1 front right, 2 back left (counter-clockwise), 3 front left, 4 back right (clockwise).
"""

from __future__ import annotations

from typing import NamedTuple

from ....core.kernels import law
from ....core.scalars import constrain
from .state import MotorsState

PLUS, X = 0, 1
# (roll, pitch) factors of motors 1 to 4; yaw is +1/2 for 1 and 2, -1/2 for 3 and 4.
_PLUS_ROLL = (-0.5, 0.5, 0.0, 0.0)
_PLUS_PITCH = (0.0, 0.0, 0.5, -0.5)
_X_ROLL = (-0.5, 0.5, 0.5, -0.5)
_X_PITCH = (0.5, -0.5, 0.5, -0.5)
_YAW = (0.5, 0.5, -0.5, -0.5)


class Demands(NamedTuple):
    """What the controllers ask of the mixer."""

    roll: float  # -1 .. 1: a motor takes half of each
    pitch: float
    yaw: float
    throttle: float  # 0 .. 1
    throttle_avg_max: float  # 0 .. 1: how far throttle may be raised for attitude
    throttle_max: float  # 0 .. 1


class Factors(NamedTuple):
    """Parts of the demands that a motor takes."""

    roll: float
    pitch: float
    yaw: float


@law
def factors(frame_type: int, k: int) -> Factors:
    """Factors of motor ``k`` (0 .. 3); any frame type but plus is flown as X."""
    if frame_type == PLUS:
        return Factors(_PLUS_ROLL[k], _PLUS_PITCH[k], _YAW[k])
    return Factors(_X_ROLL[k], _X_PITCH[k], _YAW[k])


@law
def mix(motors: MotorsState, frame_type: int, demands: Demands, yaw_headroom: float) -> float:
    """Fill ``motors.thrust`` and raise the limit flags; returns the throttle (mean thrust) that came out.

    ``yaw_headroom`` 0 .. 1: thrust kept for yaw even where roll and pitch want it all.
    """
    roll, pitch, yaw, throttle = demands.roll, demands.pitch, demands.yaw, demands.throttle
    if throttle <= 0.0:
        throttle = 0.0
        motors.limit_throttle_lower = True
    if throttle >= demands.throttle_max:
        throttle = demands.throttle_max
        motors.limit_throttle_upper = True
    throttle_avg_max = constrain(demands.throttle_avg_max, throttle, demands.throttle_max)

    # What yaw may use: the room of the tightest motor with the throttle where roll and pitch have most of it.
    centre = min(0.5, throttle_avg_max)
    room = 1.0
    for k in range(4):
        f = factors(frame_type, k)
        thrust = roll * f.roll + pitch * f.pitch
        motors.thrust[k] = thrust
        left = 1.0 - (centre + thrust) if yaw * f.yaw > 0.0 else centre + thrust
        room = min(room, max(left, 0.0) / abs(f.yaw))
    room = max(room, yaw_headroom)
    if abs(yaw) > room:
        yaw = constrain(yaw, -room, room)
        motors.limit_yaw = True

    low = 1.0
    high = -1.0
    for k in range(4):
        thrust = motors.thrust[k] + yaw * _YAW[k]
        motors.thrust[k] = thrust
        low = min(low, thrust)
        high = max(high, thrust)

    # Shrink attitude as a whole if it does not fit between nothing and full thrust.
    scale = 1.0
    if high - low > 1.0:
        scale = 1.0 / (high - low)
    if throttle_avg_max + low < 0.0:
        scale = min(scale, -throttle_avg_max / low)
    low *= scale
    high *= scale
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
    for k in range(4):
        motors.thrust[k] = base + rise + scale * motors.thrust[k]
    return base + rise
