# SPDX-License-Identifier: BSD-3-Clause
"""One tick of a Turtlebot: command to wheels, wheels to motion, walls.

As in the original's simulation, wheels take a commanded speed at once (the motors are far stronger than 5 kg at 0.3 m/s
asks for), the tyres do not slip, and the base stands level.
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....worlds.contact import nearest_of
from .state import TICK_S, TICK_US

_TWO_PI = 2.0 * math.pi


@law
def wheel_speeds(f, forward, turn):
    """Speeds over ground (left, right) [m/s] for a forward speed [m/s] and a turn rate [rad/s], counter-clockwise.

    Each wheel is limited on its own. The drive assumes one radius; the true ones differ.
    """
    half = 0.5 * float(f.wheel_separation) * turn
    limit = float(f.wheel_speed_max)
    left = min(max(forward - half, -limit), limit)
    right = min(max(forward + half, -limit), limit)
    scale = 1.0 / float(f.wheel_radius)
    return (left * float(f.wheel_radius_left) * scale, right * float(f.wheel_radius_right) * scale)


@law
def free_distance(v, solids, n, e):
    """Distance [m] from the robot's cylinder, were its axis at (n, e), to the nearest solid; negative inside of one."""
    f, floor = v.figures, float(v.body.down)
    nearest = nearest_of(solids, solids.shape[0], n, e, floor - float(f.top), floor - float(f.bottom), float(f.radius))
    return nearest[0]


@law
def step(v, solids):
    """Move on by ``TICK_US``. A move that would bring the robot into a solid does not happen; it still turns.

    Args:
        v: one record.
        solids: rows of a world's ``Geometry``.
    """
    b, c = v.body, v.command
    left, right = 0.0, 0.0
    if 1e-6 * (int(v.time_us) - int(c.time_us)) < float(v.figures.command_timeout):
        left, right = wheel_speeds(v.figures, float(c.forward), float(c.turn))
    speed, yaw_rate = 0.5 * (left + right), (left - right) / float(v.figures.wheel_separation)
    turned = yaw_rate * TICK_S
    heading = float(b.heading) + turned
    if speed != 0.0:
        middle = heading - 0.5 * turned
        travel = speed * TICK_S
        n, e = float(b.north) + travel * math.cos(middle), float(b.east) + travel * math.sin(middle)
        free = float(b.clearance) - abs(travel)
        if free < 0.0:
            free = free_distance(v, solids, n, e)
        if free < 0.0 and free < free_distance(v, solids, float(b.north), float(b.east)):
            b.collided = 1
            speed = 0.0
        else:
            b.north, b.east, b.clearance = n, e, free
    if heading > math.pi:
        heading -= _TWO_PI
    elif heading < -math.pi:
        heading += _TWO_PI
    b.heading, b.speed, b.yaw_rate = heading, speed, yaw_rate
    v.time_us += TICK_US
