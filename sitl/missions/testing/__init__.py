# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles in tests: a pytest plugin with fixtures ``copter``, ``rover``, ``vehicle_factory``, and golden flights."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .factory import VehicleFactory
    from .twin import assert_twin
    from .vehicle import Copter, Rover

__all__ = ["Copter", "Rover", "VehicleFactory", "assert_twin"]

_LAZY = {"Copter": "vehicle", "Rover": "vehicle", "VehicleFactory": "factory", "assert_twin": "twin"}
"""Name -> the module that has it, loaded when it is first used."""


def __getattr__(name: str) -> Any:
    if name not in _LAZY:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}; it has {', '.join(__all__)}")
    return getattr(import_module(f"{__name__}.{_LAZY[name]}"), name)
