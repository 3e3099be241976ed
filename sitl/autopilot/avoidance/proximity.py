# SPDX-License-Identifier: BSD-3-Clause
"""Proximity: what is seen around the vehicle, in eight sectors of 45 degrees (PRX_*, PRX1_*).

Sector ``k`` looks ``k`` times 45 degrees clockwise from the nose. Each has its nearest reading, low-passed, and the
angle of that reading. Readings come in MAVLink messages or from the vehicle's own lidar.
"""

from __future__ import annotations

import math

from ...core.algebra import direction, dot2
from ...core.border import LIDAR_SAMPLES, Sensors
from ...core.kernels import law
from ...core.records import Floats, Ints, Record, array
from ...core.scalars import TWO_PI, finite, wrap_2pi, wrap_pi
from ...core.vectors import Vec2
from ..params.avoidance import ProximitySensor

SECTORS = 8
SECTOR = TWO_PI / SECTORS
"""[rad]"""
EDGE = 1e-9
"""What rounding may take from an angle on an edge, as part of a sector."""
MAVLINK, SIMULATED = 2, 10
LIDARS = (5, 8, SIMULATED, 16)
"""PRX1_TYPE"""
SILENT_US = 500_000
"""A sensor that says nothing for so long has no data."""
OLD_US = 1_000_000
"""So long a sector's reading is good; after as long a gap its filter starts afresh."""


GROUND = 1.0
"""What is less than that over the ground counts as ground [m]."""


class Proximity(Record):
    """What is seen around the vehicle."""

    kind: int  # PRX1_TYPE at power-on, where there is such a sensor; 0 none
    update_us: int  # last readings
    scan: int  # of the lidar, that was looked at last
    range_min: float  # [m]
    range_max: float  # [m]
    has_height: bool  # what is near the ground is left out (copter, PRX_IGN_GND, range-finder):
    height: float  # over the ground [m]; 0: nothing is seen there
    tilt: Vec2  # how far down a metre forward, and a metre right on the body, leads [m]
    distance: Floats = array(SECTORS)  # of each sector [m], low-passed
    angle: Floats = array(SECTORS)  # of its reading, clockwise from the nose [rad]
    seen_us: Ints = array(SECTORS, stored="i8")  # when; 0: nothing is there
    nearest: Floats = array(SECTORS)  # space for the readings of one scan
    nearest_angle: Floats = array(SECTORS)


def power_on(proximity: Proximity, p: ProximitySensor) -> None:
    """PRX1_TYPE chooses the sensor now, and until the next power-on."""
    kind = int(p.TYPE)
    proximity.kind = kind if kind == MAVLINK or kind in LIDARS else 0


@law
def has_data(proximity: Proximity, time_us: int) -> bool:
    """Whether there is a sensor that has said something of late."""
    return proximity.kind != 0 and proximity.update_us > 0 and time_us - proximity.update_us < SILENT_US


@law
def sees(proximity: Proximity, sector: int, time_us: int) -> bool:
    """Whether something is in a sector."""
    return proximity.seen_us[sector] > 0 and time_us - proximity.seen_us[sector] < OLD_US


@law
def is_beside(angle: float, direction: float, width: float) -> bool:
    """Whether an angle [rad] is within ``width`` around a ``direction``, both in degrees."""
    return width > 0.0 and abs(wrap_pi(angle - math.radians(direction))) <= math.radians(0.5 * width)


@law
def is_ignored(angle: float, p: ProximitySensor) -> bool:
    """PRX1_IGN_*: whether readings at an angle [rad] are left out."""
    if is_beside(angle, p.IGN_ANG1, p.IGN_WID1) or is_beside(angle, p.IGN_ANG2, p.IGN_WID2):
        return True
    return is_beside(angle, p.IGN_ANG3, p.IGN_WID3) or is_beside(angle, p.IGN_ANG4, p.IGN_WID4)


@law
def mounted(angle: float, p: ProximitySensor) -> float:
    """An angle of the sensor as one of the vehicle, 0 .. 2 pi [rad] (PRX1_ORIENT, PRX1_YAW_CORR)."""
    return wrap_2pi((-angle if p.ORIENT == 1.0 else angle) + math.radians(p.YAW_CORR))


@law
def sector_of(angle: float) -> int:
    """The sector that an angle [rad] is in; its left edge belongs to it."""
    number = int(math.floor(wrap_2pi(angle) / SECTOR + 0.5 + EDGE))  # noqa: RUF046  a float on a GPU
    return number % SECTORS


@law
def is_ground(proximity: Proximity, angle: float, distance: float) -> bool:
    """Whether a reading [m] at an angle [rad] is left out as one of the ground."""
    if not proximity.has_height:
        return False
    down = dot2(proximity.tilt, direction(angle)) * distance
    return proximity.height - down < GROUND


@law
def begin_scan(proximity: Proximity, range_min: float, range_max: float, p: ProximitySensor) -> None:
    """Readings of all directions follow, of a sensor with this range [m]."""
    proximity.range_min = max(range_min, p.MIN)
    proximity.range_max = min(range_max, p.MAX) if p.MAX > 0.0 else range_max
    for k in range(SECTORS):
        proximity.nearest[k] = math.inf


@law
def note_reading(proximity: Proximity, angle: float, distance: float, p: ProximitySensor) -> None:
    """One reading [m] at an angle of the sensor [rad]."""
    if not (finite(distance) and proximity.range_min <= distance <= proximity.range_max):
        return
    at = mounted(angle, p)
    sector = sector_of(at)
    if distance < proximity.nearest[sector] and not (is_ignored(at, p) or is_ground(proximity, at, distance)):
        proximity.nearest[sector] = distance
        proximity.nearest_angle[sector] = at


@law
def end_scan(proximity: Proximity, time_us: int, cutoff: float) -> None:
    """All sectors have what the scan has met; ``cutoff``: of the filter [Hz]."""
    for k in range(SECTORS):
        end_sector(proximity, k, time_us, cutoff)
    proximity.update_us = time_us


@law
def end_sector(proximity: Proximity, k: int, time_us: int, cutoff: float) -> None:
    """One sector has the nearest of its readings, or nothing."""
    reading, before = float(proximity.nearest[k]), int(proximity.seen_us[k])
    if not reading < math.inf:
        proximity.seen_us[k] = 0
        return
    dt = (time_us - before) * 1e-6
    if before > 0 and cutoff > 0.0 and time_us - before < OLD_US:
        reading = proximity.distance[k] + (reading - proximity.distance[k]) * dt / (dt + 1.0 / (TWO_PI * cutoff))
    proximity.distance[k] = reading
    proximity.angle[k] = proximity.nearest_angle[k]
    proximity.seen_us[k] = time_us


@law
def look(proximity: Proximity, sensors: Sensors, time_us: int, cutoff: float, p: ProximitySensor) -> None:
    """Take the vehicle's own lidar's last scan, once."""
    if sensors.lidar_count == proximity.scan or sensors.lidar_samples <= 0:
        return
    proximity.scan = sensors.lidar_count
    samples = min(sensors.lidar_samples, LIDAR_SAMPLES)
    begin_scan(proximity, sensors.lidar_min, sensors.lidar_max, p)
    step = sensors.lidar_fov / max(samples - 1, 1)
    for k in range(samples):
        # The first reading is the rightmost.
        note_reading(proximity, 0.5 * sensors.lidar_fov - k * step, float(sensors.lidar_ranges[k]), p)
    end_scan(proximity, time_us, cutoff)
