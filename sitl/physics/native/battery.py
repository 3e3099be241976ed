# SPDX-License-Identifier: BSD-3-Clause
"""Battery: open-circuit voltage of the charge left, sag over the inner resistance, current of the load."""

from __future__ import annotations

from ...core.constants import TICK_S
from ...core.kernels import law
from ...vehicles.properties.body import Battery
from .records import BatteryState

OPEN_CIRCUIT = (0.714, 0.845, 0.869, 0.895, 0.905, 0.919, 0.938, 0.957, 0.976, 0.990, 1.0)
"""Share of the full voltage at charge 0, 0.1 ... 1: a lithium-polymer cell (4.20, 3.86, 3.00 V).

The curve is that of a pack in use; below ``EMPTY`` it collapses.
"""
EMPTY = 0.02
"""Charge below which the open-circuit voltage falls linearly to 0, as an exhausted pack's does: nothing flies on it."""
LEAST = 0.1
"""Least voltage at the terminals, as a share of the full one: what divides by it stays finite. It gives about 1 % of
the thrust."""


@law
def open_circuit(charge: float) -> float:
    """Open-circuit voltage, as a share of the full one, at a charge of 0 .. 1."""
    index = min(max(charge, 0.0), 1.0) * 10.0
    k = min(int(index), 9)
    share = OPEN_CIRCUIT[k] + (index - k) * (OPEN_CIRCUIT[k + 1] - OPEN_CIRCUIT[k])
    if charge < EMPTY:
        share *= max(charge, 0.0) / EMPTY
    return share


@law
def sag(battery: BatteryState, airframe: Battery, charge_per_amp: float) -> None:
    """Of a rover: the inner resistance counts without a capacity, too, as in ArduPilot's simulator."""
    if battery.capacity <= 0.0 and charge_per_amp <= 0.0:
        full = battery.full_voltage if battery.full_voltage > 0.0 else airframe.battery_voltage_full
        battery.voltage = max(battery.voltage - battery.current * airframe.battery_resistance, LEAST * full)


@law
def discharge(battery: BatteryState, power: float, airframe: Battery, charge_per_amp: float) -> None:
    """Draw the motors' power [W] for one tick; ``charge_per_amp``: loss of charge (of 1) per ampere and tick [1/A]."""
    full = battery.full_voltage if battery.full_voltage > 0.0 else airframe.battery_voltage_full
    current = airframe.avionics_current + power / max(battery.voltage, LEAST * full)
    battery.current = current
    if battery.capacity > 0.0:
        charge_per_amp = TICK_S / (3600.0 * battery.capacity)
    if charge_per_amp > 0.0:
        resistance = airframe.battery_resistance + battery.resistance
        battery.charge = max(battery.charge - current * charge_per_amp, 0.0)
        battery.voltage = max(full * open_circuit(battery.charge) - current * resistance, LEAST * full)
    else:  # as ArduPilot's simulator without SIM_BATT_CAP_AH
        battery.voltage = max(full - current * battery.resistance, LEAST * full)
