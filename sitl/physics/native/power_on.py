# SPDX-License-Identifier: BSD-3-Clause
"""Power-on of what every vehicle has: it stands at its home, its sensors have the biases of this seed."""

from __future__ import annotations

import math
from typing import Any

from ...core import rng as random
from ...core.earth_field import field_ned
from ...vehicles import Airframe, apply
from . import atmosphere, wind
from .body import GRAVITY
from .sensors import barometer, magnetometer, power

_WIND_SETTING = ("speed", "direction", "turbulence", "time_constant")

Home = tuple[float, float, float, float]
"""Latitude [deg], longitude [deg], altitude above mean sea level [m], heading [deg]."""

DEFAULT_HOME: Home = (-35.363262, 149.165237, 584.0, 353.0)
"""Canberra model aircraft club, ArduPilot's default SITL location."""


def clear(v: Any, airframe: Airframe, seed: int) -> None:
    """Empty physics, sensors, actuators and clock, but for the wind's settings; figures and random numbers start."""
    setting = {name: float(v.physics.wind[name]) for name in _WIND_SETTING}
    v.zero("physics", "sensors", "actuators", "time_us", "tick")
    random.seed(v.rng, seed)
    apply(airframe, v)
    for name, value in setting.items():
        v.physics.wind[name] = value


def place(p: Any, home: Home) -> None:
    """Stand level and still at home, nose along its heading."""
    lat, lon, alt, heading = home
    p.place.lat, p.place.lon = round(lat * 1e7), round(lon * 1e7)
    p.place.alt = alt
    p.place.field = field_ned(lat, lon)
    b, half = p.body, 0.5 * math.radians(heading)
    b.pos = b.vel = b.rates = b.rates_mean = b.acc_ned = 0.0
    b.q = (math.cos(half), 0.0, 0.0, math.sin(half))
    b.specific_force = (0.0, 0.0, -GRAVITY)


def wake(v: Any) -> None:
    """Battery, wind and air as they are at this place; sensor errors are drawn and first samples taken."""
    p = v.physics
    p.battery.charge = 1.0
    p.battery.voltage = p.airframe.battery_voltage_full
    p.battery.current = p.airframe.avionics_current
    north, east = wind.target(p.wind)
    p.wind.steady = p.wind.vel = (north, east, 0.0)
    atmosphere.update(p)
    draw_errors(p, v.rng)
    first_samples(p, v.sensors, v.rng)


def draw_errors(p: Any, rng: Any) -> None:
    """Draw what stays from power-on to power-off: turn-on biases, scale errors and where the drifts start."""
    a, s = p.airframe, p.sensors
    scale = float(a.noise_scale)
    for j in range(3):
        s.acc_bias[j] = scale * a.acc_turn_on_bias * random.normal(rng)
        s.gyro_bias[j] = scale * a.gyro_turn_on_bias * random.normal(rng)
        s.acc_scale[j] = 1.0 + scale * a.acc_scale_error * random.normal(rng)
        s.gyro_scale[j] = 1.0 + scale * a.gyro_scale_error * random.normal(rng)
        s.gps_drift[j] = random.normal(rng)
    s.baro_drift = random.normal(rng)


def first_samples(p: Any, sensors: Any, rng: Any) -> None:
    """What the sensors show before the first tick (no GPS yet)."""
    sensors.acc = p.body.specific_force
    magnetometer.sample(p, sensors, rng)
    barometer.sample(p, sensors, rng)
    power.sample(p, sensors)
