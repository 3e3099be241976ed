# SPDX-License-Identifier: BSD-3-Clause
"""What vehicles on wheels have in common in Bullet: links, what they touch, contacts that roll."""

from __future__ import annotations

import math
from typing import Any

from .client import Client
from .worlds import BODY_GROUP

ALONG_Y = (-math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))
"""Attitude of a wheel: its own z, which it turns about, is the body's y; forward is positive."""
UPRIGHT = (0.0, 0.0, 0.0, 1.0)
_BOTH = 0


class Parts:
    """Links of a multibody in the lists that pybullet takes."""

    def __init__(self, p: Any) -> None:
        self.p = p
        self.rows: list[tuple[Any, ...]] = []

    def add(
        self, mass: float, shape: int, visual: int, at: Any, parent: int, attitude: Any = UPRIGHT, turns: bool = True
    ) -> int:
        """A link on a hinge about its z, or fixed; returns its number as a parent."""
        joint = self.p.JOINT_REVOLUTE if turns else self.p.JOINT_FIXED
        self.rows.append((mass, shape, visual, at, attitude, parent, joint))
        return len(self.rows)

    def arguments(self) -> dict[str, Any]:
        """Of createMultiBody."""
        names = (
            "Masses",
            "CollisionShapeIndices",
            "VisualShapeIndices",
            "Positions",
            "Orientations",
            "ParentIndices",
            "JointTypes",
        )
        out: dict[str, Any] = {f"link{name}": [row[k] for row in self.rows] for k, name in enumerate(names)}
        count = len(self.rows)
        out["linkInertialFramePositions"] = [(0.0, 0.0, 0.0)] * count
        out["linkInertialFrameOrientations"] = [(0.0, 0.0, 0.0, 1.0)] * count
        out["linkJointAxis"] = [(0.0, 0.0, 1.0)] * count
        return out


def filter_by_both(client: Client) -> None:
    """Bodies meet when each one's mask has the other's group; as Bullet comes, one of them is enough."""
    client.p.setPhysicsEngineParameter(collisionFilterMode=_BOTH, physicsClientId=client.id)


def meet(client: Client, body: int, link: int, groups: int) -> None:
    """Let a link touch what is in these groups, and nothing else."""
    client.p.setCollisionFilterGroupMask(body, link, BODY_GROUP, groups, physicsClientId=client.id)


def touch_in_one_point(client: Client) -> None:
    """Make the contacts of wheels and floor so that a new contact point takes the last one's place.

    Bullet keeps a few points of a contact until they have moved apart by a share of the smaller shape. Those of a wheel
    that rolls hardly do: old ones would go on to carry load, as if the wheel had a flat. The share is one for the whole
    process, and counts when a contact is made, which for a wheel and the endless floor is once.
    """
    p, id_ = client.p, client.id
    p.setPhysicsEngineParameter(contactBreakingThreshold=1.0, physicsClientId=id_)
    p.performCollisionDetection(physicsClientId=id_)
    p.setPhysicsEngineParameter(contactBreakingThreshold=0.02, physicsClientId=id_)  # Bullet's own
