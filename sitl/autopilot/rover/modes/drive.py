# SPDX-License-Identifier: BSD-3-Clause
"""What the modes share: from a speed, a turn rate or a heading to the demands of throttle and steering."""

from __future__ import annotations

from ....core.kernels import law
from ....core.scalars import constrain
from .. import pilot
from ..control import motors, speed, steering
from ..navigation import waypoint
from .numbers import is_autopilot

LEAST_CRUISE_THROTTLE, MOST_CRUISE_THROTTLE = 5.0, 100.0
"""CRUISE_THROTTLE outside of this [%] says nothing about speeds."""


@law
def steer(v, demand):
    """Steering demand of a control loop; STICK_MIXING lets the pilot add to the autopilot's.

    It is not cut at -1 .. 1 here: the motors shrink it with speed first, as recorded ArduRovers do.
    """
    ap = v.autopilot
    if ap.params.STICK_MIXING > 0.0 and is_autopilot(int(ap.modes.number)):
        demand = pilot.mixed(ap, demand)
    motors.set_steering(ap, demand)


@law
def turn(v, rate):
    """Turn at ``rate`` [rad/s], right positive."""
    steer(v, steering.out_from_rate(v.autopilot, rate))


@law
def to_heading(v, heading):
    """Turn towards ``heading`` [rad]."""
    steer(v, steering.out_from_heading(v.autopilot, heading))


@law
def accelerate_sideways(v, accel):
    """Turn with a lateral acceleration [m/s^2] to the right, within ATC_TURN_MAX_G."""
    ap = v.autopilot
    most = steering.lat_accel_max(ap.params.ATC)
    steer(v, steering.out_from_lat_accel(ap, constrain(accel, -most, most)))


@law
def pilots_speed(ap, backward):
    """Speed [m/s] that the throttle stick asks for in the direction of travel; 0 when it pulls the other way.

    ``backward``: the vehicle drives backwards on purpose.
    """
    throttle = ap.params.CRUISE.THROTTLE
    if throttle < LEAST_CRUISE_THROTTLE or throttle > MOST_CRUISE_THROTTLE:
        return 0.0
    _, stick = pilot.steering_and_throttle(ap)
    asked = stick * speed.speed_max(ap.params)
    return min(asked, 0.0) if backward else max(asked, 0.0)


@law
def nudged(ap, wanted):
    """``wanted`` [m/s], or the pilot's speed when that is faster in the same direction."""
    if wanted < 0.0:
        return min(wanted, pilots_speed(ap, True))
    return max(wanted, pilots_speed(ap, False))


@law
def along_path(v):
    """One period along the path of ``navigation.waypoint``: it says how fast and how to turn."""
    ap = v.autopilot
    path = ap.modes.nav.drive
    waypoint.set_nudge_speed(ap, abs(pilots_speed(ap, path.reversed)))
    waypoint.follow(v)
    speed.drive(v, float(path.desired_speed))
    turn(v, float(path.desired_turn_rate))
