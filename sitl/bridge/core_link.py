# SPDX-License-Identifier: BSD-3-Clause
"""The compiled side of a vehicle's links, bound to one vehicle."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any, NamedTuple

from ..core import compile as compiler
from ..core.compile import Progress
from ..vehicle.core_entry import bind_unit
from ..vehicle.kinds import KINDS
from .wire.choose import Builder, Taker, message_of


class CoreUnits(NamedTuple):
    """Units of a firmware that receive from clients and send to them (``wire/link.py``), and the laws that they are
    made of."""

    receive: Callable[..., None]
    transmit: Callable[..., None]
    run: Callable[..., None]
    run_all: Callable[..., None]
    """``receive`` and ``run`` of one vehicle or many (``wire/fleet.py``)."""
    builders: tuple[Builder, ...]
    takers: tuple[Taker, ...]


class CoreLink:
    """A firmware's units for one vehicle; each is compiled or loaded when it is first called."""

    def __init__(self, vehicle: Any, units: CoreUnits) -> None:
        self._vehicle, self._units = vehicle, units
        self.numbers = frozenset(message_of(builder).kind.id for builder in units.builders)
        """Messages that the core can send."""
        self.taken = frozenset(message_of(taker).kind.id for taker in units.takers)
        """Messages that the core acts on."""

    def load(self, runs_in_core: bool, progress: Progress | None = None) -> None:
        """Compile what is needed now: ``run_all`` only for a vehicle whose physics is in the core, too."""
        kind, units = KINDS[self._vehicle.firmware.name], self._units
        needed = (units.run_all, units.receive) if runs_in_core else (units.transmit, units.receive)
        compiler.build_missing(needed, kind.record_path, progress)
        for unit in needed:
            compiler.load(unit, kind.record_path)

    def _bind(self, unit: Callable[..., None]) -> Callable[..., None]:
        vehicle = self._vehicle
        return bind_unit(unit, KINDS[vehicle.firmware.name], vehicle.fleet, vehicle.index)

    @cached_property
    def receive(self) -> Callable[[int], None]:
        """``receive(address of a port)``: act on what its client sent, up to a frame that is the shell's."""
        return self._bind(self._units.receive)

    @cached_property
    def transmit(self) -> Callable[[int, int, int], None]:
        """``transmit(address of ports, count, number)``: send the message ``number``, or all that is due (REGULAR)."""
        return self._bind(self._units.transmit)

    @cached_property
    def run(self) -> Callable[[int, int, int, int, int, int], None]:
        """``run(address of ports, count, of Ranging, of Sampler, until_us, shell_us)``: advance, measure, send, log."""
        return self._bind(self._units.run)

    @cached_property
    def run_all(self) -> Callable[[int, int, int], None]:
        """``run_all(index + 1, address of the Slot of vehicle 0, address of Ranging)``: hear, then run."""
        return self._bind(self._units.run_all)
