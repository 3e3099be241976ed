# SPDX-License-Identifier: BSD-3-Clause
"""Flies a log's script in lockstep, and says what went otherwise."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from sitl.bridge.dialect import FieldError, message
from sitl.client import Endpoint
from sitl.simulation import Simulation

from ..station import Station, StationError
from .extract import ANSWER_S, Script
from .steps import Send, Sender, Step, Upload

READY_S = 120.0
"""A vehicle that is not ready by then will not be [simulated s]."""
LANDING_S = 300.0
"""Time to land for a vehicle that was disarmed at the end of the log [simulated s]."""
LATE_S = 60.0
"""Allowed delay in reaching the items of a mission [simulated s]."""
RESULTS = ("ACCEPTED", "TEMPORARILY_REJECTED", "DENIED", "UNSUPPORTED", "FAILED", "IN_PROGRESS", "CANCELLED")
"""MAV_RESULT"""
_HEADERS = frozenset(("target_system", "target_component"))


def result_name(result: int | None) -> str:
    """A MAV_RESULT in words."""
    if result is None:
        return "not answered"
    return RESULTS[result] if 0 <= result < len(RESULTS) else f"MAV_RESULT {result}"


@dataclass
class Report:
    """Result of flying a log."""

    notes: list[str] = field(default_factory=list)
    """What could not be taken over, or differed without harm."""
    faults: list[str] = field(default_factory=list)
    """What the vehicle of the log did and this one refused."""
    waited: float = 0.0
    """Total time that steps waited for this vehicle [s]."""
    sent: int = 0
    """Messages sent."""


class _Player(Station):
    """A ground station that also is every other sender of the log."""

    def __init__(self, simulation: Simulation, advance: Callable[[int], object] | None, main: Sender) -> None:
        self.answers: dict[int, list[tuple[float, int]]] = {}
        super().__init__(simulation, advance)
        own = self.connection.endpoint
        own.system, own.component = main
        self.endpoints: dict[Sender, Endpoint] = {main: own}

    def of(self, sender: Sender) -> Endpoint:
        """The endpoint that sends what a sender sent."""
        if sender not in self.endpoints:
            endpoint = self.endpoints[sender] = Endpoint(system=sender[0], component=sender[1])
            self.simulation.bridge.add_link(endpoint.link)
        return self.endpoints[sender]

    def step(self, stop_us: int | None = None) -> None:
        super().step(stop_us)
        for endpoint in self.endpoints.values():
            for name, fields in endpoint.receive():
                self._take(name, fields)

    def until(self, time_us: int) -> None:
        """Let time pass up to exactly a time; what comes meanwhile is taken in a tenth of a second later at most."""
        while self.simulation.time_us < time_us:
            self.step(time_us)

    def _take(self, name: str, fields: Any) -> None:
        super()._take(name, fields)
        if name == "COMMAND_ACK":
            self.answers.setdefault(int(fields.command), []).append((self.now, int(fields.result)))


class LogFlight:
    """One script on one simulation, from power-on.

    Args:
        simulation: at power-on.
        script: what is to be done.
        advance: lets simulated time pass until a time [us]; it may wait for the wall clock.
    """

    def __init__(self, simulation: Simulation, script: Script, advance: Callable[[int], object] | None = None) -> None:
        self.simulation, self.script = simulation, script
        senders = [step.sender for step in script.steps if isinstance(step, Upload)] or [s.sender for s in script.steps]
        self.station = _Player(simulation, advance, senders[0] if senders else (255, 190))
        self.report = Report(notes=list(script.notes))
        self._late_us = 0
        """Delay behind the log [us]."""
        self._asked: list[tuple[float, Send]] = []
        """(time, step) of each command that was sent."""
        self._has_waited = False

    def fly(self, until_us: int | None = None) -> Report:
        """Do all steps, then wait for the end; ``until_us`` ends it earlier."""
        for step in self.script.steps:
            due_us = round(step.time * 1e6) + self._late_us
            if until_us is not None and due_us > until_us:
                self.station.until(until_us)
                break
            self.station.until(due_us)
            self._do(step)
        else:
            self._end(until_us)
        self._compare()
        return self.report

    def _do(self, step: Step) -> None:
        before_us = self.simulation.time_us
        if isinstance(step, (Send, Upload)) and step.needs_ready and not self.station.armed:
            self._wait_ready()
        if isinstance(step, Send):
            self._late_us += self.simulation.time_us - before_us
            self._send(step)
        elif isinstance(step, Upload):
            self._upload(step)  # how long it takes is the protocol's affair: no reason to be late

    def _wait_ready(self) -> None:
        if self._has_waited:
            return
        self._has_waited = True
        before = self.station.now
        try:
            self.station.wait_ready(READY_S)
        except StationError as error:
            self.report.faults.append(f"{self._at()}: {error}; the log's vehicle was ready")
        self.report.waited += self.station.now - before

    def _upload(self, step: Upload) -> None:
        try:
            self.station.transfer(step.items)
        except StationError as error:
            if step.result in (None, 0):
                self.report.faults.append(f"{self._at()}: {error}; the log's vehicle took it")
            return
        if step.result not in (None, 0):
            self.report.notes.append(f"{self._at()}: a mission was taken that the log's vehicle refused")

    def _send(self, step: Send) -> None:
        kind = message(step.name)
        fields = {name: value for name, value in step.fields.items() if name not in _HEADERS}
        if "target_system" in kind.fields:
            fields["target_system"] = self.station.system
        if "target_component" in kind.fields:
            fields["target_component"] = int(step.fields.get("target_component", 1))
        try:
            self.station.of(step.sender).send(step.name, **fields)
        except FieldError as error:
            self.report.notes.append(f"{self._at()}: {step.title} cannot be sent: {error}")
            return
        self.report.sent += 1
        if step.command is not None:
            self._asked.append((self.station.now, step))
        elif step.name == "PARAM_SET":
            name = step.fields["param_id"].decode(errors="replace")
            if name not in self.simulation.firmware.table:
                self.report.notes.append(f"{self._at()}: there is no parameter {name}")

    def _at(self) -> str:
        return f"{self.station.now:.1f} s"

    def _end(self, until_us: int | None) -> None:
        """To the end of the log, and until the vehicle is disarmed if the log's was."""
        log = self.script.log
        end_us = round(log.duration * 1e6) + self._late_us
        self.station.until(end_us if until_us is None else min(end_us, until_us))
        if until_us is not None:
            return
        wanted = {int(message.fields.seq) for message in log.of_vehicle("MISSION_ITEM_REACHED")}
        self.station.passes(lambda: wanted <= set(self.station.reached) or not self.station.armed, LATE_S)
        armed = log.changes("armed")
        if len(armed) > 1 and not armed[-1][1] and self.station.armed:
            end = self.station.now
            if self.station.passes(lambda: not self.station.armed, LANDING_S):
                self.report.notes.append(f"disarmed {self.station.now - end:.1f} s later than the log's vehicle")
            else:
                self.report.faults.append("still armed at the end; the log's vehicle was not")

    def _why(self, when: float) -> str:
        """The vehicle's status text about a command that it refused."""
        texts = (text for t, severity, text in self.station.texts if severity <= 4 and 0.0 <= t - when <= 0.5)
        return "".join(f": {text}" for text in list(texts)[:1])

    def _compare(self) -> None:
        """Compare the answers, modes and items of the two vehicles."""
        answers = self.station.answers
        for when, step in self._asked:
            queue = answers.get(step.command or 0, [])
            while queue and queue[0][0] < when - 1e-9:
                queue.pop(0)
            now = queue.pop(0)[1] if queue and queue[0][0] <= when + ANSWER_S else None
            if step.name == "SET_MODE" or step.result is None or now == step.result:
                continue
            text = f"{when:.1f} s: {step.title} was {result_name(step.result)} then, is {result_name(now)} now"
            (self.report.faults if step.result == 0 else self.report.notes).append(text + self._why(when))
        then = [int(said.fields.seq) for said in self.script.log.of_vehicle("MISSION_ITEM_REACHED")]
        now_reached = self.station.reached
        if sorted(set(then)) != sorted(set(now_reached)):
            self.report.notes.append(f"items reached then {_list(then)}, now {_list(now_reached)}")


def _list(items: list[int]) -> str:
    return ", ".join(map(str, items)) or "none"
