# SPDX-License-Identifier: BSD-3-Clause
"""What the SIM_ parameters do to the simulated world: wind and faults, at power-on and in flight."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..autopilot.params.simulation import Axes
from ..core.vectors import Vec3
from .record import Vehicle

PREFIX = "SIM_"
DEFAULT_VOLTAGE = float(np.float32(12.6))
"""SIM_BATT_VOLTAGE that leaves the airframe's battery as it is [V]."""
Fault = Callable[[Vehicle], None]
"""Brings the physics or the sensors of a vehicle in line with its parameters."""

_registered: dict[str, Fault] = {}


def register_fault(prefix: str, apply: Fault) -> None:
    """Make a fault of another package known in this process.

    Args:
        prefix: of its parameters (``sitl.autopilot.params.registered``): whenever one is set, ``apply`` is called.
        apply: called at power-on, too.
    """
    _registered[f"{prefix}_"] = apply


def axes(group: Axes) -> Vec3:
    """Three parameters as a vector."""
    return Vec3(group.X, group.Y, group.Z)


def acts_on_the_world(parameter: str) -> bool:
    """Whether a parameter belongs to the simulated world, not to the firmware."""
    return parameter.startswith((PREFIX, *_registered))


def apply(v: Vehicle) -> None:
    """Bring what every kind of vehicle has in line with its SIM_ parameters, and with those of other packages."""
    sim, physics, wind = v.autopilot.params.SIM, v.physics, v.physics.wind
    wind.speed, wind.direction = sim.WIND_SPD, sim.WIND_DIR
    wind.turbulence, wind.time_constant = sim.WIND_TURB, sim.WIND_TC
    physics.sensors.gps_off = sim.GPS1_ENABLE == 0 or sim.GPS1_TYPE == 0
    physics.sensors.gps_jammed = sim.GPS1_JAM != 0
    physics.sensors.acc_fault = axes(sim.ACC1_BIAS)
    physics.sensors.mag2_offset, physics.sensors.mag3_offset = 1e-3 * axes(sim.MAG2.OFS), 1e-3 * axes(sim.MAG3.OFS)
    physics.battery.full_voltage = 0.0 if sim.BATT_VOLTAGE == DEFAULT_VOLTAGE else sim.BATT_VOLTAGE
    if v.tick == 0 and sim.BARO_COUNT < 1:
        physics.sensors.baro_missing = True
        v.sensors.baro_count = 0
    v.autopilot.rc.has_receiver = sim.RC_FAIL == 0
    for fault in _registered.values():
        fault(v)
