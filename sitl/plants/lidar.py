# SPDX-License-Identifier: BSD-3-Clause
"""What measures distances in a world: a planar lidar and a range-finder that looks down, fixed to the body.

Scan ``k`` is taken ``k`` / rate seconds after power-on, on the tick at or after that, and written into the record's
``sensors`` before any message that is due at the same time. The readings follow Gazebo's rule (``sitl.worlds.planar``):
index 0 is the rightmost, the last one the leftmost. A reading below the least is the least.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from ..core.array_kernels import kernel
from ..core.kernels import jit_disabled, law
from ..core.record_reader import RecordReader
from ..core.rng import Rng, normal
from ..core.rotations import quat_rotate
from ..worlds import Geometry, planar
from ..worlds.planar import publish_readings
from ..worlds.raycast import scan_rays

Cast = Callable[..., bool]
NEVER = 1 << 62
DOWN = np.array([[0.0], [0.0], [1.0]])


@law
def aim(position, attitude, figures, rays, origin, directions):
    """Turn a sensor's rays into the world: ``origin`` NED, down from z = 0 of the world's frame [m], shape (3,), and
    ``directions`` NED, shape (3, rays)."""
    w, x, y, z = float(attitude[0]), float(attitude[1]), float(attitude[2]), float(attitude[3])
    for k in range(rays.shape[1]):
        n, e, d = quat_rotate(w, x, y, z, float(rays[0, k]), float(rays[1, k]), float(rays[2, k]))
        directions[0, k], directions[1, k], directions[2, k] = n, e, d
    n, e, d = quat_rotate(w, x, y, z, float(figures[3]), float(figures[4]), float(figures[5]))
    origin[0] = n + float(position[0])
    origin[1] = e + float(position[1])
    origin[2] = d + float(position[2]) - float(figures[6])


@law
def publish(rng, figures, ranges, readings):
    """What a sensor reads of the ranges that its rays met [m]; see ``measure_ranges``."""
    least, longest, noise = float(figures[0]), float(figures[1]), float(figures[2])
    publish_readings(ranges, longest, readings)
    for k in range(readings.shape[0]):
        reading = float(readings[k])
        if reading < longest:
            if noise > 0.0:
                reading = min(reading + noise * normal(rng[0]), longest)
            readings[k] = max(reading, least)


@law
def measure_ranges(rng, position, attitude, figures, solids, grid, cells, rays, origin, directions, ranges, readings):
    """One scan of a sensor on a body, into ``readings``.

    Args:
        rng: records, shape (1,): of the vehicle's random numbers.
        position: of the body, NED from the origin on the floor [m].
        attitude: quaternion from body to NED.
        figures: least reading, range, standard deviation of a reading [m], place on the body forward, right, down [m],
            height of the floor in the world's frame [m].
        solids, grid, cells: of the world's ``Geometry``.
        rays: unit vectors on the body, FRD, shape (3, rays).
        origin, directions, ranges: room to work in, shapes (3,), (3, rays), (rays,).
        readings: float32 [m]; inf: nothing in range.
    """
    aim(position, attitude, figures, rays, origin, directions)
    scan_rays(solids, grid, cells, float(origin[0]), float(origin[1]), float(origin[2]), directions, ranges)
    publish(rng, figures, ranges, readings)


def _signature() -> Any:
    from numba import types

    from ..core.numba_records import numba_type

    rng = types.Array(numba_type(Rng), 1, "C")
    line, table, whole = types.float64[::1], types.float64[:, ::1], types.int64[::1]
    return types.void(rng, line, line, line, table, line, whole, table, line, table, line, types.float32[::1])


def _aim_signature() -> Any:
    from numba import types

    line, table = types.float64[::1], types.float64[:, ::1]
    return types.void(line, line, line, table, line, table)


def _publish_signature() -> Any:
    from numba import types

    from ..core.numba_records import numba_type

    rng = types.Array(numba_type(Rng), 1, "C")
    return types.void(rng, types.float64[::1], types.float64[::1], types.float32[::1])


_measure = kernel(_signature)(measure_ranges)
_aim = kernel(_aim_signature)(aim)
_publish = kernel(_publish_signature)(publish)


class Ranger:
    """One sensor of one vehicle: ``take`` measures, ``due_us`` is when it next has to.

    Args:
        v: view of the vehicle's record.
        fleet, index: the record itself.
        name: "lidar" or "rangefinder": of its figures and counter.
        rays: unit vectors on the body, FRD, shape (3, rays).
        readings: float32 array in the record.
        geometry, floor: of the world.
        cast: an engine's own way to cast rays (``sitl.physics.engine.Engine.cast``).
    """

    def __init__(
        self,
        v: Any,
        fleet: np.ndarray[Any, Any],
        index: int,
        name: str,
        rays: np.ndarray[Any, Any],
        readings: np.ndarray[Any, Any],
        geometry: Geometry,
        floor: float,
        cast: Cast | None = None,
    ) -> None:
        self._sensors, self._counter = v.sensors, name + "_count"
        reader = RecordReader(fleet, index)
        self._count = reader.field(f"sensors.{name}_count")
        figures = ("rate", "min", "max", "noise", "at")
        self._read = reader.fields(*(f"physics.airframe.{name}_{figure}" for figure in figures))
        self._floor, self._figures = floor, np.empty(7)
        self._known: tuple[float, ...] = ()
        rng: Any = [v.rng] if jit_disabled() else fleet["rng"][index : index + 1]
        origin, room, ranges = np.empty(3), np.empty_like(rays), np.empty(rays.shape[1])
        body, numbers = v.physics.body, self._figures
        measure = partial(
            _measure.function(), rng, body.pos, body.q, numbers,
            geometry.solids, geometry.grid, geometry.cells, rays, origin, room, ranges, readings,
        )  # fmt: skip
        self._measure: Callable[[], None] = measure
        if cast is not None:
            turn, read = _aim.function(), _publish.function()

            def by_engine() -> None:
                turn(body.pos, body.q, numbers, rays, origin, room)
                if cast(origin, room, ranges, float(numbers[1])):
                    read(rng, numbers, ranges, readings)
                else:
                    measure()

            self._measure = by_engine
        self.read_figures()
        self.find_due()

    def read_figures(self) -> None:
        """Take over the figures of the vehicle's airframe, as its record has them now."""
        figures = self._read()
        if figures != self._known:
            self._known = figures
            self._period_us = 1e6 / figures[0]
            self._figures[:] = *figures[1:], self._floor

    def find_due(self) -> None:
        """Set ``due_us`` from how many measurements there have been."""
        self.due_us = math.floor(int(self._count()) * self._period_us + 0.5)

    def take(self, now_us: int) -> None:
        """Measure. Ticks that are longer than the period leave some out."""
        self._measure()
        count = int(self._count())
        self._sensors[self._counter] = max(count + 1, math.floor((now_us + 0.5) / self._period_us) + 1)
        self.find_due()


class Rangers:
    """The sensors that one vehicle has.

    Args:
        v: view of the vehicle's record, with the figures of its airframe.
        fleet, index: the record itself.
        geometry: of the world.
        floor: height of the floor in the world's frame [m].
        cast: see ``Ranger``.
    """

    def __init__(
        self,
        v: Any,
        fleet: np.ndarray[Any, Any],
        index: int,
        geometry: Geometry,
        floor: float,
        cast: Cast | None = None,
    ) -> None:
        a, s = v.physics.airframe, v.sensors
        self._sensors = s
        self.lidar: Ranger | None = None
        self.rangefinder: Ranger | None = None
        samples = int(a.lidar_samples)
        if samples > 0:
            rays = np.ascontiguousarray(planar.rays(int(a.lidar_rays), float(a.lidar_fov)))
            self.lidar = Ranger(v, fleet, index, "lidar", rays, s.lidar_ranges[:samples], geometry, floor, cast)
        if a.rangefinder_max > 0.0:
            self.rangefinder = Ranger(v, fleet, index, "rangefinder", DOWN, s.rangefinder_range, geometry, floor, cast)
        self._all = [sensor for sensor in (self.lidar, self.rangefinder) if sensor is not None]
        self.find_due()

    def read_figures(self) -> None:
        """Take over the figures in the record: after it was written from outside."""
        for sensor in self._all:
            sensor.read_figures()

    def find_due(self) -> None:
        """Set ``due_us``, when the next one has to measure, from the record: after it was written from outside."""
        for sensor in self._all:
            sensor.find_due()
        self.due_us = min((sensor.due_us for sensor in self._all), default=NEVER)

    def measure(self, now_us: int) -> None:
        """Measure with every sensor that is due."""
        for sensor in self._all:
            if sensor.due_us <= now_us:
                sensor.take(now_us)
                if sensor is self.lidar:
                    self._sensors.lidar_time_us = now_us
        self.due_us = min((sensor.due_us for sensor in self._all), default=NEVER)
