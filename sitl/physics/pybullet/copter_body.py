# SPDX-License-Identifier: BSD-3-Clause
"""A copter's model in a world of Bullet of its own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...core.constants import TICK_S
from ...worlds import World
from . import client, urdf
from .client import Client
from .copter_model import CopterModel, model, sag
from .worlds import BODY_GROUP, FLOOR_GROUP, SOLID_GROUP, Surfaces, build

BODY, LEGS, ALL = -1, 0, -2
"""Links: the one with mass and rigid outline, the one with the feet; all of them."""
_ITERATIONS, _RESIDUAL = 20, 1e-12
"""With Bullet's own residual a standing copter creeps by some micrometres a second."""
_REST_STEPS = 400
"""In which a copter that is put down comes to rest."""
_NOWHERE = (0.0, 0.0, 0.0)


class CopterBody:
    """The model of a copter, among floor and solids.

    Args:
        airframe: properties, as its record has them (``physics.airframe``).
        world: what is around it; None: a floor.
        floor: height of the floor in the world's frame [m].

    Raises:
        MissingExtra: pybullet is not installed.
    """

    def __init__(self, airframe: Any, world: World | None, floor: float) -> None:
        self.substeps = max(int(airframe.substeps), 1)
        """Steps of Bullet in a tick."""
        self.step_s = TICK_S / self.substeps
        self.has_hard_feet = sag(float(airframe.leg_time_constant)) == 0.0
        self.model: CopterModel = model(airframe)
        self.client = Client(self.step_s, _ITERATIONS, _RESIDUAL)
        p, id_ = self.client.p, self.client.id
        self.surfaces: Surfaces = build(self.client, world, floor)
        self.number = urdf.load(self.client, self.model.text, p.URDF_IGNORE_VISUAL_SHAPES)
        """Of Bullet."""
        p.changeDynamics(self.number, BODY, localInertiaDiagonal=self.model.inertia, physicsClientId=id_)
        for link in (BODY, LEGS):
            p.changeDynamics(self.number, link, linearDamping=0.0, angularDamping=0.0, physicsClientId=id_)
        self._as_built: int = p.saveState(id_)
        self.zero = floor + self._resting_height(sag(float(airframe.leg_time_constant)))
        """Height of the centre of mass in the world's frame at which the record's position is 0 [m]."""
        self._meet(FLOOR_GROUP | SOLID_GROUP)

    def put(self, position: Sequence[float], attitude: Sequence[float]) -> None:
        """Everything as it was built, but the body at a pose, at rest; in Bullet's frame."""
        p, id_ = self.client.p, self.client.id
        p.restoreState(self._as_built, physicsClientId=id_)
        client.forget(self.client, self.number)
        p.resetBasePositionAndOrientation(self.number, position, attitude, physicsClientId=id_)
        p.resetBaseVelocity(self.number, _NOWHERE, _NOWHERE, physicsClientId=id_)

    def keeps_contacts(self) -> bool:
        """Whether Bullet keeps contact points of it, with or without force."""
        return bool(self.client.p.getContactPoints(self.number, physicsClientId=self.client.id))

    def close(self) -> None:
        """Give the world up."""
        self.client.close()

    def _meet(self, groups: int) -> None:
        """Touch what is in these groups, and nothing else."""
        p, id_ = self.client.p, self.client.id
        for link in (BODY, LEGS):
            p.setCollisionFilterGroupMask(self.number, link, BODY_GROUP, groups, physicsClientId=id_)

    def _resting_height(self, pressed: float) -> float:
        """Height of the centre of mass over the floor when it stands [m]: put down where the legs should be pressed in
        by so much [m], and left alone."""
        floor = self.surfaces.height
        self._meet(FLOOR_GROUP)
        self.put((0.0, 0.0, floor + self.model.height - pressed), (0.0, 0.0, 0.0, 1.0))
        for _ in range(_REST_STEPS * self.substeps):
            self.client.step()
        (_, _, z), _ = self.client.p.getBasePositionAndOrientation(self.number, self.client.id)
        return float(z) - floor
