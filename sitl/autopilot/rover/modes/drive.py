# SPDX-License-Identifier: BSD-3-Clause
"""Driving as the controllers ask, with the pilot's help.

STICK_MIXING lets the pilot's steering stick add to the autopilot's steering; a throttle stick that asks for more speed
in the direction of travel gets it.
"""

from __future__ import annotations

from ....core.kernels import law
from ...avoidance import limit
from ...avoidance.velocity import braking
from ...events import emit_and_return
from ...navigation.state import LEG_ENDING, SPEED_REQUEST
from ...state import Estimate
from .. import pilot
from ..control import motors, speed, steering
from ..control.state import DT, Control, PositionState
from ..navigation import waypoint
from ..navigation.state import RoverNav
from ..parameters import Parameters
from ..state import Vehicle
from .state import PilotState

DECEL_SHARE = 0.5
"""Of the greatest deceleration: so much is planned with before obstacles and fences (ArduPilot's)."""


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
def at_speed(v: Vehicle, desired: float) -> None:
    """Drive at ``desired`` [m/s], or as slowly as obstacles and fences ask for."""
    ap = v.autopilot
    control, p = ap.control, ap.params
    if limit.is_active(ap.avoid):
        asked = speed.accel_limited(control, desired, p.ATC)
        b = braking(0.0, DECEL_SHARE * speed.decel_max(p.ATC), DT, p.AVOID.BEHAVE)
        desired = limit.limit_speed(ap, v.time_us, asked, b)
    speed.drive(control, ap.arming.armed, desired, p)


@law
def on_path(v: Vehicle, desired: float) -> None:
    """The same on a path, which is braked on as its position controller does."""
    ap = v.autopilot
    c, p = ap.control.position, ap.params
    if limit.is_active(ap.avoid):
        b = braking(p.PSC.POS_P, min(c.accel_max, c.lat_accel_max), DT, p.AVOID.BEHAVE)
        desired = limit.limit_speed(ap, v.time_us, desired, b)
    speed.drive(ap.control, ap.arming.armed, desired, p)


@law
def follow_path(v: Vehicle) -> None:
    """One period along the path of ``navigation.waypoint``: it says how fast and how to turn."""
    ap = v.autopilot
    nav, armed = ap.modes.nav, ap.arming.armed
    path = nav.drive
    path.nudge_speed = abs(pilot.stick_speed(ap.modes.pilot, path.reversed, ap.params))
    if waypoint.follow(nav, ap.control, ap.estimate, armed, v.time_us, ap.params):
        emit_and_return(ap.events, v.time_us, LEG_ENDING, SPEED_REQUEST, 0.0)
    on_path(v, path.desired_speed)
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
