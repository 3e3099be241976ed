# SPDX-License-Identifier: BSD-3-Clause
"""What the autonomous modes share: demands of throttle and steering, with what the pilot adds to them.

STICK_MIXING lets the pilot's steering stick add to the autopilot's steering; a throttle stick that asks for more speed
in the direction of travel gets it.
"""

from __future__ import annotations

from ....core.kernels import law
from .. import pilot
from ..control import motors, speed, steering
from ..navigation import waypoint
from ..state import Autopilot, Vehicle

CRUISE_THROTTLE_MIN, CRUISE_THROTTLE_MAX = 5.0, 100.0
"""CRUISE_THROTTLE outside of this [%] says nothing about speeds."""


@law
def steer(ap: Autopilot, demand: float) -> None:
    """Steering demand of a control loop, mixed with the stick's.

    It is not cut at -1 .. 1 here: the motors shrink it with speed first, as recorded ArduRovers do.
    """
    motors.set_steering(ap, pilot.mixed(ap, demand) if ap.params.STICK_MIXING > 0.0 else demand)


@law
def turn(ap: Autopilot, rate: float) -> None:
    """Turn at ``rate`` [rad/s], right positive."""
    steer(ap, steering.out_from_rate(ap, rate))


@law
def turn_to(ap: Autopilot, heading: float) -> None:
    """Turn towards ``heading`` [rad]."""
    steer(ap, steering.out_from_heading(ap, heading))


@law
def stick_speed(ap: Autopilot, backward: bool) -> float:
    """Speed [m/s] that the throttle stick asks for in the direction of travel; 0 when it pulls the other way.

    ``backward``: the vehicle drives backwards on purpose.
    """
    if not CRUISE_THROTTLE_MIN <= ap.params.CRUISE.THROTTLE <= CRUISE_THROTTLE_MAX:
        return 0.0
    asked = pilot.sticks(ap).throttle * speed.speed_max(ap.params)
    return min(asked, 0.0) if backward else max(asked, 0.0)


@law
def nudged(ap: Autopilot, wanted: float) -> float:
    """``wanted`` [m/s], or the stick's speed when that is faster in the same direction."""
    if wanted < 0.0:
        return min(wanted, stick_speed(ap, True))
    return max(wanted, stick_speed(ap, False))


@law
def follow_path(v: Vehicle) -> None:
    """One period along the path of ``navigation.waypoint``: it says how fast and how to turn."""
    ap = v.autopilot
    path = ap.modes.nav.drive
    waypoint.set_nudge_speed(ap, abs(stick_speed(ap, path.reversed)))
    waypoint.follow(v)
    speed.drive(v, path.desired_speed)
    turn(ap, path.desired_turn_rate)


@law
def change_path_speed(v: Vehicle, wanted: float) -> bool:
    """DO_CHANGE_SPEED [m/s] of a mode that follows a path; False for a speed that is too slow."""
    return waypoint.set_speed(v.autopilot, wanted)
