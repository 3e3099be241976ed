# SPDX-License-Identifier: BSD-3-Clause
"""The boat's hull: its speed follows the throttle with a lag, its heading stays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from sitl.core.constants import TICK_S, TICK_US
from sitl.core.kernels import unit
from sitl.core.records import Record, Records
from sitl.core.vectors import Vec3
from sitl.physics.native import battery, records
from sitl.physics.native.power_on import Home, clear, place, wake
from sitl.physics.native.prepare import prepare_shared
from sitl.physics.native.sensors.sense import sense
from sitl.physics.native.tick import Clock
from sitl.vehicles import Airframe, sensor_sets
from sitl.vehicles.properties import body
from sitl.vehicles.properties.body import Battery, Body, Outline, Ranging, Sensors
from sitl.vehicles.properties.property import described, properties


class Motor(Record):
    """What drives it."""

    speed_max: float = described("m/s", "at full throttle", 0.1, 50.0)


class Properties(body.Properties, Body, Battery, Sensors, Outline, Ranging, Motor):
    """All properties of a boat."""


@dataclass(frozen=True, kw_only=True)
class BoatAirframe(Airframe):
    """A boat as data."""

    kind: ClassVar[str] = "boat"
    known = properties(Properties)
    dtype = Properties.dtype


class Hull(Record):
    """What only a boat has."""

    speed: float  # through the water [m/s]


class Physics(records.Physics):
    """The physics of a boat."""

    airframe: Properties
    hull: Hull


@unit
def step(fleet: Records[records.Vehicle[Physics]], i: int) -> None:
    """One tick: throttle in, sensors out. The boat heads north."""
    v = fleet[i]
    v.time_us += TICK_US
    v.tick += 1
    p = v.physics
    wanted = v.actuators.controls[0] * p.airframe.speed_max
    change = TICK_S * (wanted - p.hull.speed)
    p.hull.speed += change
    p.body.vel = Vec3(p.hull.speed, 0.0, 0.0)
    p.body.pos += TICK_S * p.body.vel
    p.body.specific_force = Vec3(change / TICK_S, 0.0, p.body.specific_force.z)
    battery.discharge(p.battery, 20.0, p.airframe, p.derived.charge_per_amp)
    sense(p, v.sensors, v.rng, Clock(v.tick, v.time_us))


def init(v: Any, airframe: BoatAirframe, home: Home, seed: int) -> None:
    """Power-on at home, heading north."""
    clear(v, airframe, seed)
    prepare_shared(v.physics.airframe, v.physics.derived)
    place(v.physics, (*home[:3], 0.0))
    wake(v)


AIRFRAME = BoatAirframe(
    name="dinghy",
    description="A dinghy with an electric motor",
    properties={
        "mass": 80.0,
        "inertia": (10.0, 40.0, 45.0),
        "speed_max": 4.0,
        "battery_voltage_full": 12.6,
        "battery_capacity": 50.0,
        "battery_resistance": 0.05,
        "avionics_current": 0.5,
        **sensor_sets.ADIS16448,
        **sensor_sets.UBLOX_M8,
        **sensor_sets.MS5611,
        **sensor_sets.HMC5883,
    },
)
