# SPDX-License-Identifier: BSD-3-Clause
"""LOITER: stops and stays; drives back when it has drifted further than LOIT_RADIUS (LOIT_TYPE, LOIT_SPEED_GAIN)."""

from __future__ import annotations

import math

from ....core.algebra import horizontal, norm2
from ....core.elementary import atan2
from ....core.kernels import law
from ....core.scalars import constrain, wrap_pi
from ....core.vectors import Vec2
from ...modes import ModeResult
from ..control import speed
from ..control.forward_speed import sense
from ..navigation import waypoint
from ..parameters import Parameters
from ..state import Vehicle
from . import drive
from .mode import POSITION_TO_HOLD, Destination, RoverMode
from .state import LoiterState, Modes

LOITER = 5

EITHER_DIRECTION, FORWARDS, BACKWARDS = 0, 1, 2
"""LOIT_TYPE"""


@law
def start(v: Vehicle) -> int:
    """Enter; needs an origin."""
    ap = v.autopilot
    if not ap.estimate.origin_set:
        return ModeResult.INIT_FAILED
    loiter = ap.modes.loiter
    loiter.hold_pos = waypoint.stopping_point(ap.estimate, ap.params.ATC)
    sense(ap.control.speed, ap.estimate, v.sensors, v.time_us)
    loiter.speed = ap.control.speed.forward
    loiter.heading = ap.estimate.yaw
    loiter.distance = 0.0
    return ModeResult.ACCEPTED


@law
def aim(loiter: LoiterState, pos: Vec2, yaw: float, params: Parameters) -> None:
    """Heading and speed back to the position for a vehicle at ``pos`` [m], from beyond LOIT_RADIUS."""
    p = params.LOIT
    wanted = min((loiter.distance - p.RADIUS) * p.SPEED_GAIN, params.WP.SPEED)
    offset = loiter.hold_pos - pos
    heading = atan2(offset.y, offset.x)
    error = wrap_pi(heading - yaw)
    behind = abs(error) > 0.5 * math.pi
    if p.TYPE == BACKWARDS or (behind and p.TYPE == EITHER_DIRECTION):
        heading = wrap_pi(heading + math.pi)
        error = wrap_pi(heading - yaw)
        wanted = -wanted
    loiter.heading = heading
    # slower while it still has to turn: half the speed at a right angle
    loiter.speed = wanted * (1.0 - 0.5 * constrain(abs(error) / (0.5 * math.pi), 0.0, 1.0))


@law
def run(v: Vehicle) -> None:
    """One period."""
    ap = v.autopilot
    loiter = ap.modes.loiter
    pos = horizontal(ap.estimate.pos)
    loiter.distance = norm2(loiter.hold_pos - pos)
    if loiter.distance <= ap.params.LOIT.RADIUS:
        loiter.speed = speed.accel_limited(ap.control, 0.0, ap.params.ATC)
    else:
        aim(loiter, pos, ap.estimate.yaw, ap.params)
    drive.turn_to(ap.control, ap.estimate, ap.modes.pilot, loiter.heading, ap.params)
    drive.at_speed(v, loiter.speed)


@law
def destination(modes: Modes) -> Destination:
    """The position to stay at."""
    return Destination(POSITION_TO_HOLD, modes.loiter.hold_pos)


MODE = RoverMode(
    number=LOITER, name="LOITER", start=start, run=run, needs_position=True, autonomous=True, destination=destination
)
