# SPDX-License-Identifier: BSD-3-Clause
"""What a vehicle's lidar and range-finder read in a world: OBSTACLE_DISTANCE, DISTANCE_SENSOR, the scan as floats."""

from __future__ import annotations

import math
import struct

from ..dialect import message
from .builder import Build, Builder, Context
from .units import DEG, boot_ms, uint16

S, A = "sensors.", "physics.airframe."
SECTORS = 72
"""Elements of OBSTACLE_DISTANCE."""
UNKNOWN = 65535
LASER, BODY_FRD, FACING_DOWN, COVARIANCE_UNKNOWN = 0, 12, 25, 255
PART = 58
"""Elements of DEBUG_FLOAT_ARRAY."""
PART_BYTES = 4 * PART
NANS = struct.pack(f"<{PART}f", *(math.nan,) * PART)
SCAN_NAME = b"LASER"


def centimetres(reading: float, longest: float) -> int:
    """A reading [m] in whole centimetres; nothing in range is a centimetre more than the range."""
    return uint16(reading * 100.0 + 0.5) if reading < longest else min(uint16(longest * 100.0 + 0.5) + 1, UNKNOWN - 1)


def sectors(ranges: tuple[float, ...], field_of_view: float) -> tuple[list[float], float, float]:
    """The readings clockwise: (nearest of each sector, angle of the first [deg], from one to the next [deg]).

    One reading is one sector, up to 72; of more readings each sector has the nearest.
    """
    clockwise, count = ranges[::-1], len(ranges)
    if count <= SECTORS:
        step = field_of_view / max(count - 1, 1)
        return list(clockwise), -0.5 * field_of_view * DEG if count > 1 else 0.0, step * DEG
    step = field_of_view / SECTORS
    nearest = [math.inf] * SECTORS
    for k, reading in enumerate(clockwise):
        place = min(k * SECTORS // (count - 1), SECTORS - 1)
        nearest[place] = min(nearest[place], reading)
    return nearest, (0.5 * step - 0.5 * field_of_view) * DEG, step * DEG


def obstacle_distance(context: Context) -> Build:
    """OBSTACLE_DISTANCE: the nearest reading of the lidar in each of up to 72 sectors [cm], clockwise, on the body;
    the range + 1 where there is none; nothing without a lidar or a world.
    """
    read = context.fields(S + "lidar_time_us", S + "lidar_count", S + "lidar_ranges")
    read_figures = context.fields(A + "lidar_samples", A + "lidar_fov", A + "lidar_min", A + "lidar_max")
    pack = message("OBSTACLE_DISTANCE").pack

    def build() -> bytes:
        t, count, *ranges = read()
        samples, field_of_view, least, longest = read_figures()
        if count == 0 or samples == 0:
            return b""
        nearest, first, step = sectors(tuple(ranges[:samples]), field_of_view)
        shown = [centimetres(reading, longest) for reading in nearest] + [UNKNOWN] * (SECTORS - len(nearest))
        limits = uint16(least * 100.0 + 0.5), uint16(longest * 100.0 + 0.5)
        return pack(t, *shown, *limits, LASER, min(int(step + 0.5), 255), step, first, BODY_FRD)

    return build


def distance_sensor(context: Context) -> Build:
    """DISTANCE_SENSOR: the range-finder that looks down [cm]; the range + 1 where it meets nothing; nothing without a
    range-finder or a world.
    """
    read = context.fields("time_us", S + "rangefinder_count", S + "rangefinder_range")
    read_figures = context.fields(A + "rangefinder_max", A + "rangefinder_min")
    pack = message("DISTANCE_SENSOR").pack

    def build() -> bytes:
        t, count, reading = read()
        if count == 0:
            return b""
        longest, least = read_figures()
        limits = uint16(least * 100.0 + 0.5), uint16(longest * 100.0 + 0.5)
        rest = (LASER, 0, FACING_DOWN, COVARIANCE_UNKNOWN, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0)
        return pack(boot_ms(t), *limits, centimetres(reading, longest), *rest)

    return build


def scan(context: Context) -> Build:
    """DEBUG_FLOAT_ARRAY: the whole scan of the lidar [m], "LASER", in parts of 58 counted by array_id from 0, from
    right to left; inf where it meets nothing, nan after the last reading; time of the scan; nothing without a lidar
    or a world.
    """
    read = context.fields(S + "lidar_time_us", S + "lidar_count")
    read_samples = context.fields(A + "lidar_samples")
    ranges = context.vehicle.v.sensors.lidar_ranges  # float32, as on the wire: readings are not looked at one by one
    head = struct.Struct("<QH10s").pack

    def build() -> bytes | tuple[bytes, ...]:
        t, count = read()
        if count == 0:
            return b""
        data = ranges[: read_samples()[0]].tobytes()
        firsts = range(0, len(data), PART_BYTES)
        return tuple(
            [
                head(t, k, SCAN_NAME) + data[first : first + PART_BYTES] + NANS[min(len(data) - first, PART_BYTES) :]
                for k, first in enumerate(firsts)
            ]
        )

    return build


BUILDERS: dict[str, Builder] = {
    "OBSTACLE_DISTANCE": obstacle_distance,
    "DISTANCE_SENSOR": distance_sensor,
    "DEBUG_FLOAT_ARRAY": scan,
}
