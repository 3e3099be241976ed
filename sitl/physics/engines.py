# SPDX-License-Identifier: BSD-3-Clause
"""Engines by name. Native physics is not among them: it is compiled into the core (``physics.native``)."""

from __future__ import annotations

import importlib

from .engine import Engine, EngineError, Seat

NATIVE = "native"
ENGINES = {
    "pybullet": "sitl.physics.pybullet.make",
    "jsbsim": "sitl.physics.jsbsim.make",
}
"""Name -> module whose ``make(seat)`` gives an engine for a vehicle."""
BACKENDS = (NATIVE, *ENGINES)


def make(name: str, seat: Seat) -> Engine:
    """An engine for a vehicle.

    Raises:
        EngineError: no engine of this name, or it cannot simulate this vehicle or world.
        sitl.core.extras.MissingExtra: its library is not installed.
    """
    if name not in ENGINES:
        raise EngineError(f"physics {name!r} is not known; there are {', '.join(BACKENDS)}")
    engine: Engine = importlib.import_module(ENGINES[name]).make(seat)
    return engine
