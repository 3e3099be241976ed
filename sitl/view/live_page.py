# SPDX-License-Identifier: BSD-3-Clause
"""The page of a simulation that runs: ``sitl.run.watched`` gives it frames, and time to do what users ask for."""

from __future__ import annotations

from collections.abc import Callable
from queue import Empty, SimpleQueue
from typing import Any

from ..errors import SitlError
from ..run.pacing import StoppablePacing
from ..simulation import Simulation
from .controls import Controls, ParameterControls, Weather
from .live import LiveSource
from .page import Page
from .pilot import Pilot

Request = Callable[[], None]


class LivePage(Page):
    """A page of a simulation.

    Args:
        simulation: the vehicle.
        pace: lets its time pass; None: nobody can stop it here.
        port: on this machine; 0: a free one.
        controls: whether the page may do anything to the vehicle.
    """

    def __init__(
        self, simulation: Simulation, pace: StoppablePacing | None = None, port: int = 0, controls: bool = True
    ) -> None:
        self._requests: SimpleQueue[tuple[Request, Any]] = SimpleQueue()
        self.simulation = simulation
        source = LiveSource(simulation)
        super().__init__(source, port)
        self._live = source
        self.pilot = Pilot(simulation, self.notify)
        self.controls: Controls | None = None
        """What users can do; None: they only look."""
        self.weather: Weather | None = None
        gui = self.server.gui
        if controls:
            with self.tabs.add_tab("Control"):
                scene, shift = self.server.scene, self.cameras.shift
                self.controls = Controls(gui, scene, self.ask, self.pilot, source.stage, pace, shift)
            with self.tabs.add_tab("Faults"):
                self.weather = Weather(gui, simulation, self.ask, self.pilot)
        with self.tabs.add_tab("Parameters"):
            self.parameters = ParameterControls(gui, simulation, self.ask, self.pilot, controls)

    def ask(self, request: Request, event: Any = None) -> None:
        """Let something be done to the vehicle, by its own thread; called from the page's."""
        self._requests.put((request, getattr(event, "client", None)))

    def attend(self) -> None:
        """Do what was asked for (``sitl.run.watched.Viewer``)."""
        while True:
            try:
                request, client = self._requests.get_nowait()
            except Empty:
                break
            try:
                request()
            except SitlError as error:
                self.notify(str(error), client)
        self.pilot.listen()

    def close(self) -> None:
        super().close()
        self._live.close()
