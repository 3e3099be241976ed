# SPDX-License-Identifier: BSD-3-Clause
"""Frames of several simulations in one world: one is chosen and shown in full; of the others, position and attitude."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..autopilot.modes import shown
from ..simulation import Simulation
from . import kind
from .frame import Company, Frame, Points
from .live import Captured, LiveSource
from .shape import Shape


class CapturedCompany(NamedTuple):
    """A moment of several vehicles."""

    chosen: int
    of: Captured
    pos: Points
    q: Points
    notes: tuple[str, ...]


class CompanySource:
    """Several simulations as the page sees them.

    Args:
        vehicles: at least one; their positions are in one frame.
    """

    def __init__(self, vehicles: Sequence[Simulation]) -> None:
        self._vehicles = vehicles
        self._sources: dict[int, LiveSource] = {}
        self._wanted: tuple[str, ...] = ()
        self.chosen = 0
        """The vehicle that is shown in full."""
        shapes = dict[str, Shape]()
        for each in vehicles:
            if each.airframe.name not in shapes:
                shapes[each.airframe.name] = kind.of(each.kind).shape(each.v.physics.airframe)
        first = self._source(0).stage
        self.stage = replace(
            first, title=f"{len(vehicles)} vehicles", company=tuple(shapes[each.airframe.name] for each in vehicles)
        )
        bodies = [each.fleet["physics"]["body"][each.index] for each in vehicles]
        self._pos, self._q = [body["pos"] for body in bodies], [body["q"] for body in bodies]  # views of each record

    def _source(self, number: int) -> LiveSource:
        if number not in self._sources:
            self._sources[number] = LiveSource(self._vehicles[number])
        return self._sources[number]

    def choose(self, number: int) -> None:
        """Show another one in full from the next frame on."""
        self._source(number).choose_signals(self._wanted)
        self.chosen = number

    def capture(self) -> CapturedCompany:
        """The vehicles as they are now."""
        chosen = self.chosen
        pos, q, notes = np.array(self._pos), np.array(self._q), tuple(map(note, self._vehicles))
        return CapturedCompany(chosen, self._source(chosen).capture(), pos, q, notes)

    def frame(self, captured: CapturedCompany) -> Frame:
        """What the page shows of a moment."""
        frame = self._source(captured.chosen).frame(captured.of)
        return replace(frame, company=Company(captured.pos, captured.q, captured.chosen, captured.notes))

    def signal_names(self) -> list[str]:
        """What can be plotted, of the vehicle that is chosen."""
        return self._source(self.chosen).signal_names()

    def choose_signals(self, names: tuple[str, ...]) -> None:
        """Frames have these signals from now on.

        Raises:
            sitl.view.signals.SignalError: there is no such signal; those before stay.
        """
        self._source(self.chosen).choose_signals(names)
        self._wanted = names

    def close(self) -> None:
        """Listen no longer."""
        for source in self._sources.values():
            source.close()


def note(vehicle: Simulation) -> str:
    """System, mode and arming of a vehicle."""
    ap = vehicle.v.autopilot
    mode = vehicle.firmware.mode_names.get(int(shown(ap.modes)), "?")
    return f"system {vehicle.bridge.system}, {mode}, {'armed' if ap.arming.armed else 'disarmed'}"
