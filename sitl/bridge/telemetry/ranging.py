# SPDX-License-Identifier: BSD-3-Clause
"""Lidar, range-finder, and what the proximity sensor sees."""

from __future__ import annotations

import math
from typing import NamedTuple

from ...autopilot.avoidance import proximity
from ...autopilot.avoidance.proximity import Proximity
from ...core.border import LIDAR_SAMPLES
from ...core.kernels import law
from ...core.mavlink import MavFrame
from ...core.records import Floats, Ints
from ...vehicle.record import Vehicle
from ..wire.message import Message
from ..wire.port import Port
from .units import DEG, boot_ms, uint16

SECTORS = 72
"""Elements of OBSTACLE_DISTANCE."""
UNKNOWN = 65535
LASER, FACING_DOWN, COVARIANCE_UNKNOWN = 0, 25, 255
SECTOR_ID = 10
"""Of the DISTANCE_SENSOR of sector 0 (ArduPilot's)."""
PART = 58
"""Elements of DEBUG_FLOAT_ARRAY."""
SCAN_NAME = b"LASER"
_LETTERS = tuple(SCAN_NAME)


@law
def centimetres(reading: float, longest: float) -> int:
    """A reading [m] in whole centimetres; nothing in range is a centimetre more than the range."""
    if reading < longest:
        return uint16(reading * 100.0 + 0.5)
    return min(uint16(longest * 100.0 + 0.5) + 1, UNKNOWN - 1)


class ObstacleDistance(Message, name="OBSTACLE_DISTANCE"):
    time_usec: int
    distances: Ints
    min_distance: int
    max_distance: int
    increment: int
    increment_f: float
    angle_offset: float
    frame: int


@law
def obstacle_distance(m: ObstacleDistance, v: Vehicle) -> bool:
    """OBSTACLE_DISTANCE: the nearest reading of the lidar in each of up to 72 sectors [cm], clockwise, on the body;
    the range + 1 where there is none; nothing without a lidar or a world.

    One reading is one sector, up to 72; of more readings each sector has the nearest.
    """
    s, lidar = v.sensors, v.physics.airframe
    samples = min(lidar.lidar_samples, LIDAR_SAMPLES)
    if s.lidar_count == 0 or samples <= 0:
        return False
    fov, longest = lidar.lidar_fov, lidar.lidar_max
    for k in range(SECTORS):
        m.distances[k] = UNKNOWN
    sector, nearest = -1, math.inf
    for k in range(samples):
        index = k if samples <= SECTORS else min(k * SECTORS // (samples - 1), SECTORS - 1)
        if index != sector:
            sector, nearest = index, math.inf
        nearest = min(nearest, float(s.lidar_ranges[samples - 1 - k]))
        m.distances[sector] = centimetres(nearest, longest)
    if samples <= SECTORS:
        step = fov / max(samples - 1, 1)
        first = -0.5 * fov if samples > 1 else 0.0
    else:
        step = fov / SECTORS
        first = 0.5 * step - 0.5 * fov
    m.time_usec = s.lidar_time_us
    m.min_distance = uint16(lidar.lidar_min * 100.0 + 0.5)
    m.max_distance = uint16(longest * 100.0 + 0.5)
    m.increment = min(uint16(step * DEG + 0.5), 255)
    m.increment_f = step * DEG
    m.angle_offset = first * DEG
    m.frame = MavFrame.BODY_FRD
    return True


class Limits(NamedTuple):
    """What a range-finder can see [m]."""

    least: float
    longest: float


class DistanceSensor(Message, name="DISTANCE_SENSOR"):
    time_boot_ms: int
    min_distance: int
    max_distance: int
    current_distance: int
    type: int
    id: int
    orientation: int
    covariance: int


@law
def next_part(v: Vehicle, first: int) -> int:
    """The part of DISTANCE_SENSOR, ``first`` or behind it, whose sector sees something; 0: there is none."""
    seen = v.autopilot.proximity
    if proximity.has_data(seen, v.time_us):
        for part in range(first, proximity.SECTORS + 1):
            if proximity.sees(seen, part - 1, v.time_us):
                return part
    return 0


@law
def fill_sector(m: DistanceSensor, seen: Proximity, k: int) -> None:
    """What is nearest in a sector."""
    m.min_distance = uint16(seen.range_min * 100.0)
    m.max_distance = uint16(seen.range_max * 100.0)
    m.current_distance = uint16(float(seen.distance[k]) * 100.0)
    m.id = SECTOR_ID + k
    m.orientation = k
    m.covariance = 0


@law
def distance_sensor(m: DistanceSensor, v: Vehicle, port: Port) -> bool:
    """DISTANCE_SENSOR: the downward rangefinder [cm]; the maximum range + 1 if nothing is in range; not sent without a
    rangefinder or a world. Then each sector with a reading of the proximity sensor, orientation 0 to 7.
    """
    s = v.sensors
    m.time_boot_ms = boot_ms(v.time_us)
    m.type = LASER
    part = port.part
    if part == 0 and s.rangefinder_count == 0:
        part = next_part(v, 1)
        if part == 0:
            return False
    port.part = next_part(v, part + 1)
    if part > 0:
        fill_sector(m, v.autopilot.proximity, part - 1)
        return True
    least, longest = limits(v)
    m.min_distance = uint16(least * 100.0 + 0.5)
    m.max_distance = uint16(longest * 100.0 + 0.5)
    m.current_distance = centimetres(float(s.rangefinder_range[0]), longest)
    m.orientation = FACING_DOWN
    m.covariance = COVARIANCE_UNKNOWN
    return True


@law
def limits(v: Vehicle) -> Limits:
    """The range-finder's: of the airframe in a world, else RNGFND1_MIN and RNGFND1_MAX."""
    airframe, down = v.physics.airframe, v.physics.downward
    if down.ranges:
        return Limits(down.range_min, down.range_max)
    return Limits(airframe.rangefinder_min, airframe.rangefinder_max)


class RangeFinder(Message, name="RANGEFINDER"):
    distance: float
    voltage: float


@law
def rangefinder(m: RangeFinder, v: Vehicle) -> bool:
    """RANGEFINDER: the one that looks down [m]; a metre more than the range where it meets nothing."""
    m.distance = min(float(v.sensors.rangefinder_range[0]), limits(v).longest + 1.0)
    return v.sensors.rangefinder_count > 0


class DebugFloatArray(Message, name="DEBUG_FLOAT_ARRAY"):
    time_usec: int
    array_id: int
    name: Ints
    data: Floats


@law
def scan(m: DebugFloatArray, v: Vehicle, port: Port) -> bool:
    """DEBUG_FLOAT_ARRAY: the whole scan of the lidar [m], "LASER", in parts of 58 counted by array_id from 0, from
    right to left; inf where it meets nothing, nan after the last reading; time of the scan; nothing without a lidar
    or a world.
    """
    s = v.sensors
    samples = min(v.physics.airframe.lidar_samples, LIDAR_SAMPLES)
    part = port.part
    first = part * PART
    port.part = 0
    if s.lidar_count == 0 or first >= samples:
        return False
    m.time_usec = s.lidar_time_us
    m.array_id = part
    for k in range(len(_LETTERS)):
        m.name[k] = _LETTERS[k]
    for k in range(PART):
        m.data[k] = s.lidar_ranges[first + k] if first + k < samples else math.nan
    if first + PART < samples:
        port.part = part + 1
    return True


MESSAGES = (obstacle_distance, distance_sensor, rangefinder, scan)
