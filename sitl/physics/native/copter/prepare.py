# SPDX-License-Identifier: BSD-3-Clause
"""Figures that follow from a multicopter's figures; call again after changing any of them in the record."""

from __future__ import annotations

from ....core.kernels import law
from ..prepare import decay, prepare_shared
from ..tick import TICK_S


@law
def prepare(p):
    """Fill ``p.derived`` from ``p.airframe``."""
    a, d = p.airframe, p.derived
    dt = TICK_S / max(int(a.substeps), 1)
    d.dt = dt
    d.inverse_mass = 1.0 / float(a.mass)
    d.inverse_inertia[0], d.inverse_inertia[1] = 1.0 / a.inertia.x, 1.0 / a.inertia.y
    d.inverse_inertia[2] = 1.0 / a.inertia.z
    d.control_scale = 1.0 / (float(a.control_max) - float(a.control_min))
    d.command_step = float(a.command_slew) * TICK_S
    d.decay_up = decay(float(a.time_constant_up), dt)
    d.decay_down = decay(float(a.time_constant_down), dt)
    d.speed_per_volt = 0.0
    if a.speed_voltage > 0.0:
        d.speed_per_volt = float(a.speed_max) / float(a.speed_voltage)
    d.voltage_scale = 1.0 / float(a.battery_voltage_full)
    d.leg_release = 1.0 - decay(float(a.leg_time_constant), TICK_S)
    prepare_shared(p)
