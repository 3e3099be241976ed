# SPDX-License-Identifier: BSD-3-Clause
"""Figures of the sensors that every autopilot has. All noise, biases and drifts are multiplied by noise_scale."""

from __future__ import annotations

import math

from .figure import Figure

SENSORS = (
    Figure("noise_scale", "", "0 switches all errors off", 0.0, 100.0, 1.0),
    Figure("acc_noise_density", "m/s^2/sqrt(Hz)", "white noise of the accelerometer"),
    Figure("acc_random_walk", "m/s^3/sqrt(Hz)", "of its in-run bias"),
    Figure("acc_bias_time", "s", "correlation time of the in-run bias"),
    Figure("acc_turn_on_bias", "m/s^2", "standard deviation"),
    Figure("acc_scale_error", "", "standard deviation", default=0.0),
    Figure("acc_range", "m/s^2", "saturation"),
    Figure("gyro_noise_density", "rad/s/sqrt(Hz)", "white noise of the gyro"),
    Figure("gyro_random_walk", "rad/s^2/sqrt(Hz)", "of its in-run bias"),
    Figure("gyro_bias_time", "s", "correlation time of the in-run bias"),
    Figure("gyro_turn_on_bias", "rad/s", "standard deviation"),
    Figure("gyro_scale_error", "", "standard deviation", default=0.0),
    Figure("gyro_range", "rad/s", "saturation"),
    Figure("gps_rate", "Hz", "fixes a second", 0.1, 20.0),
    Figure("gps_delay", "s", "from the fix to the reader", 0.0, 0.35),
    Figure("gps_start", "s", "first message after boot"),
    Figure("gps_fix_time", "s", "first 3D fix after boot"),
    Figure("gps_noise_horizontal", "m", "white, standard deviation an axis"),
    Figure("gps_noise_vertical", "m", "the same, vertical"),
    Figure("gps_drift_horizontal", "m", "correlated error, standard deviation an axis"),
    Figure("gps_drift_vertical", "m", "the same, vertical"),
    Figure("gps_drift_time", "s", "correlation time of the drift"),
    Figure("gps_velocity_noise_horizontal", "m/s", "white, standard deviation an axis"),
    Figure("gps_velocity_noise_vertical", "m/s", "the same, vertical"),
    Figure("gps_satellites", "", "satellites in view", 0, 255),
    Figure("gps_hdop", "", "horizontal dilution of precision", 0.0, 99.99),
    Figure("gps_vdop", "", "vertical dilution of precision", 0.0, 99.99),
    Figure("baro_rate", "Hz", "samples a second", 1.0, 200.0),
    Figure("baro_noise", "Pa", "white, standard deviation"),
    Figure("baro_drift", "Pa", "correlated, standard deviation"),
    Figure("baro_drift_time", "s", "correlation time of the drift"),
    Figure("mag_rate", "Hz", "samples a second", 1.0, 200.0),
    Figure("mag_noise", "gauss", "white, standard deviation an axis"),
    Figure("mag_offset", "gauss", "hard iron after calibration, body", -math.inf, default=(0.0, 0.0, 0.0), length=3),
)
