# SPDX-License-Identifier: BSD-3-Clause
"""The copter's record of navigation."""

from __future__ import annotations

from ....core.vectors import Vec3
from ...navigation.state import Nav


class CopterNav(Nav):
    """Navigation of the copter."""

    pause_scale: float  # 0 .. 1: path time stops when paused, within acceleration and jerk
    pause_rate: float  # its rate of change [1/s]
    paused: bool
    # vertical limits that a command set; 0: the parameters
    speed_up: float  # [m/s]
    speed_down: float
    # circle
    circle_centre: Vec3  # NED [m]
    circle_angle: float  # of the point on the circle seen from the centre [rad]
    circle_total: float  # turned so far, signed [rad]
    circle_rate: float  # [rad/s]
    circle_top_rate: float  # signed, wanted [rad/s]
    circle_acc: float  # [rad/s^2]
    circle_running: bool  # false: still on the way to the edge
