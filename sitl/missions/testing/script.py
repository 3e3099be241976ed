# SPDX-License-Identifier: BSD-3-Clause
"""What a test sent to its vehicle, byte for byte and when: nothing else decides what the vehicle did."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from sitl.bridge.links.inprocess import InProcessLink
from sitl.simulation import Simulation


class Said(NamedTuple):
    """Bytes of the client."""

    time_us: int
    data: bytes


class Script:
    """The client's end of the vehicle's link; it keeps what goes through."""

    def __init__(self, simulation: Simulation, link: InProcessLink) -> None:
        self._simulation, self._link = simulation, link
        self.said: list[Said] = []

    def send(self, data: bytes) -> None:
        """To the vehicle."""
        self.said.append(Said(self._simulation.time_us, bytes(data)))
        self._link.send(data)

    def receive(self) -> bytes:
        """From the vehicle."""
        return self._link.receive()


def repeat(
    simulation: Simulation,
    said: list[Said],
    end_us: int,
    prepare: Callable[[Simulation], None] = lambda simulation: None,
) -> None:
    """Fly a script once more, from power-on until ``end_us``.

    Args:
        simulation: at power-on, made as the first one was.
        prepare: called when the client's link is there, as it was in the test; it may add logs.
    """
    link = InProcessLink()
    simulation.bridge.add_link(link)
    prepare(simulation)
    for time_us, data in said:
        if time_us > simulation.time_us:
            simulation.advance_to(time_us)
            link.receive()  # nobody reads it
        link.send(data)
    simulation.advance_to(end_us)
