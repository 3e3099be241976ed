# SPDX-License-Identifier: BSD-3-Clause
"""Environments whose vehicles are flown by programs of other makers, here by their stand-ins."""

from __future__ import annotations

import contextlib
import math
import socket
import subprocess
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401
from sitl.client.connection import Connection
from sitl.client.endpoint import Endpoint
from sitl.envs import EnvOptionError, NotReadyError
from sitl.envs.mavlink.foreign import physics_port
from sitl.envs.mavlink.last_messages import StepTelemetry
from sitl.envs.mavlink.preparation import set_intervals
from sitl.envs.mavlink.px4 import OFFBOARD
from sitl.envs.robots.autopilot import AutopilotRobot
from sitl.envs.robots.foreign import of_episodes
from sitl.errors import LinkLostError
from sitl.foreign.choice import Choice
from tests.ports import WORKER

ROVER, COPTER = "GazeboMazeErleRoverLIDAR-v0", "GazeboOfficeErleCopterLIDAR-v0"


def drive(env, steps, action):
    """Time of each step's end, and what was seen."""
    robot, times, seen = env.unwrapped.robot, [], []
    for _ in range(steps):
        observation, _, ended, *_ = env.step(action)
        times.append(round(float(robot.time[0]), 4))
        seen.append(observation)
        if ended:
            break
    return times, seen


@pytest.mark.slow
def test_a_rover_of_ardupilots_drives_the_maze(ardurover):
    env = gym.make(ROVER, autopilot=f"ardupilot:{ardurover}", observation="scan+pose")
    observation, _ = env.reset(seed=1)
    assert np.isfinite(observation["scan"]).any()
    times, seen = drive(env, 20, 0)
    steps = np.diff(times)
    assert np.allclose(steps[1:], steps[1], atol=1e-6)  # time goes exactly as far as each step says
    assert not np.array_equal(seen[0]["scan"], seen[-1]["scan"])
    env.reset(seed=2)
    drive(env, 2, 1)
    env.close()


@pytest.mark.slow
@pytest.mark.parametrize("program", ["arducopter", "px4"])
def test_a_copter_of_another_maker_flies_the_office(program, request):
    path = request.getfixturevalue(program)
    kind = "px4" if program == "px4" else "ardupilot"
    seen = ["scan", "pose", "true_pose", "true_wind"]
    env = gym.make(COPTER, autopilot=f"{kind}:{path}", setpoint="velocity", observation=seen, info=["true_pose"])
    env.reset(seed=1)
    robot = env.unwrapped.robot
    before = robot.pose[0].copy()
    times, _ = drive(env, 15, 0)
    observation, *_, info = env.step(0)
    body = robot.link(0).plant.vehicle.v.physics.body.pos
    slices = env.unwrapped.session.observation.slices
    assert np.allclose(info["true_pose"][:3], (body[0], -body[1], -body[2]))
    assert np.allclose(observation[slices["true_pose"]][:3], info["true_pose"][:3], atol=1e-6)
    assert observation[slices["true_wind"]].tolist() == [0.0, 0.0, 0.0]
    assert 0.0 < np.abs(observation[slices["pose"]][:3] - info["true_pose"][:3]).max() < 1.0  # what it believes
    assert robot.pose[0, 2] == pytest.approx(1.0, abs=0.3)
    assert np.hypot(*(robot.pose[0, :2] - before[:2])) > 0.2
    assert np.allclose(np.diff(times)[1:], np.diff(times)[1], atol=1e-6)
    assert robot._states[0].interval_us == 5_000  # so old telemetry may be
    env.close()


@pytest.mark.slow
def test_an_episode_with_px4_begins_where_ours_does(px4):
    """Its estimator tells a position, and a heading without declination, before it holds them for valid."""
    firsts = []
    for extra in ({}, {"autopilot": f"px4:{px4}"}):
        env = gym.make(COPTER, setpoint="velocity", **extra)
        env.reset(seed=1)
        firsts.append(env.unwrapped.robot.pose[0].copy())
        env.close()
    assert np.allclose(firsts[0][:3], firsts[1][:3], atol=1.0)
    assert abs(math.remainder(firsts[0][3] - firsts[1][3], 2.0 * math.pi)) < 0.1


@pytest.mark.slow
def test_a_program_that_dies_in_an_episode_is_told_of(ardurover):
    env = gym.make(ROVER, autopilot=f"ardupilot:{ardurover}", patience=5.0)
    env.reset(seed=1)
    link = env.unwrapped.robot.link(0)
    link.process._signal(9)
    with pytest.raises(LinkLostError, match="ended by signal 9"):
        drive(env, 3, 0)
    env.reset(seed=1)  # and the next episode has another one
    drive(env, 1, 0)
    env.close()


@pytest.mark.slow
def test_an_ardupilot_that_runs_already_is_rebooted_for_each_episode(ardurover, tmp_path):
    instance = free_instance()
    mavlink = 5760 + 10 * instance
    words = "--base-port", mavlink, "--model", "JSON:127.0.0.1", "--sim-port-out", 9002 + 10 * instance
    command = [ardurover, *words, "--home", "-35.363262,149.165237,584,0", "--speedup", 1000]
    with subprocess.Popen(list(map(str, command)), stdout=subprocess.DEVNULL) as program:
        try:
            env = gym.make(ROVER, autopilot=f"ardupilot:tcp:127.0.0.1:{mavlink}", patience=60.0)  # it has to start
            first, second = env.reset(seed=1)[0], None
            drive(env, 10, 0)
            second = env.reset(seed=1)[0]
            assert np.allclose(first, second, atol=1.0)
            drive(env, 2, 0)
            env.close()
        finally:
            program.kill()


def test_a_px4_takes_sticks_from_mavlink_in_episodes():
    ours, theirs = Choice("ardupilot", Path("arducopter")), Choice("px4", Path("px4"))
    assert of_episodes(ours, {"WPNAV_SPEED": 300.0}) == {"WPNAV_SPEED": 300.0}
    sticks = {"COM_RC_IN_MODE": 1.0, "COM_RCL_EXCEPT": 4.0}
    assert of_episodes(theirs, {"MC_ROLL_P": 6.0}) == {**sticks, "MC_ROLL_P": 6.0}


FORWARD = {"forward": (0.3, 0.0, 0.0, 0.0)}


class Launched(Exception):
    """In place of a program."""


@pytest.mark.parametrize("kind", ["ardupilot", "px4"])
def test_wind_mass_and_world_of_an_episode_are_those_of_the_physics(kind, monkeypatch):
    found = {}

    def start(choice, plant, params, inbox, patience):
        found.update(plant=plant, params=params)
        plant.close()
        raise Launched

    monkeypatch.setattr("sitl.envs.robots.foreign.launch", start)
    drawn = {"wind_speed": (4.0, 4.0), "wind_direction": (90.0, 90.0), "mass": (1.3, 1.3)}
    env = gym.make("sitl/CopterForest-v1", autopilot=f"{kind}:/bin/true", randomise=drawn, world="forest:seed=7..9")
    names = set()
    for seed in range(6):
        with pytest.raises(Launched):
            env.reset(seed=seed)
        plant = found["plant"]
        wind = plant.vehicle.v.physics.wind
        assert (wind.speed, wind.direction, plant.vehicle.airframe.value("mass")) == (4.0, 90.0, 1.3)
        names.add(plant.world.name)
        told = {name: value for name, value in found["params"].items() if name.startswith("SIM_WIND")}
        assert told == ({"SIM_WIND_SPD": 4.0, "SIM_WIND_DIR": 90.0} if kind == "ardupilot" else {})
    assert len(names) > 1
    env.close()


@pytest.mark.slow
def test_a_long_step_does_not_lose_px4s_mode(px4):
    env = gym.make(COPTER, autopilot=f"px4:{px4}", setpoint="velocity", action=FORWARD, step_time=3.0)
    env.reset(seed=1)
    robot = env.unwrapped.robot
    before = robot.true_state()[0].copy()
    env.step(0)
    assert robot.link(0).inbox.mode == OFFBOARD
    assert math.dist(before[:2], robot.true_state()[0][:2]) == pytest.approx(0.9, abs=0.3)
    env.close()


class Refusing(Connection):
    """Sends a message each 25 ms at most, as an ArduPilot with 50 loops a second."""

    def __init__(self, is_exact: bool, least_us: int = 25_000) -> None:
        super().__init__(Endpoint(), StepTelemetry(1))
        self.inbox.scans_by_mavlink, self.is_exact, self.least_us = False, is_exact, least_us
        self.asked: list[tuple[int, int]] = []

    @property
    def name(self) -> str:
        return "refusing"

    def command(self, name: str, *params, **named) -> int:
        self.asked.append(params)
        return 0 if params[1] >= self.least_us else 2


def test_a_vehicle_that_cannot_send_so_often_is_asked_for_less():
    link = Refusing(is_exact=False)
    set_intervals(link, 20_000)
    assert link.asked == [(32, 20_000), (32, 25_000), (30, 25_000)]
    link.asked.clear()
    set_intervals(link, 5_000)
    assert link.asked == [(32, 5_000), (32, 20_000), (32, 25_000), (30, 25_000)]
    for slow in (Refusing(is_exact=True), Refusing(is_exact=False, least_us=41_000)):
        with pytest.raises(NotReadyError, match="does not send LOCAL_POSITION_NED every 20 ms"):
            set_intervals(slow, 20_000)


def free_instance():
    for number in range(3 + WORKER % 4, 50, 4):
        with contextlib.ExitStack() as stack, contextlib.suppress(OSError):
            for kind, port in ((socket.SOCK_STREAM, 5760), (socket.SOCK_DGRAM, 9002)):
                probe = stack.enter_context(socket.socket(socket.AF_INET, kind))
                probe.bind(("127.0.0.1", port + 10 * number))
            return number
    raise AssertionError("no free ports")


@pytest.mark.parametrize(
    ("connection", "port"), [("tcp:h:5760", 9002), ("tcp:h:5780", 9022), ("tcp:h:5763", 9002), ("udp:h:14550", 9002)]
)
def test_the_port_of_the_physics_follows_the_instance(connection, port):
    assert physics_port(connection) == port


@pytest.mark.parametrize(
    ("options", "why"),
    [
        ({"autopilot": "ardupilot:/nowhere"}, "is not there"),
        ({"autopilot": "paparazzi"}, "none of"),
        ({"autopilot": "ardupilot:tcp:127.0.0.1:5760", "count": 2}, "one vehicle"),
        ({"autopilot": "ardupilot:tcp:127.0.0.1:5760", "connection": "tcp:127.0.0.1:5760"}, "no connection"),
        ({"autopilot": "ardupilot:tcp:127.0.0.1:5760", "gcs": "udp:127.0.0.1:14550"}, "gcs"),
        ({"autopilot": "px4:udp:127.0.0.1:14540"}, "flies no rover here"),
        ({"autopilot": "px4", "connection": "tcp:127.0.0.1:5760"}, "flies no rover here"),
        ({"autopilot": "px4", "connection": "tcp:127.0.0.1:5760", "frame": "erle_copter"}, "is not rebooted"),
        ({"autopilot": "ardupilot:/bin/true", "sensors": "uwb"}, "receiver"),
    ],
)
def test_options_that_do_not_go_together_are_refused(options, why):
    with pytest.raises(EnvOptionError, match=why):
        AutopilotRobot(**{"frame": "erle_rover", **options})
