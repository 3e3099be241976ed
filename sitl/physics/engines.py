# SPDX-License-Identifier: BSD-3-Clause
"""Engines by name. Native physics is not among them: it is compiled into the core (``physics.native``)."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping

from .engine import Engine, EngineError, Seat

NATIVE = "native"
ENGINES = ("pybullet", "jsbsim")
BACKENDS = (NATIVE, *ENGINES)


def find(name: str, kind: str, models: Mapping[str, str]) -> Callable[[Seat], Engine]:
    """The function that makes an engine for a vehicle.

    Args:
        name: of the engine.
        kind: name of the kind of vehicle.
        models: engine -> "module:FUNCTION" that makes it for this kind; loaded when it is asked for.

    Raises:
        EngineError: no engine of this name, or it does not simulate this kind.
    """
    if name not in ENGINES and name not in models:
        raise EngineError(f"physics {name!r} is not known; there are {', '.join(BACKENDS)}")
    if name not in models:
        able = ", ".join((NATIVE, *models))
        raise EngineError(f"physics {name!r} has no model of a {kind}; it is simulated by {able}")
    module, _, function = models[name].partition(":")
    make: Callable[[Seat], Engine] = getattr(importlib.import_module(module), function)
    return make
