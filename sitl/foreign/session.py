# SPDX-License-Identifier: BSD-3-Clause
"""A plant, the foreign autopilot that flies it, and its clients, for ``sitl run --autopilot``."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Protocol

from ..autopilot.params.parm_files import text_of
from ..bridge.links.link import Link
from ..plants.json_link import PORT
from ..plants.local import LocalPlant
from . import ardupilot
from .choice import Choice
from .json_host import JsonHost
from .process import HOST, AutopilotProcess, free_tcp_run
from .relay import Relay
from .slices import SlicedSession
from .wind_parameters import Wind

Say = Callable[[str], None]
Tap = Callable[[bytes], None]


class Session(Protocol):
    """A session of an autopilot that flies a plant."""

    plant: LocalPlant
    clients: str | None
    """Address of its MAVLink, when that is not on our links."""

    def serve(self, running: Callable[[], bool], on_turn: Callable[[], None]) -> None:
        """Advance physics and autopilot until ``running()`` is false; ``on_turn`` is called from time to time.

        Raises:
            AutopilotEndedError: the program that was started has ended.
        """

    def close(self) -> None:
        """End the program, close links and physics."""


class ArduPilotSession(SlicedSession):
    """ArduPilot on a plant.

    Args:
        choice: a program to start, or one that runs already and is given our port by whoever started it.
        plant: at power-on.
        links: for its clients, of a program that is started.
        instance: 10 more for the default port of the physics, 1 more for its MAV_SYSID.
        speedup: times the wall clock.
        params: under ArduPilot's names.
        folder: see ``AutopilotProcess``.
        say: prints a message for the user.
        tap: see ``Relay``.
        is_relayed_by_slice: clients are served by ``serve_slices`` alone, else by a thread. Without a ``folder`` its
            on-board log is off then, so that a flight repeats (``ardupilot.unlogged``).

    Raises:
        OptionError: no port, or a program that cannot be started.
    """

    host: JsonHost

    def __init__(
        self,
        choice: Choice,
        plant: LocalPlant,
        links: Sequence[Link] = (),
        *,
        instance: int = 0,
        speedup: float = 1.0,
        params: Mapping[str, float] | None = None,
        folder: Path | None = None,
        say: Say = lambda text: None,
        tap: Tap = lambda frame: None,
        is_relayed_by_slice: bool = False,
    ) -> None:
        self.plant, self.say, self.name, self._wind = plant, say, choice.name, Wind(plant)
        self.process: AutopilotProcess | None = None
        self.relay: Relay | None = None

        def listened(frame: bytes) -> None:
            self._wind.frame(frame)
            tap(frame)

        self.clients = choice.connection
        with contextlib.ExitStack() as undo:
            port = 0 if choice.program is not None else PORT + 10 * instance
            self.host = JsonHost(plant, (HOST, port), say)
            undo.callback(self.host.close)
            if choice.program is not None:
                base = free_tcp_run(ardupilot.SERIAL_PORTS)
                if is_relayed_by_slice and folder is None:  # its files are deleted in the end
                    params = ardupilot.unlogged(params or {})
                number = {"MAV_SYSID": 1.0 + instance, "SYSID_THISMAV": 1.0 + instance}
                self.process = ardupilot.start(
                    choice.program, plant.vehicle.airframe, plant.home, self.host.address[1], base, instance=instance,
                    speedup=speedup, sees_ground=plant.rangers is not None and plant.rangers.has_rangefinder,
                    overrides=text_of(params or {}) + text_of(number), folder=folder,
                )  # fmt: skip
                undo.callback(self.process.stop)
                self.relay = Relay((HOST, base), links, listened)
                if not is_relayed_by_slice:
                    self.relay.start()
            undo.pop_all()

    def serve(self, running: Callable[[], bool], on_turn: Callable[[], None]) -> None:
        process = self.process

        def goes_on() -> bool:
            if process is not None:
                process.check()
            self.act()
            return running()

        self.host.serve(goes_on, on_turn)

    def act(self) -> None:
        self._wind.blow()

    def close(self) -> None:
        if self.process is not None:
            self.process.stop()
        if self.relay is not None:
            self.relay.close()
        self.host.close()
        self.plant.close()
