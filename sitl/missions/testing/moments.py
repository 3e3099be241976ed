# SPDX-License-Identifier: BSD-3-Clause
"""A client whose bytes are kept, with their times, so that its flight can be flown again; and other futures of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, NamedTuple, NoReturn

from sitl import client
from sitl.autopilot.params.parameter import stored
from sitl.bridge.links import LinkFaults
from sitl.bridge.links.inprocess import InProcessLink
from sitl.client.connection import Connection, InProcess
from sitl.client.errors import ClientError
from sitl.client.session import RATES_HZ
from sitl.errors import OptionError
from sitl.plants.plant import is_remote
from sitl.simulation import Simulation
from sitl.vehicle.faults import Failure
from sitl.vehicle.ordered_faults import OrderedFaults, Repair


class Said(NamedTuple):
    """Bytes of the client, a fault that was ordered; without either, faults that its link has from then on."""

    time_us: int
    data: bytes
    faults: LinkFaults | None = None
    fault: str = ""
    """As ``Simulation.order_fault`` takes it."""


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
    for time_us, data, faults, fault in said:
        if time_us > simulation.time_us:
            simulation.advance_to(time_us)
            link.receive()  # nobody reads it
        if data:
            link.send(data)
        elif fault:
            simulation.order_fault(fault)
        else:
            simulation.set_link_faults(faults, link)
    simulation.advance_to(end_us)


__tracebackhide__ = True  # failures show the line of the test


@dataclass(frozen=True)
class RecordedMoment:
    """A vehicle at one moment, with all that its client knows and has sent."""

    vehicle: client.Moment
    said: tuple[Said, ...]


@dataclass
class Kept:
    """What of a fork that went wrong is kept for the logs."""

    error: BaseException
    said: list[Said]
    end_us: int


class Forking(client.Client):
    """A vehicle that can be put back. What goes wrong fails the test: it raises AssertionError.

    Args:
        build: makes the simulation, at power-on; called again whenever the flight is flown again for its logs. Or makes
            a connection to another autopilot, whose flight cannot be flown again.
        name: for messages and files.
    """

    failed_fork: Kept | None = None
    """What went wrong in a fork."""

    def __init__(self, build: Callable[[], Simulation | Connection], name: str = "vehicle") -> None:
        self.build = build
        self._faults: OrderedFaults | None = None
        """Of another autopilot."""
        made = build()
        connection = made if isinstance(made, Connection) else InProcess(made)
        rates = None
        if connection.simulation is not None:
            self.script = connection.endpoint.link = Script(connection.simulation, connection.endpoint.link)
        else:
            rates = {**RATES_HZ, "MISSION_CURRENT": 10}  # ours reports it without being asked
        super().__init__(connection, name=name, rates=rates)

    @property
    def cannot_repeat(self) -> str:
        """Why its flight cannot be flown again; "": it can."""
        simulation = self.connection.simulation
        if simulation is None:
            return f"autopilot {self.connection.name} (golden flights of a real ArduPilot are .digests)"
        return f"physics {simulation.physics}" if is_remote(simulation.physics) else ""

    def set_link_faults(self, faults: LinkFaults | None) -> None:
        """As ``Client.set_link_faults``."""
        super().set_link_faults(faults)
        self.script.said.append(Said(self.simulation.time_us, b"", faults))

    def order_fault(self, text: str) -> None:
        """Let something fail or be repaired now: ``Simulation.order_fault``. Another autopilot gets ``SIM_`` ones."""
        if self.connection.simulation is None:
            self._set_fault(text)
            return
        self.simulation.order_fault(text)
        self.script.said.append(Said(self.simulation.time_us, b"", fault=text))

    def _set_fault(self, text: str) -> None:
        assert self.connection.kind is not None
        table = self.connection.kind.firmware.table
        faults = self._faults = self._faults or OrderedFaults(table)
        if text.startswith("-"):
            faults.repair(Repair.of(text[1:], 0, table))
        else:
            failure = Failure.of_text(text).checked(table)
            if failure.begin or failure.end is not None:
                raise OptionError(f"fault {text}: of another autopilot it begins now, and ends when it is repaired")
            faults.order(failure, 0)
        values = faults.values(0, self.params.__getitem__)
        present = {name: self.params[name] for name in values}
        self.params.update({name: x for name, x in values.items() if present[name] != stored(table[name], x)})

    def raise_error(self, error: ClientError) -> NoReturn:
        try:
            super().raise_error(error)
        except ClientError as complete:
            raise AssertionError(str(complete)) from None

    def snapshot(self) -> Any:
        """This moment, for ``restore``."""
        return RecordedMoment(super().snapshot(), tuple(self.script.said))

    def restore(self, moment: Any) -> None:
        """Put the vehicle and all that is known of it back to a moment; what follows is as if nothing had been."""
        super().restore(moment.vehicle)
        self.script.said[:] = moment.said

    @contextmanager
    def fork(self) -> Iterator[None]:
        """What is flown in the block has not been when the block is left."""
        with super().fork():
            try:
                yield
            except BaseException as error:
                if self.failed_fork is None or self.failed_fork.error is not error:
                    self.failed_fork = Kept(error, list(self.script.said), self.simulation.time_us)
                raise
