# SPDX-License-Identifier: BSD-3-Clause
"""A log's script on a vehicle that does what the test says: when steps are due, what counts as otherwise."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from sitl.bridge.dialect import FieldError
from sitl.missions.station import StationError
from sitl.missions.tlog_replay import fly_script
from sitl.missions.tlog_replay.fly_script import LogFlight, Report, result_name
from sitl.missions.tlog_replay.steps import Send, Step, Upload

GCS = (255, 190)


class Vehicle:
    """The station's end of one: its clock runs as steps ask for."""

    system = 7

    def __init__(self) -> None:
        self.time_us, self.armed = 0, False
        self.sent: list[Any] = []
        self.uploads: list[Any] = []
        self.refuses = self.never_ready = ""
        self.ready_in_s, self.disarms_s = 0.0, 1e9
        self.answers: dict[int, list[tuple[float, int]]] = {}
        self.texts: list[tuple[float, int, str]] = []
        self.reached: list[int] = []
        self.waits = 0
        self.firmware = SimpleNamespace(table={"RTL_ALT": None})

    @property
    def now(self) -> float:
        return self.time_us * 1e-6

    def until(self, time_us: int) -> None:
        self.time_us = max(self.time_us, time_us)
        self.armed = self.armed and self.now < self.disarms_s

    def wait_ready(self, timeout: float) -> None:
        assert timeout == 120.0
        self.waits += 1
        self.time_us += round(self.ready_in_s * 1e6)
        if self.never_ready:
            raise StationError(self.never_ready)

    def transfer(self, items: Any) -> None:
        self.time_us += 500_000
        if self.refuses:
            raise StationError(self.refuses)
        self.uploads.append(items)

    def of(self, sender: Any) -> Any:
        def send(name: str, **fields: Any) -> None:
            if name == "MANUAL_CONTROL":
                raise FieldError(name, "x", "?", "a number")
            self.sent.append((round(self.now, 3), sender, name, fields))

        return SimpleNamespace(send=send)

    def passes(self, done: Any, seconds: float) -> bool:
        end = self.time_us + round(seconds * 1e6)
        while not done() and self.time_us < end:
            self.until(self.time_us + 100_000)
        return bool(done())


def flight(vehicle: Vehicle, *steps: Step, duration: float = 20.0, reached: Any = (), armed: Any = ()) -> LogFlight:
    found: Any = object.__new__(LogFlight)
    log = SimpleNamespace(
        duration=duration, changes=lambda what: list(armed),
        of_vehicle=lambda name: [SimpleNamespace(fields=SimpleNamespace(seq=seq)) for seq in reached],
    )  # fmt: skip
    found.script = SimpleNamespace(steps=steps, log=log, notes=[])
    found.simulation, found.station, found.report = vehicle, vehicle, Report()
    found._late_us, found._asked, found._has_waited = 0, [], False
    return found  # type: ignore[no-any-return]


def command(time: float, number: int = 183, result: int | None = 0, **fields: Any) -> Send:
    return Send(time, GCS, "COMMAND_LONG", {"command": number, "param1": 0.0, **fields}, result)


ARM = 400

# ---------------------------------------------------------------- when


def test_steps_are_done_at_their_times_and_later_when_the_vehicle_had_to_get_ready() -> None:
    vehicle = Vehicle()
    vehicle.ready_in_s = 3.0
    arm = command(2.0, ARM, param1=1.0)
    report = flight(vehicle, command(1.0), arm, command(4.0), command(5.0, ARM, param1=1.0)).fly()
    assert [at for at, *_ in vehicle.sent] == [1.0, 5.0, 7.0, 8.0]
    assert (report.waited, report.sent, vehicle.waits) == (3.0, 4, 1), "once"
    assert vehicle.now == pytest.approx(23.0), "the end of the log is later, too"


def test_how_long_an_upload_takes_delays_nothing() -> None:
    vehicle = Vehicle()
    flight(vehicle, Upload(1.0, GCS, ("a",)), command(3.0)).fly()
    assert [at for at, *_ in vehicle.sent] == [3.0] and vehicle.uploads == [("a",)]


@pytest.mark.parametrize(
    ("until", "sent", "end"),
    [(None, [1.0, 4.0], 20.0), (4.0, [1.0, 4.0], 4.0), (3.0, [1.0], 3.0), (30.0, [1.0, 4.0], 20.0)],
)
def test_it_ends_where_it_is_told_or_with_the_log(until: float | None, sent: list[float], end: float) -> None:
    vehicle = Vehicle()
    flight(vehicle, command(1.0), command(4.0)).fly(None if until is None else round(until * 1e6))
    assert [at for at, *_ in vehicle.sent] == sent and vehicle.now == end


@pytest.mark.parametrize(("armed", "waits"), [(False, 1), (True, 0)])
def test_an_armed_vehicle_is_ready(armed: bool, waits: int) -> None:
    vehicle = Vehicle()
    vehicle.armed = armed
    flight(vehicle, command(1.0, ARM, param1=1.0)).fly()
    assert vehicle.waits == waits


def test_a_vehicle_that_is_never_ready_is_a_fault() -> None:
    vehicle = Vehicle()
    vehicle.never_ready = "not ready to arm after 120 s: PreArm: x"
    vehicle.ready_in_s = 120.0
    report = flight(vehicle, command(2.0, ARM, result=None, param1=1.0)).fly()
    assert report.faults == ["122.0 s: not ready to arm after 120 s: PreArm: x; the log's vehicle was ready"]
    assert report.waited == 120.0


# ---------------------------------------------------------------- what is sent


def test_messages_go_to_this_vehicle_from_their_own_sender() -> None:
    vehicle = Vehicle()
    steps = [
        Send(1.0, GCS, "HEARTBEAT", {"type": 6}),
        Send(2.0, (1, 191), "COMMAND_INT", {"command": 192, "target_system": 3, "target_component": 0}),
        Send(3.0, GCS, "COMMAND_LONG", {"command": 192, "target_system": 3}),
    ]
    report = flight(vehicle, *steps).fly()
    assert [(sender, name, fields) for _, sender, name, fields in vehicle.sent] == [
        (GCS, "HEARTBEAT", {"type": 6}),
        ((1, 191), "COMMAND_INT", {"command": 192, "target_system": 7, "target_component": 0}),
        (GCS, "COMMAND_LONG", {"command": 192, "target_system": 7, "target_component": 1}),
    ]
    assert report.sent == 3


def test_what_cannot_be_sent_and_parameters_that_are_not_there_are_noted() -> None:
    vehicle = Vehicle()
    steps = [
        Send(1.0, GCS, "MANUAL_CONTROL", {"x": "?"}),
        Send(2.0, GCS, "PARAM_SET", {"param_id": b"RTL_ALT", "param_value": 1.0}),
        Send(3.0, GCS, "PARAM_SET", {"param_id": b"NO_SUCH", "param_value": 1.0}),
    ]
    report = flight(vehicle, *steps).fly()
    assert report.notes == [
        f"1.0 s: MANUAL_CONTROL cannot be sent: {FieldError('MANUAL_CONTROL', 'x', '?', 'a number')}",
        "3.0 s: there is no parameter NO_SUCH",
    ]
    assert report.sent == 2 and report.faults == []


@pytest.mark.parametrize(
    ("refuses", "result", "faults", "notes"),
    [
        ("", 0, 0, 0), ("", None, 0, 0), ("", 5, 0, 1), ("too many items", 0, 1, 0), ("too many items", None, 1, 0),
        ("too many items", 5, 0, 0),
    ],
)  # fmt: skip
def test_an_upload_is_taken_as_the_logs_vehicle_did(refuses: str, result: Any, faults: int, notes: int) -> None:
    vehicle = Vehicle()
    vehicle.refuses = refuses
    report = flight(vehicle, Upload(1.0, GCS, ("a",), result)).fly()
    assert report.faults == ["1.5 s: too many items; the log's vehicle took it"] * faults
    assert report.notes == ["1.5 s: a mission was taken that the log's vehicle refused"] * notes


# ---------------------------------------------------------------- answers


@pytest.mark.parametrize(
    ("result", "text"),
    [
        (None, "not answered"),
        (0, "ACCEPTED"),
        (4, "FAILED"),
        (6, "CANCELLED"),
        (7, "MAV_RESULT 7"),
        (-1, "MAV_RESULT -1"),
    ],
)  # fmt: skip
def test_results_by_their_names(result: int | None, text: str) -> None:
    assert result_name(result) == text


@pytest.mark.parametrize(
    ("then", "now", "faults", "notes"),
    [
        (0, 0, [], []),
        (0, 4, ["1.0 s: command 183 was ACCEPTED then, is FAILED now"], []),
        (0, None, ["1.0 s: command 183 was ACCEPTED then, is not answered now"], []),
        (4, 0, [], ["1.0 s: command 183 was FAILED then, is ACCEPTED now"]),
        (4, 4, [], []),
        (None, 4, [], []),
    ],
)
def test_a_command_that_is_refused_now_is_a_fault_and_one_that_was_then_a_note(
    then: Any, now: Any, faults: list[str], notes: list[str]
) -> None:
    vehicle = Vehicle()
    vehicle.answers = {183: [(1.1, now)]} if now is not None else {}
    report = flight(vehicle, command(1.0, result=then)).fly()
    assert (report.faults, report.notes) == (faults, notes)


def test_each_command_has_the_next_answer_within_its_time() -> None:
    vehicle = Vehicle()
    late = 5.0 + fly_script.ANSWER_S
    vehicle.answers = {183: [(0.5, 4), (1.1, 0), (3.1, 0), (late + 0.01, 0)]}
    report = flight(vehicle, command(1.0), command(3.0), command(5.0)).fly()
    assert report.faults == ["5.0 s: command 183 was ACCEPTED then, is not answered now"]
    vehicle = Vehicle()
    vehicle.answers = {183: [(late, 0)]}
    assert flight(vehicle, command(5.0)).fly().faults == []


@pytest.mark.parametrize(
    ("at", "severity", "told"),
    [(1.0, 4, True), (1.5, 2, True), (1.51, 4, False), (0.99, 4, False), (1.2, 5, False)],
)
def test_the_vehicles_reason_is_told_with_a_refusal(at: float, severity: int, told: bool) -> None:
    vehicle = Vehicle()
    vehicle.answers, vehicle.texts = {183: [(1.0, 4)]}, [(at, severity, "Gripper: none"), (9.0, 2, "later")]
    (fault,) = flight(vehicle, command(1.0)).fly().faults
    assert fault == "1.0 s: command 183 was ACCEPTED then, is FAILED now" + (": Gripper: none" if told else "")


def test_modes_are_not_judged_by_their_answers() -> None:
    vehicle = Vehicle()
    vehicle.armed = True
    assert flight(vehicle, Send(1.0, GCS, "SET_MODE", {"custom_mode": 4}, 0)).fly().faults == []


# ---------------------------------------------------------------- the end


@pytest.mark.parametrize(
    ("armed", "disarms", "faults", "notes"),
    [
        ([(1.0, True), (19.0, False)], 23.5, [], ["disarmed 3.5 s later than the log's vehicle"]),
        ([(1.0, True), (19.0, False)], 18.0, [], []),
        ([(1.0, True), (19.0, False)], 999.0, ["still armed at the end; the log's vehicle was not"], []),
        ([(1.0, True)], 999.0, [], []),
        ([(19.0, False)], 999.0, [], []),  # it was armed before the log began
    ],
)
def test_a_vehicle_has_time_to_disarm_where_the_logs_did(
    armed: Any, disarms: float, faults: list[str], notes: list[str]
) -> None:
    vehicle = Vehicle()
    vehicle.armed, vehicle.disarms_s = True, disarms
    report = flight(vehicle, command(1.0, result=None), armed=armed).fly()
    assert (report.faults, report.notes) == (faults, notes)


@pytest.mark.parametrize(
    ("then", "now", "note"),
    [
        ([1, 2], [2, 1, 1], []),
        ([1, 2], [1], ["items reached then 1, 2, now 1"]),
        ([], [3], ["items reached then none, now 3"]),
        ([3], [], ["items reached then 3, now none"]),
    ],
)
def test_items_that_were_reached_are_compared(then: list[int], now: list[int], note: list[str]) -> None:
    vehicle = Vehicle()
    vehicle.reached = now
    vehicle.armed = True
    assert flight(vehicle, reached=then).fly().notes == note
    assert vehicle.now == pytest.approx(20.0 if set(then) <= set(now) else 80.0), "a minute for those that are late"
