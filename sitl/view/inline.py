# SPDX-License-Identifier: BSD-3-Clause
"""A simulation or a fleet shown where a notebook has its output: ``simulation.view()``, ``fleet.page()``. The page
looks on while cells advance it."""

from __future__ import annotations

from ..fleet import Fleet
from ..run.watched import Watched
from ..simulation import Simulation
from .fleet_page import FleetPage
from .live_page import LivePage
from .page import Page

_LOOK_US = 20_000
"""Simulated time between two looks at the wall clock [us]."""


class _Inline:
    """A page as the value of a cell.

    Args:
        page: what is shown.
        height: of the cell's output [pixels].
    """

    def __init__(self, page: Page, height: int) -> None:
        self.page, self._height = page, height

    def refresh(self) -> None:
        """Show what the page is of as it is now."""
        self.page.capture(0.0)

    def _repr_html_(self) -> str:
        """The page in a frame of the notebook."""
        self.refresh()
        return f'<iframe src="{self.page.address}" width="100%" height="{self._height}" style="border:0"></iframe>'


class InlineView(_Inline):
    """The page of a simulation that others advance, shown by a notebook as the value of a cell. Cells command the
    vehicle, the page has no controls.

    Args:
        simulation: the vehicle; this is one of its observers until it is closed.
        height: of the cell's output [pixels].
        port: of the page on this machine; 0: a free one.

    Raises:
        MissingExtra: the library that draws it is not installed.
        sitl.view.page.PageAddressError: the port is taken.
    """

    def __init__(self, simulation: Simulation, height: int = 480, port: int = 0) -> None:
        super().__init__(LivePage(simulation, None, port, controls=False), height)
        self._simulation = simulation
        self._watched = Watched(self.page, lambda: simulation.time_us)
        self.due_us = simulation.time_us
        """When it looks next (``sitl.simulation.Observer``)."""
        simulation.observers.append(self)
        self.refresh()

    def observe(self) -> None:
        """Give the page a frame when it can take one."""
        self.due_us = self._simulation.time_us + _LOOK_US
        self._watched()

    def close(self) -> None:
        """Look on no longer, and close the page."""
        observers = self._simulation.observers
        observers[:] = [each for each in observers if each is not self]
        self.page.close()


class FleetView(_Inline):
    """The page of a fleet that others advance, shown by a notebook as the value of a cell. It has a frame after a call
    of ``advance``, at most 30 a second.

    Args:
        fleet: the vehicles; this is one of its observers until it is closed.
        height: of the cell's output [pixels].
        port: of the page on this machine; 0: a free one.

    Raises:
        MissingExtra: the library that draws it is not installed.
        sitl.view.page.PageAddressError: the port is taken.
    """

    def __init__(self, fleet: Fleet, height: int = 480, port: int = 0) -> None:
        super().__init__(FleetPage(fleet, port), height)
        self._fleet = fleet
        self._watched = Watched(self.page, lambda: int(fleet.time_us.max()))
        fleet.observers.append(self._watched)
        self.refresh()

    def close(self) -> None:
        """Look on no longer, and close the page."""
        observers = self._fleet.observers
        observers[:] = [each for each in observers if each is not self._watched]
        self.page.close()
