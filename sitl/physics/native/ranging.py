# SPDX-License-Identifier: BSD-3-Clause
"""What measures distances in a world: a planar lidar and a range-finder that looks down, fixed to the body.

Scan ``k`` is taken ``k`` / rate seconds after power-on, on the tick at or after that, and written into the record's
``sensors`` before any message that is due at the same time. The readings follow Gazebo's rule (``sitl.worlds.planar``):
index 0 is the rightmost, the last one the leftmost. A reading below the least is the least.

What a scan needs besides the vehicle's record is in a record beside it, ``Ranging``: units take its address. A sensor's
properties and the count of its scans are in the vehicle's record, so a copy of that one is the whole state.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ...core.algebra import rotate
from ...core.border import Sensors
from ...core.constants import NEVER
from ...core.kernels import law, unit
from ...core.memory import floats_at, ints_at, record_at, table_at
from ...core.records import Floats, Record, Records, repeat
from ...core.rng import Rng, normal, uniform
from ...core.vectors import Vec3
from ...vehicles.properties.body import Properties
from ...worlds.geometry import GRID_NUMBERS, SOLID_COLUMNS, Solids
from ...worlds.planar import publish_readings
from ...worlds.raycast import scan_rays, turn_rays
from .obstacles import list_solids
from .records import Body, Physics, RangeFault, Vehicle
from .traffic import Others, meet_rays

LIDAR, RANGEFINDER = 0, 1
"""Numbers of the sensors."""
SENSORS = 2


class Beams(Record):
    """A sensor's rays, and memory to work in; arrays by their addresses."""

    count: int  # rays; 0: the vehicle has no such sensor
    readings: int  # that are published, of as many rays or more
    rays: int  # unit vectors on the body, FRD, shape (3, count)
    directions: int  # memory for the same, NED, shape (3, count)
    ranges: int  # memory for what they meet [m], shape (count,)
    origin: Vec3  # where they start, NED, down from z = 0 of the world's frame [m]


class Ranging(Record):
    """A vehicle's world and its sensors' rays; arrays by their addresses."""

    # the world, which vehicles share (``sitl.worlds.geometry.Geometry``)
    solids: int  # shape (solid_count, SOLID_COLUMNS)
    solid_count: int
    grid: int  # shape (GRID_NUMBERS,)
    cells: int  # shape (cell_count,)
    cell_count: int
    floor: float  # height of the floor in the world's frame [m]
    movers: int  # what all vehicles of the world show (``traffic.Mover``), shape (mover_count,)
    mover_count: int  # 0: the vehicle is alone
    # the vehicle's own
    number: int  # of the vehicle, among those that share its world
    beams: Records[Beams] = repeat(Beams, SENSORS)


class RangerProperties(NamedTuple):
    """What a sensor is, and where."""

    range_min: float
    """Least reading [m]."""
    range_max: float
    """Greatest reading [m]."""
    noise: float
    """Standard deviation of a reading [m]."""
    at: Vec3
    """Position on the body, FRD [m]."""


@law
def solids_of(ranging: Ranging) -> Solids:
    """The world's solids."""
    rows = table_at(ranging.solids, ranging.solid_count, SOLID_COLUMNS)
    return Solids(rows, floats_at(ranging.grid, GRID_NUMBERS), ints_at(ranging.cells, ranging.cell_count))


@law
def properties_of(a: Properties, number: int) -> RangerProperties:
    """Properties of a sensor of an airframe."""
    if number == LIDAR:
        return RangerProperties(a.lidar_min, a.lidar_max, a.lidar_noise, a.lidar_at)
    return RangerProperties(a.rangefinder_min, a.rangefinder_max, a.rangefinder_noise, a.rangefinder_at)


@law
def period_us(a: Properties, number: int) -> float:
    """From one scan of a sensor to the next [us]."""
    return 1e6 / (a.lidar_rate if number == LIDAR else a.rangefinder_rate)


@law
def scans_taken(sensors: Sensors, number: int) -> int:
    """How many scans of a sensor there have been."""
    return sensors.lidar_count if number == LIDAR else sensors.rangefinder_count


@law
def sensor_due(sensors: Sensors, a: Properties, beams: Beams, number: int) -> int:
    """When a sensor has to measure next [us since power-on]."""
    if beams.count == 0:
        return NEVER
    return math.floor(scans_taken(sensors, number) * period_us(a, number) + 0.5)


@law
def scan_due(v: Vehicle[Physics], ranging: Ranging) -> int:
    """When the vehicle has to measure next [us since power-on]."""
    sensors, a = v.sensors, v.physics.airframe
    soonest = NEVER
    for number in range(SENSORS):
        soonest = min(soonest, sensor_due(sensors, a, ranging.beams[number], number))
    return soonest


@law
def aim(body: Body, at: Vec3, floor: float, beams: Beams) -> None:
    """Turn a sensor's rays into the world: ``origin`` and ``directions``.

    Args:
        body: position from the origin on the floor.
        at: position of the sensor on the body, FRD [m].
        floor: its height in the world's frame [m].
        beams: of the sensor.
    """
    q, count = body.q, beams.count
    turn_rays(q, table_at(beams.rays, 3, count), table_at(beams.directions, 3, count))
    origin = rotate(q, at) + body.pos
    beams.origin = Vec3(origin.x, origin.y, origin.z - floor)


@law
def read_ranges(rng: Rng, properties: RangerProperties, ranges: Floats, readings: Floats) -> None:
    """What a sensor reads of the ranges that its rays met [m]; inf: nothing in range."""
    longest = properties.range_max
    publish_readings(ranges, longest, readings)
    for k in range(readings.shape[0]):
        reading = float(readings[k])
        if reading < longest:
            if properties.noise > 0.0:
                reading = min(reading + properties.noise * normal(rng), longest)
            readings[k] = max(reading, properties.range_min)


@law
def spoil(rng: Rng, fault: RangeFault, number: int, readings: Floats) -> None:
    """Add what is wrong to a sensor's readings [m]."""
    loss = fault.lidar_loss if number == LIDAR else fault.loss
    for k in range(readings.shape[0]):
        if number == RANGEFINDER:
            readings[k] += fault.glitch + fault.noise * normal(rng)
        if loss > 0.0 and uniform(rng) < loss:
            readings[k] = math.inf


@law
def read(v: Vehicle[Physics], beams: Beams, number: int) -> None:
    """Write a sensor's readings of the ranges that its rays met."""
    s, a = v.sensors, v.physics.airframe
    readings = s.lidar_ranges[: beams.readings] if number == LIDAR else s.rangefinder_range[: beams.readings]
    read_ranges(v.rng, properties_of(a, number), floats_at(beams.ranges, beams.count), readings)
    if v.physics.sensors.range_fault.is_on:
        spoil(v.rng, v.physics.sensors.range_fault, number, readings)


@law
def show_lidar(s: Sensors, a: Properties) -> None:
    """Tell the autopilot what its lidar is."""
    s.lidar_samples, s.lidar_fov, s.lidar_min, s.lidar_max = a.lidar_samples, a.lidar_fov, a.lidar_min, a.lidar_max


@law
def finish(v: Vehicle[Physics], beams: Beams, number: int) -> None:
    """Write a sensor's readings of the ranges that its rays met, and count the scan. Ticks that are longer than the
    period leave some out."""
    s, a = v.sensors, v.physics.airframe
    read(v, beams, number)
    taken = max(scans_taken(s, number) + 1, math.floor((v.time_us + 0.5) / period_us(a, number)) + 1)
    if number == LIDAR:
        s.lidar_count, s.lidar_time_us = taken, v.time_us
        show_lidar(s, a)
    else:
        s.rangefinder_count = taken


@law
def cast(v: Vehicle[Physics], r: Ranging, number: int) -> None:
    """Turn a sensor's rays, and find what they meet."""
    a, beams = v.physics.airframe, r.beams[number]
    properties = properties_of(a, number)
    aim(v.physics.body, properties.at, r.floor, beams)
    directions, ranges = table_at(beams.directions, 3, beams.count), floats_at(beams.ranges, beams.count)
    scan_rays(solids_of(r), beams.origin, directions, properties.range_max, ranges)
    if r.mover_count > 0:
        origin = Vec3(beams.origin.x, beams.origin.y, beams.origin.z + r.floor)
        others = Others(r.movers, r.mover_count, r.number, v.time_us)
        meet_rays(others, origin, directions, properties.range_max, ranges)


@unit
def measure(fleet: Records[Vehicle[Physics]], i: int, ranging: int) -> None:
    """Measure with every sensor that is due.

    Args:
        fleet, i: the vehicle.
        ranging: address of its ``Ranging``.
    """
    v, r = fleet[i], record_at(Ranging, ranging)
    for number in range(SENSORS):
        if sensor_due(v.sensors, v.physics.airframe, r.beams[number], number) <= v.time_us:
            cast(v, r, number)
            finish(v, r.beams[number], number)


@law
def look_again(v: Vehicle[Physics], r: Ranging) -> None:
    """Take the last scans anew: the vehicle has been put elsewhere."""
    for number in range(SENSORS):
        if r.beams[number].count > 0 and scans_taken(v.sensors, number) > 0:
            cast(v, r, number)
            read(v, r.beams[number], number)


@unit
def aim_sensor(fleet: Records[Vehicle[Physics]], i: int, ranging: int, number: int) -> None:
    """The first part of a scan of which an engine casts the rays: turn them."""
    v, r = fleet[i], record_at(Ranging, ranging)
    aim(v.physics.body, properties_of(v.physics.airframe, number).at, r.floor, r.beams[number])


@unit
def finish_scan(fleet: Records[Vehicle[Physics]], i: int, ranging: int, number: int) -> None:
    """The last part of a scan of which an engine cast the rays: read what they met."""
    finish(fleet[i], record_at(Ranging, ranging).beams[number], number)


@unit
def list_near(fleet: Records[Vehicle[Physics]], i: int, ranging: int) -> None:
    """List the solids near the vehicle in its record."""
    list_around(fleet[i], record_at(Ranging, ranging))


@law
def list_around(v: Vehicle[Physics], r: Ranging) -> None:
    """The same."""
    list_solids(v.physics.obstacles, v.physics.body, table_at(r.solids, r.solid_count, SOLID_COLUMNS), r.floor)
