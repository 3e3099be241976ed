# SPDX-License-Identifier: BSD-3-Clause
"""How programs are chosen and started: what autopilot= means, command lines, parameters, and how they end."""

from __future__ import annotations

import math
import os
import signal
import socket
import subprocess
import sys
from pathlib import Path

import pytest

from sitl import vehicles
from sitl.errors import OptionError
from sitl.foreign import ardupilot, px4, px4_airframe
from sitl.foreign.choice import Choice, choose
from sitl.foreign.process import HOST, AutopilotEndedError, AutopilotProcess, free_tcp_run
from sitl.vehicles.receivers import equipped


def test_ardupilots_command_line():
    words = ardupilot.command(Path("/x/arducopter"), (-35.3632621, 149.1652371, 584.0, 353.0), 9012, 5770, 1, 10, ["a"])
    assert words[:4] == ["/x/arducopter", "--base-port", "5770", "--instance"]  # the instance must come after the port
    pairs = dict(zip(words[1::2], words[2::2]))
    assert pairs["--model"] == "JSON:127.0.0.1" and pairs["--sim-port-out"] == "9012" and pairs["--speedup"] == "10"
    assert pairs["--home"] == "-35.3632621,149.165237,584,353" and pairs["--defaults"] == "a"
    assert words[-1] == "--wipe"


def test_an_ardupilot_keeps_no_log_unless_it_is_told_to():
    assert ardupilot.unlogged({"WPNAV_SPEED": 300.0}) == {"LOG_BACKEND_TYPE": 0.0, "WPNAV_SPEED": 300.0}
    assert ardupilot.unlogged({"LOG_BACKEND_TYPE": 1.0}) == {"LOG_BACKEND_TYPE": 1.0}


def test_ardupilots_gps_begins_at_the_same_date_each_time():
    words = ardupilot.command(Path("/x/arducopter"), (-35.0, 149.0, 584.0, 353.0), 9012, 5770, 1, 10, ["a"])
    assert words[words.index("--start-time") + 1] == "1767225600"


def test_ardupilots_parameters_are_the_airframes():
    text = ardupilot.defaults(vehicles.load("erle_copter"), sees_ground=True)
    values = dict(line.split(" ") for line in text.splitlines())
    assert values["FRAME_CLASS"] == "1" and values["FRAME_TYPE"] == "1" and values["MOT_SPIN_MAX"] == "0.838"
    assert values["SIM_RATE_HZ"] == "800" and values["SIM_BATT_VOLTAGE"] == "12.6"
    assert values["RNGFND1_TYPE"] == "100" and values["RNGFND1_MAX_CM"] == "5000"
    rover = ardupilot.defaults(vehicles.load("erle_rover"), sees_ground=False)
    assert "RNGFND1_TYPE" not in rover and "SIM_RATE_HZ 400\n" in rover and "SIM_BATT_VOLTAGE 50.4\n" in rover


def test_px4s_parameters_are_the_airframes():
    model, values = px4.model_of(vehicles.load("erle_copter"))
    assert values["CA_ROTOR_COUNT"] == 4
    for k, (x, y, turn) in enumerate([(1, 1, 1), (-1, -1, 1), (1, -1, -1), (-1, 1, -1)]):
        assert values[f"CA_ROTOR{k}_PX"] == x * 0.141 and values[f"CA_ROTOR{k}_PY"] == y * 0.141
        assert values[f"CA_ROTOR{k}_KM"] == turn * 0.016
        assert values[f"PWM_MAIN_FUNC{k + 1}"] == 101 + k
    assert model == "none_iris" and values["MPC_THR_HOVER"] == pytest.approx(1.14 * 9.80665 / 24.013, rel=1e-3)
    assert values["THR_MDL_FAC"] == 1.0  # over the range of its speed thrust goes with the square


@pytest.mark.parametrize("sensors, delay, noise", [("gps", 120, 0.412), ("rtk", 120, 0.1), ("mocap", 50, 0.1)])
def test_px4s_filter_is_told_of_the_receiver(sensors, delay, noise):
    found = px4_airframe.receiver(equipped(vehicles.load("erle_copter"), sensors))
    assert found["SENS_GPS0_DELAY"] == delay
    assert found.get("EKF2_RNG_CTRL") == (None if sensors == "gps" else 0.0), "PX4's default, where heights are poor"
    assert found["EKF2_GPS_P_NOISE"] == pytest.approx(noise, abs=1e-3)


@pytest.mark.parametrize("frame", ["erle_copter", "ardupilot_quad", "ardupilot_hexa", "ardupilot_octa_quad"])
def test_px4s_gains_cross_over_where_they_shall(frame):
    """A command of 1 in roll, as PX4's allocator gives it to the rotors, turns the airframe by its crossover / P."""
    airframe = vehicles.load(frame)
    values, rotor = px4_airframe.parameters(airframe), px4_airframe.thrust(airframe)
    ys = [hub.y for hub in airframe.rotors]
    used = sum(abs(y) > 1e-3 for y in ys)
    mix = [y / math.sqrt(sum(y * y for y in ys)) * math.sqrt(used / 2) for y in ys]
    assert math.sqrt(sum(m * m for m in mix) / used) == pytest.approx(math.sqrt(0.5))
    torque = sum(rotor.most * m * y for m, y in zip(mix, ys))
    acceleration = torque / airframe.value("inertia")[0]
    assert values["MC_ROLLRATE_P"] * acceleration == pytest.approx(px4_airframe.RATE_CROSSOVER)
    yaw = len(ys) * rotor.most * values["CA_ROTOR0_KM"] * airframe.rotors[0].direction / airframe.value("inertia")[2]
    assert values["MC_YAWRATE_P"] * yaw == pytest.approx(px4_airframe.YAW_CROSSOVER)


def test_px4s_rovers_have_the_steering_of_the_airframe():
    model, car = px4.model_of(vehicles.load("erle_rover"))
    assert model == "gz_rover_ackermann" and car["RA_WHEEL_BASE"] == 1.95222 and car["RA_MAX_STR_ANG"] == 0.7727
    assert (car["PWM_MAIN_FUNC1"], car["PWM_MAIN_FUNC3"], car["CA_R_REV"]) == (201, 101, 1)
    assert car["RO_SPEED_LIM"] == 1.2 and car["NAV_ACC_RAD"] == 2.0
    model, tracks = px4.model_of(vehicles.load("skid_rover"))
    assert model == "gz_rover_differential" and tracks["RD_WHEEL_TRACK"] == pytest.approx(0.376 * 1.5)
    assert (tracks["PWM_MAIN_FUNC1"], tracks["PWM_MAIN_FUNC3"]) == (102, 101)  # left, right
    circle = px4.model_of(vehicles.load("ardupilot_rover"))[1]
    radius = circle["RA_WHEEL_BASE"] / math.tan(circle["RA_MAX_STR_ANG"])
    assert radius == pytest.approx(0.5 * vehicles.load("ardupilot_rover").value("turning_diameter"))


def test_free_ports_are_a_run():
    first = free_tcp_run(8)
    assert first > 0 and HOST == "127.0.0.1"


def python(*lines: str) -> list[str]:
    return [sys.executable, "-c", "\n".join(lines)]


def test_a_program_runs_in_a_folder_of_its_own_that_goes_with_it():
    process = AutopilotProcess(
        [*python("import sys, time", "print(open(sys.argv[1]).read())", "time.sleep(60)"), "{folder}/a.txt"],
        {"a.txt": "hello"}, {},
    )  # fmt: skip
    folder = process.folder
    process.check()
    assert process.is_running() and (folder / "a.txt").exists()
    process.stop()
    assert not process.is_running() and not folder.exists()
    process.stop()


def test_a_folder_that_was_named_stays(tmp_path):
    process = AutopilotProcess(python("print('said')"), {}, {}, tmp_path / "kept")
    process._process.wait()
    process.stop()
    assert process.last_output() == "said"


def test_a_folder_may_be_named_from_here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    process = AutopilotProcess(
        [*python("import sys", "print(open(sys.argv[1]).read())"), "{folder}/a.txt"], {"a.txt": "read"}, {}, Path("its")
    )
    process._process.wait()
    process.stop()
    assert process.last_output() == "read"


def test_a_program_that_ends_is_told_of_with_its_last_words():
    process = AutopilotProcess(python("print('no eeprom')", "raise SystemExit(3)"), {}, {})
    process._process.wait()
    with pytest.raises(AutopilotEndedError, match=r"code 3; it said: no eeprom"):
        process.check()
    process.stop()


@pytest.mark.parametrize("grace_s", [0.2, 0.0])
def test_a_program_that_does_not_heed_and_its_children_are_ended(grace_s):
    child = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); print(1, flush=True); time.sleep(60)"
    process = AutopilotProcess(
        python(
            "import signal, subprocess, sys, time",
            "signal.signal(signal.SIGTERM, signal.SIG_IGN)",
            f"child = subprocess.Popen([sys.executable, '-c', {child!r}])",
            "print(child.pid, flush=True)",
            "time.sleep(60)",
        ),
        {},
        {},
        grace_s=grace_s,
    )
    while len(process.last_output().split(" / ")) < 2:
        process.check()
    number = max(int(word) for word in process.last_output().split(" / "))
    process.stop()
    with pytest.raises(ProcessLookupError):
        while True:  # until its new parent has buried it
            os.kill(number, 0)
            if (stat := Path(f"/proc/{number}/stat")).exists() and stat.read_text().split(")")[1].split()[0] == "Z":
                raise ProcessLookupError
    assert process._process.returncode == -signal.SIGKILL


def test_a_program_does_not_outlive_who_started_it():
    with socket.create_server((HOST, 0)) as server:
        port = server.getsockname()[1]
        program = python("import socket, time", f"s = socket.create_connection(('{HOST}', {port}))", "time.sleep(60)")
        starter = python(
            "import os, time",
            "from sitl.foreign.process import AutopilotProcess",
            f"process = AutopilotProcess({program!r}, {{}}, {{}})",
            "time.sleep(60)",
        )
        running = subprocess.Popen(starter, env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])})
        server.settimeout(30.0)
        link, _ = server.accept()
        running.kill()  # as kill -9 does
        running.wait()
        link.settimeout(30.0)
        assert link.recv(1) == b""
        link.close()


def test_what_cannot_be_started_is_named():
    with pytest.raises(OptionError, match="/nowhere"):
        AutopilotProcess(["/nowhere"], {}, {})


@pytest.fixture
def program(tmp_path):
    path = tmp_path / "arducopter"
    path.write_text("#!/bin/sh\n")
    path.chmod(0o755)
    return path


def test_native_is_no_foreign_autopilot():
    assert choose("native", "copter") is None


def test_a_program_by_its_path(program):
    assert choose(f"ardupilot:{program}", "copter") == Choice("ardupilot", program)
    assert choose("ardupilot", "copter", program) == Choice("ardupilot", program)


def test_a_program_by_its_usual_name(program, monkeypatch):
    monkeypatch.setenv("PATH", str(program.parent))
    assert choose("ardupilot", "copter") == Choice("ardupilot", program)
    with pytest.raises(OptionError, match="ardurover"):
        choose("ardupilot", "rover")


def test_one_that_runs_already_by_its_connection():
    assert choose("ardupilot:tcp:10.0.0.1:5760", "rover") == Choice("ardupilot", None, "tcp:10.0.0.1:5760")
    assert choose("px4:udp:127.0.0.1:14540", "copter").connection == "udp:127.0.0.1:14540"


@pytest.mark.parametrize("text", ["", "paparazzi", "native:/bin/true", "Ardupilot:", None, 7])
def test_other_texts_are_refused_with_the_forms(text):
    with pytest.raises(OptionError, match='"ardupilot:PROGRAM"'):
        choose(text, "copter")


def test_a_program_that_is_not_there_or_cannot_be_run_is_named(program):
    with pytest.raises(OptionError, match="nowhere' is not there"):
        choose("px4:/nowhere", "copter")
    program.chmod(0o644)
    with pytest.raises(OptionError, match="may be run"):
        choose(f"ardupilot:{program}", "copter")


def test_our_own_autopilot_takes_no_program(program):
    with pytest.raises(OptionError, match="native"):
        choose("native", "copter", program)
