# SPDX-License-Identifier: BSD-3-Clause
"""The connection to an autopilot that is another program: when it is lost, why, and what of its flight is kept.

Program, host and stream are scripts, and the wall clock is the test's.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sitl.envs.mavlink import foreign
from sitl.envs.mavlink.foreign import Foreign
from sitl.envs.mavlink.last_messages import StepTelemetry
from sitl.envs.mavlink.preparation import BY_FORCE
from sitl.envs.robots.foreign import ForeignVehicles
from sitl.errors import LinkLostError, NotASimulatorError, NotReadyError
from sitl.foreign.process import AutopilotEndedError


class Process:
    """The program; ``ended``: why it has ended."""

    def __init__(self, ended: str = "") -> None:
        self.ended, self.stopped = ended, False

    def check(self) -> None:
        if self.ended:
            raise AutopilotEndedError(self.ended)

    def last_output(self) -> str:
        return "Init"

    def stop(self) -> None:
        self.stopped = True


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """Wall time, which passes while somebody sleeps."""
    found = SimpleNamespace(now=100.0, monotonic=lambda: found.now)

    def sleep(seconds: float) -> None:
        found.now += seconds

    found.sleep = sleep
    monkeypatch.setattr(foreign, "time", found)
    return found


def link(process: Process | None = None, **given: Any) -> Any:
    found: Any = object.__new__(Foreign)
    found.process, found.patience, found._connection, found._face, found._port = process, 5.0, "tcp:1", None, None
    found.stream, found.heard, found.tapped = None, [], []
    found.inbox = SimpleNamespace(feed=found.heard.append)
    found.tap = found.tapped.append
    vars(found).update(given)
    return found


# ---------------------------------------------------------------- opening


@pytest.mark.parametrize(("tries", "slept"), [(1, 0), (4, 3)])
def test_a_port_that_is_not_there_yet_is_tried_again(
    tries: int, slept: int, clock: SimpleNamespace, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[str] = []

    def open_stream(name: str) -> Any:
        asked.append(name)
        if len(asked) < tries:
            raise LinkLostError("refused")
        return "stream"

    monkeypatch.setattr(foreign, "open_stream", open_stream)
    monkeypatch.setattr(foreign, "Endpoint", lambda stream: ("endpoint", stream))
    closed: list[bool] = []
    made = link(stream=SimpleNamespace(close=lambda: closed.append(True)))
    made._connect()
    assert asked == ["tcp:1"] * tries and made.stream == "stream" and made.endpoint == ("endpoint", "stream")
    assert closed == [True] and clock.now == pytest.approx(100.0 + 0.05 * slept)


@pytest.mark.parametrize(("process", "seconds"), [(None, 5.0), (Process(), foreign._START_S)])
def test_one_that_nobody_opens_is_lost_after_a_while(
    process: Process | None, seconds: float, clock: SimpleNamespace, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(name: str) -> Any:
        raise LinkLostError("refused")

    monkeypatch.setattr(foreign, "open_stream", refuse)
    with pytest.raises(LinkLostError, match="refused"):
        link(process)._connect()
    assert clock.now - 100.0 == pytest.approx(max(seconds, 5.0), abs=0.06)


def test_a_program_that_has_ended_is_not_waited_for(clock: SimpleNamespace, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(name: str) -> Any:
        raise LinkLostError("refused")

    monkeypatch.setattr(foreign, "open_stream", refuse)
    with pytest.raises(LinkLostError, match=r"ended with exit code 1: no such airframe"):
        link(Process("ended with exit code 1: no such airframe"))._connect()
    assert clock.now == 100.0


# ---------------------------------------------------------------- hearing


def test_what_it_says_is_heard_and_passed_on() -> None:
    said = [b"abc", b"", b"d"]
    made = link(stream=SimpleNamespace(receive=lambda: said.pop(0)))
    for _ in range(3):
        made._hear()
    assert made.heard == made.tapped == [b"abc", b"d"]
    link()._hear()


@pytest.mark.parametrize(
    ("process", "error", "connects"),
    [(None, "gone", 0), (Process("ended: crashed"), "ended: crashed", 0), (Process(), None, 1)],
)
def test_a_port_that_closes_is_a_reboot_of_a_program_that_runs(
    process: Process | None, error: str | None, connects: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    def lost() -> bytes:
        raise LinkLostError("gone")

    connected: list[Any] = []
    monkeypatch.setattr(Foreign, "_connect", lambda self: connected.append(self))
    made = link(process, stream=SimpleNamespace(receive=lost))
    if error is None:
        made._hear()
    else:
        with pytest.raises(LinkLostError, match=error):
            made._hear()
    assert len(connected) == connects and made.heard == []


# ---------------------------------------------------------------- waiting


def test_physics_that_nobody_asks_is_a_link_that_is_lost(clock: SimpleNamespace) -> None:
    def listen() -> bool:
        clock.now += 0.5
        return False

    with pytest.raises(LinkLostError, match="tcp:1 is lost: the autopilot has not asked the physics for 5 s"):
        link(host=SimpleNamespace(listen=listen))._await()
    assert clock.now - 100.0 == pytest.approx(6.0, abs=1.0)
    link(host=SimpleNamespace(listen=lambda: True))._await()
    with pytest.raises(LinkLostError, match="ended: x"):
        link(Process("ended: x"), host=SimpleNamespace(listen=listen))._await()


@pytest.mark.parametrize(("process", "said"), [(None, ""), (Process(), "; it said: Init")])
def test_without_a_heartbeat_it_is_not_found(process: Any, said: str, clock: Any, monkeypatch: Any) -> None:
    made = link(process, host=SimpleNamespace(before_boot_us=1_000_000, time_us=0))
    made.inbox.system = 9
    ran: list[int] = []

    def run(us: int) -> None:
        ran.append(us)
        made.host.time_us += us

    made.run = run
    with pytest.raises(LinkLostError) as told:
        made.find()
    simulated = foreign._HEARTBEAT_US // 1_000_000
    assert str(told.value) == (
        f"connection tcp:1: no HEARTBEAT in {simulated} simulated seconds, {simulated} of the wall clock{said}"
    )
    assert made.time_us == 1_000_000 + sum(ran) and clock.now - 100.0 == pytest.approx(simulated), "not faster"
    made.run = lambda us: setattr(made.inbox, "system", 1)
    made.find()


# ---------------------------------------------------------------- what is kept


def test_scans_and_touches_are_read_off_the_physics_when_they_are_new() -> None:
    inbox = StepTelemetry(3)
    inbox.angles = np.zeros(3)
    made = link(inbox=inbox, _scans=4, _hits=2)
    made._sensors = SimpleNamespace(lidar_count=4, lidar_ranges=np.array([1.0, 2.0, 3.0, 4.0]))
    made._obstacles = SimpleNamespace(hit_count=2)
    made._look()
    assert (inbox.scans, inbox.hits) == (0, 0) and np.isinf(inbox.scan).all()
    made._sensors.lidar_count, made._obstacles.hit_count = 5, 5
    made._look()
    assert (inbox.scans, inbox.hits) == (1, 3) and inbox.scan[:3].tolist() == [1.0, 2.0, 3.0]
    assert np.isinf(inbox.scan[3:]).all()
    made._obstacles.hit_count = 0
    made._look()
    assert (inbox.scans, inbox.hits) == (1, 3), "another plant counts anew"


def test_everything_is_closed_at_the_end() -> None:
    closed: list[str] = []
    parts = {name: SimpleNamespace(close=lambda name=name: closed.append(name)) for name in ("stream", "host", "plant")}
    process = Process()
    link(process, **parts).close()
    assert closed == ["stream", "host", "plant"] and process.stopped
    closed.clear()
    link(**{**parts, "stream": None}).close()
    assert closed == ["host", "plant"]


# ---------------------------------------------------------------- booted anew


class Rebooting:
    """A host whose autopilot has booted after so many looks; each takes a second."""

    def __init__(self, clock: SimpleNamespace, looks: int) -> None:
        self.boots, self.steps, self.plants = 1, 0, []  # type: ignore[var-annotated]
        self._clock, self._left = clock, looks

    def attach(self, plant: Any) -> None:
        self.plants.append(plant)

    def listen(self) -> bool:
        self._clock.now += 1.0
        self._left -= 1
        self.boots += self._left == 0
        return self._left % 2 == 0

    def step(self) -> None:
        self.steps += 1


def rebooted(clock: SimpleNamespace, looks: int = 3, answers: Any = 0, hears: Any = lambda: None, **acks: Any) -> Any:
    """A link to an autopilot that runs elsewhere, and what was done to it."""
    done: list[Any] = []

    def command(name: str, **fields: Any) -> int:
        done.append((name, fields))
        if name == "PREFLIGHT_REBOOT_SHUTDOWN" and isinstance(answers, Exception):
            raise answers
        return int(answers) if name == "PREFLIGHT_REBOOT_SHUTDOWN" else 0

    plant = SimpleNamespace(close=lambda: done.append("closed"))
    inbox = SimpleNamespace(acks=acks.get("acks", {}), forget=lambda: done.append("forgot"))
    made = link(
        host=Rebooting(clock, looks), plant=plant, inbox=inbox, command=command, _hear=hears, name="tcp:1",
        _use=lambda new: done.append(("uses", new)), find=lambda: done.append("found"),
        _connect=lambda: done.append("connected"),
    )  # fmt: skip
    made.done = done
    return made


REBOOT = [
    ("COMPONENT_ARM_DISARM", {"arm": 0, "force": foreign.ARM_FORCED}), ("PREFLIGHT_REBOOT_SHUTDOWN", {"autopilot": 1}),
]  # fmt: skip


@pytest.mark.parametrize("looks", [1, 3, 4])
def test_an_autopilot_elsewhere_is_disarmed_rebooted_and_found_on_another_plant(
    looks: int, clock: SimpleNamespace
) -> None:
    made = rebooted(clock, looks)
    made.restart("other")
    assert made.done == [*REBOOT, "closed", ("uses", "other"), "forgot", "found"]
    assert made.host.plants == ["other"] and made.host.steps == (looks + 1) // 2
    assert clock.now == 100.0 + looks


def test_one_that_does_not_boot_is_lost_after_a_while(clock: SimpleNamespace) -> None:
    made = rebooted(clock, 100)
    with pytest.raises(LinkLostError, match=r"connection tcp:1: the autopilot does not boot within 5 s"):
        made.restart("other")
    assert clock.now == 105.0 and "found" not in made.done


def test_one_that_refuses_to_reboot_keeps_its_plant(clock: SimpleNamespace) -> None:
    made = rebooted(clock, answers=4)
    with pytest.raises(NotReadyError, match=r"tcp:1: the autopilot refuses to reboot \(MAV_RESULT 4\)"):
        made.restart("other")
    assert made.done == REBOOT and made.host.plants == []


@pytest.mark.parametrize("result", [None, 0, 4])
def test_of_one_that_is_gone_the_last_answer_counts(result: int | None, clock: SimpleNamespace) -> None:
    acks = {} if result is None else {foreign._REBOOT: SimpleNamespace(result=result)}
    made = rebooted(clock, answers=LinkLostError("gone"), acks=acks)
    if result == 0:
        made.restart("other")
        assert made.done[-1] == "found"
    else:
        with pytest.raises(LinkLostError if result is None else NotReadyError):
            made.restart("other")
        assert made.done == REBOOT


@pytest.mark.parametrize(("lost", "comes"), [(2, True), (100, False)])
def test_a_port_that_closes_while_it_boots_is_opened_again(lost: int, comes: bool, clock: SimpleNamespace) -> None:
    left = [lost]

    def hear() -> None:
        left[0] -= 1
        if left[0] >= 0:
            raise LinkLostError("closed")

    made = rebooted(clock, 3 if comes else 100, hears=hear)
    if comes:
        made.restart("other")
        assert made.done[-3:] == ["connected", "connected", "found"]
    else:
        with pytest.raises(LinkLostError, match="closed"):
            made.restart("other")
        assert clock.now == 105.0 and made.done.count("connected") == 4


# ---------------------------------------------------------------- what it is made of


@pytest.mark.parametrize("process", [None, SimpleNamespace(pid=12, stop=lambda: None)])
@pytest.mark.parametrize("steps", [True, False])
def test_a_link_keeps_what_it_was_given_and_its_scans_come_from_the_physics(
    monkeypatch: pytest.MonkeyPatch, process: Any, steps: bool
) -> None:
    done: list[str] = []
    monkeypatch.setattr(Foreign, "_use", lambda self, plant: done.append(plant))
    monkeypatch.setattr(Foreign, "_connect", lambda self: done.append("connected"))
    monkeypatch.setattr(Foreign, "find", lambda self: done.append("found"))
    monkeypatch.setattr(foreign, "OneCore", lambda pid: ("one core", pid))
    inbox: Any = StepTelemetry(8) if steps else SimpleNamespace()
    host: Any = SimpleNamespace(boots=3, before_boot_us=1_000_000, time_us=250_000)
    made = Foreign(host, "plant", "tcp:1", process, inbox, 5.0)  # type: ignore[arg-type]
    assert done == ["plant", "connected", "found"] and (made.host, made.process) == (host, process)
    assert (made.name, made.boots, made.time_us, made.patience) == ("tcp:1", 3, 1_250_000, 5.0)
    assert made._one_core == ("one core", None if process is None else 12) and not made.repeats and not made.is_exact
    assert not steps or (inbox.scans_by_mavlink, inbox.longest_interval_us) == (False, foreign._TELEMETRY_US)


def test_what_was_started_for_a_link_that_cannot_be_opened_is_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    def connect(self: Any) -> None:
        raise LinkLostError("refused")

    closed: list[Any] = []
    monkeypatch.setattr(Foreign, "_use", lambda self, plant: None)
    monkeypatch.setattr(Foreign, "_connect", connect)
    monkeypatch.setattr(Foreign, "close", lambda self: closed.append(self.host))
    with pytest.raises(LinkLostError, match="refused"):
        Foreign("host", "plant", "tcp:1", None, StepTelemetry(8), 5.0)  # type: ignore[arg-type]
    assert closed == ["host"]


@pytest.mark.parametrize("program", [None, "arducopter"])
@pytest.mark.parametrize("reset", ["auto", BY_FORCE])
@pytest.mark.parametrize("is_simulator", [True, False])
def test_one_that_was_found_where_it_runs_is_to_prove_that_it_is_a_simulator(
    program: Any, reset: str, is_simulator: bool
) -> None:
    """One that was started here is; and the user may say so."""
    vehicles: Any = object.__new__(ForeignVehicles)
    vehicles._choice, vehicles.options = SimpleNamespace(program=program), SimpleNamespace(reset=reset)
    asked: list[bool] = []

    def prove() -> bool:
        asked.append(True)
        return is_simulator

    found: Any = SimpleNamespace(prove=prove, name="tcp:1", doubt="it has a serial number", inbox=StepTelemetry(0))
    if program is None and reset != BY_FORCE and not is_simulator:
        with pytest.raises(NotASimulatorError, match=r"tcp:1.*it has a serial number"):
            vehicles._check(found)
    else:
        vehicles._check(found)
    assert bool(asked) == (program is None and reset != BY_FORCE), "else it is not disturbed"


@pytest.mark.parametrize(
    ("kind", "program", "params", "repeats"),
    [
        (foreign.ARDUPILOT, "arducopter", {}, True),
        (foreign.ARDUPILOT, "arducopter", {foreign.ardupilot.LOG: 1.0}, False),
        (foreign.ARDUPILOT, None, {}, False),  # nobody knows how it was started
        (foreign.PX4, "px4", {}, False),
    ],
)
def test_a_flight_repeats_of_an_ardupilot_that_was_started_here_without_a_log(
    monkeypatch: pytest.MonkeyPatch, kind: Any, program: Any, params: Any, repeats: bool
) -> None:
    process = SimpleNamespace(pid=12)
    host = SimpleNamespace(address=("127.0.0.1", 9002), close=lambda: None)
    for name in ("JsonHost", "HilHost"):
        monkeypatch.setattr(foreign, name, lambda plant, address: host)
    monkeypatch.setattr(foreign, "free_tcp_run", lambda count: 5760)
    monkeypatch.setattr(foreign.ardupilot, "start", lambda *given, **more: process)
    monkeypatch.setattr(foreign.px4, "start", lambda *given, **more: process)
    monkeypatch.setattr(foreign.px4, "free_instance", lambda: 0)
    monkeypatch.setattr(foreign.px4, "unknown_names", lambda process, params: [])
    monkeypatch.setattr(foreign, "Foreign", lambda *given: SimpleNamespace(repeats=False, given=given))
    choice: Any = SimpleNamespace(kind=kind, program=program, connection="tcp:127.0.0.1:5760", name="it",
                                  for_autopilot=lambda given: given)  # fmt: skip
    plant: Any = SimpleNamespace(close=lambda: None, home=None, vehicle=SimpleNamespace(airframe=None))
    made: Any = foreign.launch(choice, plant, params, StepTelemetry(8), 5.0)
    assert made.repeats is repeats and made.given[3] is (None if program is None else process)
