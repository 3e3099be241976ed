# SPDX-License-Identifier: BSD-3-Clause
"""What measures distances in a world: a planar lidar and a range-finder that looks down, fixed to the body.

Scan ``k`` is taken ``k`` / rate seconds after power-on, on the tick at or after that, and written into the record's
``sensors`` before any message that is due at the same time. The readings follow Gazebo's rule (``sitl.worlds.planar``):
index 0 is the rightmost, the last one the leftmost. A reading below the least is the least.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ..core.algebra import rotate
from ..core.array_kernels import Kernel, Line, NarrowLine, Table
from ..core.kernels import jit_disabled, law
from ..core.record_reader import RecordReader
from ..core.records import Record, Records
from ..core.rng import Rng, normal
from ..core.vectors import Vec3
from ..physics.native.records import Body
from ..worlds import Geometry, planar
from ..worlds.geometry import Solids
from ..worlds.planar import publish_readings
from ..worlds.raycast import scan_rays, turn_rays

Cast = Callable[..., bool]
NEVER = 1 << 62
DOWN = np.array([[0.0], [0.0], [1.0]])


class Scene(NamedTuple):
    """What a sensor can meet."""

    geometry: Geometry
    floor: float
    """Height of the floor in the world's frame [m]."""
    cast: Cast | None = None
    """An engine's own way to cast rays (``sitl.physics.engine.Engine.cast``)."""


class RangerFigures(Record):
    """What a sensor is, and where."""

    range_min: float  # least reading [m]
    range_max: float  # greatest reading [m]
    noise: float  # standard deviation of a reading [m]
    at: Vec3  # place on the body, FRD [m]
    floor: float  # height of the floor in the world's frame [m]


class Beams(NamedTuple):
    """A sensor's rays, and room to work in."""

    rays: Table
    """Unit vectors on the body, FRD, shape (3, rays)."""
    origin: Line
    """Where they start, NED, down from z = 0 of the world's frame [m], shape (3,)."""
    directions: Table
    """Unit vectors NED, shape (3, rays)."""
    ranges: Line
    """What they met [m], shape (rays,)."""


@law
def aim(bodies: Records[Body], sensors: Records[RangerFigures], beams: Beams) -> None:
    """Turn a sensor's rays into the world: ``origin`` and ``directions``."""
    body, sensor, directions = bodies[0], sensors[0], beams.directions
    q = body.q
    turn_rays(q, beams.rays, directions)
    origin = rotate(q, sensor.at) + body.pos
    beams.origin[0], beams.origin[1], beams.origin[2] = origin.x, origin.y, origin.z - sensor.floor


@law
def publish(rngs: Records[Rng], sensors: Records[RangerFigures], ranges: Line, readings: NarrowLine) -> None:
    """What a sensor reads of the ranges that its rays met [m]; see ``measure_ranges``."""
    sensor = sensors[0]
    publish_readings(ranges, sensor.range_max, readings)
    for k in range(readings.shape[0]):
        reading = float(readings[k])
        if reading < sensor.range_max:
            if sensor.noise > 0.0:
                reading = min(reading + sensor.noise * normal(rngs[0]), sensor.range_max)
            readings[k] = max(reading, sensor.range_min)


@law
def measure_ranges(
    rngs: Records[Rng],
    bodies: Records[Body],
    sensors: Records[RangerFigures],
    solids: Solids,
    beams: Beams,
    readings: NarrowLine,
) -> None:
    """One scan of a sensor on a body, into ``readings``.

    Args:
        rngs: of the vehicle's random numbers, shape (1,).
        bodies: its body, whose position counts from the origin on the floor, shape (1,).
        sensors: the sensor, shape (1,).
        solids: of the world.
        beams: of the sensor.
        readings: [m]; inf: nothing in range.
    """
    aim(bodies, sensors, beams)
    origin = Vec3(beams.origin[0], beams.origin[1], beams.origin[2])
    scan_rays(solids, origin, beams.directions, beams.ranges)
    publish(rngs, sensors, beams.ranges, readings)


_measure = Kernel(measure_ranges)
_aim = Kernel(aim)
_publish = Kernel(publish)


class Ranger:
    """One sensor of one vehicle: ``take`` measures, ``due_us`` is when it next has to.

    Args:
        v: view of the vehicle's record.
        fleet, index: the record itself.
        name: "lidar" or "rangefinder": of its figures and counter.
        rays: unit vectors on the body, FRD, shape (3, rays).
        readings: float32 array in the record.
        scene: what is around it.
    """

    def __init__(
        self,
        v: Any,
        fleet: np.ndarray[Any, Any],
        index: int,
        name: str,
        rays: np.ndarray[Any, Any],
        readings: np.ndarray[Any, Any],
        scene: Scene,
    ) -> None:
        self._sensors, self._counter = v.sensors, name + "_count"
        reader = RecordReader(fleet, index)
        self._count = reader.field(f"sensors.{name}_count")
        figures = ("rate", "min", "max", "noise", "at")
        self._read = reader.fields(*(f"physics.airframe.{name}_{figure}" for figure in figures))
        self._known: tuple[float, ...] = ()
        rngs: Any = [v.rng] if jit_disabled() else fleet["rng"][index : index + 1]
        bodies: Any = [v.physics.body] if jit_disabled() else fleet["physics"]["body"][index : index + 1]
        sensors: Any = RangerFigures.fleet(1)
        self._figures = RangerFigures.of(sensors, 0)
        self._figures.floor = scene.floor
        if jit_disabled():
            sensors = [self._figures]
        beams = Beams(rays, np.empty(3), np.empty_like(rays), np.empty(rays.shape[1]))
        measure = _measure.bind(rngs, bodies, sensors, scene.geometry.arrays, beams, readings)
        self._measure: Callable[[], None] = measure
        cast = scene.cast
        if cast is not None:
            turn, read = _aim.bind(bodies, sensors, beams), _publish.bind(rngs, sensors, beams.ranges, readings)

            def by_engine() -> None:
                turn()
                if cast(beams.origin, beams.directions, beams.ranges, self._figures.range_max):
                    read()
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
            f = self._figures
            f.range_min, f.range_max, f.noise, f.at = *figures[1:4], Vec3(*figures[4:])

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
        scene: what is around it.
    """

    def __init__(self, v: Any, fleet: np.ndarray[Any, Any], index: int, scene: Scene) -> None:
        a, s = v.physics.airframe, v.sensors
        self._sensors = s
        self.lidar: Ranger | None = None
        self.rangefinder: Ranger | None = None
        samples = int(a.lidar_samples)
        if samples > 0:
            rays = np.ascontiguousarray(planar.rays(int(a.lidar_rays), float(a.lidar_fov)))
            self.lidar = Ranger(v, fleet, index, "lidar", rays, s.lidar_ranges[:samples], scene)
        if a.rangefinder_max > 0.0:
            self.rangefinder = Ranger(v, fleet, index, "rangefinder", DOWN, s.rangefinder_range, scene)
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
