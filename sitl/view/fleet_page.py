# SPDX-License-Identifier: BSD-3-Clause
"""A fleet on the page: all of its vehicles are drawn, each in a world of its own or all in one, and one is chosen."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

from ..core.vectors import Vec3
from ..fleet import Fleet
from .axes import FLIP
from .frame import CALM, Company, Frame, Points
from .layout import BETWEEN, GRID, LAYOUTS, side_by_side
from .live import AutopilotSource, Captured
from .page import Page

_SPACING = 2.5
"""Spacing of a vehicle on a plain, where worlds have no bounds, by its size."""


class CapturedFleet(NamedTuple):
    """A moment of a fleet."""

    chosen: int
    of: Captured
    pos: Points
    q: Points


class FleetSource(AutopilotSource):
    """A fleet as the page sees it. What vehicles say to their pilots is not shown: their clients hear it."""

    def __init__(self, fleet: Fleet) -> None:
        self._all = fleet
        super().__init__(fleet.shell, fleet.records, 0)
        self.chosen, self.layout = 0, GRID
        """The vehicle that is shown in full, and one of LAYOUTS."""
        self._frame_of = 0
        body = fleet.records["physics"]["body"]
        self._pos, self._q = body["pos"], body["q"]
        size, world, count = self.stage.shape.size, self.stage.world, len(fleet)
        half = 0.5 * (_SPACING * size - BETWEEN)
        x0, y0, x1, y1 = (-half, -half, half, half) if world is None else world.bounds
        self._offsets = side_by_side(count, (x0, y0), (x1, y1))
        shapes = (self.stage.shape,) * count
        self.stage = replace(self.stage, title=f"{count} x {self.stage.title}", company=shapes, copies=self._offsets)

    def choose(self, number: int) -> None:
        """Show another one in full from the next frame on."""
        self.chosen = number

    def capture(self) -> CapturedFleet:
        """The fleet as it is now."""
        k, fleet = self.chosen, self._all
        record = fleet.records[k : k + 1].tobytes()
        moment = Captured(int(fleet.time_us[k]), record, fleet.mission(k), ())
        return CapturedFleet(k, moment, self._pos.copy(), self._q.copy())

    def frame(self, captured: Any) -> Frame:
        """What the page shows of a moment."""
        k, pos = captured.chosen, captured.pos
        if k != self._frame_of:
            self._frame_of, self._scan = k, (-1, None)
        self._stands = CALM
        if self.layout == GRID:
            positions = self._offsets * FLIP
            self._stands, pos = Vec3(*positions[k].tolist()), pos + positions
        return replace(super().frame(captured.of), company=Company(pos, captured.q, k))


class FleetPage(Page):
    """The page of a fleet. It can do nothing to the vehicles: their clients do.

    Args:
        fleet: what is shown.
        port: on this machine; 0: a free one.

    Raises:
        MissingExtra: the library that draws it is not installed.
        sitl.view.page.PageAddressError: the port is taken.
    """

    def __init__(self, fleet: Fleet, port: int = 0) -> None:
        self._of = source = FleetSource(fleet)
        super().__init__(source, port)

    def _add_looks(self, gui: Any) -> None:
        self.layout = gui.add_dropdown("Vehicles", LAYOUTS, initial_value=GRID, hint="each in a world of its own")
        self.layout.on_update(self.guarded(lambda event: self._lay_out(event.target.value)))

    def _lay_out(self, layout: str) -> None:
        self._of.layout = layout
        self.scene.place_world(self._of.stage.copies if layout == GRID else None)
        self.cameras.choose(self.cameras.view)
