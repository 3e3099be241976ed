# SPDX-License-Identifier: BSD-3-Clause
"""A world's floor and solids as Bullet's collision shapes.

Bullet's frame is that of the world's file, so that nothing is turned. The floor is a plane without an edge. Solids that
follow each other in the file share a body: Bullet looks at each body in each step, but finds its way in a compound.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...worlds import World
from ...worlds.shapes import Box, Solid
from .client import Client

SHAPES_EACH = 16
"""Most shapes of a compound that pybullet takes."""
SOLID_FRICTION = 1.0
"""Coulomb coefficient of solids; in a contact the coefficients of both sides are multiplied."""
RAY_GROUP, FLOOR_GROUP, SOLID_GROUP, BODY_GROUP = 1, 2, 4, 8
"""Collision groups (bits): what a ray or a body may leave out. That of rays is Bullet's."""


@dataclass(frozen=True)
class Surfaces:
    """What a vehicle can run into."""

    floor: int
    """Bullet's number of the floor."""
    solids: frozenset[int]
    """Bullet's numbers of the bodies that are made of solids."""
    height: float
    """Of the floor in the world's frame, which is Bullet's [m]."""


def build(client: Client, world: World | None, floor: float = 0.0) -> Surfaces:
    """Put the floor and a world's solids in.

    Args:
        client: an empty world of Bullet.
        world: None: a floor and nothing else, of friction 1.
        floor: height of the floor in the world's frame [m].
    """
    p, id_ = client.p, client.id
    plane = p.createCollisionShape(p.GEOM_PLANE, planeNormal=(0.0, 0.0, 1.0), physicsClientId=id_)
    friction = 1.0 if world is None else world.friction
    ground = _fixed(client, plane, FLOOR_GROUP, friction, (0.0, 0.0, floor))
    solids = () if world is None else world.solids
    parts = [solids[k : k + SHAPES_EACH] for k in range(0, len(solids), SHAPES_EACH)]
    bodies = [_fixed(client, _compound(client, part), SOLID_GROUP, SOLID_FRICTION) for part in parts]
    return Surfaces(ground, frozenset(bodies), floor)


def _compound(client: Client, solids: tuple[Solid, ...]) -> int:
    p = client.p
    is_box = [isinstance(solid, Box) for solid in solids]
    shape: int = p.createCollisionShapeArray(
        shapeTypes=[p.GEOM_BOX if box else p.GEOM_CYLINDER for box in is_box],
        halfExtents=[half_size(s) for s in solids],
        radii=[0.0 if isinstance(s, Box) else s.radius for s in solids],
        lengths=[0.0 if isinstance(s, Box) else s.height for s in solids],
        collisionFramePositions=[s.centre for s in solids],
        collisionFrameOrientations=[attitude(s) for s in solids],
        physicsClientId=client.id,
    )
    return shape


def half_size(solid: Solid) -> tuple[float, float, float]:
    """Half the lengths of a box [m]; zeros of a cylinder."""
    if not isinstance(solid, Box):
        return (0.0, 0.0, 0.0)
    x, y, z = solid.size
    return (0.5 * x, 0.5 * y, 0.5 * z)


def attitude(solid: Solid) -> tuple[float, float, float, float]:
    """Bullet's quaternion (x, y, z, w) of a solid."""
    half = 0.5 * solid.yaw if isinstance(solid, Box) else 0.0
    return (0.0, 0.0, math.sin(half), math.cos(half))


def _fixed(
    client: Client, shape: int, group: int, friction: float, position: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> int:
    p, id_ = client.p, client.id
    body: int = p.createMultiBody(
        0.0, shape, basePosition=position, useMaximalCoordinates=1, physicsClientId=id_
    )  # maximal coordinates: a plain rigid body, which costs a step less
    p.changeDynamics(body, -1, lateralFriction=friction, restitution=0.0, physicsClientId=id_)
    p.setCollisionFilterGroupMask(body, -1, group, RAY_GROUP | BODY_GROUP, physicsClientId=id_)
    return body


Array = np.ndarray[Any, Any]
NED_SIGNS = np.array([1.0, -1.0, -1.0])
"""From NED to Bullet's x, y, z, and back."""


def cast(client: Client, origin: Array, directions: Array, ranges: Array, reach: float) -> None:
    """See ``sitl.physics.engine.Engine.cast``."""
    start = np.repeat((NED_SIGNS * origin)[None, :], ranges.shape[0], axis=0)
    ends = start + reach * (NED_SIGNS[:, None] * directions).T
    met = client.p.rayTestBatch(start, ends, collisionFilterMask=FLOOR_GROUP | SOLID_GROUP, physicsClientId=client.id)
    for k, (body, _, share, _, _) in enumerate(met):
        ranges[k] = share * reach if body >= 0 else np.inf
