# SPDX-License-Identifier: BSD-3-Clause
"""Battery: open-circuit voltage of the charge left, sag over the inner resistance, current of the load."""

from __future__ import annotations

from ...core.kernels import law

OPEN_CIRCUIT = (0.714, 0.845, 0.869, 0.895, 0.905, 0.919, 0.938, 0.957, 0.976, 0.990, 1.0)
"""Share of the full voltage at charge 0, 0.1 ... 1: a lithium-polymer cell (4.20, 3.86, 3.00 V)."""


@law
def open_circuit(charge):
    """Open-circuit voltage, as a share of the full one, at a charge of 0 .. 1."""
    place = min(max(charge, 0.0), 1.0) * 10.0
    k = min(int(place), 9)
    return OPEN_CIRCUIT[k] + (place - k) * (OPEN_CIRCUIT[k + 1] - OPEN_CIRCUIT[k])


@law
def update(p, power):
    """Draw the motors' power [W] for one tick."""
    a, b = p.airframe, p.battery
    full = float(a.battery_voltage_full)
    voltage = max(float(b.voltage), 0.1 * full)
    current = float(a.avionics_current) + power / voltage
    b.current = current
    if a.battery_capacity > 0.0:
        b.charge = max(float(b.charge) - current * float(p.derived.charge_per_amp), 0.0)
        b.voltage = max(full * open_circuit(float(b.charge)) - current * float(a.battery_resistance), 0.1 * full)
    else:
        b.voltage = full  # as ArduPilot's simulator without SIM_BATT_CAP_AH
