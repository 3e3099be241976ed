# SPDX-License-Identifier: BSD-3-Clause
"""The copter's record of navigation."""

from __future__ import annotations

from ....core.records import Floats, array
from ...navigation.state import Nav


class CopterNav(Nav):
    """Navigation of the copter."""

    pause_scale: float  # 0 .. 1: path time stops when paused, within acceleration and jerk
    pause_rate: float  # its rate of change [1/s]
    paused: int
    # vertical limits that a command set; 0: the parameters
    speed_up: float  # [m/s]
    speed_down: float
    # circle
    circle_centre: Floats = array(3)  # NED [m]
    circle_angle: float  # of the point on the circle seen from the centre [rad]
    circle_total: float  # turned so far, signed [rad]
    circle_rate: float  # [rad/s]
    circle_top_rate: float  # signed, wanted [rad/s]
    circle_acc: float  # [rad/s^2]
    circle_running: int  # 0 still on the way to the edge
