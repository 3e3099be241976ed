# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle and its clients in the core: bytes are acted on, ticks go by, messages go out when they are due.

A firmware makes three units of these laws (``copter/core.py``): ``receive``, ``transmit`` and ``run``. All take the
address of the vehicle's ports, which lie side by side. Of a vehicle in a world, ``run`` takes the address of its
``Ranging``, too: lidar and range-finder measure, and solids are listed, while the core goes on.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple, TypeVar

from ...core.constants import NEVER, TICK_US
from ...core.kernels import law
from ...core.memory import bytes_at, record_at
from ...physics.native.ranging import Ranging, list_near, measure, scan_due
from ...vehicle.record import Vehicle
from ...vehicle.sampler import row_due, take_row
from .frames import COMPONENT, copy_payload, next_frame
from .port import INCOMING, PAYLOAD, PAYLOAD_BYTES, Port
from .spool import spill_all
from .streams import Builder, next_due, send, send_all_due

V = TypeVar("V", bound=Vehicle)
Advance = Callable[[Sequence[V], int, int], None]
Transmit = Callable[[Sequence[V], int, int, int, int], None]
REGULAR = -1
"""In place of a message's number: all that is due."""
Taker = Callable[[int, V, int, int], bool]


@law
def receive_port(v: V, address: int, take: Taker[V], targets: Callable[[int], int]) -> None:
    """Act on what a client sent, up to a frame that is the shell's: ``frame_end`` is 0 when there is none.

    Args:
        v: the vehicle.
        address: of the port.
        take: law that acts on a message by its number (``choose.choose_taker``); False: it is the shell's.
        targets: offset of target_system in a message that ``take`` knows, -1: it has none.
    """
    port = record_at(Port, address)
    port.frame_end = 0
    while next_frame(port, address):
        taken = port.frame_sender == (port.system << 8 | COMPONENT)  # our own words
        if not taken:
            incoming, payload = bytes_at(address + INCOMING, port.in_size), bytes_at(address + PAYLOAD, PAYLOAD_BYTES)
            copy_payload(incoming, port.frame_payload, port.frame_payload_size, payload)
            target = targets(port.frame_number)
            system = port.payload[target] if target >= 0 else 0
            if system == 0 or system == port.system:
                taken = take(port.frame_number, v, port.frame_sender >> 8, address + PAYLOAD)
                port.taken += 1 if taken else 0
            else:
                taken = True
        port.frame_taken = taken
        if not taken or port.stops_at_frames:
            return
        port.frame_end = 0
    keep_rest(port, address)


@law
def keep_rest(port: Port, address: int) -> None:
    """Move what is left of the bytes that came in to the beginning."""
    incoming = bytes_at(address + INCOMING, port.in_size)
    left = port.in_size - port.in_at
    for k in range(left):
        incoming[k] = incoming[port.in_at + k]
    port.in_size = left
    port.in_at = 0


class Links(NamedTuple):
    """The ports of a vehicle's clients."""

    address: int
    """Of the first; the others follow."""
    clients: int


class Instruments(NamedTuple):
    """What a vehicle measures and logs with, by address."""

    ranging: int
    """Its ``Ranging``; 0: it is in no world."""
    sampler: int
    """The ``Sampler`` of its log (``sitl.vehicle.sampler``); 0: the core takes no rows."""


class Limits(NamedTuple):
    """How far a run goes."""

    until_us: int
    """The first tick at or after this is the last one [us since boot]."""
    shell_us: int
    """When the shell has to act before messages are sent [us since boot]."""


@law
def run_vehicle(
    fleet: Sequence[V],
    index: int,
    links: Links,
    instruments: Instruments,
    limits: Limits,
    advance: Advance[V],
    transmit: Transmit[V],
) -> None:
    """Advance to the first tick at or after ``until_us``, measuring and then sending what falls due.

    Back early, at the end of the tick, when something happened that the shell must know, when a message is due that the
    core cannot send, and when what goes out, or what is logged, needs space.

    Args:
        fleet: the vehicle's fleet.
        index: of the vehicle.
        links: its clients.
        instruments: what it measures and logs with.
        limits: when to stop.
        advance: unit that goes on by some ticks.
        tell: unit that sends what is due.
    """
    v, ranging, sampler = fleet[index], instruments.ranging, instruments.sampler
    events, obstacles = v.autopilot.events, v.physics.obstacles
    before = events.count
    while True:
        if obstacles.wanted and ranging != 0:
            list_near(fleet, index, ranging)
            events.attention = False
        due = measurement_due(v, ranging)
        stop = min(min(limits.until_us, due), min(row_due(sampler), next_due(links.address, links.clients)))
        ticks = (stop - v.time_us + TICK_US - 1) // TICK_US
        advance(fleet, index, max(ticks, 1))
        if due <= v.time_us:
            measure(fleet, index, ranging)
        if wants_shell(v, ranging) or events.count != before or v.time_us >= limits.shell_us:
            return
        has_space = True
        if next_due(links.address, links.clients) <= v.time_us:
            transmit(fleet, index, links.address, links.clients, REGULAR)
            has_space = spill_all(links.address, links.clients, v.time_us)
            if next_due(links.address, links.clients) <= v.time_us:
                return
        if row_due(sampler) <= v.time_us and not take_row(sampler, v.time_us):
            return
        if not has_space:
            return
        if v.time_us >= limits.until_us:
            return


@law
def wants_shell(v: Vehicle, ranging: int) -> bool:
    """Whether the core came back for the shell, and not for another list of near solids."""
    return v.autopilot.events.attention and not (v.physics.obstacles.wanted and ranging != 0)


@law
def measurement_due(v: Vehicle, ranging: int) -> int:
    """When lidar or range-finder have to measure next [us since boot]."""
    return scan_due(v, record_at(Ranging, ranging)) if ranging != 0 else NEVER


@law
def transmit_links(v: V, links: Links, number: int, build: Builder) -> None:
    """Send all that is due to every client, or the message ``number`` to the first."""
    if number == REGULAR:
        send_all_due(v, links.address, links.clients, build)
    else:
        send(v, record_at(Port, links.address), links.address, number, build)
