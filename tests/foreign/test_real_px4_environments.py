# SPDX-License-Identifier: BSD-3-Clause
"""Environments and policies on a real PX4: SITL_PX4 names the folder of its program, as in test_real_px4.py."""

from __future__ import annotations

import math
import os
import time
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401
from sitl.agents import baselines, learnt
from sitl.agents.deploy import deploy
from sitl.client.connection import Remote, connect
from sitl.core.mavlink import MavResult
from sitl.envs.mavlink.last_messages import StepTelemetry
from sitl.envs.mavlink.preparation import mode_parameters
from sitl.envs.mavlink.px4 import ALTCTL, HOLD, MODES, OFFBOARD, POSCTL
from tests.foreign.test_foreign_runs import command, line_with

PROGRAM = str(Path(os.environ.get("SITL_PX4", "")) / "px4")
X, Y, Z, YAW, FORWARD, LEFT, UP, TURN, ROLL, PITCH, ROLL_RATE = range(11)
TEN_DEGREES = math.radians(10.0)

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not Path(PROGRAM).is_file(), reason="SITL_PX4 names no px4 program"),
]


@pytest.fixture
def flown():
    """``flown(setpoint, step_time, (row, steps), ...)``: true states at the start and after each, and the mode."""
    made = []

    def fly(setpoint: str, step_time: float, *moves):
        options = {"robot": "erle_copter", "world": "open", "take_off": 3.0, "action": "continuous"}
        env = gym.make(
            "sitl/Navigate-v1", autopilot=f"px4:{PROGRAM}", setpoint=setpoint, step_time=step_time, **options
        )
        made.append(env)
        env.reset(seed=1)
        robot = env.unwrapped.robot
        states = [robot.true_state()[0].copy()]
        for row, steps in moves:
            for _ in range(steps):
                env.step(np.array(row, np.float32))
            states.append(robot.true_state()[0].copy())
        return states, robot.link(0).inbox.mode

    yield fly
    for env in made:
        env.close()


def test_it_hovers_at_a_position(flown):
    (start, end), mode = flown("position", 0.1, ((2.0, 1.0, 4.0, 0.5), 80))
    assert mode == OFFBOARD and start[Z] == pytest.approx(3.0, abs=0.4)
    assert math.dist(end[:3], (2.0, 1.0, 4.0)) < 0.8 and abs(end[YAW] - 0.5) < 0.1  # its GPS is that good
    assert np.abs(end[FORWARD:TURN]).max() < 0.2


@pytest.mark.parametrize("step_time", [0.1, 3.0])
def test_a_velocity_is_flown_whatever_the_length_of_a_step(flown, step_time):
    (_, end, turning), mode = flown(
        "velocity",
        step_time,
        ((1.0, 0.0, 0.0, 0.0), round(3.0 / step_time)),
        ((0.0, 0.0, 0.0, 0.4), 15 if step_time < 1.0 else 1),
    )
    assert mode == OFFBOARD
    assert end[FORWARD : TURN + 1] == pytest.approx([1.0, 0.0, 0.0, 0.0], abs=0.2)
    assert turning[TURN] == pytest.approx(0.4, abs=0.15)


def test_an_acceleration_is_flown(flown):
    (start, middle, end), _ = flown("acceleration", 0.1, ((1.0, 0.0, 0.0, 0.0), 15), ((-1.0, 0.0, 0.0, 0.0), 15))
    assert middle[FORWARD] - start[FORWARD] == pytest.approx(1.3, abs=0.4)
    assert abs(end[FORWARD] - start[FORWARD]) < 0.4


def test_it_leans_at_once_by_ten_degrees(flown):
    (_, soon, end, level), _ = flown(
        "thrust", 0.1, ((TEN_DEGREES, 0.0, 0.0, 0.55), 5), ((0.0, TEN_DEGREES, 0.0, 0.55), 8), ((0, 0, 0, 0.55), 8)
    )
    assert soon[ROLL] == pytest.approx(TEN_DEGREES, abs=0.04)
    assert end[ROLL : PITCH + 1] == pytest.approx([0.0, TEN_DEGREES], abs=0.04)
    assert np.abs(level[ROLL : PITCH + 1]).max() < 0.04 and end[LEFT] < -0.2 and level[FORWARD] < -0.8


def test_a_pulse_of_rates_is_a_lean(flown):
    pulse = ((0.5, 0.0, 0.0, 0.6), 4), ((0.0, 0.0, 0.0, 0.6), 2), ((-0.5, 0.0, 0.0, 0.6), 4)
    (_, soon, leaning, end), _ = flown("rates", 0.1, *pulse)
    assert soon[ROLL_RATE] == pytest.approx(0.5, abs=0.15) and leaning[ROLL] == pytest.approx(0.2, abs=0.06)
    assert abs(end[ROLL]) < 0.06


@pytest.mark.parametrize(("setpoint", "number", "slowest"), [("rc", ALTCTL, 1.0), ("loiter", POSCTL, 0.2)])
def test_sticks_fly_it_in_modes_of_its_own(flown, setpoint, number, slowest):
    rest = (1500.0,) * 4
    forward, climb = (1500.0, 1400.0, 1500.0, 1500.0), (1500.0, 1500.0, 1600.0, 1500.0)
    (start, fast, high, _), mode = flown(setpoint, 0.1, (forward, 20), (climb, 20), (rest, 10))
    assert mode == number and fast[FORWARD] - start[FORWARD] > slowest and fast[PITCH] < 0.0
    assert abs(fast[Z] - start[Z]) < 0.4 and high[Z] - fast[Z] > 0.2


@pytest.mark.filterwarnings("ignore:.*out of date")
@pytest.mark.parametrize("name", ["sitl/CopterHover-v0", "sitl/CopterForest-v1", "sitl/CopterReachGoalDiscrete-v1"])
def test_ids_with_wind_many_worlds_and_goals_are_flown(name):
    env = gym.make(name, autopilot=f"px4:{PROGRAM}")
    worlds = set()
    for seed in (1, 2):
        env.reset(seed=seed)
        session = env.unwrapped.session
        worlds.add(session.robot.world.name)
        drawn = session.randomisation.ranges
        wind = session.robot.link(0).plant.vehicle.v.physics.wind
        assert (wind.speed > 0.0) == ("wind_speed" in drawn)
        for _ in range(5):
            env.step(env.action_space.sample())
    assert len(worlds) == 2 or "Forest" not in name
    env.close()


def test_two_fly_side_by_side():
    env = gym.make_vec("sitl/CopterWaypoint-v1", num_envs=2, vectorization_mode="vector_entry_point",
                       autopilot=f"px4:{PROGRAM}")  # fmt: skip
    env.reset(seed=1)
    for _ in range(5):
        _, rewards, terminated, _, _ = env.step(env.action_space.sample())
        assert rewards.shape == (2,) and np.isfinite(rewards).all() and not terminated.any()
    env.close()


def pilot(address: str) -> Remote:
    """At the connection of programs; it must be closed before another uses that."""
    return connect(address, StepTelemetry(1), 20.0, warn=lambda text: None)


def waited(link: Remote, done, seconds: float = 60.0) -> bool:
    """Whether it is so within this wall time."""
    until = time.monotonic() + seconds
    while not done() and time.monotonic() < until:
        link.endpoint.send("HEARTBEAT", type=6, autopilot=8, system_status=4, mavlink_version=3)
        link.listen(200_000)
    return done()


def test_a_policy_takes_it_over_in_hold_flies_and_hands_it_over_to_be_landed(tmp_path):
    words = "--autopilot", f"px4:{PROGRAM}", "--speedup", "1", "--out", "none", "--tcp", "0", "--log-dir", str(tmp_path)
    with command("run", "copter", *words, cwd=tmp_path) as process:
        address = line_with(process.stdout, "MAVLink on tcp:").rpartition(" ")[2]
        link = pilot(address)
        assert waited(
            link, lambda: link.inbox.mode == HOLD and link.command("COMPONENT_ARM_DISARM", arm=1) == MavResult.ACCEPTED
        )
        here = math.nan  # 0 is a place of its own to some versions, which stay on the ground then
        up = link.command("NAV_TAKEOFF", altitude=590.0, latitude=here, longitude=here, yaw=here)
        assert up == MavResult.ACCEPTED
        assert waited(link, lambda: link.inbox.mode == HOLD and link.inbox.position[3] < -2.0)
        link.close()
        policy = learnt.load(baselines.find("copter-waypoint"))
        done = deploy(policy, address, episodes=2, reset="return", wait=20.0, options={"autopilot": "px4"})
        assert len(done.episodes) == 2 and all(one.solved for one in done.episodes)
        assert [deed.what for deed in done.deeds if deed.what != "limited"] == 2 * ["taken over"] + ["handed over"]
        link = pilot(address)
        assert waited(link, lambda: link.inbox.mode == HOLD, 5.0)
        assert link.command("DO_SET_MODE", *mode_parameters(MODES["LAND"])) == MavResult.ACCEPTED
        assert waited(link, lambda: not link.inbox.armed)
        link.close()
        process.terminate()
