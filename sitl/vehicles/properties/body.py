# SPDX-License-Identifier: BSD-3-Clause
"""Properties that every vehicle with an autopilot has: body, outline, battery, sensors.

All noise, biases and drifts are multiplied by noise_scale.
"""

from __future__ import annotations

import math

from ...core.records import Floats, Record
from ...core.vectors import Vec3
from .property import described


class Body(Record):
    """Every body."""

    mass: float = described("kg", "everything included", 0.001, 1e4)
    inertia: Vec3 = described("kg m^2", "about body x, y, z", 1e-9, 1e6)
    on_bench: int = described("", "1: stands on a bench that turns it as outputs 5 to 8 say", 0, 1, 0)


OUTLINE_DISCS = 3
"""Greatest number of discs that a vehicle's outline is made of."""


class Outline(Record):
    """What touches the solids of a world: upright discs, one behind the other."""

    contact_discs: int = described("", "how many of them", 1, OUTLINE_DISCS, 1)
    contact_along: Floats = described(
        "m", "their middles, forward of the origin", -100.0, 100.0, (0.0,) * OUTLINE_DISCS, count=OUTLINE_DISCS
    )
    contact_radius: float = described("m", "of each", 0.0, 100.0, 0.0)
    contact_top: float = described("m", "how far they reach above the origin", 0.0, 100.0, 0.0)
    contact_bottom: float = described("m", "how far they reach below the origin", 0.0, 100.0, 0.0)
    base_along: float = described(
        "m", "what start poses of a world mean, forward of the origin", -math.inf, default=0.0
    )


class Battery(Record):
    """The battery, and what draws on it besides the motors."""

    battery_voltage_full: float = described("V", "open circuit, full", 1.0, 1000.0)
    battery_capacity: float = described("Ah", "0: an ideal source of battery_voltage_full", default=0.0)
    battery_resistance: float = described("ohm", "inner resistance", default=0.0)
    avionics_current: float = described("A", "drawn by everything but the motors", default=0.0)


class Sensors(Record):
    """The sensors that every autopilot has."""

    noise_scale: float = described("", "0 switches all errors off", 0.0, 100.0, 1.0)
    acc_noise_density: float = described("m/s^2/sqrt(Hz)", "white noise of the accelerometer")
    acc_random_walk: float = described("m/s^3/sqrt(Hz)", "of its in-run bias")
    acc_bias_time: float = described("s", "correlation time of the in-run bias")
    acc_turn_on_bias: float = described("m/s^2", "standard deviation")
    acc_scale_error: float = described("", "standard deviation", default=0.0)
    acc_range: float = described("m/s^2", "saturation")
    gyro_noise_density: float = described("rad/s/sqrt(Hz)", "white noise of the gyro")
    gyro_random_walk: float = described("rad/s^2/sqrt(Hz)", "of its in-run bias")
    gyro_bias_time: float = described("s", "correlation time of the in-run bias")
    gyro_drift_speed: float = described(
        "rad/s^2", "steady change of the bias of all axes, which turns round", default=0.0
    )
    gyro_drift_time: float = described("s", "after which it turns round; 0: never", default=0.0)
    gyro_turn_on_bias: float = described("rad/s", "standard deviation")
    gyro_scale_error: float = described("", "standard deviation", default=0.0)
    gyro_range: float = described("rad/s", "saturation")
    gps_rate: float = described("Hz", "fixes a second", 0.1, 20.0)
    gps_delay: float = described("s", "from the fix to the reader", 0.0, 0.35)
    gps_start: float = described("s", "first message after boot")
    gps_fix_time: float = described("s", "first 3D fix after boot")
    gps_noise_horizontal: float = described("m", "white, standard deviation an axis")
    gps_noise_vertical: float = described("m", "the same, vertical")
    gps_drift_horizontal: float = described("m", "correlated error, standard deviation an axis")
    gps_drift_vertical: float = described("m", "the same, vertical")
    gps_drift_time: float = described("s", "correlation time of the drift")
    gps_velocity_noise_horizontal: float = described("m/s", "white, standard deviation an axis")
    gps_velocity_noise_vertical: float = described("m/s", "the same, vertical")
    gps_satellites: float = described("", "satellites in view", 0, 255)
    gps_hdop: float = described("", "horizontal dilution of precision", 0.0, 99.99)
    gps_vdop: float = described("", "vertical dilution of precision", 0.0, 99.99)
    baro_rate: float = described("Hz", "samples a second", 1.0, 200.0)
    baro_noise: float = described("Pa", "white, standard deviation")
    baro_drift: float = described("Pa", "correlated, standard deviation")
    baro_drift_time: float = described("s", "correlation time of the drift")
    mag_rate: float = described("Hz", "samples a second", 1.0, 200.0)
    mag_noise: float = described("gauss", "white, standard deviation an axis")
    mag_offset: Vec3 = described("gauss", "hard iron after calibration, body", -math.inf, default=(0.0, 0.0, 0.0))


LIDAR_SAMPLES = 360
"""Greatest number of published readings."""


class Ranging(Record):
    """Lidar and range-finder."""

    lidar_rays: int = described("", "rays cast; both ends of the field of view are rays", 0, 4096, 0)
    lidar_samples: int = described("", "readings published, of as many rays or more; 0 none", 0, LIDAR_SAMPLES, 0)
    lidar_fov: float = described("rad", "field of view, symmetric about straight ahead", 0.0, 2.0 * math.pi, 0.0)
    lidar_min: float = described("m", "least reading", 0.0, 10000.0, 0.0)
    lidar_max: float = described("m", "range; what is farther reads as nothing", 0.0, 600.0, 0.0)
    lidar_rate: float = described("Hz", "scans a second", 0.1, 400.0, 10.0)
    lidar_noise: float = described("m", "standard deviation of a reading", 0.0, 10.0, 0.0)
    lidar_at: Vec3 = described("m", "its position on the body: forward, right, down", -100.0, 100.0, (0.0, 0.0, 0.0))
    rangefinder_max: float = described("m", "range of the one that looks down; 0 none", 0.0, 600.0, 0.0)
    rangefinder_min: float = described("m", "least reading", 0.0, 10000.0, 0.0)
    rangefinder_rate: float = described("Hz", "readings a second", 0.1, 400.0, 10.0)
    rangefinder_noise: float = described("m", "standard deviation of a reading", 0.0, 10.0, 0.0)
    rangefinder_at: Vec3 = described("m", "its position on the body", -100.0, 100.0, (0.0, 0.0, 0.0))


class Properties(Body, Battery, Sensors, Outline, Ranging):
    """What all kinds have; each kind has more."""
