# SPDX-License-Identifier: BSD-3-Clause
"""Engines by name. Native physics is not among them: it is compiled into the core (``physics.native``)."""

from __future__ import annotations

import importlib.util
import re
from collections.abc import Callable, Mapping

from ..errors import MissingExtra
from .engine import Engine, EngineError, EngineVehicle

NATIVE = "native"
ENGINES = ("pybullet", "jsbsim")
"""Their names are those of the modules that they are made with, and of the extras that bring these."""
BACKENDS = (NATIVE, *ENGINES)
_registered: dict[str, dict[str, str]] = {}
"""Engines of other packages: name -> kind of vehicle -> "module:FUNCTION"."""


def register_engine(name: str, kind: str, reference: str) -> None:
    """Make an engine of another package known in this process.

    Args:
        name: what ``physics=`` takes.
        kind: name of a kind of vehicle that it simulates.
        reference: "module:FUNCTION" of a function that makes an ``Engine`` of a ``EngineVehicle``.

    Raises:
        EngineError: the name is one of ours, or ``reference`` is no such text.
    """
    if name in BACKENDS:
        raise EngineError(f"physics {name!r} comes with the simulator; choose another name")
    if not re.fullmatch(r"[\w.]+:\w+", reference):
        raise EngineError(f'physics {name!r}: where it is must be written as "module:FUNCTION", not {reference!r}')
    _registered.setdefault(name, {})[kind] = reference


def backends() -> tuple[str, ...]:
    """Names of all engines, native physics first."""
    return (*BACKENDS, *_registered)


def find(name: str, kind: str, models: Mapping[str, str]) -> Callable[[EngineVehicle], Engine]:
    """The function that makes an engine for a vehicle.

    Args:
        name: of the engine.
        kind: name of the kind of vehicle.
        models: engine -> "module:FUNCTION" that makes it for this kind; loaded when it is asked for.

    Raises:
        EngineError: no engine of this name, it does not simulate this kind, or it is another package's and cannot be
            imported.
        MissingExtra: the library that one of ours is made with is not installed; nothing has been compiled for it yet.
    """
    others = {engine: references[kind] for engine, references in _registered.items() if kind in references}
    models = {**models, **others}
    if name not in backends() and name not in models:
        raise EngineError(f"physics {name!r} is not known; there are {', '.join(backends())}")
    if name not in models:
        able = ", ".join((NATIVE, *models))
        raise EngineError(f"physics {name!r} has no model of a {kind}; it is simulated by {able}")
    if name in ENGINES and importlib.util.find_spec(name) is None:
        raise MissingExtra(f"physics {name!r} needs {name}: pip install 'gym-sitl[{name}]'")
    module, _, function = models[name].partition(":")
    try:
        make: Callable[[EngineVehicle], Engine] = getattr(importlib.import_module(module), function)
    except (ImportError, AttributeError) as error:
        if name in others:
            raise EngineError(f"physics {name!r} at {models[name]}: {error}") from error
        raise
    return make
