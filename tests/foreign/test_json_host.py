# SPDX-License-Identifier: BSD-3-Clause
"""A plant behind the JSON wire, asked by scripted peers with the habits of ArduPilot's program."""

from __future__ import annotations

import contextlib
import json
import socket
import threading

import pytest

from sitl.bridge.ardupilot_json.servos import Servos, encode
from sitl.core.algebra import Quat, euler_of
from sitl.errors import OptionError
from sitl.foreign.json_host import JsonHost
from sitl.plants.local import stand_alone
from sitl.scenario import DEFAULT_HOME
from tests.bridge.json_lines import found_by_text

ANY = ("127.0.0.1", 0)


@contextlib.contextmanager
def served(plant):
    """A host and a peer; wall time is a list's only number."""
    wall, said = [0.0], []
    host = JsonHost(plant, ANY, said.append, lambda: wall[0])
    host.wall, host.said = wall, said
    peer = Peer(host)
    try:
        yield host, peer
    finally:
        peer.close()
        host.close()


class Peer:
    """Says frames to a ``JsonHost`` in the same thread, which has its turn in between."""

    def __init__(self, host) -> None:
        self.host = host
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.connect(host.address)
        self.socket.setblocking(False)

    def send(self, number: int, pulse: int = 1000, rate: int = 400, pulses: int = 16) -> None:
        self.socket.send(encode(Servos(rate, number, (pulse,) * pulses)))

    def lines(self) -> list[dict]:
        """All answers that are there."""
        found = []
        while True:
            try:
                self.text = self.socket.recv(65535).decode()
            except BlockingIOError:
                return found
            found.append(json.loads(self.text))

    def ask(self, number: int, **frame) -> dict:
        """A frame, and the one line that answers it."""
        self.send(number, **frame)
        assert self.host.listen()
        self.host.step()
        (line,) = self.lines()
        return line

    def close(self) -> None:
        self.socket.close()


def first_value(text: str):
    """The number or list that a text begins with."""
    return json.JSONDecoder().raw_decode(text)[0]


def test_a_standing_copter_is_told_as_it_is(copter_plant):
    with served(copter_plant) as (_, peer):
        line = peer.ask(0)
        assert line["timestamp"] == pytest.approx(0.0025, rel=1e-8)
        assert line["position"] == [0.0, 0.0, 0.0] and line["velocity"] == [0.0, 0.0, 0.0]
        assert line["imu"]["accel_body"] == pytest.approx([0.0, 0.0, -9.80665])
        assert line["battery"]["voltage"] == pytest.approx(12.6, abs=0.1)
        assert "windvane" not in line and "rng_1" not in line and "attitude" not in line


def test_ardupilots_clock_of_whole_microseconds_keeps_step_with_ours(copter_plant):
    with served(copter_plant) as (host, peer):
        theirs, last = 0, 0.0
        for number in range(3000):
            now = peer.ask(number)["timestamp"]
            theirs, last = int(theirs + (now - last) * 1e6), now
        assert theirs == host.time_us == 7_500_000


class Gyro:
    """An IMU as ArduPilot samples one: once a frame, at most 1000 times a second; its loop runs 400 times a second and
    reads its own whole microseconds. Asks for 1 Hz more than it got."""

    def __init__(self, peer, rate: int) -> None:
        self.peer, self.rate, self.number, self.time_us, self.last = peer, rate, 0, 0, 0.0
        self.samples = self._next = 0
        self.pulse, self._loop_at = 1000, 0
        self.path: list[list[float]] = []

    def frame(self) -> None:
        """Ask; take a line when one is there already, else when physics has had its turn."""
        self.peer.send(self.number, pulse=self.pulse, rate=self.rate)
        try:
            data = self.peer.socket.recv(65535)
        except BlockingIOError:
            assert self.peer.host.listen()
            self.peer.host.step()
            data = self.peer.socket.recv(65535)
        line = json.loads(data)
        step = line["timestamp"] - self.last
        self.time_us, self.last, self.number = int(self.time_us + step * 1e6), line["timestamp"], self.number + 1
        self.rate = int(1.0 / step) + 1
        self.path.append([*line["position"], *line["velocity"], *line["quaternion"]])
        if self.time_us >= self._next:
            self.samples, self._next = self.samples + 1, 1000 * (self.time_us // 1000 + 1)
        if self.time_us >= self._loop_at:
            self._loop_at += 2500
            self.pulse = 1400 + self.time_us // 2500 % 300


@pytest.mark.parametrize(("rate", "least", "ticks"), [(800, 790, 400), (1200, 990, 400), (400, 390, 400)])
def test_an_imu_gets_the_samples_that_it_asks_for(copter_plant, rate, least, ticks):
    with served(copter_plant) as (host, peer):
        imu = Gyro(peer, rate)
        for _ in range(rate):
            imu.frame()
        assert imu.time_us == host.time_us == 2500 * ticks
        assert least <= imu.samples <= rate and imu.rate // 400 == rate // 400


def test_finer_steps_fly_the_same_flight_as_whole_ticks():
    def flight(rate):
        plant = stand_alone("erle_copter", home=DEFAULT_HOME)
        with served(plant) as (_, peer):
            imu = Gyro(peer, rate)
            for _ in range(rate):
                imu.frame()
        end = list(plant.vehicle.v.physics.body.pos)
        plant.close()
        return imu.path, end

    whole, end = flight(400)
    halves, end_of_halves = flight(800)
    assert end == end_of_halves and end[2] < -0.1  # the same bits
    for k in range(1, 400):
        assert halves[2 * k + 1] == pytest.approx(whole[k], rel=1e-8, abs=1e-12)
        middle = [0.5 * (a + b) for a, b in zip(whole[k - 1], whole[k])]
        assert halves[2 * k] == pytest.approx(middle, rel=1e-8, abs=1e-12)


@pytest.mark.parametrize("pulses", [16, 32])
def test_pulses_turn_the_rotors(copter_plant, pulses):
    with served(copter_plant) as (_, peer):
        for number in range(200):
            line = peer.ask(number, pulse=1700, pulses=pulses)
        assert line["position"][2] < -0.2 and line["velocity"][2] < -0.5
        assert list(copter_plant.vehicle.v.actuators.pwm) == [1700] * 16


def test_a_rovers_pulses_are_centred(rover_plant):
    with served(rover_plant) as (_, peer):
        for number in range(200):
            still = peer.ask(number, pulse=1500)
        assert abs(still["velocity"][0]) < 1e-6
        for number in range(200, 400):
            line = peer.ask(number, pulse=1700)
        assert line["velocity"][0] > 0.1


@pytest.mark.parametrize(("rate", "ticks"), [(400, 1), (100, 4), (50, 8)])
def test_the_rate_asked_for_is_the_step(copter_plant, rate, ticks):
    with served(copter_plant) as (host, peer):
        peer.ask(0, rate=rate)
        assert host.time_us == 2500 * ticks


def test_a_frame_sent_again_gets_the_same_line_and_is_not_stepped_again(copter_plant):
    with served(copter_plant) as (host, peer):
        first = peer.ask(0)
        for _ in range(2):
            host.wall[0] += 1.0
            peer.send(0)
            assert not host.listen()
            assert peer.lines() == [first]
        assert host.time_us == 2500
        peer.ask(1)
        assert host.time_us == 5000


def test_of_frames_that_waited_while_time_was_held_one_is_answered(copter_plant):
    with served(copter_plant) as (host, peer):
        peer.ask(0)
        for _ in range(10):  # nobody listens for ten seconds; it repeats itself
            peer.send(1)
            host.wall[0] += 1.0
        assert host.listen()
        host.step()
        assert len(peer.lines()) == 1 and host.time_us == 5000
        assert not host.listen() and peer.lines() == []


def test_junk_and_strangers_do_not_hide_the_autopilots_frame(copter_plant):
    with served(copter_plant) as (host, peer):
        peer.ask(0)
        host.wall[0] += 0.1
        other = Peer(host)
        other.send(7)
        peer.send(1)
        peer.socket.send(b"junk")
        other.socket.send(b"junk")
        assert host.listen()
        host.step()
        other.close()
        assert len(peer.lines()) == 1 and host.time_us == 5000 and host.end.count == 1


def test_an_autopilot_started_anew_begins_at_power_on(copter_plant):
    with served(copter_plant) as (host, peer):
        for number in range(300):
            before = peer.ask(number, pulse=1700)
        assert before["position"][2] < -0.5
        host.wall[0] += 0.5
        again = Peer(host)
        line = again.ask(0)
        again.close()
        assert line["position"] == [0.0, 0.0, 0.0] and host.time_us == 2500 and host.boots == 1


def converse(host, answers: int, until_us: int, rate: int = 400, pulse: int = 1500) -> list[bytes]:
    """What an autopilot in a thread of its own is told until a time."""
    told, peer, is_over = [], Peer(host), threading.Event()
    peer.socket.settimeout(0.05)

    def ask():
        while not is_over.is_set():
            peer.send(len(told), rate=rate, pulse=pulse + len(told) % 100)
            while not is_over.is_set():
                with contextlib.suppress(TimeoutError):
                    told.append(peer.socket.recv(65535))
                    break

    thread = threading.Thread(target=ask)
    thread.start()
    while host.time_us < until_us:
        if host.listen():
            host.step(until_us, answers)
    while not host.listen():
        pass
    is_over.set()
    thread.join()
    peer.close()
    return told


@pytest.mark.parametrize("rate", [400, 800, 1200])
def test_a_burst_says_what_single_answers_say(rate):
    def said(answers, in_python=False):
        plant = stand_alone("erle_copter", home=DEFAULT_HOME)
        with served(plant) as (host, _):
            if in_python:
                host._lines.is_quick = False
            found = converse(host, answers, 500_000, rate)
            assert host.time_us == 500_000 and host.end.count == len(found)
        plant.close()
        return found[: 200 * rate // 400]

    single = said(1)
    assert len(single) == 200 * rate // 400 and said(16) == single and said(1, in_python=True) == single


def test_a_lidar_measures_in_a_burst_when_it_is_due():
    def scanned(answers):
        plant = stand_alone("erle_rover", home=DEFAULT_HOME, world="maze_erlerover")
        with served(plant) as (host, _):
            converse(host, answers, 1_000_000)
        sensors = plant.vehicle.v.sensors
        found = int(sensors.lidar_count), sensors.lidar_ranges.tolist()
        plant.close()
        return found

    single = scanned(1)
    assert single[0] > 3 and scanned(16) == single


def test_strangers_within_a_burst_are_told_of_and_its_frames_are_answered(copter_plant):
    with served(copter_plant) as (host, peer):
        peer.send(0)
        assert host.listen()
        other = Peer(host)
        other.send(7)
        peer.socket.send(b"junk")
        peer.send(1)
        host.step(answers=9)
        while host.time_us < 5000:
            if host.listen():
                host.step(answers=9)
        other.close()
        assert len(peer.lines()) == 2 and host.end.count == 1
        assert any("second autopilot" in text for text in host.said)
        assert any("no frame of servos" in text for text in host.said)


def test_strangers_and_junk_are_told_of_and_change_nothing(copter_plant):
    with served(copter_plant) as (host, peer):
        peer.ask(0)
        other = Peer(host)
        other.send(0)
        assert not host.listen()
        other.socket.send(b"\x00" * 40)
        assert not host.listen()
        other.close()
        assert other.host.time_us == 2500
        assert any("second autopilot" in text for text in host.said) and any(
            "begins with 0" in text for text in host.said
        )
        peer.ask(1)


def test_time_can_be_held_within_a_step(copter_plant):
    with served(copter_plant) as (host, peer):
        peer.send(0, rate=50)
        assert host.listen() and host.listen()  # it waits
        host.step(until_us=5000)
        assert host.time_us == 5000
        peer.send(1, rate=50)
        assert host.listen()
        host.step(until_us=5000)  # a step is a tick at least
        assert host.time_us == 7500


def test_range_finder_and_vane_are_told_where_there_is_something_to_tell():
    plant = stand_alone(
        "erle_copter", home=DEFAULT_HOME, world="maze_erlerover", start=(0.0, 0.0, 0.0, 0.0),
        params={"SIM_WIND_SPD": 5.0, "SIM_WIND_DIR": 0.0},
    )  # fmt: skip
    with served(plant) as (_, peer):
        line = peer.ask(0)
        assert 0.0 <= line["rng_1"] < 0.3
        attitude = euler_of(Quat(*line["quaternion"]))  # ArduPilot sees a range only where it is told, too
        assert line["attitude"] == pytest.approx(tuple(attitude), abs=1e-7)
        assert line["windvane"]["direction"] == pytest.approx(0.0, abs=1e-6)  # head to wind
        assert line["windvane"]["speed"] == pytest.approx(5.0, abs=0.1)
        text = peer.text
    plant.close()
    assert text.startswith("\n{") and text.endswith("}\n") and " " not in text
    for key in ("timestamp", "position", "quaternion", "velocity", "rng_1", "attitude"):
        assert first_value(found_by_text(text, "", key)) == line[key], key
    for section in ("imu", "windvane", "battery"):
        for key, value in line[section].items():
            assert first_value(found_by_text(text, section, key)) == value, key


@pytest.mark.parametrize("answers", [1, 16])
def test_solids_near_a_vehicle_that_has_moved_are_listed_anew(answers):
    plant = stand_alone("erle_rover", home=DEFAULT_HOME, world="maze_erlerover", start=(0.0, 0.0, 0.0, 0.0))
    obstacles = plant.vehicle.v.physics.obstacles

    def step(number):
        obstacles.wanted = True
        peer.send(number)
        assert host.listen()
        host.step(answers=answers)
        assert peer.lines() and not obstacles.wanted

    with served(plant) as (host, peer):
        peer.ask(100)
        step(101)
        peer.ask(0)  # the autopilot was restarted: sensors have other memory from now on
        assert host.boots == 1
        step(1)
    plant.close()


def test_same_pulses_same_lines(copter_plant):
    def flight():
        plant = stand_alone("erle_copter", home=DEFAULT_HOME)
        with served(plant) as (_, peer):
            return [peer.ask(number, pulse=1400 + number % 300) for number in range(400)]

    assert flight() == flight()


def test_a_port_that_is_taken_is_named(copter_plant):
    with served(copter_plant) as (host, _), pytest.raises(OptionError, match=str(host.address[1])):
        JsonHost(copter_plant, host.address)
