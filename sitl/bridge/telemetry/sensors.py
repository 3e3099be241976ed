# SPDX-License-Identifier: BSD-3-Clause
"""Sensors as measured: RAW_IMU, SCALED_IMU, HIGHRES_IMU, SCALED_PRESSURE; and truth: SIMSTATE."""

from __future__ import annotations

import math

from ...core.algebra import euler_of
from ...core.constants import GRAVITY
from ...core.vectors import Quat
from ...physics.carried import MILLIG
from ..dialect import message
from .builder import Build, Builder, Context
from .units import boot_ms, int16

S = "sensors."
_IMU = (S + "acc", S + "gyro", S + "mag")


def _scaled(values: tuple[float, ...]) -> list[int]:
    """Specific force [mG], rates [mrad/s], field [mgauss]."""
    k = 1000.0 / GRAVITY
    return [int16(x * k) for x in values[:3]] + [int16(x * 1000.0) for x in values[3:9]]


def raw_imu(context: Context) -> Build:
    """RAW_IMU: mG, mrad/s, mgauss (ArduPilot sends scaled values here), centidegrees Celsius."""
    read = context.fields("time_us", *_IMU, S + "temperature")
    pack = message("RAW_IMU").pack

    def build() -> bytes:
        t, *imu, temperature = read()
        return pack(t, *_scaled(tuple(imu)), 0, int16(temperature * 100.0))

    return build


def scaled_imu(context: Context) -> Build:
    """SCALED_IMU: mG, mrad/s, mgauss."""
    read = context.fields("time_us", *_IMU, S + "temperature")
    pack = message("SCALED_IMU").pack

    def build() -> bytes:
        t, *imu, temperature = read()
        return pack(boot_ms(t), *_scaled(tuple(imu)), int16(temperature * 100.0))

    return build


def highres_imu(context: Context) -> Build:
    """HIGHRES_IMU: m/s^2, rad/s, gauss, hPa, pressure altitude in the standard atmosphere [m], degC."""
    read = context.fields("time_us", *_IMU, S + "abs_pressure", S + "temperature")
    pack = message("HIGHRES_IMU").pack
    all_but_differential_pressure = 0x1BFF

    def build() -> bytes:
        t, *imu, pressure, temperature = read()
        altitude = 44330.77 * (1.0 - math.pow(max(pressure, 0.0) / 1013.25, 0.1902632)) if pressure >= 0.0 else 0.0
        return pack(t, *imu, pressure, 0.0, altitude, temperature, all_but_differential_pressure, 0)

    return build


def scaled_pressure(context: Context) -> Build:
    """SCALED_PRESSURE: hPa, centidegrees Celsius."""
    read = context.fields("time_us", S + "abs_pressure", S + "temperature")
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


BUILDERS: dict[str, Builder] = {
    "RAW_IMU": raw_imu,
    "SCALED_IMU": scaled_imu,
    "HIGHRES_IMU": highres_imu,
    "SCALED_PRESSURE": scaled_pressure,
    "SIMSTATE": simstate,
}
