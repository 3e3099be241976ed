# SPDX-License-Identifier: BSD-3-Clause
"""A Turtlebot as a multibody of Bullet: a base that stands on two driven wheels and two casters.

Wheels and casters are spheres, which meet the floor in one exact point; wheels are sprung, casters slide without
friction and are stiff, so that it does not nod. Solids meet the upright cylinder of the airframe. Properties that only
Bullet needs stand here, those of the robot in ``sitl.vehicles.turtlebot``.

Sources: [model] kobuki.urdf.xacro, kobuki_gazebo.urdf.xacro of erlerobot/gym-gazebo; [estimate] this project's.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...core.constants import GRAVITY
from .client import Client
from .wheels import ALONG_Y, Parts, meet, touch_in_one_point
from .worlds import FLOOR_GROUP, SOLID_GROUP

MASS = 5.0
"""With plates and lidar [kg] [estimate]."""
CENTRE_HEIGHT = 0.10
"""Of the centre of mass: battery and motors are at the bottom [m] [estimate]."""
WHEEL_MASS = 0.1
"""[kg] [estimate]."""
ROTOR = 0.25
"""Inertia of both geared motors, as it appears at the rims, by the robot's mass [estimate]."""
TORQUE = 1.0
"""Of each motor at its wheel [N m] [model]."""
CASTER_OFFSET = 0.115
"""Ahead and behind the axle [m] [model]."""
CASTER_RADIUS = 0.0176
"""[m] [model]."""
CASTER_LOAD = 0.1
"""Share of the weight on each [estimate]."""
SAG = 0.1
"""By which the weight presses the wheels' springs together, by wheel radius [estimate]."""
STIFFER = 10.0
"""A caster against a spring of its load and the wheels' sag [estimate]."""
FASTEST = 1e4
"""Of a joint [rad/s]; Bullet's own limit is lower."""


@dataclass(frozen=True)
class TurtlebotModel:
    """The robot in Bullet."""

    body: int
    """Bullet's number of it."""
    height: float
    """Of the base's centre of mass over the floor [m]."""
    wheels: tuple[int, int]
    """Joints of the left and the right wheel."""


def build(client: Client, airframe: Any, floor: float) -> TurtlebotModel:
    """Put a Turtlebot into a world of Bullet, at its origin, nose to x, at rest on its springs.

    Args:
        client: the world.
        airframe: its properties, in a record.
        floor: its height in Bullet's frame [m].
    """
    p, id_, f, height = client.p, client.id, airframe, CENTRE_HEIGHT
    sag, half = SAG * float(f.wheel_radius), 0.5 * float(f.wheel_separation)
    parts, links = Parts(p), []
    for radius, side in ((float(f.wheel_radius_left), half), (float(f.wheel_radius_right), -half)):
        shape = p.createCollisionShape(p.GEOM_SPHERE, radius=radius, physicsClientId=id_)
        seen = p.createVisualShape(
            p.GEOM_CYLINDER, radius=radius - sag, length=0.02, rgbaColor=(0.1, 0.1, 0.1, 1.0), physicsClientId=id_
        )
        position = (0.0, side, radius - sag - height)
        links.append((parts.add(WHEEL_MASS, shape, seen, position, 0, ALONG_Y) - 1, radius, 0.5 - CASTER_LOAD, 1.0))
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=CASTER_RADIUS, physicsClientId=id_)
    for ahead in (CASTER_OFFSET, -CASTER_OFFSET):
        position = (ahead, 0.0, CASTER_RADIUS - sag / STIFFER - height)
        number = parts.add(0.5 * WHEEL_MASS, shape, -1, position, 0, turns=False) - 1
        links.append((number, CASTER_RADIUS, CASTER_LOAD, STIFFER))
    mass = MASS - 3.0 * WHEEL_MASS
    top, bottom, wide = float(f.top), float(f.bottom), float(f.radius)
    outline = {"physicsClientId": id_, "radius": wide}
    middle = (0.0, 0.0, 0.5 * (top + bottom) - height)
    body: int = p.createMultiBody(
        mass,
        p.createCollisionShape(
            p.GEOM_CYLINDER, height=max(top - bottom, 1e-3), collisionFramePosition=middle, **outline
        ),
        p.createVisualShape(
            p.GEOM_CYLINDER,
            length=max(top - bottom, 1e-3),
            visualFramePosition=middle,
            rgbaColor=(0.2, 0.2, 0.25, 1.0),
            **outline,
        ),
        basePosition=(0.0, 0.0, floor + height),
        **parts.arguments(),
        physicsClientId=id_,
    )
    flat = mass * (0.25 * wide * wide + (top - bottom) ** 2 / 12.0)
    still = {"restitution": 0.0, "linearDamping": 0.0, "angularDamping": 0.0, "physicsClientId": id_}
    p.changeDynamics(
        body, -1, localInertiaDiagonal=(flat, flat, 0.5 * mass * wide * wide), lateralFriction=0.0, **still
    )
    meet(client, body, -1, SOLID_GROUP)
    for link, radius, load, stiffer in links:
        disc = 0.25 * WHEEL_MASS * radius * radius
        spin = 0.5 * ROTOR * MASS * radius * radius
        stiffness = stiffer * load * MASS * GRAVITY / sag
        p.changeDynamics(body, link, maxJointVelocity=FASTEST, physicsClientId=id_)  # first: it upsets other settings
        p.changeDynamics(
            body,
            link,
            localInertiaDiagonal=(disc, disc, spin),
            lateralFriction=1.0 if stiffer == 1.0 else 0.0,
            contactStiffness=stiffness,
            contactDamping=2.0 * (stiffness * load * MASS) ** 0.5,
            jointDamping=0.0,
            **still,
        )
        meet(client, body, link, FLOOR_GROUP)
    touch_in_one_point(client)
    return TurtlebotModel(body, height, (links[0][0], links[1][0]))
