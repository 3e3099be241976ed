# SPDX-License-Identifier: BSD-3-Clause
"""Physics and autopilot in two processes; one of them is stopped, or killed and started anew, while a copter flies.

Nothing here waits for the wall clock: each step waits for what the other side then says.
"""

from __future__ import annotations

import contextlib
import os
import queue
import signal
import subprocess
import sys
import threading

import pytest
from pymavlink import mavutil

from sitl.simulation import load_core
from sitl.vehicle.kinds import KINDS

pytestmark = pytest.mark.slow

PATIENCE_S = 120.0
"""A hang fails the test after this."""
HEIGHT = 10.0
LINKS = {"hil": ("tcp:0", "MAVLink HIL on tcp:"), "json": ("json:0", "JSON on udp ")}


class Process:
    """A ``sitl`` command and what it says."""

    def __init__(self, *words: str, folder) -> None:
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path)), "PYTHONUNBUFFERED": "1"}
        self.process = subprocess.Popen(
            [sys.executable, "-m", "sitl", *words], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            text=True, env=environment,
        )  # fmt: skip
        self.said: list[str] = []
        self._lines: queue.Queue[str] = queue.Queue()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        for line in self.process.stdout:
            self._lines.put(line.strip())

    def says(self, text: str) -> str:
        """The next line with a text."""
        while True:
            try:
                line = self._lines.get(timeout=PATIENCE_S)
            except queue.Empty:
                raise AssertionError(f"nobody said {text!r}, but: {self.said}") from None
            self.said.append(line)
            if text in line:
                return line

    def signal(self, number: int) -> None:
        self.process.send_signal(number)

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()


class Ground:
    """A ground station of one autopilot."""

    def __init__(self, port: str) -> None:
        self.link = mavutil.mavlink_connection(f"tcp:127.0.0.1:{port}")
        assert self.next("HEARTBEAT") is not None
        for number in (33, 193):
            self.command(511, number, 100_000)

    def next(self, kind: str, holds=lambda m: True):
        """The next message of a kind for which something holds."""
        while True:
            found = self.link.recv_match(type=kind, blocking=True, timeout=PATIENCE_S)
            assert found is not None, f"no {kind}"
            if holds(found):
                return found

    def says(self, text: str) -> str:
        return self.next("STATUSTEXT", lambda m: text in m.text).text

    def command(self, number: int, *params: float) -> None:
        for _ in range(20):
            padded = [*params, *(0.0,) * (7 - len(params))]
            self.link.mav.command_long_send(1, 1, number, 0, *padded)
            if self.next("COMMAND_ACK", lambda m: m.command == number).result == 0:
                return
        raise AssertionError(f"command {number} is refused")

    def place(self):
        return self.next("GLOBAL_POSITION_INT")

    def take_off(self) -> None:
        self.next("EKF_STATUS_REPORT", lambda m: m.flags & 16)
        self.command(176, 1, 4)
        self.command(400, 1)
        self.command(22, 0, 0, 0, 0, 0, 0, HEIGHT)
        self.next("GLOBAL_POSITION_INT", lambda m: abs(m.relative_alt * 1e-3 - HEIGHT) < 0.3 and abs(m.vz) < 20)

    def hovers(self, since_ms: int) -> None:
        """It hovers where it did, and time goes on."""
        here = self.next("GLOBAL_POSITION_INT", lambda m: m.time_boot_ms > since_ms + 2000)
        assert abs(here.relative_alt * 1e-3 - HEIGHT) < 0.5

    def close(self) -> None:
        self.link.close()


class Flight:
    """Both processes and a ground station; the copter hovers."""

    def __init__(self, kind: str, folder, stack: contextlib.ExitStack) -> None:
        self.kind, self.folder, self.stack = kind, folder, stack
        listen, says = LINKS[kind]
        self.physics = self.start("physics", "copter", "--listen", listen)
        self.where = self.physics.says(says).partition(says)[2]
        self.autopilot = self.start_autopilot()
        self.ground = self.call()
        self.ground.take_off()

    def start(self, *words: str) -> Process:
        made = Process(*words, folder=self.folder)
        self.stack.callback(made.kill)
        return made

    def start_physics(self) -> Process:
        """Anew, at the same port."""
        scheme = "tcp" if self.kind == "hil" else "json"
        made = self.start("physics", "copter", "--listen", f"{scheme}:{self.where}")
        made.says(LINKS[self.kind][1])
        return made

    def start_autopilot(self) -> Process:
        address = f"hil:tcp:{self.where}" if self.kind == "hil" else f"json:{self.where}"
        words = "--speedup", "20", "--out", "none", "--tcp", "0", "--log-dir", "logs"
        return self.start("run", "copter", "--physics", address, *words)

    def call(self) -> Ground:
        station = Ground(self.autopilot.says("MAVLink on tcp:").rpartition(":")[2])
        self.stack.callback(station.close)
        return station


@pytest.fixture(scope="module", autouse=True)
def _core():
    """Nobody waits for a compiler."""
    load_core(KINDS["copter"])


@pytest.fixture
def flight(request, tmp_path):
    with contextlib.ExitStack() as stack:
        yield Flight(request.param, tmp_path, stack)


on_both_links = pytest.mark.parametrize("flight", LINKS, indirect=True)


@on_both_links
def test_physics_that_is_stopped_stops_time_and_the_flight_goes_on(flight):
    flight.physics.signal(signal.SIGSTOP)
    assert "does not answer" in flight.ground.says("physics")
    beats = [flight.ground.next("HEARTBEAT") for _ in range(3)]  # it serves its clients meanwhile
    assert all(beat.base_mode & 128 for beat in beats)
    before = flight.ground.link.messages["GLOBAL_POSITION_INT"].time_boot_ms
    flight.physics.signal(signal.SIGCONT)
    flight.ground.says("Physics is back")
    assert 0 <= flight.ground.place().time_boot_ms - before < 1000  # no time passed
    flight.ground.hovers(before)


@on_both_links
def test_an_autopilot_that_is_stopped_stops_time_and_the_flight_goes_on(flight):
    before = flight.ground.place().time_boot_ms
    flight.autopilot.signal(signal.SIGSTOP)
    flight.physics.says("the autopilot is silent: time stands at")
    flight.autopilot.signal(signal.SIGCONT)
    flight.physics.says("the autopilot is back")
    flight.ground.hovers(before)


@on_both_links
def test_physics_that_is_started_anew_is_at_power_on_and_the_autopilot_reboots_with_it(flight):
    flight.physics.kill()
    flight.ground.says("physics")
    flight.physics = flight.start_physics()
    beat = flight.ground.next("HEARTBEAT", lambda m: not m.base_mode & 128)
    assert beat.custom_mode == 0
    flight.ground.command(511, 33, 100_000)
    flight.ground.next("GLOBAL_POSITION_INT", lambda m: m.time_boot_ms < 100_000 and abs(m.relative_alt) < 500)
    flight.ground.command(511, 193, 100_000)
    flight.ground.take_off()


def started_anew(flight) -> Ground:
    """The ground station of another autopilot."""
    flight.autopilot.kill()
    flight.autopilot = flight.start_autopilot()
    return flight.call()


@pytest.mark.parametrize("flight", ["hil"], indirect=True)
def test_an_autopilot_that_is_started_anew_over_hil_joins_in_the_air_disarmed_and_falls(flight):
    high = flight.ground.place().alt
    flight.autopilot.kill()
    gone = flight.physics.says("has gone at")
    assert "time stands" in gone
    ground = started_anew(flight)
    assert gone.split("has gone at ")[1].split(" s")[0] in flight.physics.says("has come at")  # nothing moved meanwhile
    assert not ground.next("HEARTBEAT").base_mode & 128
    ground.next("EKF_STATUS_REPORT", lambda m: m.flags & 16)
    assert ground.place().alt < high - 8000  # [mm]
    ground.take_off()


@pytest.mark.parametrize("flight", ["json"], indirect=True)
def test_an_autopilot_that_is_started_anew_over_json_begins_at_power_on(flight):
    ground = started_anew(flight)
    flight.physics.says("autopilot at")
    assert not ground.next("HEARTBEAT").base_mode & 128
    assert abs(ground.next("GLOBAL_POSITION_INT", lambda m: m.lat != 0).relative_alt) < 500
    ground.take_off()
