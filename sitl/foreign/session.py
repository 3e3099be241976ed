# SPDX-License-Identifier: BSD-3-Clause
"""A plant, the foreign autopilot that flies it, and its clients, for ``sitl run --autopilot``."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Protocol

from ..autopilot.params.files import text_of
from ..bridge.hil.protocol import BASE_PORT
from ..bridge.links.link import Link
from ..errors import LinkLostError
from ..plants.json_link import PORT
from ..plants.local import LocalPlant
from ..plants.physics_server import WAIT_S, PhysicsServer, Silence
from ..run.pacing import Pacing
from ..run.runner import Pace
from . import ardupilot, px4
from .choice import Choice
from .json_host import ANSWERS, JsonHost
from .process import HOST, AutopilotProcess, free_tcp_run
from .relay import Relay
from .wind import Wind

Say = Callable[[str], None]
Tap = Callable[[bytes], None]
LOST_S = 30.0
"""Wall time after which an autopilot that asks for nothing is lost to a script that waits for it [s]."""


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


class ArduPilotSession:
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
        self.plant, self._say, self._name, self._wind = plant, say, choice.name, Wind(plant)
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
            self._wind.blow()
            return running()

        self.host.serve(goes_on, on_turn)

    @property
    def time_us(self) -> int:
        """Simulated time since the start; reboots do not set it back [us]."""
        return self.host.before_boot_us + self.host.time_us

    def serve_slices(
        self,
        pace: Pace[ArduPilotSession],
        *,
        until_us: int | None = None,
        running: Callable[[], bool] = lambda: True,
        on_slice: Callable[[], None] = lambda: None,
    ) -> None:
        """As ``sitl.run.runner.serve``. Clients and autopilot hear each other between two slices, when the autopilot
        has done all that it does until then.

        Raises:
            AutopilotEndedError: the program has ended.
            LinkLostError: it has asked for no step in LOST_S.
        """
        host, relay, process = self.host, self.relay, self.process
        assert relay is not None and process is not None
        silence = Silence(self._say, lambda: f"{self.time_us * 1e-6:.4f} s")
        while running() and (until_us is None or self.time_us < until_us):
            goal = self.time_us + pace.slice_us
            goal = goal if until_us is None else min(goal, until_us)
            while running():
                if not host.listen():
                    process.check()
                    relay.turn(0.0)
                    silence.goes_on()
                    if silence.waits * WAIT_S > LOST_S:
                        last = process.last_output()
                        raise LinkLostError(
                            f"autopilot {self._name} has not asked its physics in {LOST_S:g} s; it said: {last}"
                        )
                    on_slice()
                    continue
                if silence.waits:
                    silence.is_over()
                if self.time_us >= goal:
                    break
                host.step(goal - host.before_boot_us, ANSWERS)
            relay.turn(0.0)
            self._wind.blow()
            on_slice()
            pace.after_slice(self)

    def close(self) -> None:
        if self.process is not None:
            self.process.stop()
        if self.relay is not None:
            self.relay.close()
        self.host.close()
        self.plant.close()


class Px4Session:
    """PX4 on a plant. Its clients reach it at its own UDP ports (``clients``).

    Args:
        choice, plant, instance, folder, say: see ``ArduPilotSession``.
        speedup: times the wall clock; None: as fast as it goes.
        params: under PX4's names.

    Raises:
        OptionError, LinkAddressError: no copter, no port, or a program that cannot be started.
    """

    def __init__(
        self,
        choice: Choice,
        plant: LocalPlant,
        *,
        instance: int = 0,
        speedup: float | None = 1.0,
        params: Mapping[str, float] | None = None,
        folder: Path | None = None,
        say: Say = lambda text: None,
    ) -> None:
        self.plant, self._speedup = plant, speedup
        self.process: AutopilotProcess | None = None
        self.clients = (
            f"udp {HOST}:{px4.programs_port(instance)}, for ground stations {HOST}:{px4.STATIONS_PORT}"
            if choice.program is not None
            else choice.connection
        )
        self.server = PhysicsServer(plant, HOST, BASE_PORT + instance, say)
        if choice.program is not None:
            try:
                self.process = px4.start(
                    choice.program, plant.vehicle.airframe, plant.home, instance, speedup=speedup or 1.0, params=params,
                    folder=folder,
                )  # fmt: skip
            except BaseException:
                self.server.close()
                raise

    def serve(self, running: Callable[[], bool], on_turn: Callable[[], None]) -> None:
        process, end, due_us = self.process, self.server.end, 0
        pacing, starting = Pacing(self._speedup), Pacing(min(self._speedup or 1.0, 1.0))
        looked_us = end.time_us

        def goes_on() -> bool:
            nonlocal due_us, looked_us
            if process is not None:
                process.check()
            on_turn()
            if end.time_us >= due_us:  # PX4 goes as fast as its physics: this is what holds it
                passed_us, looked_us = end.time_us - looked_us, end.time_us
                due_us = end.time_us + pacing.slice_us
                wait = (starting if end.is_starting else pacing).wait_s(passed_us)
                if wait > 0.0:
                    time.sleep(wait)
            return running()

        self.server.serve(goes_on)

    def close(self) -> None:
        if self.process is not None:
            self.process.stop()
        self.server.close()
        self.plant.close()
