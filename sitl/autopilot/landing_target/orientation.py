# SPDX-License-Identifier: BSD-3-Clause
"""Where a sensor looks, or a beacon shines: MAV_SENSOR_ORIENTATION, of which eight are level.

https://mavlink.io/en/messages/common.html#MAV_SENSOR_ORIENTATION
"""

from __future__ import annotations

import math

from ...core.algebra import horizontal, turned, with_down
from ...core.kernels import law
from ...core.vectors import Vec3

UP, DOWN = 24, 25
LEVEL = 8
"""Numbers below: so many times 45 degrees clockwise from ahead."""


@law
def mounted(line: Vec3, orientation: int) -> Vec3:
    """A direction that a sensor sees which looks down, as one sees it that looks elsewhere; FRD."""
    if orientation == DOWN:
        return line
    ahead = Vec3(line.z, line.y, -line.x)
    if orientation == UP:
        return Vec3(ahead.z, ahead.y, -ahead.x)
    return with_down(turned(horizontal(ahead), math.radians(45.0 * (orientation % LEVEL))), ahead.z)


@law
def axis(orientation: int) -> Vec3:
    """The middle of what it sees, FRD; of a beacon NED."""
    return mounted(Vec3(0.0, 0.0, 1.0), orientation)
