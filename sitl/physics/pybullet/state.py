# SPDX-License-Identifier: BSD-3-Clause
"""The whole state of a world of Bullet as bytes.

Poses and velocities are not all of it: Bullet keeps contact points and what the solver pushed with, and it turns the
quaternion that it is given into a matrix and back. Its own file has everything, in double precision; but what reading
it makes of contacts depends on those that the world has at that time. So ``forget`` comes before ``load``; and a world
that was saved with something near has to forget and load, too, to go on as those do that load it.
"""

from __future__ import annotations

import os
import tempfile
import zlib

from ..engine import EngineError
from .client import Client, silence

_FAR_AWAY = (0.0, 0.0, 1e5)
"""From all solids [m]."""
_PASSES = 20
"""Of collision detection, after which pairs that came apart are gone: a pass looks at some of them only."""


def forget(client: Client, body: int) -> None:
    """Let Bullet forget all contacts of a body, as if its world had just been built: it is far away for a while."""
    p, id_ = client.p, client.id
    p.resetBasePositionAndOrientation(body, _FAR_AWAY, (0.0, 0.0, 0.0, 1.0), physicsClientId=id_)
    for _ in range(_PASSES):
        p.performCollisionDetection(id_)


def save(client: Client) -> bytes:
    """The state of a world."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "state.bullet")
        client.p.saveBullet(path, client.id)
        with open(path, "rb") as file:
            return zlib.compress(file.read(), 1)


def load(client: Client, state: bytes) -> None:
    """Put a world back.

    Raises:
        EngineError: the state is not one of a world with these bodies.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "state.bullet")
        try:
            with open(path, "wb") as file:
                file.write(zlib.decompress(state))
            with silence():
                client.p.restoreState(fileName=path, physicsClientId=client.id)
        except (zlib.error, client.p.error):
            raise EngineError(
                "this snapshot is not of a vehicle and world like this one in pybullet; restore it where it was taken"
            ) from None
