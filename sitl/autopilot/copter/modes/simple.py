# SPDX-License-Identifier: BSD-3-Clause
"""SIMPLE and SUPER_SIMPLE: roll and pitch sticks count from another heading than the nose's.

In SIMPLE forwards is the heading at arming. In SUPER_SIMPLE it is away from home, once the vehicle is HOME_RADIUS from
it; nearer it stays what it was. A position of the mode switch selects them (bits of SIMPLE and SUPER_SIMPLE), or a
switch of its own.

Source: https://ardupilot.org/copter/docs/simpleandsuper-simple-modes.html
"""

from __future__ import annotations

from ....core.algebra import horizontal, norm2, turned
from ....core.elementary import atan2
from ....core.kernels import law
from ....core.mavlink import MavSeverity
from ....core.vectors import Vec2, Vec3
from ...aux_switch import has_function
from ...events import Event, emit
from ..parameters import Parameters
from ..state import Vehicle
from .state import PilotState, SimpleState

OFF, SIMPLE, SUPER_SIMPLE = 0, 1, 2
SIMPLE_FUNCTION, SUPER_SIMPLE_FUNCTION = 3, 13
HOME_RADIUS = 10.0  # [m]

_TEXTS = {OFF: "SIMPLE mode off", SIMPLE: "SIMPLE mode on", SUPER_SIMPLE: "SUPERSIMPLE mode on"}
SIMPLE_CHANGED = Event(31, MavSeverity.INFO, _TEXTS)


@law
def begin(simple: SimpleState, yaw: float) -> None:
    """On arming: forwards is where the nose points [rad]."""
    simple.heading = yaw
    simple.heading_from_home = yaw


@law
def choose(v: Vehicle, number: int) -> None:
    """OFF, SIMPLE or SUPER_SIMPLE from now on."""
    ap = v.autopilot
    if ap.modes.simple.number != number:
        ap.modes.simple.number = number
        emit(ap.events, v.time_us, SIMPLE_CHANGED, float(number), 0.0)


@law
def of_position(position: int, params: Parameters) -> int:
    """What SIMPLE and SUPER_SIMPLE say of position 0 .. 5 of the mode switch."""
    bit = 1 << position
    if int(params.SUPER_SIMPLE) & bit != 0:
        return SUPER_SIMPLE
    return SIMPLE if int(params.SIMPLE) & bit != 0 else OFF


@law
def follow_mode_switch(v: Vehicle, position: int) -> None:
    """The mode of ``position`` 0 .. 5 was entered; a switch of SIMPLE takes precedence."""
    p = v.autopilot.params
    if not has_function(p, SIMPLE_FUNCTION, SUPER_SIMPLE_FUNCTION):
        choose(v, of_position(position, p))


@law
def look_from_home(simple: SimpleState, pos: Vec3, home: Vec3) -> None:
    """Away from home is forwards in SUPER_SIMPLE; both NED [m]."""
    away = horizontal(pos) - horizontal(home)
    if norm2(away) > HOME_RADIUS:
        simple.heading_from_home = atan2(away.y, away.x)


@law
def turn_sticks(pilot: PilotState, simple: SimpleState, yaw: float) -> None:
    """Roll and pitch sticks, as if the nose pointed elsewhere than at ``yaw`` [rad]."""
    if simple.number == OFF:
        return
    forwards = simple.heading_from_home if simple.number == SUPER_SIMPLE else simple.heading
    stick = turned(Vec2(-pilot.pitch, pilot.roll), forwards - yaw)
    pilot.pitch = -stick.x
    pilot.roll = stick.y
