# SPDX-License-Identifier: BSD-3-Clause
"""What follows from a multicopter's properties; call again after changing any of them in the record."""

from __future__ import annotations

from ....core.constants import TICK_S
from ....core.kernels import law
from ....core.vectors import Vec3
from ....vehicles.properties.multicopter import Properties
from ..prepare import decay, prepare_shared
from .state import Derived


@law
def prepare(a: Properties, d: Derived) -> None:
    """Fill ``d`` from the airframe's properties."""
    dt = TICK_S / max(a.substeps, 1)
    d.dt = dt
    d.inverse_mass = 1.0 / a.mass
    d.inverse_inertia = Vec3(1.0 / a.inertia.x, 1.0 / a.inertia.y, 1.0 / a.inertia.z)
    d.control_scale = 1.0 / (a.control_max - a.control_min)
    d.command_step = a.command_slew * TICK_S
    d.decay_up = decay(d.motor_lag if d.motor_lag > 0.0 else a.time_constant_up, dt)
    d.decay_down = decay(d.motor_lag if d.motor_lag > 0.0 else a.time_constant_down, dt)
    d.speed_per_volt = 0.0
    if a.speed_voltage > 0.0:
        d.speed_per_volt = a.speed_max / a.speed_voltage
    d.voltage_scale = 1.0 / a.battery_voltage_full
    d.leg_release = 1.0 - decay(a.leg_time_constant, TICK_S)
    prepare_shared(a, d)
