# SPDX-License-Identifier: BSD-3-Clause
"""Serves a plant to an autopilot that speaks ArduPilot's JSON interface (``arducopter --model JSON:127.0.0.1``)."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable

from ..bridge.ardupilot_json.physics_end import Asked, Heard, PhysicsEnd, ticks
from ..bridge.ardupilot_json.servos import controls, is_frame
from ..errors import OptionError
from ..plants.alone import restart
from ..plants.json_link import WAIT_S, wait_in_kernel
from ..plants.local import LocalPlant
from ..vehicle.record import TICK_US
from .body import BodyLines

_MOST = 65535
_GATHERED = 10_000
"""So many datagrams are looked through at once: nobody can keep us from answering."""
_IDLE_S = 0.01
"""After so long without an answer of ours the frames that wait are looked through [s]."""


class JsonHost:
    """One plant at a UDP port.

    Args:
        plant: at power-on, as ``sitl.plants.alone.stand_alone`` gives it.
        address: host and port to listen on; port 0: a free one.
        say: takes what people should be told.
        clock: wall time [s].

    Raises:
        OptionError: the port cannot be had.
    """

    def __init__(
        self,
        plant: LocalPlant,
        address: tuple[str, int],
        say: Callable[[str], None] = lambda text: None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.end, self._say, self._wall = PhysicsEnd(), say, clock
        self.boots = 0
        """How often the autopilot has been started anew, and the physics with it."""
        self.seat(plant)
        self._pending: Heard | None = None
        self._answered = float("-inf")
        self._peer: tuple[str, int] = ("", 0)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._socket.bind(address)
        except OSError as error:
            self._socket.close()
            where = f"json:{address[0]}:{address[1]}"
            raise OptionError(f"{where} cannot be listened on: {error.strerror or error}") from None
        wait_in_kernel(self._socket, WAIT_S)

    def seat(self, plant: LocalPlant) -> None:
        """Serve this plant from now on."""
        self.plant = plant
        self._lines = BodyLines(plant.craft)
        self._clock: Callable[[], int] = plant.craft.reader.field("time_us")
        self._is_copter = plant.craft.kind.name == "copter"

    @property
    def address(self) -> tuple[str, int]:
        """(host, port) that it listens on."""
        host, port = self._socket.getsockname()[:2]
        return host, port

    @property
    def time_us(self) -> int:
        """Simulated time since power-on [us]."""
        return self._clock()

    @property
    def is_owing(self) -> bool:
        """Whether the autopilot waits for an answer of ours."""
        return self._pending is not None

    def listen(self) -> bool:
        """Wait a moment for a frame that asks for a step, unless one waits already; whether there is one."""
        if self._pending is not None:
            return True
        try:
            datagram, peer = self._socket.recvfrom(_MOST)
        except OSError:  # none came, or our last answer met a closed port
            return False
        now = self._wall()
        waiting = {peer: datagram}
        if now - self._answered > _IDLE_S:
            self._newest(waiting)
        for peer in sorted(waiting, key=lambda peer: peer != self.end.peer):  # the autopilot before strangers
            if self._hear(waiting[peer], peer, now):
                return True
        return False

    def _hear(self, datagram: bytes, peer: tuple[str, int], now: float) -> bool:
        """Take one datagram; whether it asks for a step."""
        heard = self.end.hear(datagram, peer, now)
        if heard.note:
            self._say(heard.note)
        if heard.asked is Asked.NOTHING:
            return False
        self._peer = peer
        if heard.asked is Asked.REPEAT:
            self._send(self.end.repeat(now))
            self._answered = now
            return False
        self._pending = heard
        return True

    def _newest(self, waiting: dict[tuple[str, int], bytes]) -> None:
        """Look through the datagrams that wait: the last frame of each sender counts, or the last that is none."""
        for _ in range(_GATHERED):
            try:
                datagram, peer = self._socket.recvfrom(_MOST, socket.MSG_DONTWAIT)
            except OSError:
                return
            if peer not in waiting or is_frame(datagram) or not is_frame(waiting[peer]):
                waiting[peer] = datagram

    def step(self, until_us: int | None = None) -> None:
        """Do what the frame that waits asks for, and answer it; no further than ``until_us`` [us]."""
        heard, self._pending = self._pending, None
        if heard is None or heard.servos is None:
            return
        plant, servos = self.plant, heard.servos
        if heard.asked is Asked.RESTART:
            restart(plant)
            self.boots += 1
        actuators = plant.craft.v.actuators
        actuators.controls[:] = controls(servos.pulses, self._is_copter)
        actuators.pwm[:] = servos.pulses[:16]
        count = ticks(servos.rate)
        if until_us is not None:
            count = min(count, max((until_us - self._clock()) // TICK_US, 1))
        for _ in range(count):
            plant.tick()
        self._answered = self._wall()
        self._send(self.end.answer(self._lines.line(), self._answered))

    def _send(self, line: bytes) -> None:
        try:
            self._socket.sendto(line, self._peer)
        except OSError as error:
            self._say(f"an answer to {self._peer[0]}:{self._peer[1]} was not sent: {error.strerror or error}")

    def serve(self, running: Callable[[], bool], on_turn: Callable[[], None] = lambda: None) -> None:
        """Answer until ``running()`` is false; ``on_turn`` is called now and then, also while nobody asks."""
        turn, turns = self.listen, 0
        while True:
            if turn():
                self.step()
                turns += 1
            else:
                turns = 0
            if turns & 31 == 0:
                if not running():
                    return
                on_turn()

    def close(self) -> None:
        """Let go of the socket; the plant is the caller's."""
        self._socket.close()
