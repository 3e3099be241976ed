# SPDX-License-Identifier: BSD-3-Clause
"""Ways to have a vehicle at the other end of MAVLink's bytes, and to let its time go by."""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from ..bridge.dialect import message
from ..bridge.links.inprocess import InProcessLink
from ..bridge.services.commands import GRANT, RESEED
from ..errors import LinkLostError
from ..warp.page import CLOCK_PAGE
from .byte_socket import ByteStream, open_stream
from .commands import arguments, command_number
from .endpoint import Endpoint, Inbox

if TYPE_CHECKING:
    from ..simulation import Simulation
    from ..vehicle.kind import Kind

REQUEST_MESSAGE, AUTOPILOT_VERSION = command_number("REQUEST_MESSAGE"), message("AUTOPILOT_VERSION").id
ACCEPTED = 0
"""MAV_RESULT"""
TRIES = 4
"""A command that is not answered is sent so many times."""
PROOF = "SIM_WIND_SPD"
"""A parameter that only simulators have."""
_ANSWER_US = 1_000_000
"""Time within which a parameter is answered by a vehicle that goes by its own clock [us]."""
_LOOK_US = 20_000
_PROOF_S = 3.0
"""Wall time that a vehicle which answers other questions has for the parameter that proves a simulator [s]."""
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
    is_simulator = False
    """Whether it has proved to be one; a vehicle in this process need not."""
    simulation: Simulation | None = None
    """The vehicle itself, when it is in this process."""
    kind: Kind | None = None
    """Of vehicle, when its physics is in this process."""
    link: InProcessLink | None = None
    """Its end of the way to it, then."""

    def __init__(self, endpoint: Endpoint, inbox: Inbox | None = None) -> None:
        self.endpoint = endpoint
        self.inbox: Any = inbox if inbox is not None else Inbox()

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
            self.endpoint.command(number, *params, target=self.inbox.system or 1, confirmation=attempt)
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
            self._ask_parameter(name)
            for _ in range(1 if self.is_exact else _ANSWER_US // _LOOK_US):
                self.pause(0 if self.is_exact else _LOOK_US)
                if name in values:
                    return float(values[name])
        return None

    def _ask_parameter(self, name: str) -> None:
        target = {"target_system": self.inbox.system, "target_component": 1}
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

    def ask_who_it_is(self) -> None:
        """Find out whether it is a simulator, by questions that change no vehicle.

        Raises:
            LinkLostError: it answers none of them.
        """
        parameters, acks = self.inbox.parameters, self.inbox.acks
        self._ask_parameter(PROOF)
        self.endpoint.command(REQUEST_MESSAGE, AUTOPILOT_VERSION, target=self.inbox.system)
        self.exchange(lambda: PROOF in parameters or REQUEST_MESSAGE in acks, within=self.patience)
        if PROOF not in parameters:
            self._ask_parameter(PROOF)
            with contextlib.suppress(LinkLostError):
                self.exchange(lambda: PROOF in parameters, within=min(self.patience, _PROOF_S))
        self.is_simulator = PROOF in parameters

    def close(self) -> None:
        self.stream.close()


class Lockstep(Remote):
    """One that waits for grants (``sitl run --lockstep``): the same bytes at the same simulated times as in process.

    Args:
        time_ms: its simulated time since the start [ms].
    """

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

    def _reached(self, goal: int) -> bool:
        ack = self.inbox.acks.get(GRANT)
        if ack is None or ack.result != ACCEPTED or ack.result_param2 < goal:
            return False
        self.time_ms = ack.result_param2
        return True

    def reseed(self, seed: int) -> None:
        """Another seed for the noise of the vehicle's sensors."""
        self._send(RESEED, seed - (1 << 32) if seed >= 1 << 31 else seed)
        self.run(0)

    def _send(self, number: int, x: int) -> None:
        self.endpoint.send("COMMAND_INT", target_system=self.inbox.system, target_component=1, command=number, x=x)


class RealTime(Remote):
    """One that goes by its own clock; ``run`` ends with the first message that is late enough."""

    is_exact = False
    is_held = False

    def run(self, us: int) -> None:
        if us == 0:
            self.pause(0)
            return
        goal = self.inbox.time_ms + max(us // 1000 - 1, 1)
        self.exchange(lambda: self.inbox.time_ms >= goal, repeat=False, within=self.patience + 1e-6 * us)

    def pause(self, us: int) -> None:
        self.stream.flush()
        end = time.monotonic() + 1e-6 * us
        while True:
            left = end - time.monotonic()
            if self.stream.wait(max(left, 0.0)):
                self.inbox.feed(self.stream.receive())
            elif left <= 0.0:
                return

    def wait_answer(self, done: Callable[[], bool]) -> bool:
        self.exchange(done, within=self.patience)
        return True


def connect(
    text: str,
    inbox: Inbox | None = None,
    patience: float = 10.0,
    *,
    system: int = 255,
    component: int = 190,
    warn: Callable[[str], object] = lambda _: None,
) -> Lockstep | RealTime:
    """Find the vehicle, whether it proves to be a simulator, and whether its time can be held.

    It is only asked questions. One whose time cannot be held is used by its own clock.

    Args:
        text: a form of ``open_stream``.
        inbox: gets what comes back.
        patience: wall time [s] without a message after which the vehicle is lost.
        system, component: MAVLink ids of the client.
        warn: is told when the time cannot be held, but not in a script under ``sitl exec``, whose clock is the
            vehicle's.

    Raises:
        OptionError: no such form of connection.
        LinkLostError: nobody there.
    """
    stream = open_stream(text)
    probe = Remote(stream, inbox, patience, system, component)
    inbox, acks = probe.inbox, probe.inbox.acks

    def can_be_held() -> bool:
        return GRANT in acks and acks[GRANT].result == ACCEPTED

    try:
        if text.startswith(("udp:", "udpin:")):
            probe.exchange(lambda: inbox.system != 0, within=patience)
        probe.ask_who_it_is()
        if probe.is_simulator:  # to others it is somebody else's command
            probe.endpoint.send("COMMAND_INT", target_component=1, command=GRANT, x=0)
            probe.exchange(lambda: GRANT in acks, within=patience)
        if inbox.system == 0 and not can_be_held():
            probe.exchange(lambda: inbox.system != 0, within=patience)
    except LinkLostError:
        stream.close()
        raise LinkLostError(f"connection {text}: no vehicle answers within {patience:g} s") from None
    found: Lockstep | RealTime
    if can_be_held():
        found = Lockstep(stream, inbox, patience, acks[GRANT].result_param2, system, component)
    else:
        if CLOCK_PAGE not in os.environ:  # there this process's own clock is the vehicle's
            warn(f"connection {text}: the vehicle's clock cannot be held (no sitl run --lockstep); real time")
        found = RealTime(stream, inbox, patience, system, component)
    found.endpoint, found.is_simulator = probe.endpoint, probe.is_simulator
    inbox.system = inbox.system or 1
    return found
