# SPDX-License-Identifier: BSD-3-Clause
"""Ways to have a vehicle at the other end of MAVLink's bytes, and to let its time go by."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from ..bridge.dialect import MessageType
from ..bridge.links.inprocess import InProcessLink
from ..bridge.services.command_protocol import GRANT, RESEED
from ..core.mavlink import MavResult
from ..errors import LinkLostError
from ..warp.page import CLOCK_PAGE
from . import proof
from .byte_socket import ByteSocket, ByteStream, open_stream
from .commands import arguments, command_number
from .endpoint import AUTOPILOT, HEARTBEAT, Endpoint, Inbox
from .proof import REQUEST_MESSAGE

if TYPE_CHECKING:
    from ..simulation import Simulation
    from ..vehicle.kind import Kind

TRIES = 4
"""A command that is not answered is sent so many times."""
_ANSWER_US = 1_000_000
"""Time within which a parameter is answered by a vehicle that goes by its own clock [us]."""
_LOOK_US = 20_000
_PROOF_S = 3.0
"""Wall time that a vehicle which was just found has for the signs of a simulator [s]."""
EVERYBODY = 0
"""The target of the question who is there."""
_REPEAT_S = 0.5
"""Wall time after which a datagram that is not answered is taken for lost."""


class Connection:
    """Bytes to and from one vehicle, and its clock. Time goes by only in ``run`` and ``pause``.

    Args:
        endpoint: encodes what is sent.
        inbox: gets what comes back.
    """

    is_exact = True
    """Whether its clock goes exactly as far as it is told to."""
    is_held = True
    """Whether its clock stands between two calls."""
    doubt = "it has not been asked"
    """Why it may be real; "": it has proved to be a simulator (``proof``). A vehicle in this process need not."""
    simulation: Simulation | None = None
    """The vehicle itself, when it is in this process."""
    kind: Kind | None = None
    """Of vehicle, when its physics is in this process."""
    link: InProcessLink | None = None
    """Its end of the way to it, then."""

    def __init__(self, endpoint: Endpoint, inbox: Inbox | None = None) -> None:
        self.inbox: Any = inbox if inbox is not None else Inbox()
        self.endpoint = endpoint

    @property
    def endpoint(self) -> Endpoint:
        """Encodes what is sent; the vehicle answers to its ids."""
        return self._endpoint

    @endpoint.setter
    def endpoint(self, endpoint: Endpoint) -> None:
        self._endpoint = self.inbox.own = endpoint

    @property
    def system(self) -> int:
        """MAVLink id of the vehicle.

        Raises:
            LinkLostError: it has not been heard, so nothing can be sent to it.
        """
        if self.inbox.system == 0:
            raise LinkLostError(f"connection {self.name}: no vehicle has been heard yet")
        return int(self.inbox.system)

    @property
    def is_simulator(self) -> bool:
        """Whether the vehicle has proved to be one, when it was asked last."""
        return not self.doubt

    def prove(self) -> bool:
        """Ask the vehicle, now, for the signs of a simulator (``proof``); whether it has given all of them.

        Raises:
            LinkLostError: the connection is lost.
        """
        self.doubt = "it has not answered yet"
        self.doubt = proof.ask(self).doubt
        return self.is_simulator

    @property
    def name(self) -> str:
        """Of the connection, for messages."""
        raise NotImplementedError

    @property
    def time_us(self) -> int:
        """Simulated time since the start of the vehicle; reboots do not set it back [us]."""
        return 1000 * int(self.inbox.time_ms)

    @property
    def boots(self) -> int:
        """Differs before and after a reboot."""
        return int(self.inbox.boots)

    def run(self, us: int) -> None:
        """The vehicle receives what was sent and goes on by a simulated time [us]; all that it sends is received."""
        raise NotImplementedError

    def pause(self, us: int) -> None:
        """The same for a vehicle whose clock may not be known yet."""
        self.run(us)

    def catch_up(self) -> None:
        """Take in what has come while nobody listened: a vehicle whose clock is not held has gone on meanwhile."""

    def reopen(self) -> bool:
        """Connect again to a vehicle that has closed the connection to boot, and listen until it is heard; False: this
        kind of connection cannot.

        Raises:
            LinkLostError: it is not there any more.
        """
        return False

    def listen(self, us: int) -> None:
        """Send what is kept and take in what comes within this wall time [us]. In process, nobody is waited for."""
        self.run(0)

    def request(
        self,
        number: int,
        params: Sequence[float] = (),
        wait: Callable[[Callable[[], bool]], bool] | None = None,
        tries: int = TRIES,
    ) -> int | None:
        """Send a COMMAND_LONG until it is answered.

        Args:
            number: MAV_CMD.
            params: up to seven.
            wait: lets time go by until what it is given holds; returns whether it does. None: ``wait_answer``.
            tries: so many times it is sent.

        Returns:
            The MAV_RESULT; None when there is no answer.
        """
        acks, wait = self.inbox.acks, wait or self.wait_answer
        acks.pop(number, None)
        for attempt in range(tries):
            self.endpoint.command(number, *params, target=self.system, confirmation=attempt)
            if wait(lambda: number in acks):
                return int(acks[number].result)
        return None

    def command(self, name: str, *params: Any, **named: Any) -> int:
        """Send a command of this name (``commands``) until it is answered; returns the MAV_RESULT.

        Raises:
            LinkLostError: no answer.
            UnknownNameError: no such command, or no such parameter of it.
        """
        number = command_number(name)
        result = self.request(number, arguments(number, params, named))
        if result is None:
            raise LinkLostError(f"connection {self.name}: the vehicle does not answer {name}")
        return result

    def parameter(self, name: str) -> float | None:
        """A parameter as it is now; None when the vehicle does not give it."""
        values = self.inbox.parameters
        values.pop(name, None)
        for _ in range(TRIES):
            self.ask_parameter(name)
            for _ in range(1 if self.is_exact else _ANSWER_US // _LOOK_US):
                self.pause(0 if self.is_exact else _LOOK_US)
                if name in values:
                    return float(values[name])
        return None

    def ask_parameter(self, name: str) -> None:
        """Ask the vehicle for a parameter by its name."""
        target = {"target_system": self.system, "target_component": AUTOPILOT}
        self.endpoint.send("PARAM_REQUEST_READ", param_id=name.encode(), param_index=-1, **target)

    def wait_answer(self, done: Callable[[], bool]) -> bool:
        """Let as little time go by as an answer takes; whether it is there."""
        self.run(0)
        return done()

    def close(self) -> None:
        """Let go of what is open."""


class InProcess(Connection):
    """A simulation in this process; bytes pass without a socket.

    Args:
        simulation: the vehicle.
        inbox: gets what comes back.
        link: another than a new one, for example one that loses frames.
        advance: lets simulated time pass until a time [us]; None: ``simulation.advance_to``.
        system, component: MAVLink ids of the client.
    """

    name = "inprocess"

    def __init__(
        self,
        simulation: Simulation,
        inbox: Inbox | None = None,
        *,
        link: InProcessLink | None = None,
        advance: Callable[[int], object] | None = None,
        system: int = 255,
        component: int = 190,
    ) -> None:
        super().__init__(Endpoint(link, system, component), inbox)
        self.simulation: Simulation = simulation
        self.kind = simulation.kind
        self._advance_to = advance or simulation.advance_to
        self.link = self.endpoint.link
        simulation.bridge.add_link(self.endpoint.link)
        self.inbox.system = simulation.bridge.system

    @property
    def time_us(self) -> int:
        return self.simulation.time_us

    @property
    def boots(self) -> int:
        return self.simulation.before_boot_us

    def run(self, us: int) -> None:
        simulation = self.simulation
        goal = simulation.time_us + us
        self._advance_to(goal)
        while simulation.time_us < goal:  # one that waits for the wall clock may be interrupted
            self._advance_to(goal)
        self.receive()

    def receive(self) -> None:
        """Take in what the vehicle has sent, without time passing."""
        data = self.endpoint.link.receive()
        if data:
            self.inbox.feed(data)

    def close(self) -> None:
        self.simulation.close()


class Remote(Connection):
    """A vehicle at the other end of a socket.

    Args:
        stream: the socket.
        inbox: gets what comes back.
        patience: wall time [s] without a message after which it is lost.
    """

    is_exact = is_held = False

    def __init__(
        self, stream: ByteStream, inbox: Inbox | None, patience: float, system: int = 255, component: int = 190
    ) -> None:
        super().__init__(Endpoint(stream, system, component), inbox)
        self.stream = stream
        self.patience = patience

    @property
    def name(self) -> str:
        return self.stream.name

    def exchange(self, done: Callable[[], bool], repeat: bool = True, within: float | None = None) -> None:
        """Send what is kept and listen until ``done()``.

        Args:
            done: looked at after all that the vehicle sends.
            repeat: send it again after half a second.
            within: wall time for it all [s], whatever else the vehicle sends; None: as long as its time goes on.

        Raises:
            LinkLostError: not done in time.
        """
        data = self.stream.flush()
        began = sent = last = time.monotonic()
        while True:
            received = self.stream.receive()
            now = time.monotonic()
            if received:
                count = self.inbox.count
                self.inbox.feed(received)
                if self.inbox.count != count:
                    last = now
            if done():
                return
            since = last if within is None else began
            if now - since >= (self.patience if within is None else within):
                texts = self.inbox.last_texts[-4:]
                said = f"; its last texts: {'; '.join(texts)}" if texts else ""
                raise LinkLostError(f"connection {self.name} is lost: no answer for {now - since:.1f} s{said}")
            if repeat and now - max(sent, since) >= _REPEAT_S:
                self.stream.write(data)
                sent = now
            self.stream.wait(_REPEAT_S)

    def reopen(self) -> bool:
        """See ``Connection``: over TCP."""
        stream, end = self.stream, time.monotonic() + self.patience
        while isinstance(stream, ByteSocket) and stream.reopen(max(end - time.monotonic(), 0.0)):
            try:
                self.find()
            except LinkLostError:  # one that is still about to close takes connections, too
                if time.monotonic() >= end:
                    raise
            else:
                return True
        return False

    def find(self) -> None:
        """Listen until a HEARTBEAT of an autopilot says where the vehicle is; ask for one meanwhile.

        Raises:
            LinkLostError: none comes.
        """
        received: list[MessageType] = []
        self.inbox.witness = lambda kind, _: received.append(kind)
        try:
            if isinstance(self.stream, ByteSocket) and self.stream.listens:
                self._find_sender(self.stream, lambda: HEARTBEAT in received)
            else:
                self.endpoint.command(REQUEST_MESSAGE, HEARTBEAT.id, target=self.inbox.system or EVERYBODY)
                self.exchange(lambda: HEARTBEAT in received, within=self.patience)
        finally:
            self.inbox.witness = None

    def _find_sender(self, stream: ByteSocket, is_found: Callable[[], bool]) -> None:
        """The first sender of such a HEARTBEAT is the one that is spoken to and heard from now on."""
        end = time.monotonic() + self.patience
        while not is_found():
            left = end - time.monotonic()
            if not stream.wait(max(left, 0.0)) and left <= 0.0:
                raise LinkLostError(f"connection {self.name}: no HEARTBEAT of an autopilot")
            for data, address in stream.receive_each():
                if not is_found():
                    self.inbox.feed(data)
                    if is_found():
                        stream.settle(address)
                elif address == stream.peer:
                    self.inbox.feed(data)

    def prove_at_first(self) -> None:
        """The proof of one that was just found.

        Raises:
            LinkLostError: it answers no question.
        """
        signs = proof.ask(self, max(round(min(self.patience, _PROOF_S) / _REPEAT_S), 1))
        if not signs.received:
            self.exchange(lambda: REQUEST_MESSAGE in self.inbox.acks, within=self.patience)
        self.doubt = signs.doubt

    def listen(self, us: int) -> None:
        self.stream.flush()
        end = time.monotonic() + 1e-6 * us
        while True:
            left = end - time.monotonic()
            if self.stream.wait(max(left, 0.0)):
                self.inbox.feed(self.stream.receive())
            if left <= 0.0:  # whatever else comes
                return

    def pause(self, us: int) -> None:
        self.listen(us)

    def close(self) -> None:
        self.stream.close()


class Lockstep(Remote):
    """One that waits for grants (``sitl run --lockstep``): the same bytes at the same simulated times as in process.

    Args:
        time_ms: its simulated time since the start [ms].
    """

    is_exact = is_held = True

    def __init__(
        self, stream: ByteStream, inbox: Inbox | None, patience: float, time_ms: int, system: int = 255,
        component: int = 190,
    ) -> None:  # fmt: skip
        super().__init__(stream, inbox, patience, system, component)
        self.time_ms = time_ms

    @property
    def time_us(self) -> int:
        return 1000 * self.time_ms

    def run(self, us: int) -> None:
        before = self.time_ms
        self.time_ms = goal = before + us // 1000  # what comes in is of this time, as it is in process
        self.inbox.acks.pop(GRANT, None)
        self._send(GRANT, goal)
        try:
            self.exchange(lambda: self._reached(goal))
        except LinkLostError:
            self.time_ms = before
            raise

    def pause(self, us: int) -> None:
        self.run(us)

    def _reached(self, goal: int) -> bool:
        ack = self.inbox.acks.get(GRANT)
        if ack is None or ack.result != MavResult.ACCEPTED or ack.result_param2 < goal:
            return False
        self.time_ms = ack.result_param2
        return True

    def reseed(self, seed: int) -> None:
        """Another seed for the noise of the vehicle's sensors."""
        self._send(RESEED, seed - (1 << 32) if seed >= 1 << 31 else seed)
        self.run(0)

    def _send(self, number: int, x: int) -> None:
        target = {"target_system": self.system, "target_component": AUTOPILOT}
        self.endpoint.send("COMMAND_INT", command=number, x=x, **target)


class RealTime(Remote):
    """One that goes by its own clock; ``run`` ends with the first message that is late enough."""

    def run(self, us: int) -> None:
        if us == 0:
            self.pause(0)
            return
        goal = self.inbox.time_ms + max(us // 1000 - 1, 1)
        self.exchange(lambda: self.inbox.time_ms >= goal, repeat=False, within=self.patience + 1e-6 * us)

    def catch_up(self) -> None:
        self.pause(0)

    def wait_answer(self, done: Callable[[], bool]) -> bool:
        self.exchange(done, within=self.patience)
        return True


def connect(
    text: str,
    inbox: Inbox | None = None,
    patience: float = 10.0,
    *,
    target: int = 0,
    system: int = 255,
    component: int = 190,
    warn: Callable[[str], object] = lambda _: None,
) -> Lockstep | RealTime:
    """Find the vehicle, whether it proves to be a simulator, and whether its time can be held.

    It is only asked questions, until it has proved to be a simulator (``proof``). ``prove`` is the proof anew, when
    something depends on it later. One whose time cannot be held is used by its own clock.

    Args:
        text: a form of ``open_stream``.
        inbox: gets what comes back.
        patience: wall time [s] without a message after which the vehicle is lost.
        target: MAVLink id of the vehicle, where several share the link; 0: the first whose HEARTBEAT is received.
        system, component: MAVLink ids of the client.
        warn: called when the time cannot be held, but not in a script under ``sitl exec``, whose clock is the
            vehicle's.

    Raises:
        OptionError: no such form of connection.
        LinkLostError: nobody there.
    """
    stream = open_stream(text)
    probe = Remote(stream, inbox, patience, system, component)
    inbox, acks = probe.inbox, probe.inbox.acks
    inbox.system = target

    def can_be_held() -> bool:
        return GRANT in acks and acks[GRANT].result == MavResult.ACCEPTED

    try:
        probe.find()
        probe.prove_at_first()
        if probe.is_simulator:  # to others it is somebody else's command
            found_at = {"target_system": probe.system, "target_component": AUTOPILOT}
            probe.endpoint.send("COMMAND_INT", command=GRANT, x=0, **found_at)
            probe.exchange(lambda: GRANT in acks, within=patience)
    except LinkLostError:
        stream.close()
        who = f"no vehicle of system {target}" if target else "no vehicle"
        raise LinkLostError(f"connection {text}: {who} answers within {patience:g} s") from None
    found: Lockstep | RealTime
    if can_be_held():
        found = Lockstep(stream, inbox, patience, acks[GRANT].result_param2, system, component)
    else:
        if CLOCK_PAGE not in os.environ:  # there this process's own clock is the vehicle's
            warn(f"connection {text}: the vehicle's clock cannot be held (no sitl run --lockstep); real time")
        found = RealTime(stream, inbox, patience, system, component)
    found.endpoint, found.doubt = probe.endpoint, probe.doubt
    return found
