# SPDX-License-Identifier: BSD-3-Clause
"""The copter's record of navigation."""

from __future__ import annotations

from ...navigation.state import nav_dtype

NAV_DTYPE = nav_dtype(
    ("pause_scale", "f8"),  # 0 .. 1: path time stops when paused, within acceleration and jerk
    ("pause_rate", "f8"),  # its rate of change [1/s]
    ("paused", "i8"),
    # vertical limits that a command set; 0: the parameters
    ("speed_up", "f8"),  # [m/s]
    ("speed_down", "f8"),
    # circle
    ("circle_centre", "f8", 3),  # NED [m]
    ("circle_angle", "f8"),  # of the point on the circle seen from the centre [rad]
    ("circle_total", "f8"),  # turned so far, signed [rad]
    ("circle_rate", "f8"),  # [rad/s]
    ("circle_top_rate", "f8"),  # signed, wanted [rad/s]
    ("circle_acc", "f8"),  # [rad/s^2]
    ("circle_running", "i8"),  # 0 still on the way to the edge
)
