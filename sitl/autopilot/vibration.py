# SPDX-License-Identifier: BSD-3-Clause
"""How much the accelerometer shakes: what VIBRATION and VIBE report, worked out every tick as ArduPilot does.

Source: https://ardupilot.org/copter/docs/common-measuring-vibration.html
"""

from __future__ import annotations

import math

from ..core.constants import GRAVITY, TICK_US
from ..core.kernels import inlined, law
from ..core.records import Record
from ..core.scalars import finite
from ..core.vectors import Vec3
from .control.pid import lowpass_gain

FLOOR_HZ, LEVEL_HZ = 5.0, 2.0
"""Cut-off frequencies: slower than the first is motion, and the level follows with the second."""
CLIP = 15.5 * GRAVITY
"""An axis beyond it counts as clipped [m/s^2]: half a g below the 16 g of usual accelerometers."""
_DT = TICK_US * 1e-6


class Vibration(Record):
    """What is known of the accelerometer's vibration."""

    floor: Vec3  # slow part of the specific force, body [m/s^2]
    squares: Vec3  # filtered squares of the rest [m^2/s^4]
    clips: int  # samples with a clipped axis since boot
    more_clips: int  # by so many the second IMU has more


@law
def is_clipped(acc: Vec3) -> bool:
    """Whether an axis of a sample [m/s^2] is clipped."""
    return abs(acc.x) > CLIP or abs(acc.y) > CLIP or abs(acc.z) > CLIP


@law
def compare_clips(vibration: Vibration, acc: Vec3, acc2: Vec3) -> None:
    """Samples of two IMUs that differ."""
    vibration.more_clips += (1 if is_clipped(acc2) else 0) - (1 if is_clipped(acc) else 0)


@inlined
def update_vibration(vibration: Vibration, acc: Vec3) -> None:
    """Take a sample of the accelerometer [m/s^2] into account; one that is no number counts for nothing."""
    if not (finite(acc.x) and finite(acc.y) and finite(acc.z)):
        return
    if is_clipped(acc):
        vibration.clips += 1
    vibration.floor += lowpass_gain(FLOOR_HZ, _DT) * (acc - vibration.floor)
    rest = acc - vibration.floor
    squares = Vec3(rest.x * rest.x, rest.y * rest.y, rest.z * rest.z)
    vibration.squares += lowpass_gain(LEVEL_HZ, _DT) * (squares - vibration.squares)


@law
def vibration_levels(vibration: Vibration) -> Vec3:
    """Level on each axis of the body [m/s^2]."""
    squares = vibration.squares
    return Vec3(math.sqrt(squares.x), math.sqrt(squares.y), math.sqrt(squares.z))
