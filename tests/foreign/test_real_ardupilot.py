# SPDX-License-Identifier: BSD-3-Clause
"""A real ArduPilot on our physics: SITL_ARDUPILOT names the folder of ``arducopter`` and ``ardurover``."""

from __future__ import annotations

import contextlib
import math
import os
import re
import subprocess
import sys
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401
from benchmarks.recorded import __main__ as compare
from sitl.client import Client
from sitl.client.connection import connect
from sitl.client.endpoint import Inbox
from sitl.envs.mavlink.foreign import launch
from sitl.errors import LinkLostError
from sitl.foreign.choice import choose
from sitl.missions.testing.factory import VehicleFactory
from sitl.missions.testing.golden import GoldenStore
from sitl.missions.testing.setup import Defaults
from sitl.plants.local import stand_alone
from tests.foreign.test_foreign_runs import command, line_with

FOLDER = os.environ.get("SITL_ARDUPILOT", "")
PROGRAMS = {"copter": "arducopter", "rover": "ardurover"}
EXAMPLES = Path(__file__).parents[2] / "examples"

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        not all((Path(FOLDER) / program).is_file() for program in PROGRAMS.values()),
        reason="SITL_ARDUPILOT names no folder with arducopter and ardurover",
    ),
]


def program(kind: str) -> str:
    return f"ardupilot:{Path(FOLDER) / PROGRAMS[kind]}"


@pytest.fixture
def client():
    """``client(kind, **params)``: of one that has just been started."""
    made = []

    def make(kind: str, frame: str, **params: float) -> Client:
        choice = choose(program(kind), kind)
        assert choice is not None
        made.append(Client(launch(choice, stand_alone(frame), params, Inbox(), 30.0), name=kind))
        return made[-1]

    yield make
    for vehicle in made:
        vehicle.close()


@pytest.mark.parametrize(("kind", "frame"), [("copter", "erle_copter"), ("rover", "erle_rover")])
def test_it_is_ready_as_soon_as_on_its_own_physics_and_its_clock_is_ours(client, kind, frame):
    vehicle = client(kind, frame)
    vehicle.wait_ready()
    assert 35.0 < vehicle.now < 46.0  # 41.7 s on its own, with its log
    theirs = vehicle.message("SYSTEM_TIME").time_boot_ms * 1e-3
    assert theirs == pytest.approx(vehicle.now, abs=0.15)
    full = stand_alone(frame).vehicle.airframe.value("battery_voltage_full")
    assert vehicle.telemetry.voltage == pytest.approx(full, rel=0.05)


def test_the_copter_flies_where_it_is_sent(client):
    copter = client("copter", "erle_copter")
    copter.wait_ready()
    copter.take_off(10.0)
    copter.goto(15.0, -5.0)
    north, east, down = copter.connection.plant.vehicle.v.physics.body.pos
    assert math.dist((north, east, down), (15.0, -5.0, -10.0)) < 2.0
    copter.return_to_launch()
    assert not copter.armed


def flown(client, kind: str) -> list[str]:
    """Digests of a flight in wind and turbulence."""
    vehicle = client(kind, f"erle_{kind}", SIM_WIND_SPD=4.0, SIM_WIND_TURB=1.0)
    vehicle.wait_ready()
    if kind == "copter":
        vehicle.take_off(10.0)
    else:
        vehicle.guided_and_armed()
    vehicle.goto(15.0, -5.0)
    return list(vehicle.connection.digests)


@pytest.mark.parametrize("kind", ["copter", "rover"])
def test_a_flight_repeats_bit_for_bit(client, kind):
    first = flown(client, kind)
    assert len(first) > 45
    for _ in range(2):
        assert flown(client, kind) == first


@pytest.mark.parametrize("kind", ["copter", "rover"])
def test_episodes_repeat_bit_for_bit(kind):
    name = {"copter": "GazeboOfficeErleCopterLIDAR-v0", "rover": "GazeboMazeErleRoverLIDAR-v0"}[kind]

    def episode() -> list[str]:
        env = gym.make(name, autopilot=program(kind))
        env.action_space.seed(7)
        env.reset(seed=7)
        for _ in range(30):
            *_, terminated, truncated, _ = env.step(env.action_space.sample())
            if terminated or truncated:
                break
        digests = list(env.unwrapped.robot.link(0).digests)
        env.close()
        return digests

    first = episode()
    assert len(first) > 30 and episode() == first


def test_wind_that_is_set_in_flight_is_our_physics(client):
    copter = client("copter", "erle_copter")
    copter.wait_ready()
    copter.take_off(8.0)
    copter.delay(3.0)
    calm = math.hypot(copter.attitude.roll, copter.attitude.pitch)
    copter.params.update(SIM_WIND_SPD=8.0, SIM_WIND_DIR=0.0)
    copter.delay(6.0)
    assert -9.0 < copter.connection.plant.vehicle.v.physics.wind.vel[0] < -4.0  # less near the ground
    assert math.hypot(copter.attitude.roll, copter.attitude.pitch) > calm + 0.02


@pytest.mark.parametrize("kind", ["copter", "rover"])
def test_it_repeats_its_recorded_flights(kind):
    metrics = [f for f in compare.metrics(kind, autopilot=program(kind)) if f.theirs]
    reached = [f for f in metrics if "reached" in f.name]
    assert len(reached) >= 4
    for metric in reached:
        assert abs(metric.percent) < 3.0, metric


@pytest.mark.parametrize(("kind", "mission"), [("copter", "copter/square"), ("rover", "rover/square")])
def test_a_mission_of_the_library_is_flown_in_a_test(tmp_path, kind, mission):
    factory = VehicleFactory(Defaults(autopilot=program(kind)), GoldenStore(tmp_path), tmp_path / "logs")
    try:
        vehicle = factory(kind)
        vehicle.fly_mission(mission)
        assert len(vehicle.reached) >= 4 and not vehicle.armed
    finally:
        factory.close()


@pytest.mark.parametrize(
    ("name", "kind", "options"),
    [
        ("GazeboMazeErleRoverLIDAR-v0", "rover", {"observation": "scan+pose"}),
        ("GazeboOfficeErleCopterLIDAR-v0", "copter", {"setpoint": "velocity", "observation": "scan+pose"}),
    ],
)
def test_an_environment_is_flown(name, kind, options):
    env = gym.make(name, autopilot=program(kind), **options)
    robot = env.unwrapped.robot
    for seed in (1, 2):
        observation, _ = env.reset(seed=seed)
        assert np.isfinite(observation["scan"]).any()
        start, times = robot.pose[0].copy(), []
        for _ in range(20):
            _, _, ended, *_ = env.step(0)
            times.append(float(robot.time[0]))
            assert not ended
        assert np.allclose(np.diff(times)[1:], np.diff(times)[1], atol=1e-6)
        assert np.hypot(*(robot.pose[0, :2] - start[:2])) > 0.5
        link = robot.link(0)
        told = robot.time[0] * 1e3 + robot._states[0].began_us * 1e-3 - link.inbox.position[0]
        assert 0.0 <= told <= 26.0  # the age of its telemetry [ms]
    link.process._signal(9)
    with pytest.raises(LinkLostError, match="ended by signal 9"):
        env.step(0)
    env.close()


@pytest.fixture
def running(tmp_path):
    """``running(kind, *words)``: a client of ``sitl run``."""
    with contextlib.ExitStack() as stack:

        def make(kind: str, *words: str) -> Client:
            words = "--speedup", "10", "--out", "none", "--tcp", "0", "--log-dir", str(tmp_path), *words
            process = stack.enter_context(command("run", kind, "--autopilot", program(kind), *words, cwd=tmp_path))
            port = line_with(process.stdout, "MAVLink on tcp:").rpartition(" ")[2]
            vehicle = Client(connect(port, Inbox(), 60.0, warn=lambda text: None), name=kind)
            stack.callback(vehicle.close)
            return vehicle

        yield make


def test_a_copter_is_run_in_a_world_and_wind_is_set_in_flight(running):
    copter = running("copter", "--world", "office_erlecopter")
    assert copter.connection.prove(), copter.connection.doubt
    copter.wait_ready()
    copter.take_off(2.0)
    copter.delay(2.0)
    assert copter.message("DISTANCE_SENSOR").current_distance == pytest.approx(200, abs=40)
    assert abs(copter.attitude.pitch) < 0.02
    copter.params.update(SIM_WIND_SPD=6.0, SIM_WIND_DIR=math.degrees(copter.attitude.yaw))
    copter.delay(6.0)
    assert copter.attitude.pitch < -0.05
    copter.params["SIM_WIND_SPD"] = 0.0
    copter.delay(10.0)
    assert abs(copter.attitude.pitch) < 0.03


def test_a_rover_is_run_in_a_world(running):
    rover = running("rover", "--world", "maze_erlerover")
    rover.wait_ready()
    rover.guided_and_armed()
    rover.home()  # it may have been set before the client came
    began = rover.position
    rover.set_velocity(0.6, 0.0)
    rover.delay(3.0)
    assert 0.9 < rover.position.north - began.north < 1.9


TESTS = """
import math

def test_it_flies_in_wind_with_a_weak_motor(vehicle_factory):
    copter = vehicle_factory("copter", world="office_erlecopter", wind=(4.0, 0.0))
    copter.takeoff(2.0)
    copter.delay(2.0)
    assert math.hypot(copter.attitude.roll, copter.attitude.pitch) > 0.03
    with copter.fail("motor", motor=1, thrust=0.9):
        copter.delay(4.0)
        assert copter.params["SIM_ENGINE_FAIL"] == 1
        pulses = copter.message("SERVO_OUTPUT_RAW")
        others = pulses.servo2_raw, pulses.servo3_raw, pulses.servo4_raw
        assert pulses.servo1_raw > max(others) + 30
    assert copter.height > 1.5

def test_it_drives(vehicle_factory):
    rover = vehicle_factory("rover", world="maze_erlerover")
    rover.guided_and_armed()
    rover.set_velocity(0.6, 0.0)
    rover.delay(3.0)
    assert rover.position.north > 0.9
"""


def test_pytest_flies_with_those_of_the_path(tmp_path):
    (tmp_path / "test_it.py").write_text(TESTS)
    paths = {"PATH": FOLDER + os.pathsep + os.environ["PATH"], "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    words = sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "--sitl-autopilot", "ardupilot", "-n", "0"
    made = subprocess.run(words, cwd=tmp_path, env={**os.environ, **paths}, capture_output=True, text=True, check=False)
    assert made.returncode == 0 and "2 passed" in made.stdout, made.stdout[-3000:] + made.stderr[-1000:]


@pytest.mark.parametrize("speedup", ["20", "max"])
def test_a_script_is_run_on_its_clock(tmp_path, speedup):
    script = sys.executable, EXAMPLES / "pymavlink_guided.py", "tcp:127.0.0.1:{tcp}"
    words = "--speedup", speedup, "--out", "none", "--tcp", "0", "--log-dir", tmp_path, "--", *script
    with command("exec", "--vehicle", "copter", "--autopilot", program("copter"), *words, cwd=tmp_path) as process:
        out, err = process.communicate(timeout=300)
    assert process.returncode == 0, err
    said = {what: float(when) for when, what in re.findall(r"^ *([0-9.]+) s  (.*)$", out, re.MULTILINE)}
    assert said["landed and disarmed"] - said["take off"] == pytest.approx(56.0, abs=2.0)  # whatever the speed-up
