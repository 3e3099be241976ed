# SPDX-License-Identifier: BSD-3-Clause
"""Figures of the sensors that every autopilot has. All noise, biases and drifts are multiplied by noise_scale."""

from __future__ import annotations

import math

from ...core.records import Record
from ...core.vectors import Vec3
from .figure import figure


class Sensors(Record):
    """The sensors that every autopilot has."""

    noise_scale: float = figure("", "0 switches all errors off", 0.0, 100.0, 1.0)
    acc_noise_density: float = figure("m/s^2/sqrt(Hz)", "white noise of the accelerometer")
    acc_random_walk: float = figure("m/s^3/sqrt(Hz)", "of its in-run bias")
    acc_bias_time: float = figure("s", "correlation time of the in-run bias")
    acc_turn_on_bias: float = figure("m/s^2", "standard deviation")
    acc_scale_error: float = figure("", "standard deviation", default=0.0)
    acc_range: float = figure("m/s^2", "saturation")
    gyro_noise_density: float = figure("rad/s/sqrt(Hz)", "white noise of the gyro")
    gyro_random_walk: float = figure("rad/s^2/sqrt(Hz)", "of its in-run bias")
    gyro_bias_time: float = figure("s", "correlation time of the in-run bias")
    gyro_turn_on_bias: float = figure("rad/s", "standard deviation")
    gyro_scale_error: float = figure("", "standard deviation", default=0.0)
    gyro_range: float = figure("rad/s", "saturation")
    gps_rate: float = figure("Hz", "fixes a second", 0.1, 20.0)
    gps_delay: float = figure("s", "from the fix to the reader", 0.0, 0.35)
    gps_start: float = figure("s", "first message after boot")
    gps_fix_time: float = figure("s", "first 3D fix after boot")
    gps_noise_horizontal: float = figure("m", "white, standard deviation an axis")
    gps_noise_vertical: float = figure("m", "the same, vertical")
    gps_drift_horizontal: float = figure("m", "correlated error, standard deviation an axis")
    gps_drift_vertical: float = figure("m", "the same, vertical")
    gps_drift_time: float = figure("s", "correlation time of the drift")
    gps_velocity_noise_horizontal: float = figure("m/s", "white, standard deviation an axis")
    gps_velocity_noise_vertical: float = figure("m/s", "the same, vertical")
    gps_satellites: float = figure("", "satellites in view", 0, 255)
    gps_hdop: float = figure("", "horizontal dilution of precision", 0.0, 99.99)
    gps_vdop: float = figure("", "vertical dilution of precision", 0.0, 99.99)
    baro_rate: float = figure("Hz", "samples a second", 1.0, 200.0)
    baro_noise: float = figure("Pa", "white, standard deviation")
    baro_drift: float = figure("Pa", "correlated, standard deviation")
    baro_drift_time: float = figure("s", "correlation time of the drift")
    mag_rate: float = figure("Hz", "samples a second", 1.0, 200.0)
    mag_noise: float = figure("gauss", "white, standard deviation an axis")
    mag_offset: Vec3 = figure("gauss", "hard iron after calibration, body", -math.inf, default=(0.0, 0.0, 0.0))
