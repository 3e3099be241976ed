# SPDX-License-Identifier: BSD-3-Clause
"""Rays of a planar laser scanner, and the readings that it publishes from them.

The rule is Gazebo's (ray sensor with a horizontal resolution below 1, as the paper's robots had): more rays are cast
than readings published; reading i lies at ray i * (rays - 1) / (readings - 1), between two rays, and is their weighted
mean. A ray that meets nothing within the range counts as the range.
"""

from __future__ import annotations

import math

import numpy as np

from ..core.array_kernels import Kernel, Line
from ..core.kernels import law
from .geometry import Floats
from .rays import INF


def angles(count: int, field_of_view: float) -> Floats:
    """Angles [rad], counter-clockwise from straight ahead, evenly from right to left, both ends; shape (count,)."""
    if count == 1:
        return np.zeros(1)
    return np.linspace(-0.5 * field_of_view, 0.5 * field_of_view, count)


def rays(count: int, field_of_view: float) -> Floats:
    """Unit vectors on the body (FRD: three rows, forward, right, down) at those angles; shape (3, count)."""
    at = [float(a) for a in angles(count, field_of_view)]
    return np.array([[math.cos(a) for a in at], [-math.sin(a) for a in at], [0.0] * count])


@law
def publish_readings(ranges: Line, longest: float, out: Line) -> None:
    """The published readings of the ranges that were cast, into ``out``; see ``publish``."""
    cast, published = ranges.shape[0], out.shape[0]
    for i in range(published):
        place = i * (cast - 1) / (published - 1) if published > 1 else 0.0
        first = min(int(place), max(cast - 2, 0))
        a = min(ranges[first], longest)
        b = min(ranges[min(first + 1, cast - 1)], longest)
        reading = a + (place - first) * (b - a)
        out[i] = INF if reading >= longest else reading


_publish = Kernel(publish_readings)


def publish(ranges: Floats, longest: float, out: Floats) -> Floats:
    """The published readings [m] of the ranges that were cast, into ``out``, which is returned.

    Args:
        ranges: what the rays met [m], inf for nothing.
        longest: range of the sensor [m]; a reading of that or more is inf.
        out: as many readings as are published.
    """
    _publish(ranges, longest, out)
    return out
