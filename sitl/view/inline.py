# SPDX-License-Identifier: BSD-3-Clause
"""A simulation or a fleet shown where a notebook has its output: ``simulation.view()``, ``fleet.page()``. The page
looks on while cells advance it."""

from __future__ import annotations

from ..fleet import Fleet
from ..run.watched import Watched
from ..simulation import Simulation
from .fleet import FleetPage
from .live_page import LivePage

_LOOK_US = 20_000
"""Simulated time between two looks at the wall clock [us]."""


class InlineView:
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
        self._simulation, self._height = simulation, height
        self.page = LivePage(simulation, None, port, controls=False)
        self._watched = Watched(self.page, lambda: simulation.time_us)
        self.due_us = simulation.time_us
        """When it looks next (``sitl.simulation.Observer``)."""
        simulation.observers.append(self)
        self.refresh()

    def observe(self) -> None:
        """Give the page a frame when it can take one."""
        self.due_us = self._simulation.time_us + _LOOK_US
        self._watched()

    def refresh(self) -> None:
        """Show the vehicle as it is now."""
        self.page.capture(0.0)

    def close(self) -> None:
        """Look on no longer, and close the page."""
        observers = self._simulation.observers
        observers[:] = [each for each in observers if each is not self]
        self.page.close()

    def _repr_html_(self) -> str:
        """The page in a frame of the notebook."""
        self.refresh()
        return _frame(self.page.address, self._height)


class FleetView:
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
        self._fleet, self._height = fleet, height
        self.page = FleetPage(fleet, port)
        self._watched = Watched(self.page, lambda: int(fleet.time_us.max()))
        fleet.observers.append(self._watched)
        self.refresh()

    def refresh(self) -> None:
        """Show the fleet as it is now."""
        self.page.capture(0.0)

    def close(self) -> None:
        """Look on no longer, and close the page."""
        observers = self._fleet.observers
        observers[:] = [each for each in observers if each is not self._watched]
        self.page.close()

    def _repr_html_(self) -> str:
        """The page in a frame of the notebook."""
        self.refresh()
        return _frame(self.page.address, self._height)


def _frame(address: str, height: int) -> str:
    return f'<iframe src="{address}" width="100%" height="{height}" style="border:0"></iframe>'
