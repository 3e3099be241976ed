# SPDX-License-Identifier: BSD-3-Clause
"""The rover's record of navigation. Paths lie in the plane: the third numbers of its positions are 0."""

from __future__ import annotations

from ....core.records import Record
from ....core.vectors import Vec2
from ...navigation.state import Nav


class DriveState(Record):
    """What a driving mode hands to the controllers, and how it turns on the spot."""

    # what the mode hands to the controllers
    desired_speed: float  # along the nose, backward negative [m/s]
    desired_turn_rate: float  # right positive [rad/s]
    desired_lat_accel: float  # to the right [m/s^2]
    crosstrack: float  # from the line between the waypoints, negative to its right [m]
    origin: Vec2  # where that line begins, NE [m]
    reversed: bool  # drives backwards (DO_SET_REVERSE)
    shaped: bool  # the target is shaped towards the destination, without planned legs
    nudge_speed: float  # speed limit that the pilot's stick asks for [m/s]; below the other it says nothing
    speed_us: int  # when the speed limit last changed
    pivoting: bool  # turns on the spot towards the destination
    pivot_us: int  # when it looked there (start of WP_PIVOT_DELAY); 0 not yet
    pivot_next: bool  # it will at the end of the current leg


class RoverNav(Nav):
    """Navigation of the rover."""

    drive: DriveState
    heading: float  # YAW_SPEED [rad]
    heading_speed: float  # [m/s]
