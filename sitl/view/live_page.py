# SPDX-License-Identifier: BSD-3-Clause
"""The page of simulations that run, one or several: ``sitl.run.watched`` gives it frames, and time to do what users ask
for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from queue import Empty, Full, Queue
from typing import Any

from ..run.pacing import StoppablePacing
from ..simulation import Simulation
from .company import CompanySource
from .controls import Controls, ParameterControls, Weather
from .live import LiveSource
from .page import Page
from .pilot_link import Pilot

Request = Callable[[], None]
MOST_REQUESTS = 64
"""That wait for the vehicle."""


class LivePage(Page):
    """A page of a simulation, or of several that share a world: one of these is chosen, shown in full and commanded.

    Args:
        vehicles: what is shown.
        pace: lets its time pass; None: nobody can stop it here.
        port: on this machine; 0: a free one.
        controls: whether the page may do anything to a vehicle.
    """

    def __init__(
        self,
        vehicles: Simulation | Sequence[Simulation],
        pace: StoppablePacing | None = None,
        port: int = 0,
        controls: bool = True,
    ) -> None:
        self._requests: Queue[tuple[Request, Any]] = Queue(MOST_REQUESTS)
        self._vehicles = [vehicles] if isinstance(vehicles, Simulation) else list(vehicles)
        self._live = source = LiveSource(vehicles) if isinstance(vehicles, Simulation) else CompanySource(vehicles)
        self._pilots: dict[int, Pilot] = {}
        super().__init__(source, port)
        self.controls: Controls | None = None
        """What users can do; None: they only look."""
        self.weather: Weather | None = None
        gui = self.server.gui
        if controls:
            with self.tabs.add_tab("Control"):
                scene, shift, of = self.server.scene, self.cameras.shift, source.stage
                self.controls = Controls(gui, scene, self.ask, lambda: self.pilot, of, pace, shift)
                if of.company:  # whoever is chosen next is not flown by sticks yet
                    held = self.controls.sticks.held
                    self.vehicle_number.on_update(lambda event: setattr(held, "value", False))
            with self.tabs.add_tab("Faults"):
                self.weather = Weather(gui, self.simulation, self.ask, lambda: self.pilot)
        with self.tabs.add_tab("Parameters"):
            self.parameters = ParameterControls(gui, lambda: self.simulation, self.ask, lambda: self.pilot, controls)

    @property
    def chosen(self) -> int:
        """Number of the vehicle that is shown in full."""
        return self._live.chosen if isinstance(self._live, CompanySource) else 0

    @property
    def simulation(self) -> Simulation:
        """The vehicle that is shown in full."""
        return self._vehicles[self.chosen]

    @property
    def pilot(self) -> Pilot:
        """Commands that vehicle."""
        number = self.chosen
        if number not in self._pilots:
            self._pilots[number] = Pilot(self._vehicles[number], self.notify)
        return self._pilots[number]

    def ask(self, request: Request, event: Any = None) -> None:
        """Let something be done to the vehicle, by its own thread; called from the page's. Whoever asks too much is
        told so."""
        client = getattr(event, "client", None)
        try:
            self._requests.put_nowait((request, client))
        except Full:
            self.notify(f"{MOST_REQUESTS} requests wait for the vehicle already", client)

    def attend(self) -> None:
        """Do what was asked for (``sitl.run.watched.Viewer``)."""
        for _ in range(MOST_REQUESTS):
            try:
                request, client = self._requests.get_nowait()
            except Empty:
                break
            self.safely(request, client)
        self.safely(self._attend_pilots)

    def _attend_pilots(self) -> None:
        for number, pilot in self._pilots.items():
            if number != self.chosen:
                pilot.hold(None)
            pilot.keep_sticks()
            pilot.listen()

    def close(self) -> None:
        super().close()
        self._live.close()
