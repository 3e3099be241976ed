# SPDX-License-Identifier: BSD-3-Clause
"""A plant, the PX4 that flies it, and its clients, for ``sitl run`` and ``sitl exec``."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from ..bridge.hil.protocol import BASE_PORT
from ..bridge.links.link import Link
from ..plants.local import LocalPlant
from ..plants.physics_server import PhysicsServer
from ..run.pacing import Pacing
from . import px4
from .choice import Choice
from .hil_host import HilHost
from .process import HOST, AutopilotProcess, free_udp_port
from .relay import UdpRelay
from .session import Say, Tap
from .sim_parameters import SimParameterPort
from .slices import SlicedSession


class Px4Session(SlicedSession):
    """PX4 on a plant.

    Args:
        choice, plant, links, instance, params, folder, say, tap, is_relayed_by_slice: see ``ArduPilotSession``.
        speedup: times the wall clock; None: as fast as it goes.

    Raises:
        OptionError, LinkAddressError: no copter, no port, or a program that cannot be started.
    """

    def __init__(
        self,
        choice: Choice,
        plant: LocalPlant,
        links: Sequence[Link] = (),
        *,
        instance: int = 0,
        speedup: float | None = 1.0,
        params: Mapping[str, float] | None = None,
        folder: Path | None = None,
        say: Say = lambda text: None,
        tap: Tap = lambda frame: None,
        is_relayed_by_slice: bool = False,
    ) -> None:
        self.plant, self.say, self.name, self._speedup = plant, say, choice.name, speedup
        self.process: AutopilotProcess | None = None
        self.relay: UdpRelay | None = None
        self.clients = choice.connection
        self._params = SimParameterPort(plant)
        self._given, self._is_set = dict(params or {}), False
        self.server: PhysicsServer | None = None
        with contextlib.ExitStack() as undo:
            if is_relayed_by_slice:
                self.host = HilHost(plant, (HOST, BASE_PORT + instance))
                undo.callback(self.host.close)
            else:
                self.server = PhysicsServer(plant, HOST, BASE_PORT + instance, say)
                undo.callback(self.server.close)
            if choice.program is not None:
                port = free_udp_port()
                self.relay = UdpRelay(port, links, tap, self._params.answer)
                undo.callback(self.relay.close)
                self.process = px4.start(
                    choice.program, plant.vehicle.airframe, plant.home, instance, speedup=speedup or 1.0, params=params,
                    folder=folder, link=(port, self.relay.own_port),
                )  # fmt: skip
                if not is_relayed_by_slice:
                    self.relay.start()
            undo.pop_all()

    def act(self) -> None:
        self._params.act()
        if not self._is_set and self.relay is not None and self.relay.frames and self.process is not None:
            self._is_set = True
            for name in px4.unknown_names(self.process, self._given):
                self.say(f"--params: {self.name} has no parameter {name}; it is left out")

    def serve(self, running: Callable[[], bool], on_turn: Callable[[], None]) -> None:
        """See ``Session``."""
        server, process = self.server, self.process
        assert server is not None
        end, due_us = server.end, 0
        pacing, starting = Pacing(self._speedup), Pacing(min(self._speedup or 1.0, 1.0))
        looked_us = end.time_us

        def goes_on() -> bool:
            nonlocal due_us, looked_us
            if not running():  # a program may end as its connection does
                return False
            if process is not None:
                process.check()
            self.act()
            on_turn()
            if end.time_us >= due_us:  # PX4 goes as fast as its physics: this is what holds it
                passed_us, looked_us = end.time_us - looked_us, end.time_us
                due_us = end.time_us + pacing.slice_us
                wait = (starting if end.is_starting else pacing).wait_s(passed_us)
                if wait > 0.0:
                    time.sleep(wait)
            return True

        server.serve(goes_on)

    def close(self) -> None:
        """End the program, close links and physics."""
        if self.process is not None:
            self.process.stop()
        if self.relay is not None:
            self.relay.close()
        (self.server or self.host).close()
        self.plant.close()
