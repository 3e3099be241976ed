# SPDX-License-Identifier: BSD-3-Clause
"""The lidar and range-finder of one vehicle: memory that the laws of ``sitl.physics.native.ranging`` work on, and when
they are called where the core does not do it by itself."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ..core.constants import NEVER
from ..physics.native.ranging import (
    LIDAR,
    RANGEFINDER,
    Ranging,
    aim_sensor,
    finish_scan,
    measure,
    properties_of,
    scan_due,
    sensor_due,
)
from ..worlds import Geometry, planar, raycast
from .plant import SimulatedVehicle

Cast = Callable[..., bool]
Unit = Callable[..., None]
Array = np.ndarray[Any, Any]


class Scene(NamedTuple):
    """What a sensor can meet."""

    geometry: Geometry
    floor: float
    """Height of the floor in the world's frame [m]."""
    cast: Cast | None = None
    """An engine's own way to cast rays (``sitl.physics.engine.Engine.cast``)."""


class Company(NamedTuple):
    """The vehicles that share a world, and which of them this is."""

    movers: int
    """Address of what they show (``sitl.physics.native.traffic.Mover``), which stays in place."""
    total: int
    number: int


class Rays(NamedTuple):
    """A sensor's rays, and memory to work in: the arrays of a ``Beams``."""

    rays: Array
    directions: Array
    ranges: Array


def rays_of(v: Any) -> list[Rays | None]:
    """The rays of the sensors that a vehicle's properties ask for; None: it has no such sensor."""
    a = v.physics.airframe
    fan = planar.rays(a.lidar_rays, a.lidar_fov) if a.lidar_samples > 0 else None
    down = np.array([[0.0], [0.0], [1.0]]) if a.rangefinder_max > 0.0 else None
    return [
        None if rays is None else Rays(np.ascontiguousarray(rays), np.empty(rays.shape), np.empty(rays.shape[1]))
        for rays in (fan, down)
    ]


def show_world(r: Ranging, geometry: Geometry, floor: float) -> None:
    """Let sensors measure in a world, whose arrays have to stay in place; ``floor``: its height [m]."""
    r.solids, r.grid, r.cells = (a.ctypes.data for a in (geometry.solids, geometry.grid, geometry.cells))
    r.solid_count, r.cell_count, r.floor = len(geometry.solids), len(geometry.cells), floor


class Rangers:
    """The sensors that one vehicle has, from power-on.

    Args:
        vehicle: with the properties of its airframe in its record.
        scene: what is around it.
        bind: makes a unit a function for this vehicle.
    """

    def __init__(self, vehicle: SimulatedVehicle, scene: Scene, bind: Callable[[Unit], Unit]) -> None:
        self._v, self._scene = vehicle.v, scene
        self._memory = Ranging.fleet(1)
        self.address: int = self._memory.ctypes.data
        """Of the record ``Ranging``, which lives as long as this."""
        self._ranging = r = Ranging.of(self._memory, 0)
        show_world(r, scene.geometry, scene.floor)
        self._rays = rays_of(self._v)
        for number, arrays in enumerate(self._rays):
            if arrays is not None:
                beams = r.beams[number]
                beams.count = len(arrays.ranges)
                beams.rays, beams.directions, beams.ranges = (array.ctypes.data for array in arrays)
        r.beams[LIDAR].readings, r.beams[RANGEFINDER].readings = self._v.physics.airframe.lidar_samples, 1
        if scene.cast is None:
            self._measure: Callable[[], None] = partial(bind(measure), self.address)
        else:
            self._aim, self._finish = (partial(bind(unit), self.address) for unit in (aim_sensor, finish_scan))
            self._measure = self._by_engine
        self.due_us = NEVER
        """When to measure next [us since boot]."""
        self.find_due()

    def with_own_workspace(self) -> tuple[int, Any]:
        """(Address of a ``Ranging`` of the same world and sensors with other memory to work in, what keeps it alive):
        for vehicles that another thread advances."""
        memory = self._memory.copy()
        copy, buffers = Ranging.of(memory, 0), []
        for number, arrays in enumerate(self._rays):
            if arrays is not None:
                own = Rays(arrays.rays, np.empty_like(arrays.directions), np.empty_like(arrays.ranges))
                buffers.append(own)
                copy.beams[number].directions, copy.beams[number].ranges = (
                    own.directions.ctypes.data,
                    own.ranges.ctypes.data,
                )
        return memory.ctypes.data, (self, memory, buffers)

    def enter(self, geometry: Geometry, floor: float) -> None:
        """Measure in another world from now on; ``floor``: height of its floor in its frame [m]."""
        self._scene = self._scene._replace(geometry=geometry, floor=floor)
        show_world(self._ranging, geometry, floor)

    def share(self, company: Company) -> None:
        """Let the sensors meet other vehicles."""
        r = self._ranging
        r.movers, r.mover_count, r.number = company

    @property
    def has_rangefinder(self) -> bool:
        """Whether one looks down."""
        return self._rays[RANGEFINDER] is not None

    def find_due(self) -> None:
        """Set ``due_us`` from the vehicle's record: after it was written from outside."""
        self.due_us = scan_due(self._v, self._ranging)

    def measure(self) -> None:
        """Measure with every sensor that is due."""
        self._measure()
        self.find_due()

    def _by_engine(self) -> None:
        v, r, scene = self._v, self._ranging, self._scene
        for number, arrays in enumerate(self._rays):
            beams = r.beams[number]
            if arrays is None or sensor_due(v.sensors, v.physics.airframe, beams, number) > v.time_us:
                continue
            self._aim(number)
            origin, longest = np.array(beams.origin), properties_of(v.physics.airframe, number).range_max
            assert scene.cast is not None
            if not scene.cast(origin, arrays.directions, arrays.ranges, longest):
                raycast.scan(scene.geometry, origin, arrays.directions, arrays.ranges)
            self._finish(number)
