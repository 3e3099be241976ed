# SPDX-License-Identifier: BSD-3-Clause
"""What a kind of vehicle adds to the engine; properties of JSBSim, fields of the record, units."""

from __future__ import annotations

import struct
from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import partial
from typing import Any

from ..engine import EngineError, EngineVehicle, offset


class Properties:
    """Properties by name; looked up once, a read or write takes 0.1 us."""

    def __init__(self, executive: Any) -> None:
        self._tree = executive.get_property_manager()

    def _node(self, name: str) -> Any:
        node = self._tree.get_node(name)
        if node is None:
            raise EngineError(f"JSBSim has no property {name!r}")
        return node

    def reader(self, name: str) -> Callable[[], float]:
        """A function that reads it."""
        read: Callable[[], float] = self._node(name).get_double_value
        return read

    def writer(self, name: str) -> Callable[[float], None]:
        """A function that writes it."""
        write: Callable[[float], None] = self._node(name).set_double_value
        return write


class VehicleModel(ABC):
    """The part of a kind of vehicle: its aircraft, and what it exchanges with JSBSim besides the body's motion."""

    ahead = 0.0
    """From the origin of the body forward to its centre of mass, which JSBSim moves [m]."""
    idle_parameters: tuple[str, ...] = ()
    """As of ``Engine``."""

    def __init__(self, vehicle: EngineVehicle) -> None:
        self.vehicle = vehicle

    def frames(self, a: Any) -> int:
        """Frames of JSBSim a tick, of the vehicle's properties."""
        return 1

    @abstractmethod
    def document(self, a: Any, dt: float) -> str:
        """The aircraft of properties for frames of dt [s]."""

    def height(self, a: Any) -> float:
        """Of the centre of mass over the ground, standing [m]."""
        return 0.0

    @abstractmethod
    def bind(self, properties: Properties, a: Any, dt: float) -> None:
        """Look up the properties of a new executive, whose frames are dt [s] long."""

    @abstractmethod
    def inputs(self) -> None:
        """From the record to JSBSim, before a tick."""

    @abstractmethod
    def outputs(self, down: float) -> None:
        """From JSBSim to the record, after a tick; ``down`` is the velocity [m/s]."""

    def starting(self) -> None:
        """JSBSim is about to start: what has a state of its own takes it from the record, and keeps it meanwhile."""
        return

    def started(self) -> None:
        """It has."""
        return


def writer(vehicle: EngineVehicle, path: str, count: int) -> Callable[..., None]:
    """A function of ``count`` numbers that writes them as f8 from the field at ``path`` on."""
    dtype, memory = vehicle.fleet.dtype, vehicle.fleet.view("u1").data
    start = vehicle.index * dtype.itemsize + offset(dtype, *path.split("."))
    return partial(struct.Struct(f"<{count}d").pack_into, memory, start)


FOOT = 0.3048
"""[m]"""
SLUG = 14.593902937206364
"""[kg]"""
POUND = SLUG * FOOT
"""Of force [N]."""
POUND_FOOT = POUND * FOOT
"""Of torque [N m]."""
SLUG_FOOT2 = SLUG * FOOT * FOOT
"""Of inertia [kg m^2]."""
SLUG_BY_FOOT3 = SLUG / (FOOT * FOOT * FOOT)
"""Of density [kg/m^3]."""
POUNDS_BY_SLUG = 32.174049
"""What JSBSim divides a weight in pounds by to get the mass."""
PASCALS = POUND / (FOOT * FOOT)
"""Of a pound by square foot [Pa]."""
RANKINE = 5.0 / 9.0
"""Of a difference of temperature [K]."""
