# SPDX-License-Identifier: BSD-3-Clause
"""Driving as the controllers ask, with the pilot's help.

STICK_MIXING lets the pilot's steering stick add to the autopilot's steering; a throttle stick that asks for more speed
in the direction of travel gets it.
"""

from __future__ import annotations

from ....core.kernels import law
from ...events import LEG_ENDING, emit_and_return
from ...navigation.state import SPEED_REQUEST
from ...state import Estimate
from .. import pilot
from ..control import motors, speed, steering
from ..control.state import Control, PositionState
from ..navigation import waypoint
from ..navigation.state import RoverNav
from ..parameters import Parameters
from ..state import Vehicle
from .state import PilotState


@law
def turn(control: Control, estimate: Estimate, sticks: PilotState, rate: float, params: Parameters) -> None:
    """Turn at ``rate`` [rad/s], right positive; the stick may add to it."""
    demand = steering.out_from_rate(control, estimate, rate, params.ATC)
    motors.set_steering(control.motors, pilot.mixed(sticks, demand, params.STICK_MIXING))


@law
def turn_to(control: Control, estimate: Estimate, sticks: PilotState, heading: float, params: Parameters) -> None:
    """Turn towards ``heading`` [rad]; the stick may add to it."""
    demand = steering.out_from_heading(control, estimate, heading, params.ATC)
    motors.set_steering(control.motors, pilot.mixed(sticks, demand, params.STICK_MIXING))


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
    turn(ap.control, ap.estimate, ap.modes.pilot, path.desired_turn_rate, ap.params)


@law
def begin_return(nav: RoverNav, c: PositionState, params: Parameters) -> None:
    """A way home begins: at RTL_SPEED, else WP_SPEED."""
    waypoint.start(nav, c, params)
    if params.RTL_SPEED > 0.0:
        waypoint.set_speed(nav, params.RTL_SPEED)


def change_path_speed(v: Vehicle, wanted: float) -> bool:
    """DO_CHANGE_SPEED [m/s] of a mode that follows a path; False for a speed that is too slow."""
    return waypoint.set_speed(v.autopilot.modes.nav, wanted)
