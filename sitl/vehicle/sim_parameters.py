# SPDX-License-Identifier: BSD-3-Clause
"""What the SIM_ parameters do to the simulated world: wind and faults, at power-on and in flight."""

from __future__ import annotations

from collections.abc import Callable

from .record import Vehicle

PREFIX = "SIM_"
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


def acts_on_the_world(parameter: str) -> bool:
    """Whether a parameter belongs to the simulated world, not to the firmware."""
    return parameter.startswith((PREFIX, *_registered))


def apply(v: Vehicle) -> None:
    """Bring what every kind of vehicle has in line with its SIM_ parameters, and with those of other packages."""
    sim, physics, wind = v.autopilot.params.SIM, v.physics, v.physics.wind
    wind.speed, wind.direction = sim.WIND_SPD, sim.WIND_DIR
    wind.turbulence, wind.time_constant = sim.WIND_TURB, sim.WIND_TC
    physics.sensors.gps_off = sim.GPS1_ENABLE == 0
    v.autopilot.rc.has_receiver = sim.RC_FAIL == 0
    for fault in _registered.values():
        fault(v)
