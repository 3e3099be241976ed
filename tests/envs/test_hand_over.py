# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle that may be real is handed over whatever fails, and whatever ends the process."""

from __future__ import annotations

import json
import os
import re
import signal
import sys
import threading

import gymnasium as gym
import numpy as np
import pytest

from sitl.autopilot.copter.modes.guided import GUIDED
from sitl.bridge.dialect import message
from sitl.bridge.frame import Splitter, encode_v2
from sitl.client.connection import RealTime
from sitl.envs import EnvOptionError
from sitl.envs.mavlink import hand_over
from sitl.envs.mavlink.endings import ENDINGS
from sitl.envs.mavlink.last_messages import StepTelemetry
from tests.envs.test_guarded_vehicles import BRAKE, LOITER, STILL, environment, mode
from tests.envs.test_reset_of_real_vehicles import DISARM, MODE, REBOOT, RealVehicle, hovering

ENDED_BY = ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT", "SIGTSTP", "SIGUSR1", "SIGUSR2", "SIGALRM", "SIGXCPU")
pytestmark = pytest.mark.filterwarnings("ignore:.*clock cannot be held")


@pytest.fixture(autouse=True)
def signals(monkeypatch):
    """As at the start of a process. Tests that run in the background have inherited that SIGINT is passed over."""
    for vehicles in list(ENDINGS._owed):  # of an earlier test that failed
        vehicles.close()
    before = {signal.SIGINT: signal.signal(signal.SIGINT, signal.default_int_handler)}
    for name in set(ENDED_BY) - {"SIGINT"}:  # a command in an earlier test may have left its handler
        number = getattr(signal, name)
        before[number] = signal.signal(number, signal.SIG_DFL)
    yield
    for number, handler in before.items():
        signal.signal(number, handler)
    assert not ENDINGS._owed and not ENDINGS._installed


def is_hand_over(name, fields):
    return name == "COMMAND_LONG" and fields.command == MODE and fields.param2 == BRAKE


class DeafVehicle(RealVehicle):
    """A vehicle that answers the hand-over with a result of its own for the first ``count`` times; None: it does not
    hear it. ``meanwhile`` is called each time; ``to`` is whom it answers."""

    def __init__(self, simulation, count, result=None, meanwhile=lambda: None, to=(0, 0)):
        super().__init__(simulation)
        self._left, self._result, self._meanwhile, self._to = count, result, meanwhile, to

    def _take(self, frame):
        fields = frame.kind.decode(frame.payload)
        if is_hand_over(frame.kind.name, fields) and self._left > 0:
            self._left -= 1
            self.received.append((frame.kind.name, fields))
            if self._result is not None:
                ack = message("COMMAND_ACK")
                target = {"target_system": self._to[0], "target_component": self._to[1]}
                payload = ack.payload(command=MODE, result=self._result, **target)
                self._refusals.append(encode_v2(ack, payload, 0, 1, 1))
            self._meanwhile()
            return
        super()._take(frame)


def flying(vehicle, **options):
    env = environment(vehicle, patience=0.5, guard={"late": 60.0, **options.pop("guard", {})}, **options)
    env.reset(seed=1)
    env.step(STILL)
    return env


def deeds(env):
    return [deed.what for deed in env.robot.watch.deeds if deed.what != "limited"]


def handlers():
    return {number: signal.getsignal(number) for number in signal.valid_signals()}


@pytest.mark.parametrize("name", ENDED_BY)
def test_a_signal_that_would_end_the_process_hands_over_and_handlers_are_restored(name):
    number, before = getattr(signal, name), handlers()
    simulation = hovering()
    with RealVehicle(simulation) as vehicle:
        env = flying(vehicle)
        assert signal.getsignal(number) != before[number]
        try:
            with pytest.raises(KeyboardInterrupt if name == "SIGINT" else SystemExit) as ended:
                signal.raise_signal(number)
            signal.raise_signal(number)  # a second one is passed over: the first is on its way to close()
        finally:
            env.close()
        assert mode(simulation) == BRAKE and handlers() == before
    assert name == "SIGINT" or ended.value.code == 128 + number
    assert env.robot.watch.deeds[-1].why == f"closed ({name})" and deeds(env)[-1] == "handed over"
    assert not {DISARM, REBOOT} & vehicle.commands() and simulation.v.autopilot.arming.armed == 1


def test_an_agent_that_passes_over_the_signal_loses_the_vehicle_at_its_next_step():
    simulation = hovering()
    with RealVehicle(simulation) as vehicle:
        env = flying(vehicle)
        with pytest.raises(SystemExit):
            signal.raise_signal(signal.SIGTERM)
        *_, truncated, info = env.step(STILL)
        assert truncated and info["handed_over"] == "the process was told to end (SIGTERM)"
        assert mode(simulation) == BRAKE
        env.close()


def test_what_is_passed_over_stays_so_and_others_handlers_are_called():
    heard = []
    before = signal.signal(signal.SIGTERM, lambda number, frame: heard.append(number))
    hangup = signal.signal(signal.SIGHUP, signal.SIG_IGN)  # nohup
    try:
        with RealVehicle(hovering()) as vehicle:
            env = flying(vehicle)
            assert signal.getsignal(signal.SIGHUP) == signal.SIG_IGN
            signal.raise_signal(signal.SIGTERM)
            assert heard == [signal.SIGTERM] and not env.step(STILL)[3]
            env.close()
    finally:
        signal.signal(signal.SIGTERM, before)
        signal.signal(signal.SIGHUP, hangup)


@pytest.mark.parametrize("count", [1, 3])
def test_a_command_that_is_lost_is_sent_again_whatever_signals_come_meanwhile(count):
    simulation, main = hovering(), threading.main_thread().ident
    interrupt = lambda: signal.pthread_kill(main, signal.SIGINT)  # noqa: E731
    with DeafVehicle(simulation, count, meanwhile=interrupt) as vehicle:
        env = flying(vehicle)
        with pytest.raises(KeyboardInterrupt):  # afterwards
            env.close()
        assert mode(simulation) == BRAKE and deeds(env) == ["taken over", "handed over"]
    assert sum(is_hand_over(*each) for each in vehicle.received) == count + 1


@pytest.mark.parametrize("to", [(254, 190), (0, 0), (255, 190)])
def test_an_answer_to_another_station_or_to_an_earlier_command_ends_nothing(to):
    """The command is lost; what is accepted is another one, also of this client: into GUIDED, say."""
    simulation = hovering()
    with DeafVehicle(simulation, 1, result=0, to=to) as vehicle:
        env = flying(vehicle)
        env.close()
        assert mode(simulation) == BRAKE and deeds(env) == ["taken over", "handed over"]
    assert sum(is_hand_over(*each) for each in vehicle.received) >= 2


@pytest.mark.parametrize(("result", "says"), [(None, "it does not answer DO_SET_MODE to mode 17, sent"),
                                              (4, "it refuses mode 17 (MAV_RESULT 4)")])  # fmt: skip
def test_a_vehicle_that_does_not_do_it_is_told_of_aloud(monkeypatch, capsys, result, says):
    monkeypatch.setattr(hand_over, "BOUND_S", 0.6)
    monkeypatch.setattr(hand_over, "REFUSED_S", 0.6)
    simulation = hovering()
    with DeafVehicle(simulation, 1000, result) as vehicle:
        env = flying(vehicle)
        env.close()
        assert deeds(env) == ["taken over", "not handed over"] and says in env.robot.watch.deeds[-1].why
    said = capsys.readouterr().err
    assert "NOT HANDED OVER: the vehicle at udpout:127.0.0.1:" in said and says in said
    assert mode(simulation) == GUIDED


def test_a_mode_that_a_pilot_has_chosen_meanwhile_stays():
    simulation = hovering()
    with DeafVehicle(simulation, 1, meanwhile=lambda: simulation.bridge.autopilot.set_mode(LOITER)) as vehicle:
        env = flying(vehicle)
        env.close()
        simulation.advance(2.0)
    assert mode(simulation) == LOITER or vehicle._left == 0


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="Linux has it")
def test_a_log_that_cannot_be_written_stops_nothing(capsys):
    simulation = hovering()
    with RealVehicle(simulation) as vehicle:
        env = flying(vehicle, guard={"log": "/dev/full"})
        env.close()
        assert mode(simulation) == BRAKE
    assert deeds(env) == ["taken over", "log lost", "handed over"]
    said = capsys.readouterr().err
    assert said.count("guard: log '/dev/full' cannot be written: No space left on device") == 1


def test_a_log_that_breaks_in_flight_stops_nothing(tmp_path):
    log, simulation = tmp_path / "logs" / "guard.jsonl", hovering()
    log.parent.mkdir()
    with RealVehicle(simulation) as vehicle:
        env = flying(vehicle, guard={"log": log})
        assert [json.loads(line)["what"] for line in log.read_text().splitlines()] == ["taken over"]
        log.unlink()
        log.parent.rmdir()
        env.close()
        assert (mode(simulation) == BRAKE and deeds(env)[-1] == "handed over") or deeds(env)[-2] == "handed over"


def test_a_log_that_cannot_be_opened_is_refused_before_the_vehicle_hears_anything(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with RealVehicle(hovering()) as vehicle:
        for log in (tmp_path / "none" / "guard.jsonl", tmp_path, tmp_path / "pipe", "a\0b"):
            with pytest.raises(EnvOptionError, match=r"guard: log .* cannot be written: "):
                environment(vehicle, guard={"log": log})
    assert not vehicle.received


@pytest.mark.parametrize("stream", ["stderr", "stdout"])
def test_words_that_nobody_hears_stop_nothing(monkeypatch, stream):
    class Closed:
        def write(self, text):
            raise BrokenPipeError

        flush = write

    simulation = hovering()
    with RealVehicle(simulation) as vehicle:
        env = flying(vehicle, guard={"log": "/dev/full"} if os.path.exists("/dev/full") else {})
        monkeypatch.setattr(sys, stream, Closed())
        env.close()
        assert mode(simulation) == BRAKE


class Watching:
    """A page that fails when ``when``."""

    def __init__(self, when):
        self._when = when

    def _fail(self, when):
        if when == self._when:
            raise RuntimeError("the page is gone")

    def started(self, index):
        self._fail("start")

    def stepped(self, rows):
        self._fail("step")

    def close(self):
        self._fail("close")


@pytest.mark.parametrize(
    ("when", "many"), [("start", False), ("step", False), ("close", False), ("step", True), ("close", True)]
)
def test_a_page_that_fails_does_not_stop_it(when, many):
    simulation = hovering()
    with RealVehicle(simulation) as vehicle:
        env = vector(vehicle) if many else flying(vehicle)
        env.watch(Watching(when))
        with pytest.raises(RuntimeError, match="the page is gone"):
            if when == "close":
                env.close()
            elif when == "start":
                env.reset(seed=2)
            else:
                env.step(STILL[None] if many else STILL)
        assert mode(simulation) == BRAKE
        env.watch(Watching("never"))
        env.close()


def vector(vehicle):
    options = {"reset": "none", "patience": 0.5, "wait": 5.0, "setpoint": "velocity", "action": "normalised",
               "observation": "scan", "task": "wander"}  # fmt: skip
    url = f"udpout:127.0.0.1:{vehicle.port}"
    env = gym.make_vec("GazeboOfficeErleCopterLIDAR-v0", num_envs=1, connection=url, guard={"late": 60.0}, **options)
    env.reset(seed=1)
    return env.unwrapped


@pytest.mark.parametrize("action", [np.full(4, np.nan, np.float32), np.zeros(3, np.float32), "none"], ids=str)
def test_a_step_that_raises_hands_over_without_close(action):
    simulation = hovering()
    with RealVehicle(simulation) as vehicle:
        env = flying(vehicle)
        with pytest.raises(gym.error.InvalidAction):
            env.step(action)
        assert mode(simulation) == BRAKE and env.robot.watch.deeds[-1].why.startswith("InvalidAction: ")
        env.close()


def test_a_reset_that_is_broken_off_hands_over(monkeypatch):
    """With reset="force" the vehicle is armed and takes off before the agent is in charge."""
    simulation = hovering()
    with RealVehicle(simulation, waits=False) as vehicle:
        env = environment(vehicle, reset="force", guard={"late": 60.0}, take_off=3.0)

        def prepared(*_):
            raise KeyboardInterrupt

        monkeypatch.setattr(env.robot._vehicles, "prepare", prepared)
        monkeypatch.setattr("sitl.envs.robots.at_connection.reboot", lambda link: None)
        with pytest.raises(KeyboardInterrupt):
            env.reset(seed=1)
        assert mode(simulation) == BRAKE
        env.close()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no os.fork")
@pytest.mark.filterwarnings("ignore:.*multi-threaded.*:DeprecationWarning")
def test_a_copy_of_the_process_commands_no_vehicle():
    simulation, before = hovering(), handlers()
    with RealVehicle(simulation) as vehicle:
        env = flying(vehicle)
        sent = vehicle.commands()
        child = os.fork()
        if child == 0:
            is_so = handlers() == before
            try:
                ENDINGS.settle_all()
                env.close()
            finally:
                os._exit(0 if is_so else 1)
        assert os.waitpid(child, 0)[1] == 0
        env.step(STILL)
        assert mode(simulation) == GUIDED and vehicle.commands() == sent
        env.close()
        assert mode(simulation) == BRAKE


class Clock:
    """In place of ``time``: a millisecond goes by each time somebody looks, whatever else the machine does."""

    now = 0.0

    def monotonic(self):
        self.now += 0.001
        return self.now

    def sleep(self, seconds):
        self.now += seconds


class BrokenStream:
    """A link that fails ``count`` times when something is sent or received, and then passes on what is sent."""

    name = "udp:broken"

    def __init__(self, count, answer):
        self._left, self._answer, self.sent, self._said = count, answer, [], b""

    def _fail(self):
        if self._left > 0:
            self._left -= 1
            raise (OSError("cable"), MemoryError(), RuntimeError("odd"))[self._left % 3]

    def limit(self, seconds):
        raise OSError("no limits")

    def write(self, data):
        self._fail()
        self.sent.append(data)
        self._said = self._answer

    def wait(self, seconds):
        return bool(self._said)

    def receive(self):
        self._fail()
        said, self._said = self._said, b""
        return said


class TimedStream(BrokenStream):
    """A link on which time goes by while somebody listens, and which notes when each command was sent."""

    def __init__(self, clock, answer):
        super().__init__(0, b"")
        self._clock, self._reply, self.commands = clock, answer, []

    def write(self, data):
        ((kind, payload, *_),) = Splitter().cut(data)
        fields = kind.decode(payload)
        self.commands.append((self._clock.now, fields))
        if fields.command == MODE:
            self._said += self._reply

    def wait(self, seconds):
        if not self._said:
            self._clock.now += min(seconds, 0.02)
        return bool(self._said)


def heard(name, system=1, **fields):
    kind = message(name)
    return encode_v2(kind, kind.payload(**fields), 0, system, 1)


FLYING = heard("HEARTBEAT", base_mode=209, custom_mode=GUIDED)
UNTOLD = heard("COMMAND_ACK", command=MODE, result=0)
OWN = heard("COMMAND_ACK", command=MODE, result=0, target_system=255, target_component=190)


@pytest.mark.parametrize(
    ("answer", "done"),
    [
        (OWN, True),
        (UNTOLD, False),  # alone
        (UNTOLD + heard("HEARTBEAT", base_mode=209, custom_mode=BRAKE), True),
        (OWN + FLYING, False),  # that was an earlier command
        (heard("COMMAND_ACK", command=MODE, result=0, target_system=254, target_component=190), False),
        (heard("COMMAND_ACK", command=MODE, result=4, target_system=254, target_component=190), False),
        (heard("HEARTBEAT", base_mode=209, custom_mode=BRAKE), True),
        (heard("HEARTBEAT", base_mode=209, custom_mode=LOITER), True),
        (heard("HEARTBEAT", base_mode=81, custom_mode=GUIDED), True),  # disarmed
        (FLYING, False),
        (heard("COMMAND_ACK", command=MODE, result=5), False),  # in progress
        (heard("COMMAND_ACK", command=MODE, result=0, system=2), False),  # another vehicle's
        (heard("HEARTBEAT", base_mode=209, custom_mode=BRAKE, system=2), False),
        (heard("COMMAND_ACK", command=REBOOT, result=0), False),
        (bytes(range(256)) + FLYING[:9], False),
    ],
)
def test_what_ends_it(monkeypatch, answer, done):
    monkeypatch.setattr(hand_over, "BOUND_S", 0.2)
    monkeypatch.setattr(hand_over, "REPEAT_S", 0.01)
    monkeypatch.setattr(hand_over, "SILENCE_S", 0.05)
    monkeypatch.setattr(hand_over, "time", Clock())
    stream = BrokenStream(7, answer)
    inbox = StepTelemetry(8)
    inbox.system, inbox.mode, inbox.armed = 1, GUIDED, True
    link = RealTime(stream, inbox, 1.0)
    deed = hand_over.HandOver(link, BRAKE, GUIDED)
    deed.run()
    says = "it accepts mode 17, but no HEARTBEAT says" if deed.result == 0 else "does not answer"
    assert deed.is_done == done and len(stream.sent) >= 1 and (done or says in deed.failure)


REFUSED = heard("COMMAND_ACK", command=MODE, result=4)


@pytest.mark.parametrize(
    ("answer", "done", "seconds", "modes", "says"),
    [
        (b"", False, 10.0, 40, r"it does not answer DO_SET_MODE to mode 17, sent 4\d times in 10 s"),
        (REFUSED, False, 2.0, 8, r"it refuses mode 17 \(MAV_RESULT 4\)"),
        (UNTOLD, False, 10.0, 40, "it accepts mode 17, but no HEARTBEAT says in 10 s that it is in it"),
        (OWN, True, 2.0, 5, None),  # at once, and from 1.2 s on again
    ],
)
def test_how_long_and_how_often_a_vehicle_is_asked(monkeypatch, answer, done, seconds, modes, says):
    """Every quarter of a second; for ten seconds where it does not answer, for two where it refuses. One that accepts
    is asked for a HEARTBEAT; it is believed when none comes within two seconds."""
    clock = Clock()
    monkeypatch.setattr(hand_over, "time", clock)
    stream, inbox = TimedStream(clock, answer), StepTelemetry(8)
    inbox.system, inbox.mode, inbox.armed = 1, GUIDED, True
    deed = hand_over.HandOver(RealTime(stream, inbox, 1.0), BRAKE, GUIDED)
    deed.run()
    assert deed.is_done == done and clock.now == pytest.approx(seconds, abs=0.4)
    asked = [(at, fields) for at, fields in stream.commands if fields.command == MODE]
    assert deed.sent == len(asked) == pytest.approx(modes, abs=1)
    assert [fields.confirmation for _, fields in asked] == list(range(len(asked)))
    assert {(f.param1, f.param2, f.param3, f.target_system, f.target_component) for _, f in asked} == {(1, 17, 0, 1, 1)}
    gaps = np.diff([at for at, _ in asked]).tolist()
    assert gaps == pytest.approx([1.25 if done else 0.25] + [0.25] * (len(gaps) - 1), abs=0.04)
    others = [fields for _, fields in stream.commands if fields.command != MODE]
    assert all((fields.command, fields.param1) == (512, 0) for fields in others), "REQUEST_MESSAGE of HEARTBEAT"
    assert len(others) == pytest.approx(9 if done else 0, abs=1)
    assert says is None or re.fullmatch(says, deed.failure)


def test_a_vehicle_that_could_not_be_asked_is_reported_with_the_reason():
    deed = hand_over.HandOver(RealTime(BrokenStream(0, b""), StepTelemetry(8), 1.0), BRAKE, GUIDED)
    deed.sent, deed.error = 3, OSError("cable")
    assert deed.failure == "it does not answer DO_SET_MODE to mode 17, sent 3 times in 10 s (cable)"


def test_a_vehicle_that_is_not_ours_is_not_asked():
    for mode_, armed in ((LOITER, True), (GUIDED, False)):
        stream, inbox = BrokenStream(0, b""), StepTelemetry(8)
        inbox.system, inbox.mode, inbox.armed = 1, mode_, armed
        deed = hand_over.HandOver(RealTime(stream, inbox, 1.0), BRAKE, GUIDED)
        deed.run()
        assert deed.is_done and not stream.sent
