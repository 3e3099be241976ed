# SPDX-License-Identifier: BSD-3-Clause
"""A real PX4 on our physics: SITL_PX4 names the folder of its program, whose ``../etc`` has its start-up files."""

from __future__ import annotations

import contextlib
import importlib.util
import math
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from sitl.client import Client
from sitl.client.connection import connect
from sitl.client.endpoint import Inbox
from sitl.client.errors import UnknownNameError
from sitl.errors import LinkLostError, OptionError
from sitl.missions.testing.factory import VehicleFactory
from sitl.missions.testing.golden import GoldenStore
from sitl.missions.testing.setup import Defaults
from tests.foreign.test_foreign_runs import command, line_with

FOLDER = os.environ.get("SITL_PX4", "")
PROGRAM = f"px4:{Path(FOLDER) / 'px4'}"
EXAMPLES = Path(__file__).parents[2] / "examples"
COPTERS = ("erle_copter", "ardupilot_quad", "ardupilot_x", "ardupilot_hexa", "ardupilot_octa_quad", "ardupilot_y6")

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not (Path(FOLDER) / "px4").is_file(), reason="SITL_PX4 names no folder with px4"),
]


@pytest.fixture
def fly(tmp_path):
    """``fly(kind, **options)``: a vehicle of a test, ready to arm."""
    factory = VehicleFactory(Defaults(autopilot=PROGRAM), GoldenStore(tmp_path), tmp_path / "logs")
    yield factory
    factory.close()


def truth(vehicle) -> tuple[float, float, float]:
    return tuple(vehicle.connection.plant.vehicle.v.physics.body.pos)


def test_it_flies_where_it_is_sent_by_its_own_modes(fly):
    copter = fly("copter", params={"MPC_XY_CRUISE": 4.0})
    assert copter.now < 16.0 and copter.params["MPC_XY_CRUISE"] == 4.0
    copter.takeoff(10.0)
    copter.fly_to(15.0, -5.0, 10.0, yaw=90.0)
    assert math.dist(truth(copter), (15.0, -5.0, -10.0)) < 2.5
    copter.wait_heading(90.0)
    copter.set_velocity(2.0, 0.0, body=True)
    copter.delay(4.0)
    assert copter.mode == "OFFBOARD" and copter.velocity[1] == pytest.approx(2.0, abs=0.4)
    copter.params["NAV_RCL_ACT"] = 2  # a whole number, whose bytes are sent
    assert copter.params["NAV_RCL_ACT"] == 2
    copter.return_to_launch()
    assert not copter.armed and math.hypot(*truth(copter)[:2]) < 1.0


def test_what_it_has_not_is_named(fly):
    copter = fly("copter")
    with pytest.raises(UnknownNameError, match="no mode 'GUIDED'; it has MANUAL"):
        copter.change_mode("GUIDED")
    with pytest.raises(OptionError, match="COM_RC_IN_MODE"):
        copter.set_rc(roll=1600)
    with pytest.raises(OptionError, match="has no MC_ROLRATE_P"):
        fly("copter", params={"MC_ROLRATE_P": 0.2})


def test_faults_act_on_its_sensors_and_motors(fly):
    copter = fly("copter")
    copter.takeoff(8.0)
    with copter.fail("wind", speed=8.0, direction=0.0):
        copter.delay(6.0)
        assert copter.params["SIM_WIND_SPD"] == 8.0
        assert -9.0 < copter.connection.plant.vehicle.v.physics.wind.vel[0] < -4.0
        assert math.hypot(copter.attitude.roll, copter.attitude.pitch) > 0.08
    with copter.fail("motor", motor=1, thrust=0.9):
        copter.delay(4.0)
        assert copter.params["SIM_ENGINE_FAIL"] == 1
    with copter.fail("gps"):
        copter.wait_statustext("Failsafe", 30.0)
    assert not copter.idle_faults


@pytest.mark.parametrize(("kind", "mission"), [("copter", "copter/square"), ("rover", "rover/square")])
def test_a_mission_of_the_library_is_flown_in_a_test(fly, kind, mission):
    vehicle = fly(kind)
    vehicle.fly_mission(mission)
    assert vehicle.telemetry.items[-1] >= 4 and len(vehicle.download()) == len(vehicle.upload(mission).items)


@pytest.mark.parametrize("frame", COPTERS)
def test_every_copter_hovers_and_holds_its_place_in_wind(fly, frame):
    copter = fly("copter", frame=frame)
    copter.takeoff(10.0)
    copter.params.update(SIM_WIND_SPD=8.0, SIM_WIND_TURB=1.0)
    copter.delay(12.0)
    places = []
    for _ in range(40):
        copter.delay(0.2)
        places.append(truth(copter))
    assert max(math.dist(a, places[0]) for a in places) < 1.5
    copter.land()


def test_a_rover_is_driven_by_velocities(fly):
    rover = fly("rover")
    rover.start()
    rover.set_velocity(0.8, 0.0)
    rover.delay(8.0)
    assert rover.velocity[0] == pytest.approx(0.8, abs=0.25)
    rover.stop()


@pytest.mark.parametrize("speedup", ["20", "max"])
@pytest.mark.parametrize("script", ["mavsdk_mission.py", "mavsdk_offboard.py"])
def test_a_script_is_run_on_its_clock(tmp_path, script, speedup):
    if importlib.util.find_spec("mavsdk") is None:
        pytest.skip("MAVSDK is missing")
    run = sys.executable, EXAMPLES / script, "udpin://127.0.0.1:14543"
    words = "--speedup", speedup, "--instance", "3", "--tcp", "0", "--log-dir", tmp_path, "--", *run
    with command("exec", "--vehicle", "copter", "--autopilot", PROGRAM, *words, cwd=tmp_path) as process:
        out, err = process.communicate(timeout=300)
    assert process.returncode == 0, out + err
    said = re.search(r"^ *([0-9.]+) s  landed and disarmed$", out, re.MULTILINE)
    if script == "mavsdk_mission.py":
        assert said is not None and 55.0 < float(said[1]) < 70.0  # whatever the speed-up


SCRIPT = """
import math, sys, time
from pymavlink import mavutil
link = mavutil.mavlink_connection(sys.argv[1])
link.wait_heartbeat()

def command(number, *params):
    while True:
        link.mav.command_long_send(link.target_system, 1, number, 0, *params, *(0,) * (7 - len(params)))
        ack = link.recv_match(type="COMMAND_ACK", condition=f"COMMAND_ACK.command=={number}", blocking=True, timeout=2)
        if ack is not None and ack.result == 0:
            return

ready = mavutil.mavlink.MAV_SYS_STATUS_PREARM_CHECK
while not link.recv_match(type="SYS_STATUS", blocking=True).onboard_control_sensors_health & ready:
    pass
home = link.recv_match(type="GLOBAL_POSITION_INT", blocking=True).alt * 1e-3
command(176, 1, 4, 3)  # AUTO.LOITER
command(400, 1)
began = time.monotonic()
command(22, 0, 0, 0, math.nan, math.nan, math.nan, home + 5.0)
while link.recv_match(type="GLOBAL_POSITION_INT", blocking=True).relative_alt < 4500:
    pass
command(176, 1, 4, 6)  # AUTO.LAND
while link.motors_armed():
    link.recv_match(type="HEARTBEAT", blocking=True)
print(f"{time.monotonic() - began:6.1f} s  landed and disarmed")
"""


@pytest.mark.parametrize("speedup", ["1", "max"])
def test_a_script_of_pymavlink_is_run_on_its_clock(tmp_path, speedup):
    (tmp_path / "script.py").write_text(SCRIPT)
    run = sys.executable, tmp_path / "script.py", "tcp:127.0.0.1:{tcp}"
    words = "--speedup", speedup, "--instance", "3", "--out", "none", "--tcp", "0", "--log-dir", tmp_path, "--", *run
    with command("exec", "--vehicle", "copter", "--autopilot", PROGRAM, *words, cwd=tmp_path) as process:
        out, err = process.communicate(timeout=200)
    assert process.returncode == 0, out + err
    assert 10.0 < float(line_with(iter(out.split("\n")), "landed").split()[0]) < 40.0


@pytest.fixture
def running(tmp_path):
    """``running(*words)``: a client of ``sitl run``, and the process id of its px4."""
    with contextlib.ExitStack() as stack:

        def make(*words: object):
            words = "--out", "none", "--tcp", "0", "--instance", "3", "--log-dir", tmp_path, *words
            process = stack.enter_context(command("run", "copter", "--autopilot", PROGRAM, *words, cwd=tmp_path))
            port = line_with(process.stdout, "MAVLink on tcp:").rpartition(" ")[2]
            copter = Client(connect(port, Inbox(), 60.0, warn=lambda text: None), name="copter")
            stack.callback(copter.close)
            listed = subprocess.check_output(["ps", "--ppid", str(process.pid), "-o", "pid=,args="], text=True)
            pid = next(int(line.split()[0]) for line in listed.splitlines() if "bin/px4" in line)
            return copter, process, pid

        yield make


def test_wind_is_set_in_flight_and_an_unknown_parameter_is_named(running, tmp_path):
    (tmp_path / "my.params").write_text("MPC_XY_CRUISE 4\nMC_ROLRATE_P 0.2\nSIM_WIND_SPD 2\n")
    copter, process, _ = running("--params", tmp_path / "my.params")
    copter.wait_ready()
    copter.take_off(5.0)
    assert copter.params["SIM_WIND_SPD"] == 2.0 and copter.params["MPC_XY_CRUISE"] == 4.0
    copter.params["SIM_WIND_SPD"] = 8.0
    copter.delay(5.0)
    assert math.hypot(copter.attitude.roll, copter.attitude.pitch) > 0.06
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=30)
    assert "has no parameter MC_ROLRATE_P" in err and err.count("has no parameter") == 1
    assert next(iter(tmp_path.glob("px4-*.tlog"))).stat().st_size > 100_000


def test_a_program_that_is_stopped_and_continued_flies_on(running):
    copter, process, pid = running("--speedup", "5")
    copter.wait_ready()
    copter.take_off(5.0)
    os.kill(pid, signal.SIGSTOP)
    time.sleep(8.0)  # wall time, in which the physics says that time stands
    os.kill(pid, signal.SIGCONT)
    copter.delay(5.0)
    assert copter.armed and copter.altitude == pytest.approx(5.0, abs=1.0)
    process.send_signal(signal.SIGSTOP)
    time.sleep(3.0)
    process.send_signal(signal.SIGCONT)
    copter.delay(5.0)
    assert copter.armed and copter.altitude == pytest.approx(5.0, abs=1.0)
    os.kill(pid, signal.SIGKILL)
    _, err = process.communicate(timeout=30)
    assert process.returncode == 2 and "ended by signal 9; it said: " in err and "time stands at" in err


def test_a_program_that_is_killed_ends_a_test(fly):
    copter = fly("copter")
    copter.connection.process._signal(9)
    with pytest.raises(LinkLostError, match="ended by signal 9"):
        copter.delay(1.0)
