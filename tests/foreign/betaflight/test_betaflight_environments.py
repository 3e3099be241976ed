# SPDX-License-Identifier: BSD-3-Clause
"""The real program in environments, in tests of users, in scripts and from the command line."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401
from sitl.client import Client
from sitl.client.connection import connect
from sitl.client.endpoint import Inbox
from sitl.envs.options import EnvOptionError
from sitl.errors import LinkLostError
from sitl.examples import betaflight_gates
from tests.foreign.test_foreign_runs import command, line_with

HOVER = 2 * 0.45 - 1


@pytest.fixture
def make(program):
    """``make(id, **options)``: an environment that Betaflight flies."""
    made = []

    def build(name="sitl/CopterGates-v1", **options):
        chosen = {"setpoint": "rates", "step_time": 0.02, **options}
        made.append(gym.make(name, autopilot=f"betaflight:{program}", **chosen))
        return made[-1]

    yield build
    for env in made:
        env.close()


def test_a_policy_of_rates_races_through_gates_and_the_episode_repeats(make):
    env = make(**betaflight_gates.OPTIONS)
    flights = [betaflight_gates.fly(env, 3, 5.0) for _ in range(2)]
    assert flights[0] == flights[1]
    assert flights[0][0].startswith("6 gates in ") and flights[0][0].endswith(", solved")


def test_sticks_lean_it_in_angle(make):
    env = make(setpoint="rc", step_time=0.1)
    robot = env.unwrapped.robot
    env.reset(seed=1)
    for _ in range(5):
        env.step(np.array([0.5, 0.0, 0.14, 0.0], np.float32))
    roll = robot.true_state()[0, 8]
    assert 0.1 < roll < 0.6
    assert robot.link(0).inbox.mode == 1


def test_two_fly_beside_each_other_each_alone(make):
    env, other = make(), make()
    env.reset(seed=5)
    other.reset(seed=5)
    for _ in range(10):
        env.step(np.array([0.1, 0, 0, HOVER], np.float32))
        other.step(np.array([0.1, 0, 0, HOVER], np.float32))
    assert np.array_equal(env.unwrapped.robot.true_state(), other.unwrapped.robot.true_state())


def test_a_killed_program_is_lost_and_the_next_reset_starts_it_again(make):
    env = make()
    env.reset(seed=1)
    env.unwrapped.robot.link(0).process._signal(signal.SIGKILL)
    with pytest.raises(LinkLostError, match="ended by signal 9"):
        env.step(np.array([0, 0, 0, HOVER], np.float32))
    env.reset(seed=1)
    env.step(np.array([0, 0, 0, HOVER], np.float32))


def test_set_points_that_it_has_not_are_refused(program):
    with pytest.raises(EnvOptionError, match=r"velocity.*rates"):
        gym.make("sitl/CopterGates-v1", autopilot=f"betaflight:{program}")


def test_lines_and_our_parameters_reach_program_and_physics(make):
    env = make(params={"motor_idle": 900, "SIM_WIND_SPD": 3.0})
    env.reset(seed=1)
    plant = env.unwrapped.robot.link(0).plant
    assert plant.vehicle.v.physics.wind.speed == 3.0
    env = make(params={"no_such_name": 1})
    with pytest.raises(EnvOptionError, match="no_such_name"):
        env.reset(seed=1)


TESTS = """
def test_it_hovers_in_wind_and_a_motor_fails(vehicle_factory):
    copter = vehicle_factory("copter", wind=(2.0, 0.0))
    copter.set_mode("ANGLE")
    assert copter.mode == "ANGLE"
    copter.arm()
    for _ in range(40):
        push = 1570 + 100 * (2.0 - copter.altitude) - 120 * copter.climb_rate
        copter.rc({3: int(min(max(push, 1060), 1900))})
        copter.delay(0.1)
    assert 1.5 < copter.altitude < 2.5
    with copter.fail("motor", motor=1):
        copter.delay(1.0)
    assert copter.altitude < 1.5
"""


def test_pytest_flies_it(tmp_path, program):
    (tmp_path / "test_it.py").write_text(TESTS)
    path = {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    words = sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-n", "0"
    words = *words, "--sitl-autopilot", f"betaflight:{program}"
    made = subprocess.run(words, cwd=tmp_path, env={**os.environ, **path}, capture_output=True, text=True, check=False)
    assert made.returncode == 0 and "1 passed" in made.stdout, made.stdout[-3000:] + made.stderr[-1000:]


def test_it_is_run_from_the_command_line_and_its_physics_has_wind(tmp_path, program):
    (tmp_path / "lines.txt").write_text("# mine\nset motor_idle = 900\nSIM_WIND_SPD 3\n")
    words = "--speedup", "5", "--out", "none", "--tcp", "0", "--log-dir", str(tmp_path), "--params", "lines.txt"
    with command("run", "copter", "--autopilot", f"betaflight:{program}", *words, cwd=tmp_path) as process:
        port = line_with(process.stdout, "MAVLink on tcp:").rpartition(" ")[2]
        client = Client(connect(port, Inbox(), 60.0, warn=lambda text: None), name="copter")
        assert client.connection.prove(), client.connection.doubt
        client.wait_ready()
        assert client.params["SIM_WIND_SPD"] == 3.0
        client.set_mode("ACRO")
        client.arm()
        pulses = client.message("SERVO_OUTPUT_RAW")[1:5]
        assert min(pulses) == pytest.approx(1090, abs=5)  # the loops add to one or the other
        client.disarm()
        client.close()


def test_a_script_is_run_on_its_clock(tmp_path, program):
    (tmp_path / "script.py").write_text(
        "import os, sys, time\n"
        "os.environ['MAVLINK20'] = '1'  # else its dialect is loaded, and compiled, at the first message\n"
        "from pymavlink import mavutil\n"
        "link = mavutil.mavlink_connection(sys.argv[1])\n"
        "first = link.recv_match(type='ATTITUDE', blocking=True).time_boot_ms\n"
        "began = time.monotonic()\n"
        "while time.monotonic() < began + 20: link.recv_match(blocking=True, timeout=1)\n"
        "last = link.recv_match(type='ATTITUDE', blocking=True).time_boot_ms\n"
        "print('passed', round((last - first) / 1000))\n"
    )
    words = "--speedup", "10", "--out", "none", "--tcp", "0", "--log-dir", tmp_path, "--"
    script = sys.executable, "script.py", "tcp:127.0.0.1:{tcp}"
    with command("exec", "--vehicle", "copter", "--autopilot", f"betaflight:{program}", *words, *script,
                 cwd=tmp_path) as process:  # fmt: skip
        out, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    assert 20 <= int(out.partition("passed ")[2]) <= 22
