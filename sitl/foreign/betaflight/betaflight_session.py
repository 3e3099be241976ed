# SPDX-License-Identifier: BSD-3-Clause
"""A plant, the Betaflight that flies it, and its clients, for ``sitl run`` and ``sitl exec``."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ...bridge.links.link import Link
from ...errors import LinkLostError
from ...plants.local import LocalPlant
from ...plants.physics_server import WAIT_S, Silence
from ...run.pacing import Pacing
from ..choice import Choice
from ..process import HOST
from ..slices import LOST_S
from . import airframe
from .clients import Clients
from .configuration import BEGINNING, ENDING, configure
from .host import BetaflightHost
from .program import EEPROM, USERS_PORT, Program

if TYPE_CHECKING:
    from ...run.runner import Pace

Say = Callable[[str], None]
_SLICE_US = 20_000
"""Clients are heard at least so often [us]."""


def starter(
    path: Path, plant: LocalPlant, lines: Sequence[str] = (), users_port: int = 0, folder: Path | None = None
) -> Callable[[bytes | None], Program]:
    """What starts the program for the vehicle of a plant, with these lines in its configuration.

    A folder that is kept has a configuration of its own from the second time on: what was changed in it, by a
    configurator, stays, and only these lines are typed over it.

    Raises:
        OptionError: lines that it does not take.
    """
    airframe.check(plant.vehicle.airframe)
    kept = folder / EEPROM if folder is not None else None
    if kept is not None and kept.is_file():
        eeprom = configure(path, lines, kept.read_bytes()) if lines else kept.read_bytes()
    else:
        eeprom = configure(path, [*BEGINNING, *airframe.lines(plant), *lines, *ENDING])
    return lambda saved: Program(path, saved or eeprom, users_port, folder)


class BetaflightSession:
    """Betaflight on a plant.

    Args:
        choice: the program.
        plant: at power-on.
        links: for its clients.
        instance: 10 more for the port of its second serial port.
        speedup: times the wall clock; None: as fast as it goes.
        lines: of its command line.
        folder: see ``AutopilotProcess``.
        say: prints a message for the user.
        tap: gets each frame.

    Raises:
        OptionError: an airframe that it does not fly, or a program that cannot be started.
    """

    def __init__(
        self,
        choice: Choice,
        plant: LocalPlant,
        links: Sequence[Link] = (),
        *,
        instance: int = 0,
        speedup: float | None = 1.0,
        lines: Sequence[str] = (),
        folder: Path | None = None,
        say: Say = lambda text: None,
        tap: Callable[[bytes], None] = lambda frame: None,
    ) -> None:
        assert choice.program is not None
        self.plant, self._say, self._name, self._speedup = plant, say, choice.name, speedup
        port = USERS_PORT + 10 * instance
        self.clients: str | None = f"MSP, for configurators: tcp {HOST}:{port}"
        self.host = BetaflightHost(plant, starter(choice.program, plant, lines, port, folder), say)
        self._clients = Clients(self.host.face, links, tap)

    @property
    def time_us(self) -> int:
        """Simulated time since the start [us]."""
        return self.host.time_us

    def serve(self, running: Callable[[], bool], on_turn: Callable[[], None]) -> None:
        """Advance physics and autopilot until ``running()`` is false; ``on_turn`` is called from time to time.

        Raises:
            AutopilotEndedError: the program has ended.
        """
        pacing = Pacing(self._speedup)
        silence = Silence(self._say, lambda: f"{self.time_us * 1e-6:.4f} s")
        while running():
            before_us = self.time_us
            self._advance(before_us + min(pacing.slice_us, _SLICE_US), silence, running)
            on_turn()
            wait = pacing.wait_s(self.time_us - before_us)
            self._clients.turn(0.0)
            until = time.monotonic() + wait
            while (left := until - time.monotonic()) > 0.0:
                self._clients.turn(left)

    def _advance(self, goal_us: int, silence: Silence, running: Callable[[], bool]) -> None:
        """Up to a time [us], or for as long as the program is silent and nobody ends it."""
        host = self.host
        while host.time_us < goal_us and running():
            if host.listen():
                if silence.waits:
                    silence.is_over()
                host.step()
            else:
                host.program.process.check()
                silence.goes_on()
                return

    def serve_slices(
        self,
        pace: Pace[BetaflightSession],
        *,
        until_us: int | None = None,
        running: Callable[[], bool] = lambda: True,
        on_slice: Callable[[], None] = lambda: None,
    ) -> None:
        """As ``sitl.run.runner.serve``: bytes of clients are read between two slices.

        Raises:
            AutopilotEndedError: the program has ended.
            LinkLostError: it has not answered in LOST_S.
        """
        silence = Silence(self._say, lambda: f"{self.time_us * 1e-6:.4f} s")
        while running() and (until_us is None or self.time_us < until_us):
            goal = self.time_us + pace.slice_us
            self._advance(goal if until_us is None else min(goal, until_us), silence, running)
            self._clients.turn(0.0)
            on_slice()
            if silence.waits * WAIT_S > LOST_S:
                last = self.host.program.process.last_output()
                raise LinkLostError(f"autopilot {self._name} has not answered in {LOST_S:g} s; it said: {last}")
            if not silence.waits:
                pace.after_slice(self)

    def close(self) -> None:
        """End the program, close links and physics."""
        self.host.close()
        self._clients.close()
        self.plant.close()
