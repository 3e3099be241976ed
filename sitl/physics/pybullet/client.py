# SPDX-License-Identifier: BSD-3-Clause
"""One world of Bullet in this process ("direct"), with its clock and solver set.

Bullet's frame is that of world files: x forward (north), y left (west), z up, metres; its bodies' axes are forward,
left, up. From and to NED and FRD only signs change: (x, y, z) is (north, -east, -down), and the quaternion (w, x, y, z)
of a body is (w, x, -y, -z) here, which Bullet writes (x, y, z, w).

The whole state of a world of Bullet as bytes.

Poses and velocities are not all of it: Bullet keeps contact points and what the solver pushed with, and it turns the
quaternion that it is given into a matrix and back. Its own file has everything, in double precision; but what reading
it makes of contacts depends on those that the world has at that time. So ``load`` makes it forget them first; and a
world that was saved with something near has to load, too, to go on as those do that load it. The same goes for a
vehicle that is put back to power-on.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import sys
import tempfile
import zlib
from collections.abc import Iterator
from functools import cache
from typing import Any

from ...core.constants import GRAVITY
from ...errors import MissingExtra
from ..engine import EngineError

ITERATIONS = 50
"""Passes of the contact solver; it leaves off sooner when nothing changes."""
RESIDUAL = 1e-7
"""Bullet's own."""


class Client:
    """A world of its own: gravity, a step, repeatable bit for bit.

    ``p`` is the module; every function of it takes ``id`` as ``physicsClientId``. ``step()`` moves the world on.

    Args:
        step_s: of the simulation [s].
        iterations: greatest number of passes of the solver in a step.
        residual: the solver leaves off when a pass changes velocities by less than this, squared.

    Raises:
        MissingExtra: pybullet is not installed.
        EngineError: this process has too many worlds open.
    """

    def __init__(self, step_s: float, iterations: int = ITERATIONS, residual: float = RESIDUAL) -> None:
        self.p = p = bullet()
        self.id: int = p.connect(p.DIRECT)
        if self.id < 0:
            raise EngineError("pybullet opens no more worlds in this process; close some that are not used")
        p.setGravity(0.0, 0.0, -GRAVITY, self.id)
        p.setPhysicsEngineParameter(
            fixedTimeStep=step_s,
            numSubSteps=0,
            numSolverIterations=iterations,
            solverResidualThreshold=residual,
            deterministicOverlappingPairs=1,
            enableFileCaching=0,  # it would keep every state and model that it ever read
            physicsClientId=self.id,
        )
        self._step = p.stepSimulation

    def step(self) -> None:
        """Move everything on by one step."""
        self._step(self.id)

    def close(self) -> None:
        """Give the world up; may be called twice."""
        if self.id >= 0:
            with contextlib.suppress(self.p.error):
                self.p.disconnect(self.id)
            self.id = -1

    def __del__(self) -> None:
        if getattr(self, "id", -1) >= 0 and not sys.is_finalizing():
            self.close()


@cache
def bullet() -> Any:
    """The module ``pybullet``, imported without its line on standard output.

    Raises:
        MissingExtra: it is not installed.
    """
    try:
        with silence():
            import pybullet
    except ImportError:
        raise MissingExtra("physics by PyBullet needs pybullet: pip install 'gym-sitl[pybullet]'") from None
    return pybullet


@contextlib.contextmanager
def silence() -> Iterator[None]:
    """Send what C code prints nowhere: descriptors 1 and 2, since C knows nothing of ``sys.stdout``."""
    sys.stdout.flush()
    sys.stderr.flush()
    flush = ctypes.CDLL(None).fflush
    flush(None)
    kept = [(number, os.dup(number)) for number in (1, 2)]
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        for number, _ in kept:
            os.dup2(nowhere, number)
        yield
    finally:
        flush(None)
        for number, copy in kept:
            os.dup2(copy, number)
            os.close(copy)
        os.close(nowhere)


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
    """Put a world back; ``body`` and ``height`` [m] as for ``forget``.

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
