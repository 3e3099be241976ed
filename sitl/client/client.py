# SPDX-License-Identifier: BSD-3-Clause
"""The client: flies or drives one vehicle from Python, by MAVLink bytes, in simulated time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .files import Files
from .session import OnBoard, Repeated
from .telemetry import Telemetry

if TYPE_CHECKING:
    from ..simulation import Snapshot

__tracebackhide__ = True


@dataclass(frozen=True)
class Moment:
    """A vehicle in this process at one moment, with all that its client knows."""

    simulation: Snapshot
    telemetry: Telemetry
    sequence: int
    repeated: dict[str, Repeated]
    next_us: dict[str, int]
    texts_read: int
    is_silent: bool
    asked: tuple[int, int, frozenset[str]]
    companions: tuple[tuple[OnBoard, dict[str, Any]], ...]


class Client(Files):
    """One vehicle, flown by MAVLink bytes: ``Client(Simulation("erle_copter"))`` or ``Client("udp:127.0.0.1:14550")``.

    See ``Session`` for the arguments, and docs/client.md for all calls. Times are simulated seconds, positions metres
    from home, altitudes above home. What is awaited in vain raises an error that says what was seen last, when, and
    what the vehicle said.
    """

    # ------------------------------------------------------------------ other futures, of vehicles in this process

    def snapshot(self) -> Moment:
        """This moment, for ``restore``."""
        self.connection.run(0)
        return Moment(
            self.simulation.snapshot(), self.telemetry.copy(), self.connection.endpoint.sequence,
            dict(self._repeated), dict(self._next_us), self._texts_read, self._is_silent,
            (self._asked_us, self._unanswered, frozenset(self._awaited)),
            tuple((companion, companion.state()) for companion in self.companions),
        )  # fmt: skip

    def restore(self, moment: Moment) -> None:
        """Put the vehicle and all that is known of it back to a moment; what follows is as if nothing had been."""
        self.connection.endpoint.link.receive()  # of another future
        self.simulation.restore(moment.simulation)
        self.telemetry = moment.telemetry.copy()
        self.connection.endpoint.sequence = moment.sequence
        self._repeated, self._next_us = dict(moment.repeated), dict(moment.next_us)
        self._texts_read, self._is_silent = moment.texts_read, moment.is_silent
        self._asked_us, self._unanswered, awaited = moment.asked
        self._awaited = set(awaited)
        self.companions[:] = [companion.restored(state, self) for companion, state in moment.companions]
        self._boots = self.connection.boots

    @contextmanager
    def fork(self) -> Iterator[None]:
        """What is flown in the block has not been when the block is left."""
        moment = self.snapshot()
        try:
            yield
        finally:
            self.restore(moment)
