# SPDX-License-Identifier: BSD-3-Clause
"""Rays cast by Bullet at floor and solids."""

from __future__ import annotations

from typing import Any

import numpy as np

from .client import Client
from .worlds import FLOOR_GROUP, SOLID_GROUP

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
