# SPDX-License-Identifier: BSD-3-Clause
"""Serves a plant to an autopilot that speaks ArduPilot's JSON interface (``arducopter --model JSON:127.0.0.1``)."""

from __future__ import annotations

import socket
import time
from collections import deque
from collections.abc import Callable

from ..bridge.ardupilot_json.physics_end import Asked, PhysicsEnd
from ..bridge.ardupilot_json.servos import is_frame
from ..errors import OptionError
from ..plants.json_link import LOCAL, PORT, WAIT_S, parse_address, wait_in_kernel
from ..plants.local import LocalPlant, restart
from ..plants.physics_server import Silence
from .body import BodyLines
from .exchange import IS_ODD

_MAX_DATAGRAM = 1024
"""Bytes of a datagram that are read: more than a frame has."""
_GATHERED = 10_000
"""Largest number of waiting datagrams that are read before answering, so that nobody can prevent an answer."""
_IDLE_S = 0.01
"""Time without an answer of ours after which waiting datagrams are read through [s]."""
_ENOUGH = (Asked.NOTHING, Asked.REPEAT)
"""What is asked for when the caller gets a turn without a step."""
ANSWERS = 16
"""So many answers are given in one call at most: the autopilot's MAVLink is looked at in between, which stands still
when nobody reads it."""


class JsonHost:
    """Serves one plant at a UDP port.

    Args:
        plant: at power-on, as ``sitl.plants.local.stand_alone`` gives it.
        address: host and port to listen on; port 0: a free one.
        say: prints a message for the user.
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
        """Number of restarts of the autopilot, each with the physics."""
        self.before_boot_us = 0
        """Simulated time before the last of them [us]."""
        self.attach(plant)
        self._restarts = False
        self._unread: deque[tuple[bytes, tuple[str, int]]] = deque()
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

    def attach(self, plant: LocalPlant) -> None:
        """Serve another plant from now on."""
        self.plant = plant
        self._lines = BodyLines(plant)
        self._clock: Callable[[], int] = plant.vehicle.reader.field("time_us")

    @property
    def address(self) -> tuple[str, int]:
        """(host, port) that it listens on."""
        host, port = self._socket.getsockname()[:2]
        return host, port

    @property
    def time_us(self) -> int:
        """Simulated time since power-on [us]."""
        return self._clock()

    def listen(self) -> bool:
        """Wait for a frame that requests a step, unless one is pending; returns whether there is one."""
        while not self._lines.is_asked:
            try:
                datagram, peer = self._receive()
            except OSError:  # none came, or our last answer met a closed port
                return False
            now = self._wall()
            if now - self._answered > _IDLE_S:
                asked = self._process_all(self._drain(datagram, peer), now)
            elif self.end.is_answered(datagram, peer, now):
                continue
            else:
                asked = self._process(datagram, peer, now)
            if asked in _ENOUGH:
                return False
        return True

    def _receive(self, flags: int = 0) -> tuple[bytes, tuple[str, int]]:
        """The next datagram and who sent it."""
        return self._unread.popleft() if self._unread else self._socket.recvfrom(_MAX_DATAGRAM, flags)

    def _process_all(self, waiting: dict[tuple[str, int], bytes], now: float) -> Asked:
        """Process what has waited, the autopilot's datagram before those of strangers, until one is served."""
        for peer in sorted(waiting, key=lambda peer: peer != self.end.peer):
            asked = self._process(waiting[peer], peer, now)
            if asked is not Asked.NOTHING:
                return asked
        return Asked.NOTHING

    def _process(self, datagram: bytes, peer: tuple[str, int], now: float) -> Asked:
        """Process one datagram; returns what it asks for. A request of a step is pending from now on."""
        request = self.end.receive(datagram, peer, now)
        if request.note:
            self._say(request.note)
        if request.asked is Asked.REPEAT:
            self._peer = peer
            self._send(self.end.repeat(now))
            self._answered = now
        elif request.asked in (Asked.STEP, Asked.RESTART) and request.servos is not None:
            self._peer, self._restarts = peer, request.asked is Asked.RESTART
            self._lines.ask(request.servos.rate, request.servos.pulses)
        return request.asked

    def _drain(self, datagram: bytes, peer: tuple[str, int]) -> dict[tuple[str, int], bytes]:
        """Read the datagrams that wait behind this one; of each sender the last frame counts, or its last datagram if
        there is no frame."""
        waiting = {peer: datagram}
        for _ in range(_GATHERED):
            try:
                datagram, peer = self._receive(socket.MSG_DONTWAIT)
            except OSError:
                break
            if peer not in waiting or is_frame(datagram) or not is_frame(waiting[peer]):
                waiting[peer] = datagram
        return waiting

    def step(self, until_us: int | None = None, answers: int = 1) -> None:
        """Perform the requested step and answer it; at most until ``until_us`` [us since power-on].

        With more ``answers`` it may wait for the steps that follow and answer as many of them, up to the same time.
        """
        if not self._lines.is_asked:
            return
        if self._restarts:
            self._restarts = False
            self.before_boot_us += self._clock()
            restart(self.plant)
            self.boots += 1
        if self._lines.is_quick:
            self._converse(until_us, answers)
            return
        states = self._lines.step(until_us)
        self._answered = self._wall()
        self.end.answer(states, self._answered)
        for line in states:
            self._send(line)

    def _converse(self, until_us: int | None, answers: int) -> None:
        """Steps and answers in one compiled call."""
        lines, x = self._lines, self._lines.exchange
        x.count = self.end.count or 0
        how = lines.converse(self._socket, self._peer, until_us, answers)
        self._answered = self._wall()
        self.end.go_on(int(x.first), int(x.count), lines, self._answered)
        if how == IS_ODD:
            self._unread.extend(lines.unjudged())

    def _send(self, line: bytes) -> None:
        try:
            self._socket.sendto(line, self._peer)
        except OSError as error:
            self._say(f"an answer to {self._peer[0]}:{self._peer[1]} was not sent: {error.strerror or error}")

    def serve(self, running: Callable[[], bool], on_turn: Callable[[], None] = lambda: None) -> None:
        """Answer until ``running()`` is false; ``on_turn`` is called from time to time, also without requests. An
        autopilot that falls silent is reported, and time stands."""
        turn, turns = self.listen, 0
        silence = Silence(self._say, lambda: f"{self.time_us * 1e-6:.4f} s")
        while True:
            if turn():
                if silence.waits:
                    silence.is_over()
                self.step(answers=ANSWERS)
                turns += 1
            else:
                turns = 0
                if self.end.peer is not None:
                    silence.goes_on()
            if turns & 1 == 0:
                if not running():
                    return
                on_turn()

    def close(self) -> None:
        """Close the socket; the plant stays open."""
        self._socket.close()


def serve(
    plant: LocalPlant,
    address: str,
    instance: int,
    say: Callable[[str], None],
    running: Callable[[], bool],
) -> None:
    """Listen until ``running()`` is false.

    Args:
        plant: at power-on.
        address: "[HOST:]PORT", "HOST", or "" for the default port of the instance on this machine.
        instance: adds 10 to the default port for each.
        say: prints a message for the user.
        running: checked about every 0.1 s.

    Raises:
        OptionError: the address cannot be had.
    """
    where = parse_address(address, "--listen json:[HOST:]PORT") if address else (LOCAL, PORT + 10 * instance)
    host = JsonHost(plant, where, say)
    say(f"JSON on udp {host.address[0]}:{host.address[1]}")
    try:
        host.serve(running)
    finally:
        host.close()
