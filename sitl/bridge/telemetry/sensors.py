# SPDX-License-Identifier: BSD-3-Clause
"""Sensors as they measure: IMU, pressure, lidar and range-finder."""

from __future__ import annotations

import math
import struct

from ...core.algebra import euler_of
from ...core.constants import GRAVITY
from ...core.vectors import Quat
from ...physics.carried import MILLIG
from ..dialect import message
from .builder import DEG, Build, Builder, Context, boot_ms, int16, uint16

SENSORS_S = "sensors."
_IMU = (SENSORS_S + "acc", SENSORS_S + "gyro", SENSORS_S + "mag")


def _scaled(values: tuple[float, ...]) -> list[int]:
    """Specific force [mG], rates [mrad/s], field [mgauss]."""
    k = 1000.0 / GRAVITY
    return [int16(x * k) for x in values[:3]] + [int16(x * 1000.0) for x in values[3:9]]


def raw_imu(context: Context) -> Build:
    """RAW_IMU: mG, mrad/s, mgauss (ArduPilot sends scaled values here), centidegrees Celsius."""
    read = context.fields("time_us", *_IMU, SENSORS_S + "temperature")
    pack = message("RAW_IMU").pack

    def build() -> bytes:
        t, *imu, temperature = read()
        return pack(t, *_scaled(tuple(imu)), 0, int16(temperature * 100.0))

    return build


def scaled_imu(context: Context) -> Build:
    """SCALED_IMU: mG, mrad/s, mgauss."""
    read = context.fields("time_us", *_IMU, SENSORS_S + "temperature")
    pack = message("SCALED_IMU").pack

    def build() -> bytes:
        t, *imu, temperature = read()
        return pack(boot_ms(t), *_scaled(tuple(imu)), int16(temperature * 100.0))

    return build


def highres_imu(context: Context) -> Build:
    """HIGHRES_IMU: m/s^2, rad/s, gauss, hPa, pressure altitude in the standard atmosphere [m], degC."""
    read = context.fields("time_us", *_IMU, SENSORS_S + "abs_pressure", SENSORS_S + "temperature")
    pack = message("HIGHRES_IMU").pack
    all_but_differential_pressure = 0x1BFF

    def build() -> bytes:
        t, *imu, pressure, temperature = read()
        altitude = 44330.77 * (1.0 - math.pow(max(pressure, 0.0) / 1013.25, 0.1902632)) if pressure >= 0.0 else 0.0
        return pack(t, *imu, pressure, 0.0, altitude, temperature, all_but_differential_pressure, 0)

    return build


def scaled_pressure(context: Context) -> Build:
    """SCALED_PRESSURE: hPa, centidegrees Celsius."""
    read = context.fields("time_us", SENSORS_S + "abs_pressure", SENSORS_S + "temperature")
    pack = message("SCALED_PRESSURE").pack

    def build() -> bytes:
        t, pressure, temperature = read()
        return pack(boot_ms(t), pressure, 0.0, int16(temperature * 100.0), 0)

    return build


def simstate(context: Context) -> Build:
    """SIMSTATE: the simulator's truth: angles [rad], specific force [m/s^2] and rates [rad/s] of the body, degE7."""
    vehicle = context.vehicle
    pack = message("SIMSTATE").pack

    def build() -> bytes:
        truth = vehicle.truth()
        fx, fy, fz = truth.acceleration
        angles = euler_of(Quat(*truth.attitude))
        return pack(*angles, MILLIG * fx, MILLIG * fy, MILLIG * fz, *truth.rates, truth.lat, truth.lon)

    return build


RANGING_S, A = "sensors.", "physics.airframe."
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
    read = context.fields(RANGING_S + "lidar_time_us", RANGING_S + "lidar_count", RANGING_S + "lidar_ranges")
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
    read = context.fields("time_us", RANGING_S + "rangefinder_count", RANGING_S + "rangefinder_range")
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
    read = context.fields(RANGING_S + "lidar_time_us", RANGING_S + "lidar_count")
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
    "RAW_IMU": raw_imu,
    "SCALED_IMU": scaled_imu,
    "HIGHRES_IMU": highres_imu,
    "SCALED_PRESSURE": scaled_pressure,
    "SIMSTATE": simstate,
    "OBSTACLE_DISTANCE": obstacle_distance,
    "DISTANCE_SENSOR": distance_sensor,
    "DEBUG_FLOAT_ARRAY": scan,
}
