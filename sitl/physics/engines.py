# SPDX-License-Identifier: BSD-3-Clause
"""Engines by name. Native physics is not among them: it is compiled into the core (``physics.native``)."""

from __future__ import annotations

import importlib
from collections.abc import Mapping

from .engine import Engine, EngineError, Seat

NATIVE = "native"
ENGINES = ("pybullet", "jsbsim")
BACKENDS = (NATIVE, *ENGINES)


def make(name: str, seat: Seat, models: Mapping[str, str]) -> Engine:
    """An engine for a vehicle.

    Args:
        name: of the engine.
        seat: where it finds the vehicle.
        models: engine -> "module:FUNCTION" that makes it for this kind of vehicle; loaded when it is asked for.

    Raises:
        EngineError: no engine of this name, or it cannot simulate this vehicle or world.
        sitl.core.extras.MissingExtra: its library is not installed.
    """
    if name not in ENGINES and name not in models:
        raise EngineError(f"physics {name!r} is not known; there are {', '.join(BACKENDS)}")
    if name not in models:
        able = ", ".join((NATIVE, *models))
        raise EngineError(f"physics {name!r} has no model of a {seat.airframe.kind}; it is simulated by {able}")
    module, _, function = models[name].partition(":")
    engine: Engine = getattr(importlib.import_module(module), function)(seat)
    return engine
