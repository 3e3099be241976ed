# SPDX-License-Identifier: BSD-3-Clause
"""Other futures: a vehicle put back to where it was, with all that its ground station knew."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from sitl.simulation import Snapshot

from .connected import Connected, Held
from .script import Said
from .telemetry import Telemetry


@dataclass(frozen=True)
class Moment:
    """A vehicle at one moment, with all that its ground station knows."""

    simulation: Snapshot
    telemetry: Telemetry
    said: tuple[Said, ...]
    sequence: int
    held: dict[str, Held]
    next_us: dict[str, int]
    found: int
    silent: bool
    acks: dict[int, int]


@dataclass
class Kept:
    """What of a fork that went wrong is kept for the logs."""

    error: BaseException
    said: list[Said]
    end_us: int


class Forking(Connected):
    """A vehicle that can be put back."""

    failed_fork: Kept | None = None
    """What went wrong in a fork."""

    def snapshot(self) -> Moment:
        """This moment, for ``restore``."""
        self.hear()
        return Moment(
            self.simulation.snapshot(), self.telemetry.copy(), tuple(self.script.said), self.client._sequence,
            dict(self._held), dict(self._next_us), self._found, self._silent, dict(self._acks),
        )  # fmt: skip

    def restore(self, moment: Moment) -> None:
        """Put the vehicle and all that is known of it back to a moment; what follows is as if nothing had been."""
        self.client.receive()  # of another future
        self.simulation.restore(moment.simulation)
        self.telemetry = moment.telemetry.copy()
        self.script.said[:] = moment.said
        self.client._sequence = moment.sequence
        self._held, self._next_us = dict(moment.held), dict(moment.next_us)
        self._found, self._silent, self._acks = moment.found, moment.silent, dict(moment.acks)
        self._boot_us = self.simulation.before_boot_us

    @contextmanager
    def fork(self) -> Iterator[None]:
        """What is flown in the block has not been when the block is left."""
        moment = self.snapshot()
        try:
            yield
        except BaseException as error:
            if self.failed_fork is None or self.failed_fork.error is not error:
                self.failed_fork = Kept(error, list(self.script.said), self.simulation.time_us)
            raise
        finally:
            self.restore(moment)
