# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles with their clients in the core; one that needs the shell stops, and the others go on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

from ...core.array_kernels import IntColumn
from ...core.kernels import law
from ...core.memory import call_unit, ints_at, record_at
from ...core.records import Record
from ...vehicle.record import Vehicle
from .link import wants_shell
from .port import SIZE, Port
from .streams import next_due

V = TypeVar("V", bound=Vehicle)


GOES_ON, TO_HEAR, TO_SERVE = 0, 1, 2
"""A client's words are the shell's; so is what happened, or what is due."""
STAYS = -1
"""In place of a time: the vehicle stays as it is."""


class Slot(Record):
    """How far a vehicle is to go, and what its owner keeps of it besides its record and its ports."""

    until_us: int  # where it is to go on to [us since boot], or STAYS
    shell_us: int  # when the shell has something to do [us since boot]
    events_seen: int  # events that the shell has acted on
    needs_shell: int  # GOES_ON, or what the core has left to it
    ports: int  # address of its clients' ports
    clients: int


@law
def receive_clients(
    fleet: Sequence[V], index: int, slot: Slot, ranging: int, receive: Callable[[Sequence[V], int, int], None]
) -> bool:
    """Let a vehicle act on what its clients sent; False: the shell has to act before it goes on."""
    v = fleet[index]
    for k in range(slot.clients):
        port = record_at(Port, slot.ports + k * SIZE)
        if port.in_size > 0:
            receive(fleet, index, slot.ports + k * SIZE)
            if port.frame_end != 0 or v.autopilot.events.count != slot.events_seen:
                return False
    return v.autopilot.events.count == slot.events_seen and not wants_shell(v, ranging)


@law
def run_slot(
    fleet: Sequence[V],
    index: int,
    ranging: int,
    slot: Slot,
    receive: Callable[[Sequence[V], int, int], None],
    run: Callable[[Sequence[V], int, int, int, int, int, int, int], None],
) -> None:
    """Let one vehicle act on what its clients sent and go on to ``slot.until_us``."""
    v = fleet[index]
    slot.needs_shell = GOES_ON
    if not receive_clients(fleet, index, slot, ranging, receive):
        slot.needs_shell = TO_HEAR
    elif v.time_us < slot.until_us:
        shell_us = slot.shell_us
        run(fleet, index, slot.ports, slot.clients, ranging, 0, min(slot.until_us, shell_us), shell_us)
        happened = v.autopilot.events.count != slot.events_seen or wants_shell(v, ranging)
        is_behind = next_due(slot.ports, slot.clients) <= v.time_us
        if happened or is_behind or not slot.until_us <= v.time_us < shell_us:
            slot.needs_shell = TO_SERVE


@law
def run_slots(
    fleet: Sequence[V],
    first: int,
    last: int,
    slots: int,
    ranging: int,
    receive: Callable[[Sequence[V], int, int], None],
    run: Callable[[Sequence[V], int, int, int, int, int, int, int], None],
) -> None:
    """The same for vehicles ``first`` .. ``last`` - 1; those whose ``until_us`` is STAYS excepted.

    Args:
        fleet: the vehicles.
        first, last: of them.
        slots: address of one ``Slot`` for each vehicle.
        ranging: address of the ``Ranging`` of their world, for one thread; 0: there is none.
        hear: unit that acts on a client's bytes.
        run: unit that advances.
    """
    for index in range(first, last):
        slot = record_at(Slot, slots + index * SLOT_SIZE)
        if slot.until_us == STAYS:
            slot.needs_shell = GOES_ON
        else:
            run_slot(fleet, index, ranging, slot, receive, run)


@law
def set_goals(times: IntColumn, until: IntColumn, step_us: int) -> None:
    """Let each vehicle go on for a time [us]; ``until`` is the slots' ``until_us``, shape (count,)."""
    for k in range(times.shape[0]):
        until[k] = times[k] + step_us


@law
def any_waits(needs_shell: IntColumn) -> bool:
    """Whether any vehicle needs the shell; ``needs_shell`` is the slots', shape (count,)."""
    for k in range(needs_shell.shape[0]):  # noqa: SIM110 - laws know no generators
        if needs_shell[k] != GOES_ON:
            return True
    return False


@law
def run_fleet(unit: int, vehicles: int, size: int, count: int, slots: int, ranging: int, step_us: int) -> bool:
    """Let all vehicles of a fleet go on, in one thread; whether any of them needs the shell.

    Args:
        unit: address of ``run_all`` of their kind.
        vehicles: address of their records, whose first number is the time since boot.
        size: of a record [bytes].
        count: of the vehicles.
        slots: address of one ``Slot`` for each vehicle.
        ranging: address of the ``Ranging`` of their world; 0: there is none.
        step_us: for how long; STAYS: as the slots say.
    """
    if step_us != STAYS:
        for k in range(count):
            record_at(Slot, slots + k * SLOT_SIZE).until_us = ints_at(vehicles + k * size, 1)[0] + step_us
    call_unit(unit, vehicles, count, 0, count, slots, ranging)
    for k in range(count):  # noqa: SIM110 - laws know no generators
        if record_at(Slot, slots + k * SLOT_SIZE).needs_shell != GOES_ON:
            return True
    return False


SLOT_SIZE = Slot.dtype.itemsize
