# SPDX-License-Identifier: BSD-3-Clause
"""One tick of a Turtlebot: command to wheels, wheels to motion, walls.

As in the original's simulation, wheels take a commanded speed at once (the motors are far stronger than 5 kg at 0.3 m/s
asks for), the tyres do not slip, and the base stands level.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.array_kernels import Table
from ....core.elementary import sincos
from ....core.kernels import inlined, law
from ....core.scalars import TWO_PI
from ....core.vectors import Vec2
from ....vehicles.turtlebot import Properties
from ....worlds.contact import Volume, nearest_of
from .state import TICK_S, Body, Command


class WheelSpeeds(NamedTuple):
    """Speeds over ground of the wheels."""

    left: float
    """[m/s]"""
    right: float
    """[m/s]"""


@inlined
def wheel_speeds(f: Properties, forward: float, turn: float) -> WheelSpeeds:
    """What the wheels do for a forward speed [m/s] and a turn rate [rad/s], counter-clockwise.

    Each wheel is limited on its own. The drive assumes one radius; the true ones differ.
    """
    half, limit = 0.5 * f.wheel_separation * turn, f.wheel_speed_max
    left = min(max(forward - half, -limit), limit)
    right = min(max(forward + half, -limit), limit)
    scale = 1.0 / f.wheel_radius
    return WheelSpeeds(left * f.wheel_radius_left * scale, right * f.wheel_radius_right * scale)


@law
def free_distance(f: Properties, floor: float, solids: Table, position: Vec2) -> float:
    """Distance [m] from the robot's cylinder, were its axis at a position (north, east [m]) of a floor (down [m]), to
    the nearest solid; negative inside of one.
    """
    return nearest_of(solids, solids.shape[0], Volume(position, floor - f.top, floor - f.bottom, f.radius)).distance


@inlined
def commanded(f: Properties, c: Command, time_us: int) -> WheelSpeeds:
    """What the wheels do now: a command holds until its time-out."""
    if 1e-6 * (time_us - c.time_us) < f.command_timeout:
        return wheel_speeds(f, c.forward, c.turn)
    return WheelSpeeds(0.0, 0.0)


@inlined
def move(b: Body, f: Properties, wheels: WheelSpeeds, solids: Table) -> None:
    """Move on by ``TICK_US``. A move that would bring the robot into a solid does not happen; it still turns.

    ``solids``: rows of a world's ``Geometry``.
    """
    speed, yaw_rate = 0.5 * (wheels.left + wheels.right), (wheels.left - wheels.right) / f.wheel_separation
    turned = yaw_rate * TICK_S
    heading = b.heading + turned
    if speed != 0.0:
        middle = heading - 0.5 * turned
        travel = speed * TICK_S
        sine, cosine = sincos(middle)
        n, e = b.north + travel * cosine, b.east + travel * sine
        free = b.clearance - abs(travel)
        if free < 0.0:
            free = free_distance(f, b.down, solids, Vec2(n, e))
        if free < 0.0 and free < free_distance(f, b.down, solids, Vec2(b.north, b.east)):
            b.collided = True
            speed = 0.0
        else:
            b.north, b.east, b.clearance = n, e, free
    if heading > math.pi:
        heading -= TWO_PI
    elif heading < -math.pi:
        heading += TWO_PI
    b.heading, b.speed, b.yaw_rate = heading, speed, yaw_rate
