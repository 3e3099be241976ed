# SPDX-License-Identifier: BSD-3-Clause
"""The copter's record of navigation."""

from __future__ import annotations

from ....core.records import Floats, Record, array
from ....core.vectors import Vec3
from ...navigation.state import Nav

SPLINE_PARTS = 64


class Spline(Record):
    """The curve to a spline waypoint: origin + slope u + square u^2 + cube u^3, ``u`` from 0 to 1."""

    active: bool  # flown instead of the current leg, which is a point at its end
    u: float  # where the target is
    speed: float  # of the target along the curve [m/s]
    end_speed: float  # with which it goes on to the next command [m/s]
    origin: Vec3  # NED [m]
    end: Vec3  # NED [m]
    slope: Vec3  # [m]
    square: Vec3  # [m]
    cube: Vec3  # [m]
    allowed: Floats = array(SPLINE_PARTS + 1)  # speed at equal steps of ``u`` [m/s]


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
    circle_reported: int  # number of the circle that was reported last
    over_ground: bool  # legs, targets and positions along them are above the ground: down 0 is the ground
    ground_lost: bool  # and how high it is below is not known
    ground_d: float  # what is added to them; follows the ground, within the limits of climbs and descents [m]
    ground_vel: float  # [m/s]
    ground_acc: float  # [m/s^2]
    height_error: float  # LOITER_TO_ALT: in the last tick, down positive [m]
    spline: Spline
