# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles of a fleet that are in different worlds: each measures with a record of its own."""

from __future__ import annotations

from typing import NamedTuple

from ...core.kernels import law
from ...core.memory import call_unit, ints_at, record_at
from .fleet import GOES_ON, SLOT_SIZE, STAYS, Slot


class Vehicles(NamedTuple):
    """The vehicles of a fleet."""

    unit: int
    """Address of ``run_all`` of their kind."""
    records: int
    """Address of their records, whose first number is the time since boot."""
    size: int
    """Of a record [bytes]."""
    total: int
    """Their number."""


@law
def run_in_worlds(
    vehicles: Vehicles, first: int, count: int, slots: int, ranging: int, ranging_size: int, step_us: int
) -> bool:
    """Let vehicles ``first`` .. ``first + count`` - 1 of a fleet go on, in one thread; whether any of them needs the
    shell.

    Args:
        vehicles: of the fleet.
        first, count: of those that go on.
        slots: address of one ``Slot`` for each vehicle.
        ranging: address of one ``Ranging`` for each vehicle.
        ranging_size: of one [bytes].
        step_us: for how long; STAYS: as the slots say.
    """
    waits = False
    for k in range(first, first + count):
        slot = record_at(Slot, slots + k * SLOT_SIZE)
        if step_us != STAYS:
            slot.until_us = ints_at(vehicles.records + k * vehicles.size, 1)[0] + step_us
        call_unit(vehicles.unit, vehicles.records, vehicles.total, k, k + 1, slots, ranging + k * ranging_size)
        waits = waits or slot.needs_shell != GOES_ON
    return waits
