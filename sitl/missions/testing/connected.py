# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle and a ground station beside it, in one process: time, commands, telemetry; all by MAVLink bytes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, NoReturn

from sitl.bridge.client import Client, Received
from sitl.bridge.dialect import message
from sitl.simulation import Simulation

from .known import Known
from .script import Script
from .telemetry import RATES_HZ, Telemetry

STEP_US = 100_000
"""Waits look ten times a second [simulated us]."""
BEAT_US = 1_000_000
"""Between two heartbeats of the ground station."""
REPEAT_US = 500_000
"""Between two sendings of what a vehicle forgets soon: velocities, sticks."""
ANSWER_S = 3.0
"""A command is answered within."""
REQUEST_MESSAGE, SET_INTERVAL = 512, 511
RESULTS = ("accepted", "temporarily rejected", "denied", "unsupported", "failed", "in progress", "cancelled")
"""MAV_RESULT"""
Held = tuple[str, dict[str, Any]]


@dataclass
class Watch:
    """Something that must hold all the time."""

    holds: Callable[[], Any]
    what: str


@dataclass
class Ear:
    """Collects messages of one name."""

    name: str
    heard: list[Any] = field(default_factory=list)


class Connected(Known):
    """Time, commands and telemetry of one vehicle.

    Args:
        build: makes the simulation, at power-on; called again whenever the flight is flown again for its logs.
        name: for messages and files.
    """

    def __init__(self, build: Callable[[], Simulation], name: str = "vehicle") -> None:
        __tracebackhide__ = True
        self.build, self.name = build, name
        self.simulation = build()
        self.client = Client()
        self.simulation.bridge.add_link(self.client.link)
        self.script = Script(self.simulation, self.client.link)
        self.client.link = self.script
        self.telemetry = Telemetry()
        self._held: dict[str, Held] = {}
        self._next_us = {"beat": 0}
        self._found = 0
        self._silent = False
        self._acks: dict[int, int] = {}
        self._watches: list[Watch] = []
        self._ears: list[Ear] = []
        self._boot_us = self.simulation.before_boot_us
        self._ask()

    # ------------------------------------------------------------------ time

    def delay(self, seconds: float) -> None:
        """Let simulated time pass."""
        __tracebackhide__ = True
        stop = self.simulation.time_us + round(seconds * 1e6)
        while self.simulation.time_us < stop:
            self.step(stop)

    def step(self, stop_us: int | None = None) -> None:
        """Go on to the next whole tenth of a second, but not beyond ``stop_us``, and hear what the vehicle says."""
        __tracebackhide__ = True
        simulation = self.simulation
        now = simulation.time_us
        for name, due in self._next_us.items():
            if now >= due:
                self._repeat(name)
                self._next_us[name] = now + (BEAT_US if name == "beat" else REPEAT_US)
        until = now // STEP_US * STEP_US + STEP_US
        simulation.advance_to(until if stop_us is None else min(until, stop_us))
        self.hear()
        if simulation.before_boot_us != self._boot_us:
            self._boot_us = simulation.before_boot_us
            self._ask()
        for watch in self._watches:
            if not watch.holds():
                self._watches.remove(watch)
                self.give_up(f"at all times: {watch.what}; it is not so now")

    def hear(self) -> None:
        """Take in what the vehicle has sent."""
        now = self.now
        for received in self.client.receive():
            self._take(now, received)

    def _take(self, now: float, received: Received) -> None:
        name, fields = received
        self.telemetry.take(now, name, fields)
        if name == "COMMAND_ACK":
            self._acks[int(fields.command)] = int(fields.result)
        for ear in self._ears:
            if ear.name == name:
                ear.heard.append(fields)

    def wait_until(
        self,
        condition: Callable[[], Any],
        timeout: float,
        what: str = "the condition",
        last: Callable[[], str] = lambda: "",
        hold: float = 0.0,
    ) -> None:
        """Wait until a condition holds, and has held for ``hold`` seconds; looked at ten times a second.

        Args:
            timeout: simulated seconds.
            what: is awaited; for the message.
            last: tells what was seen last; for the message.

        Raises:
            AssertionError: it did not come to hold in time.
        """
        __tracebackhide__ = True
        begin = self.simulation.time_us
        stop, since = begin + round(timeout * 1e6), -1
        while True:
            if condition():
                since = self.simulation.time_us if since < 0 else since
                if self.simulation.time_us - since >= round(hold * 1e6):
                    return
            else:
                since = -1
            if self.simulation.time_us >= stop:
                kept = f", for {hold:g} s" if hold else ""
                self.give_up(f"waited {timeout:g} s for {what}{kept}", last())
            self.step()

    @contextmanager
    def always(self, condition: Callable[[], Any], what: str = "the condition holds") -> Iterator[None]:
        """While the block flies, a condition must hold; looked at ten times a second."""
        watch = Watch(condition, what)
        self._watches.append(watch)
        try:
            yield
        finally:
            if watch in self._watches:
                self._watches.remove(watch)

    # ------------------------------------------------------------------ commands and messages

    def send(self, name: str, **fields: Any) -> None:
        """Send any message; fields not given are zero, its target is this vehicle."""
        known = message(name).fields
        if "target_system" in known:
            fields.setdefault("target_system", self.simulation.bridge.system)
        if "target_component" in known:
            fields.setdefault("target_component", 1)
        self.client.send(name, **fields)

    def command(self, number: int, *params: float, name: str = "") -> None:
        """Send a COMMAND_LONG with up to seven parameters, and wait until it is accepted."""
        __tracebackhide__ = True
        what = name or f"command {number}"
        self._acks.pop(number, None)
        self.client.command(number, *params, target=self.simulation.bridge.system)
        self.wait_until(lambda: number in self._acks, ANSWER_S, f"an answer to {what}")
        result = self._acks[number]
        if result:
            self.give_up(f"{what} was refused: {RESULTS[result] if result < len(RESULTS) else result}")

    def message(self, name: str, timeout: float = 2.0) -> Any:
        """Ask for one message and wait for it; gives its fields as a named tuple."""
        __tracebackhide__ = True
        with self._listening(name) as ear:
            self.command(REQUEST_MESSAGE, message(name).id, name=f"the request for {name}")
            self.wait_until(lambda: ear.heard, timeout, name)
        return ear.heard[-1]

    @contextmanager
    def messages(self, name: str, rate_hz: float | None = None) -> Iterator[list[Any]]:
        """All messages of a name that come while the block flies, as a list that grows; ``rate_hz``: ask for them."""
        if rate_hz is not None:
            number = message(name).id
            self.command(SET_INTERVAL, number, 1e6 / rate_hz, name=f"{name} at {rate_hz:g} Hz")
        with self._listening(name) as ear:
            yield ear.heard
        if rate_hz is not None:
            self.client.set_interval(name, float(RATES_HZ.get(name, 0)))

    @contextmanager
    def _listening(self, name: str) -> Iterator[Ear]:
        message(name)  # says when there is none
        ear = Ear(name)
        self._ears.append(ear)
        try:
            yield ear
        finally:
            self._ears = [other for other in self._ears if other is not ear]

    def _ask(self) -> None:
        for name, rate in RATES_HZ.items():
            self.client.set_interval(name, rate)

    def _repeat(self, name: str) -> None:
        if name == "beat":
            if not self._silent:
                self.client.send("HEARTBEAT", type=6, autopilot=8, mavlink_version=3)
        elif name in self._held:
            kind, fields = self._held[name]
            self.send(kind, **fields)

    def _hold(self, name: str, kind: str, fields: dict[str, Any]) -> None:
        """Send a message now, and again and again until it is let go."""
        self._held[name] = (kind, fields)
        self.send(kind, **fields)
        self._next_us[name] = self.simulation.time_us + REPEAT_US

    def _let_go(self, name: str) -> None:
        self._held.pop(name, None)
        self._next_us.pop(name, None)

    # ------------------------------------------------------------------ failures

    def give_up(self, what: str, last: str = "") -> NoReturn:
        """Fail, and say what the vehicle does.

        Raises:
            AssertionError: always.
        """
        __tracebackhide__ = True
        lines = [what]
        if last:
            lines.append(f"  last seen: {last}")
        lines.append(f"  {self.name} at {self.now:.1f} s simulated: {self.describe()}")
        if self.texts:
            lines += ["  last texts:", *(f"  {text}" for text in self.last_texts())]
        raise AssertionError("\n".join(lines))
