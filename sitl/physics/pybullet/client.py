# SPDX-License-Identifier: BSD-3-Clause
"""One world of Bullet in this process ("direct"), with its clock and solver set.

Bullet's frame is that of world files: x forward (north), y left (west), z up, metres; its bodies' axes are forward,
left, up. From and to NED and FRD only signs change: (x, y, z) is (north, -east, -down), and the quaternion (w, x, y, z)
of a body is (w, x, -y, -z) here, which Bullet writes (x, y, z, w).
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import sys
from collections.abc import Iterator
from functools import cache
from typing import Any

from ...core.extras import MissingExtra
from ..engine import EngineError
from ..native.body import GRAVITY

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
