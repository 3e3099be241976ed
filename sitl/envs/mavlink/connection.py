# SPDX-License-Identifier: BSD-3-Clause
"""Ways to have a vehicle at the other end of MAVLink's bytes, and to let its time go by."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from gymnasium import logger

from sitl.bridge.client import Client
from sitl.bridge.dialect import message
from sitl.bridge.services.grants import GRANT, RESEED
from sitl.simulation import Simulation

from .ends import LinkLostError, SocketEnd
from .telemetry import Telemetry

COMMAND_INT = message("COMMAND_INT")
ACCEPTED, IN_PROGRESS = 0, 5
_TRIES = 4
_REPEAT_S = 0.5
"""Wall time after which a datagram that is not answered is taken for lost."""


class Connection:
    """A vehicle that is spoken to; time goes by only in ``run`` and ``pause``."""

    client: Client
    is_exact = True
    """Whether its clock goes exactly as far as it is told to."""
    splits_steps = True
    """Whether it can be spoken to within a step."""
    sees = False
    """Whether scans and touches come with it, not by MAVLink."""
    longest_interval_us = 1 << 62
    """Greatest interval of telemetry that is new enough at the end of a step [us]."""
    was_rebooted = False
    learned: float | None = None
    """What the vehicle may have changed by itself, as it was at first (``preparation.reboot``)."""

    def __init__(self, readings: int) -> None:
        self.heard = Telemetry(readings)

    def run(self, us: int) -> None:
        """The vehicle hears what was sent and goes on by a simulated time [us]; all that it says is heard."""
        raise NotImplementedError

    def pause(self, us: int) -> None:
        """The same for a vehicle that may not say where it is yet."""
        self.run(us)

    def command(self, number: int, *params: float) -> int:
        """Send a COMMAND_LONG; returns the MAV_RESULT.

        Raises:
            LinkLostError: no answer.
        """
        self.heard.acks.clear()
        for _ in range(_TRIES):
            self.client.command(number, *params, target=self.heard.system)
            result = self._answer(number)
            if result is not None:
                return result
        raise LinkLostError(f"connection {self.name}: the vehicle does not answer command {number}")

    def _answer(self, number: int) -> int | None:
        self.run(0)
        return self._result(number)

    def _result(self, number: int) -> int | None:
        results = [ack.result for ack in self.heard.acks if ack.command == number and ack.result != IN_PROGRESS]
        return int(results[0]) if results else None

    @property
    def name(self) -> str:
        """Of the connection, for people."""
        raise NotImplementedError

    def close(self) -> None:
        """Let go of what is open."""


class InProcess(Connection):
    """A simulation in this process; bytes pass without a socket.

    Args:
        simulation: the vehicle.
        readings: of its scans.
    """

    name = "inprocess"

    def __init__(self, simulation: Simulation, readings: int) -> None:
        super().__init__(readings)
        self.simulation = simulation
        self.client = Client()
        simulation.bridge.add_link(self.client.link)
        self.heard.system = simulation.bridge.system
        self._receive = self.client.link.receive

    def run(self, us: int) -> None:
        simulation = self.simulation
        simulation.advance_to(simulation.time_us + us)
        data = self._receive()
        if data:
            self.heard.feed(data)

    def close(self) -> None:
        self.simulation.close()


class Remote(Connection):
    """A vehicle at the other end of a socket.

    Args:
        end: the socket.
        readings: of its scans.
        patience: wall time [s] without a word after which it is lost.
    """

    def __init__(self, end: SocketEnd, readings: int, patience: float) -> None:
        super().__init__(readings)
        self.end = end
        self.client = Client(end)
        self.patience = patience

    @property
    def name(self) -> str:
        return self.end.name

    def exchange(self, done: Callable[[], bool], repeat: bool = True, within: float | None = None) -> None:
        """Send what is kept and listen until ``done()``.

        Args:
            done: looked at after every word of the vehicle.
            repeat: send it again after half a second.
            within: wall time for it all [s], whatever else the vehicle says; None: as long as its time goes on.

        Raises:
            LinkLostError: not done in time.
        """
        data = self.end.flush()
        began = sent = last = time.monotonic()
        while True:
            heard = self.end.receive()
            now = time.monotonic()
            if heard:
                words = self.heard.words
                self.heard.feed(heard)
                if self.heard.words != words:
                    last = now
            if done():
                return
            since = last if within is None else began
            if now - since >= (self.patience if within is None else within):
                told = f"; it told: {'; '.join(self.heard.texts[-4:])}" if self.heard.texts else ""
                raise LinkLostError(f"connection {self.name} is lost: no answer for {now - since:.1f} s{told}")
            if repeat and now - max(sent, since) >= _REPEAT_S:
                self.end.write(data)
                sent = now
            self.end.wait(_REPEAT_S)

    def close(self) -> None:
        self.end.close()


class Lockstep(Remote):
    """One that waits for grants (``sitl run --lockstep``): the same bytes at the same simulated times as in process."""

    def __init__(self, end: SocketEnd, readings: int, patience: float, time_ms: int) -> None:
        super().__init__(end, readings, patience)
        self.time_ms = time_ms
        """Simulated time since the start [ms]."""

    def run(self, us: int) -> None:
        goal = self.time_ms + us // 1000
        self.client.send("COMMAND_INT", target_system=self.heard.system, target_component=1, command=GRANT, x=goal)
        self.exchange(lambda: self._reached(goal))

    def _reached(self, goal: int) -> bool:
        for ack in self.heard.acks:
            if ack.command == GRANT and ack.result == ACCEPTED and ack.result_param2 >= goal:
                self.time_ms = ack.result_param2
                self.heard.acks = [other for other in self.heard.acks if other.command != GRANT]
                return True
        return False

    def reseed(self, seed: int) -> None:
        """Another seed for the noise of the vehicle's sensors."""
        x = seed - (1 << 32) if seed >= 1 << 31 else seed
        self.client.send("COMMAND_INT", target_system=self.heard.system, target_component=1, command=RESEED, x=x)
        self.run(0)


class RealTime(Remote):
    """One that goes by its own clock; a step ends with the first position that is old enough."""

    is_exact = False
    splits_steps = False

    def run(self, us: int) -> None:
        if us == 0:
            self.pause(0)
            return
        goal = self.heard.position[0] + us // 1000 - 1
        self.exchange(lambda: self.heard.position[0] >= goal, repeat=False, within=self.patience + 1e-6 * us)

    def pause(self, us: int) -> None:
        self.end.flush()
        end = time.monotonic() + 1e-6 * us
        while True:
            left = end - time.monotonic()
            if self.end.wait(max(left, 0.0)):
                self.heard.feed(self.end.receive())
            elif left <= 0.0:
                return

    def _answer(self, number: int) -> int | None:
        self.exchange(lambda: self._result(number) is not None, within=self.patience)
        return self._result(number)


def connect(text: str, readings: int, patience: float) -> Remote:
    """Find the vehicle, and whether its time can be held; one whose cannot is used in real time, with a warning.

    Raises:
        EnvOptionError, LinkLostError: no such form of connection; nobody there.
    """
    end = SocketEnd(text)
    probe = Remote(end, readings, patience)
    answer: list[Any] = []

    def answered() -> bool:
        answer.extend(ack for ack in probe.heard.acks if ack.command == GRANT)
        return bool(answer)

    try:
        if text.startswith(("udp:", "udpin:")):
            probe.exchange(lambda: probe.heard.system != 0, within=patience)
        probe.client.send("COMMAND_INT", target_component=1, command=GRANT, x=0)
        probe.exchange(answered, within=patience)
        if probe.heard.system == 0 and answer[0].result != ACCEPTED:
            probe.exchange(lambda: probe.heard.system != 0, within=patience)
    except LinkLostError:
        end.close()
        raise LinkLostError(f"connection {text}: no vehicle answers within {patience:g} s") from None
    found: Remote
    if answer[0].result == ACCEPTED:
        found = Lockstep(end, readings, patience, answer[0].result_param2)
    else:
        logger.warn(f"connection {text}: the vehicle's clock cannot be held (no sitl run --lockstep); real time")
        found = RealTime(end, readings, patience)
    found.heard.system = probe.heard.system or 1
    return found
