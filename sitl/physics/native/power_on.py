# SPDX-License-Identifier: BSD-3-Clause
"""Power-on of what every vehicle has: it stands at its home, its sensors have the biases of this seed."""

from __future__ import annotations

import math

from ...core import rng as random
from ...core.algebra import ZERO
from ...core.border import Sensors
from ...core.constants import GRAVITY
from ...core.earth_field import field_ned
from ...core.elementary import cos, sin
from ...core.rng import Rng
from ...core.vectors import Quat, Vec3
from ...vehicles import Airframe, apply
from ...vehicles.properties.body import Sensors as SensorProperties
from . import atmosphere, wind
from .records import Physics, SensorState, Vehicle
from .sensors import barometer, magnetometer, power

Home = tuple[float, float, float, float]
"""Latitude [deg], longitude [deg], altitude above mean sea level [m], heading [deg]."""

DEFAULT_HOME: Home = (-35.363262, 149.165237, 584.0, 353.0)
"""Canberra model aircraft club, ArduPilot's default SITL location."""
WIND_SETTINGS = (
    "speed", "direction", "turbulence", "time_constant", "is_shaped", "is_shared", "profile", "full_height", "gain",
    "elevation",
)  # fmt: skip


def clear(v: Vehicle[Physics], airframe: Airframe, seed: int) -> None:
    """Empty physics, sensors, actuators and clock, but for the wind's settings; properties and random numbers start."""
    w = v.physics.wind
    setting = {name: getattr(w, name) for name in WIND_SETTINGS}
    v.zero("physics", "sensors", "actuators", "time_us", "tick")
    random.seed(v.rng, seed)
    apply(airframe, v)
    for name, value in setting.items():
        setattr(w, name, value)


def place(p: Physics, home: Home) -> None:
    """Stand level and still at home, nose along its heading."""
    lat, lon, alt, heading = home
    p.origin.lat, p.origin.lon = round(lat * 1e7), round(lon * 1e7)
    p.origin.alt = alt
    p.origin.field = Vec3(*field_ned(lat, lon))
    b, half = p.body, 0.5 * math.radians(heading)
    b.pos = b.vel = b.rates = b.rates_mean = b.acc_ned = ZERO
    b.q = Quat(cos(half), 0.0, 0.0, sin(half))
    b.specific_force = Vec3(0.0, 0.0, -GRAVITY)


def wake(v: Vehicle[Physics]) -> None:
    """Battery, wind and air as they are at this position; sensor errors are drawn and first samples taken."""
    p, w = v.physics, v.physics.wind
    p.battery.charge = 1.0
    p.battery.voltage = p.airframe.battery_voltage_full
    p.battery.current = p.airframe.avionics_current
    w.steady = w.vel = wind.aim(w, -p.body.pos.z)
    atmosphere.set_air(p.air, p.origin.alt - p.body.pos.z)
    draw_errors(p.sensors, p.airframe, v.rng)
    first_samples(p, v.sensors, v.rng)


def draw_errors(s: SensorState, a: SensorProperties, rng: Rng) -> None:
    """Draw what stays from power-on to power-off: turn-on biases, scale errors and where the drifts start."""
    draws = [[random.normal(rng) for _ in range(5)] for _ in range(3)]  # axis by axis
    acc_bias, gyro_bias, acc_scale, gyro_scale, drift = (Vec3(*axes) for axes in zip(*draws, strict=True))
    scale, one = a.noise_scale, Vec3(1.0, 1.0, 1.0)
    s.acc_bias = scale * a.acc_turn_on_bias * acc_bias
    s.gyro_bias = scale * a.gyro_turn_on_bias * gyro_bias
    s.acc_scale = one + scale * a.acc_scale_error * acc_scale
    s.gyro_scale = one + scale * a.gyro_scale_error * gyro_scale
    s.gps[0].drift = drift
    s.baro_drift = random.normal(rng)


def first_samples(p: Physics, sensors: Sensors, rng: Rng) -> None:
    """What the sensors show before the first tick (no GPS yet)."""
    sensors.acc = p.body.specific_force
    magnetometer.sample(p, sensors, rng, 0)
    barometer.sample(p, sensors, rng)
    power.sample(p.battery, sensors)
