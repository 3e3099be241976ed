# SPDX-License-Identifier: BSD-3-Clause
"""Many vehicles with a client each in the core; one that needs the shell stops, and the others go on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple, TypeVar

from ...core.kernels import law
from ...core.memory import record_at
from ...core.records import Record
from ...vehicle.record import Vehicle
from .link import wants_shell
from .port import SIZE, Port

V = TypeVar("V", bound=Vehicle)


GOES_ON, TO_HEAR, TO_SERVE = 0, 1, 2
"""A client's words are the shell's; so is what happened, or what is due."""
STAYS = -1
"""In place of a time: the vehicle stays as it is."""


class Slot(Record):
    """What a fleet keeps of a vehicle besides its record and its port."""

    until_us: int  # where it is to go on to [us since boot], or STAYS
    shell_us: int  # when the shell has something to do [us since boot]
    events_seen: int  # events that the shell has acted on
    needs_shell: int  # GOES_ON, or what the core has left to it


class Beside(NamedTuple):
    """What lies beside the vehicles' records, by address."""

    ports: int
    """One ``Port`` for each vehicle."""
    slots: int
    """One ``Slot`` for each vehicle."""
    ranging: int
    """The ``Ranging`` of their world, for one thread; 0: there is none."""


@law
def run_slot(
    fleet: Sequence[V],
    index: int,
    port_address: int,
    ranging: int,
    slot: Slot,
    hear: Callable[[Sequence[V], int, int], None],
    run: Callable[[Sequence[V], int, int, int, int, int, int, int], None],
) -> None:
    """Let one vehicle act on what its client sent and go on to ``slot.until_us``."""
    v, port = fleet[index], record_at(Port, port_address)
    events = v.autopilot.events
    if port.in_size > 0:
        hear(fleet, index, port_address)
    slot.needs_shell = GOES_ON
    if port.frame_end != 0 or events.count != slot.events_seen or wants_shell(v, ranging):
        slot.needs_shell = TO_HEAR
    elif v.time_us < slot.until_us:
        run(fleet, index, port_address, 1, ranging, 0, min(slot.until_us, slot.shell_us), slot.shell_us)
        happened = events.count != slot.events_seen or wants_shell(v, ranging)
        if happened or not slot.until_us <= v.time_us < slot.shell_us or port.next_us <= v.time_us:
            slot.needs_shell = TO_SERVE


@law
def run_slots(
    fleet: Sequence[V],
    first: int,
    last: int,
    beside: Beside,
    hear: Callable[[Sequence[V], int, int], None],
    run: Callable[[Sequence[V], int, int, int, int, int, int, int], None],
) -> None:
    """The same for vehicles ``first`` .. ``last`` - 1; those whose ``until_us`` is STAYS excepted."""
    for index in range(first, last):
        slot = record_at(Slot, beside.slots + index * SLOT_SIZE)
        if slot.until_us != STAYS:
            run_slot(fleet, index, beside.ports + index * SIZE, beside.ranging, slot, hear, run)


SLOT_SIZE = Slot.dtype.itemsize
