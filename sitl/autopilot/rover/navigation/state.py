# SPDX-License-Identifier: BSD-3-Clause
"""The rover's record of navigation. Paths lie in the plane: the third numbers of its positions are 0."""

from __future__ import annotations

from ....core.records import record
from ...navigation.state import nav_dtype

DRIVE_DTYPE = record(
    # what the mode hands to the controllers
    ("desired_speed", "f8"),  # along the nose, backward negative [m/s]
    ("desired_turn_rate", "f8"),  # right positive [rad/s]
    ("desired_lat_accel", "f8"),  # to the right [m/s^2]
    ("crosstrack", "f8"),  # from the line between the waypoints, negative to its right [m]
    ("origin", "f8", 2),  # where that line begins, NE [m]
    ("reversed", "i8"),  # drives backwards (DO_SET_REVERSE)
    ("shaped", "i8"),  # the target is shaped towards the destination, without planned legs
    ("nudge_speed", "f8"),  # speed limit that the pilot's stick asks for [m/s]; below the other it says nothing
    ("speed_us", "i8"),  # when the speed limit last changed
    ("pivoting", "i8"),  # turns on the spot towards the destination
    ("pivot_us", "i8"),  # when it looked there (start of WP_PIVOT_DELAY); 0 not yet
    ("pivot_next", "i8"),  # it will at the end of the current leg
)

NAV_DTYPE = nav_dtype(
    ("drive", DRIVE_DTYPE),
    ("heading", "f8"),  # YAW_SPEED [rad]
    ("heading_speed", "f8"),  # [m/s]
)
