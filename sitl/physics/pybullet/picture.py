# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a vehicle in its world by Bullet's software renderer: no window, no graphics card.

They are taken in a world of Bullet of their own, of visual shapes alone, so that looking changes nothing.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...worlds import World
from ...worlds.raycast import scan
from ...worlds.shapes import Box, Marking, Solid
from .client import Client
from .urdf import Colour
from .worlds import NED_SIGNS, attitude, half_size

TILE = 1.0
"""Side of the floor's tiles [m]."""
_TILES = 24
"""Rows and columns of tiles about the vehicle: the floor ends beyond."""
_LIGHT: Colour = (0.78, 0.78, 0.76, 1.0)
_DARK: Colour = (0.66, 0.67, 0.66, 1.0)
_WALL: Colour = (0.72, 0.56, 0.40, 1.0)
_PILLAR: Colour = (0.45, 0.55, 0.65, 1.0)
_PAINT: Colour = (0.35, 0.35, 0.38, 1.0)
_FIELD_OF_VIEW = 60.0
"""Of the picture's height [deg]."""
_NEAR, _FAR = 0.02, 60.0
"""What is drawn [m]."""
_SUN = (-0.4, 0.5, 1.0)
Floats = np.ndarray[Any, Any]


class Camera(NamedTuple):
    """Where a picture is taken from."""

    eye: tuple[float, float, float]
    """x, y, z in the world's frame [m]."""
    target: tuple[float, float, float]
    """What is in its middle [m]."""


class Picture:
    """Takes pictures of one vehicle.

    Args:
        vehicle: puts the vehicle's model, with what is to be seen of it, into a world of Bullet; returns its number.
        world: what is around it; None: a floor.
        floor: height of the floor in the world's frame [m].
        reach: size of the vehicle [m]; the chase view keeps a few times that away.
    """

    def __init__(self, vehicle: Callable[[Client], int], world: World | None, floor: float, reach: float) -> None:
        self._client = client = Client(0.01)
        self._world, self._floor, self._reach = world, floor, reach
        if world is not None:
            for solid in world.solids:
                self._solid(solid)
            for marking in world.markings:
                self._marking(marking)
        self._tiles = [self._tile(0, _LIGHT), self._tile(1, _DARK)]
        self._vehicle = vehicle(client)

    def render(
        self,
        position: Sequence[float],
        attitude: Sequence[float],
        width: int,
        height: int,
        camera: Camera | None = None,
        joints: Mapping[int, float] | None = None,
    ) -> Floats:
        """A picture, uint8, shape (height, width, 3): red, green, blue.

        Args:
            position: of the vehicle in Bullet's frame [m].
            attitude: Bullet's quaternion (x, y, z, w).
            width, height: [pixels].
            camera: None: from behind and above, along the vehicle's heading.
            joints: number of a joint -> its angle or length [rad, m].
        """
        p, id_ = self._client.p, self._client.id
        p.resetBasePositionAndOrientation(self._vehicle, position, attitude, physicsClientId=id_)
        for joint, value in (joints or {}).items():
            p.resetJointState(self._vehicle, joint, value, physicsClientId=id_)
        # An even number of tiles on, so that the pattern stays where it is.
        centre = [2.0 * TILE * math.floor(position[k] / (2.0 * TILE) + 0.5) for k in range(2)]
        for tiles in self._tiles:
            p.resetBasePositionAndOrientation(tiles, (*centre, self._floor), (0.0, 0.0, 0.0, 1.0), physicsClientId=id_)
        view = camera or self._chase(position, attitude)
        _, _, pixels, _, _ = p.getCameraImage(
            width,
            height,
            viewMatrix=p.computeViewMatrix(view.eye, view.target, (0.0, 0.0, 1.0)),
            projectionMatrix=p.computeProjectionMatrixFOV(_FIELD_OF_VIEW, width / height, _NEAR, _FAR),
            lightDirection=_SUN,
            shadow=0,
            flags=p.ER_NO_SEGMENTATION_MASK,
            renderer=p.ER_TINY_RENDERER,
            physicsClientId=id_,
        )
        return np.ascontiguousarray(np.reshape(np.asarray(pixels, np.uint8), (height, width, 4))[:, :, :3])

    def close(self) -> None:
        """Give its world up."""
        self._client.close()

    def _chase(self, position: Sequence[float], attitude: Sequence[float]) -> Camera:
        x, y, z, w = attitude
        heading = math.atan2(2.0 * (x * y + w * z), 1.0 - 2.0 * (y * y + z * z))
        back = np.array([-math.cos(heading), -math.sin(heading), 0.5])
        away = min(5.0 * self._reach, self._view_back(position, back))
        x, y, z = position[0] + away * back[0], position[1] + away * back[1], position[2] + away * back[2]
        return Camera((float(x), float(y), float(z)), (position[0], position[1], position[2]))

    def _view_back(self, position: Sequence[float], back: Floats) -> float:
        """How far the camera can go back before something comes between, in lengths of ``back``."""
        if self._world is None:
            return math.inf
        length = float(np.linalg.norm(back))
        rays = np.ascontiguousarray((NED_SIGNS * back / length)[:, None])
        met = scan(self._world.geometry, NED_SIGNS * np.array(position), rays, np.empty(1))
        return max(0.9 * float(met[0]) / length, 1.5 * self._reach)

    # ------------------------------------------------------------------ what is to be seen

    def _seen(self, shape: int, position: Sequence[float], turn: Sequence[float] = (0.0, 0.0, 0.0, 1.0)) -> int:
        body: int = self._client.p.createMultiBody(
            0.0, -1, shape, basePosition=position, baseOrientation=turn, physicsClientId=self._client.id
        )
        return body

    def _solid(self, solid: Solid) -> None:
        p, id_ = self._client.p, self._client.id
        if isinstance(solid, Box):
            shape = p.createVisualShape(p.GEOM_BOX, halfExtents=half_size(solid), rgbaColor=_WALL, physicsClientId=id_)
        else:
            shape = p.createVisualShape(
                p.GEOM_CYLINDER, radius=solid.radius, length=solid.height, rgbaColor=_PILLAR, physicsClientId=id_
            )
        self._seen(shape, solid.centre, attitude(solid))

    def _marking(self, marking: Marking) -> None:
        p, id_ = self._client.p, self._client.id
        half = 0.5 * marking.yaw
        if marking.radius > 0.0:
            shape = p.createVisualShape(
                p.GEOM_CYLINDER, radius=marking.radius, length=0.004, rgbaColor=_PAINT, physicsClientId=id_
            )
        else:
            extents = (0.5 * marking.size[0], 0.5 * marking.size[1], 0.002)
            shape = p.createVisualShape(p.GEOM_BOX, halfExtents=extents, rgbaColor=_PAINT, physicsClientId=id_)
        self._seen(shape, (*marking.centre, self._floor), (0.0, 0.0, math.sin(half), math.cos(half)))

    def _tile(self, odd: int, colour: Colour) -> int:
        """Every second tile of the floor as one mesh."""
        p, low = self._client.p, -0.5 * _TILES * TILE
        corners: list[list[float]] = []
        indices: list[int] = []
        for row in range(_TILES):
            for column in range((row + odd) % 2, _TILES, 2):
                x, y, first = low + TILE * row, low + TILE * column, len(corners)
                corners += [[x, y, 0.0], [x + TILE, y, 0.0], [x + TILE, y + TILE, 0.0], [x, y + TILE, 0.0]]
                indices += [first, first + 1, first + 2, first, first + 2, first + 3]
        shape = p.createVisualShape(
            p.GEOM_MESH,
            vertices=corners,
            indices=indices,
            normals=[[0.0, 0.0, 1.0]] * len(corners),
            rgbaColor=colour,
            physicsClientId=self._client.id,
        )
        return self._seen(shape, (0.0, 0.0, self._floor))
