# SPDX-License-Identifier: BSD-3-Clause
"""Driving as the controllers ask, with the pilot's help.

STICK_MIXING lets the pilot's steering stick add to the autopilot's steering; a throttle stick that asks for more speed
in the direction of travel gets it.
"""

from __future__ import annotations

from ....core.kernels import law
from ...events import LEG_ENDING, emit_and_return
from ...navigation.state import SPEED_REQUEST
from ...state import Radio
from .. import pilot
from ..control import motors, speed, steering
from ..control.state import MotorsState, PositionState
from ..navigation import waypoint
from ..navigation.state import RoverNav
from ..parameters import Parameters
from ..state import Autopilot, Vehicle
from .state import PilotState


@law
def steer(m: MotorsState, sticks: PilotState, rc: Radio, demand: float, params: Parameters) -> None:
    """Steering demand of a control loop, mixed with the stick's."""
    motors.set_steering(m, pilot.mixed(sticks, rc, demand, params))


@law
def turn(ap: Autopilot, rate: float) -> None:
    """Turn at ``rate`` [rad/s], right positive."""
    demand = steering.out_from_rate(ap.control, ap.estimate, rate, ap.params.ATC)
    steer(ap.control.motors, ap.modes.pilot, ap.rc, demand, ap.params)


@law
def turn_to(ap: Autopilot, heading: float) -> None:
    """Turn towards ``heading`` [rad]."""
    demand = steering.out_from_heading(ap.control, ap.estimate, heading, ap.params.ATC)
    steer(ap.control.motors, ap.modes.pilot, ap.rc, demand, ap.params)


@law
def follow_path(v: Vehicle) -> None:
    """One period along the path of ``navigation.waypoint``: it says how fast and how to turn."""
    ap = v.autopilot
    nav, armed = ap.modes.nav, ap.arming.armed
    path = nav.drive
    path.nudge_speed = abs(pilot.stick_speed(ap.modes.pilot, path.reversed, ap.params))
    if waypoint.follow(nav, ap.control, ap.estimate, armed, v.time_us, ap.params):
        emit_and_return(ap.events, v.time_us, LEG_ENDING, SPEED_REQUEST, 0.0)
    speed.drive(ap.control, armed, path.desired_speed, ap.params)
    turn(ap, path.desired_turn_rate)


@law
def begin_return(nav: RoverNav, c: PositionState, params: Parameters) -> None:
    """A way home begins: at RTL_SPEED, else WP_SPEED."""
    waypoint.start(nav, c, params)
    if params.RTL_SPEED > 0.0:
        waypoint.set_speed(nav, params.RTL_SPEED)


def change_path_speed(v: Vehicle, wanted: float) -> bool:
    """DO_CHANGE_SPEED [m/s] of a mode that follows a path; False for a speed that is too slow."""
    return waypoint.set_speed(v.autopilot.modes.nav, wanted)
