# SPDX-License-Identifier: BSD-3-Clause
"""Environments of vehicles in other processes, and of those that send sectors and no whole scans."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import threading

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401
from sitl.bridge.core_link import CoreLink
from sitl.bridge.dialect import message
from sitl.bridge.frame import encode_v2
from sitl.bridge.wire.choose import message_of
from sitl.client import connect
from sitl.envs import EnvOptionError
from sitl.envs.mavlink.last_messages import SCAN, SECTORS, StepTelemetry
from sitl.envs.robots import autopilot, in_process
from sitl.envs.robots.in_process import InProcessVehicles
from sitl.envs.robots.starts import Starts
from sitl.errors import LinkLostError
from tests.envs import lockstep_vehicle
from tests.ports import free_port

ROVER, COPTER = "GazeboMazeErleRoverLIDAR-v0", "GazeboOfficeErleCopterLIDAR-v0"


def compare(here, there, steps):
    for seed in (5, 6):  # the second episode begins with a reboot in mid-drive
        a, b = here.reset(seed=seed)[0], there.reset(seed=seed)[0]
        for k in range(steps):
            assert a.keys() == b.keys()
            for name in a:
                assert np.array_equal(a[name], b[name]), (seed, k, name)
            (a, *rest_a), (b, *rest_b) = here.step(k // 15 % 3), there.step(k // 15 % 3)
            assert rest_a == rest_b
            if rest_a[1]:
                break


def test_a_rover_by_udp_in_lockstep_is_the_one_in_process(tmp_path):
    port = free_port()
    options = ("--lockstep", "--out", f"udp:127.0.0.1:{port}")
    with lockstep_vehicle.vehicle(tmp_path, "rover", "maze_erlerover", *options):
        here = gym.make(ROVER, observation="scan+pose")
        there = gym.make(ROVER, observation="scan+pose", connection=f"udp:127.0.0.1:{port}")
        compare(here, there, 60)
        there.close()


class Lossy:
    """A client's end of a link that loses every ``nth`` datagram, in either direction."""

    def __init__(self, end, nth):
        self._end, self._nth, self._count, self.lost = end, nth, 0, 0

    def __getattr__(self, name):
        return getattr(self._end, name)

    def _is_lost(self):
        self._count += 1
        lost = self._count % self._nth == 0
        self.lost += lost
        return lost

    def flush(self):
        write = self._end.write
        self._end.write = lambda data: None
        try:
            data = self._end.flush()
        finally:
            self._end.write = write
        self.write(data)
        return data

    def write(self, data):
        if not self._is_lost():
            self._end.write(data)

    def receive(self):
        data = self._end.receive()
        return b"" if data and self._is_lost() else data


def test_lost_datagrams_change_nothing(tmp_path, monkeypatch):
    monkeypatch.setattr("sitl.client.connection._REPEAT_S", 0.05)
    port = free_port()
    options = ("--lockstep", "--out", f"udp:127.0.0.1:{port}")
    with lockstep_vehicle.vehicle(tmp_path, "rover", "maze_erlerover", *options):
        here = gym.make(ROVER, observation="scan+pose")
        there = gym.make(ROVER, observation="scan+pose", connection=f"udp:127.0.0.1:{port}")
        a, b = here.reset(seed=5)[0], there.reset(seed=5)[0]
        link = there.unwrapped.robot.link(0)
        link.stream = link.endpoint.link = lossy = Lossy(link.stream, 5)
        for k in range(40):
            for name in a:
                assert np.array_equal(a[name], b[name]), (k, name)
            a, b = here.step(k // 15 % 3)[0], there.step(k // 15 % 3)[0]
        assert lossy.lost > 10


def test_a_copter_by_tcp_in_lockstep_is_the_one_in_process_until_it_is_gone(tmp_path):
    with lockstep_vehicle.vehicle(tmp_path, "copter", "office_erlecopter", "--lockstep", "--out", "none") as (
        port,
        run,
    ):
        text = f"tcp:127.0.0.1:{port}"
        here = gym.make(COPTER, observation="scan+pose")
        there = gym.make(COPTER, observation="scan+pose", connection=text)
        compare(here, there, 60)
        with pytest.raises(EnvOptionError, match="only vehicles in process have snapshots"):
            there.unwrapped.snapshot()
        with pytest.raises(EnvOptionError, match="starts where it was started"):
            there.reset(options={"pose": (1.0, 0.0, 0.0)})
        run.kill()
        run.wait()
        with pytest.raises(LinkLostError, match=f"connection {text} is lost"):
            there.step(0)
        with pytest.raises(LinkLostError, match="is not open"):
            there.step(0)
        with pytest.raises(LinkLostError, match=f"connection {text}: Connection refused"):
            there.reset()


def test_a_vehicle_without_lockstep_runs_in_real_time_with_a_warning(tmp_path):
    options = ("--speedup", "20", "--out", "none")
    with lockstep_vehicle.vehicle(tmp_path, "rover", "maze_erlerover", *options) as (port, _):
        env = gym.make(ROVER, connection=f"tcp:127.0.0.1:{port}")
        with pytest.warns(UserWarning, match="clock cannot be held"):
            assert env.reset(seed=1)[0].tolist() == [6, 4, 10, 13, 4, 6]
        begun = None
        for _ in range(20):
            env.step(0)
            begun = env.unwrapped.robot.time[0] if begun is None else begun
        assert env.unwrapped.robot.velocity[0, 0] > 1.0
        assert env.unwrapped.robot.time[0] - begun > 1.8


def test_an_episode_is_recorded_logged_and_replayed_byte_for_byte(tmp_path):
    kept = tmp_path / "episode.rec"
    options = ("--lockstep", "--out", "none", "--rec", str(kept), "--log-dir", str(tmp_path / "logs"))
    with lockstep_vehicle.vehicle(tmp_path, "rover", "open", *options) as (port, run):
        env = gym.make("sitl/RoverWaypoint-v0", connection=f"tcp:127.0.0.1:{port}")
        env.reset(seed=1)
        for _ in range(20):
            env.step(np.array([1.0, 0.2], np.float32))
        env.close()
        run.terminate()
        run.wait()
    assert (tmp_path / "logs" / "erle_rover-0.tlog").stat().st_size > 50_000
    command = [sys.executable, "-m", "sitl", "mission", "replay", str(kept), "--exact"]
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run(command, cwd=tmp_path, env=env, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "the same, byte for byte" in done.stdout


def test_nobody_there_is_said_at_once():
    env = gym.make(ROVER, connection=f"udp:127.0.0.1:{free_port()}", patience=0.6)
    with pytest.raises(LinkLostError, match=r"no vehicle answers within 0\.6 s"):
        env.reset()


def test_a_vehicle_that_does_not_answer_is_not_waited_for_for_ever():
    """One that talks, and says nothing to what it is asked."""
    port = free_port()
    stop = threading.Event()

    def talk():
        beat = encode_v2(message("HEARTBEAT"), message("HEARTBEAT").payload(type=10), 0, 1, 1)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
            while not stop.wait(0.02):
                sock.sendto(beat, ("127.0.0.1", port))

    talker = threading.Thread(target=talk)
    talker.start()
    try:
        env = gym.make(ROVER, connection=f"udp:127.0.0.1:{port}", patience=0.8)
        with pytest.raises(LinkLostError, match="no vehicle answers"):
            env.reset()
    finally:
        stop.set()
        talker.join()


def test_a_vehicle_that_another_client_reboots_is_noticed(tmp_path):
    with lockstep_vehicle.vehicle(tmp_path, "rover", "maze_erlerover", "--lockstep", "--out", "none") as (port, _):
        env = gym.make(ROVER, connection=f"tcp:127.0.0.1:{port}")
        env.reset(seed=1)
        env.step(0)
        other = connect(f"tcp:127.0.0.1:{port}", patience=5.0)
        assert other.command("COMPONENT_ARM_DISARM", arm=0, force=21196) == 0
        assert other.command("PREFLIGHT_REBOOT_SHUTDOWN", autopilot=1) == 0
        with pytest.raises(LinkLostError, match="rebooted"):
            env.step(0)
        assert env.reset(seed=1)[0].tolist() == [6, 4, 10, 13, 4, 6]


def test_sectors_are_spread_over_the_readings(monkeypatch):
    whole = gym.make(COPTER, observation="scan")
    seen, _ = whole.reset(seed=2)
    make = CoreLink.__init__

    def make_without_scans(self, vehicle, units):
        make(self, vehicle, units._replace(builders=[b for b in units.builders if message_of(b).kind is not SCAN]))

    monkeypatch.setattr(CoreLink, "__init__", make_without_scans)
    monkeypatch.setattr(in_process, "STARTS", Starts())
    monkeypatch.setattr(autopilot, "make_vehicles", lambda setup, choice: InProcessVehicles(setup))
    sectors = gym.make(COPTER, observation="scan")
    rough, _ = sectors.reset(seed=2)
    assert sectors.unwrapped.robot.link(0).inbox.scan_kind is SECTORS
    assert rough == pytest.approx(seen, abs=0.0051)
    assert not np.array_equal(rough, seen)
    for action in (0, 1, 2, 0):
        seen, rough = whole.step(action)[0], sectors.step(action)[0]
        assert rough == pytest.approx(seen, abs=0.0051)


def test_a_sector_that_was_not_measured_is_out_of_range():
    telemetry = StepTelemetry(3)
    telemetry.scan_kind, telemetry.angles = SECTORS, np.radians([-90.0, 0.0, 90.0])
    distances = [65535] * 72
    distances[0], distances[18], distances[54] = 150, 250, 1001  # ahead, right, left: beyond the range
    fields = SECTORS.decode(SECTORS.payload(distances=distances, max_distance=1000, increment=5))
    telemetry._sectors(fields)
    assert telemetry.scan[:3].tolist() == [2.5, 1.5, np.inf]
    assert telemetry.scans == 1
