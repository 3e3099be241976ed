# SPDX-License-Identifier: BSD-3-Clause
"""The whole state of a world of Bullet as bytes.

Poses and velocities are not all of it: Bullet keeps contact points and what the solver pushed with, and it turns the
quaternion that it is given into a matrix and back. Its own file has everything, in double precision; but what reading
it makes of contacts depends on those that the world has at that time. So ``load`` makes it forget them first; and a
world that was saved with something near has to load, too, to go on as those do that load it. The same goes for a
vehicle that is put back to power-on.
"""

from __future__ import annotations

import os
import tempfile
import zlib

from ..engine import EngineError
from .client import Client, silence

_FAR = 1e5
"""Away from all solids [m]."""
_PASSES = 20
"""Of collision detection, after which pairs that came apart are gone: a pass looks at some of them only."""


def forget(client: Client, body: int, height: float = _FAR) -> None:
    """Let Bullet forget all contacts of a body, as if its world had just been built: it is far away for a while.

    Args:
        client: the world.
        body: Bullet's number of it.
        height: at which it is while away [m]: one that has to keep its contact with the floor stays on it.
    """
    p, id_ = client.p, client.id
    p.resetBasePositionAndOrientation(body, (_FAR, _FAR, height), (0.0, 0.0, 0.0, 1.0), physicsClientId=id_)
    for _ in range(_PASSES):
        p.performCollisionDetection(id_)


def save(client: Client) -> bytes:
    """The state of a world."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "state.bullet")
        client.p.saveBullet(path, client.id)
        with open(path, "rb") as file:
            return zlib.compress(file.read(), 1)


def load(client: Client, state: bytes, body: int, height: float = _FAR) -> None:
    """Put a world back; ``body`` and ``height`` as for ``forget``.

    Raises:
        EngineError: the state is not one of a world with these bodies; the world stays as it is.
    """
    p, id_ = client.p, client.id
    kept = p.saveState(id_)
    try:
        forget(client, body, height)
        _read(client, state)
    except EngineError:
        p.restoreState(kept, physicsClientId=id_)
        raise
    finally:
        p.removeState(kept, id_)


def _read(client: Client, state: bytes) -> None:
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
