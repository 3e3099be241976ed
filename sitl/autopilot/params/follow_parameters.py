# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of FOLLOW."""

from __future__ import annotations

from .parameter import INT8, INT16, ParameterGroup, param


class Follow(ParameterGroup):
    """FOLL_: another vehicle is followed."""

    ENABLE: float = param(0, 0, 1, "", "1: positions of other vehicles are taken", INT8)
    SYSID: float = param(0, 0, 255, "", "System id of the vehicle to follow; 0: the first that is heard", INT16)
    DIST_MAX: float = param(100.0, 0.0, 100000.0, "m", "A vehicle further away is not followed; 0: no limit")
    OFS_TYPE: float = param(0, 0, 1, "", "Offsets are: 0 north, east, down; 1 forward, right, down of the lead", INT8)
    OFS_X: float = param(
        0.0, -100000.0, 100000.0, "m", "Position beside the lead: north or forward; all 0: as it is when FOLLOW begins"
    )
    OFS_Y: float = param(0.0, -100000.0, 100000.0, "m", "East or right")
    OFS_Z: float = param(0.0, -100000.0, 100000.0, "m", "Down")
    TIMEOUT: float = param(3.0, 0.0, 100.0, "s", "A lead that was silent for so long is not followed")
    POS_P: float = param(0.1, 0.01, 1.0, "1/s", "Speed asked for per distance from the position (rovers)")
    ACCEL_NE: float = param(
        2.5, 0.0, 50.0, "m/s/s", "Horizontal acceleration of what is taken for the lead's motion; 0: as it is told"
    )
    JERK_NE: float = param(5.0, 0.0, 500.0, "m/s/s/s", "Its jerk")
    ACCEL_D: float = param(2.5, 0.0, 50.0, "m/s/s", "The same for its height")
    JERK_D: float = param(5.0, 0.0, 500.0, "m/s/s/s", "Its jerk")
    ACCEL_H: float = param(90.0, 0.0, 3600.0, "deg/s/s", "The same for its heading")
    JERK_H: float = param(360.0, 0.0, 36000.0, "deg/s/s/s", "Its jerk")
