# SPDX-License-Identifier: BSD-3-Clause
"""The ``sitl`` command as a user types it, in processes of its own."""

from __future__ import annotations

import json
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from sitl import vehicles
from sitl.cli import demo, main
from sitl.cli.cache import all_entries
from sitl.core.fingerprint import reached
from sitl.core.kernels import UNITS
from sitl.logs import plot, tlog_flight
from sitl.simulation import Core
from sitl.vehicle.kinds import KINDS
from tests.cli.command import environment, sitl
from tests.platforms import on_linux
from tests.ports import free_port

RUN = ("run", "copter", "--out", "none", "--tcp", "0", "--speedup", "max")


def test_a_run_says_where_it_listens_and_writes_a_log(core: Core, tmp_path: Path) -> None:
    result = sitl(*RUN, "--duration", "60", folder=tmp_path)
    assert result.returncode == 0, result.stderr
    lines = result.stdout.splitlines()
    assert lines[0].startswith("MAVLink on tcp:127.0.0.1:") and not lines[0].endswith(":0")
    assert lines[1] == "log: logs/erle_copter-0.tlog"
    flown = tlog_flight.read(tmp_path / "logs" / "erle_copter-0.tlog")
    assert flown["ATTITUDE"][-1, 0] == pytest.approx(60.0, abs=0.2)
    assert any("is using GPS" in text for _, text in flown.texts)
    plot.draw(flown, tmp_path / "flight.png")
    assert (tmp_path / "flight.png").read_bytes().startswith(b"\x89PNG")


def test_an_out_that_listens_says_so(core: Core, tmp_path: Path) -> None:
    stream, datagram = free_port(), free_port()
    outs = ("--out", f"tcp:{stream}", "--out", f"udpin:{datagram}", "--out", "udp:127.0.0.1:9")
    result = sitl("run", "copter", "--tcp", "0", *outs, "--speedup", "max", "--duration", "1", folder=tmp_path)
    assert result.returncode == 0, result.stderr
    tcp, datagrams, sent, served, _ = result.stdout.splitlines()
    assert tcp.startswith("MAVLink on tcp:127.0.0.1:") and tcp.endswith("(listens: clients connect to it)")
    assert datagrams.endswith("(listens for datagrams)") and "(" not in sent + served


def test_two_runs_write_the_same_log_and_none_is_overwritten(core: Core, tmp_path: Path) -> None:
    for _ in range(2):
        assert sitl(*RUN, "--duration", "10", "--seed", "5", folder=tmp_path).returncode == 0
    first, second = (tmp_path / "logs" / f"erle_copter-0{n}.tlog" for n in ("", "-2"))
    assert first.read_bytes() == second.read_bytes()
    assert sitl(*RUN, "--duration", "10", "--seed", "6", folder=tmp_path).returncode == 0
    assert (tmp_path / "logs" / "erle_copter-0-3.tlog").read_bytes() != first.read_bytes()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signals_end_a_run_cleanly(core: Core, tmp_path: Path, number: int) -> None:
    command = [sys.executable, "-m", "sitl", *RUN[:-2], "--speedup", "5"]
    run = subprocess.Popen(
        command, cwd=tmp_path, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert run.stdout is not None
    port = int(run.stdout.readline().rsplit(":", 1)[1])
    with socket.create_connection(("127.0.0.1", port), timeout=60) as client:
        assert client.recv(1)[0] in (0xFD, 0xFE), "the first byte is a MAVLink frame's"
        run.send_signal(number)
        out, err = run.communicate(timeout=120)  # a client that left first, with bytes unread, would be told of
    assert (run.returncode, err) == (0, ""), out
    tlog_flight.read(tmp_path / "logs" / "erle_copter-0.tlog")


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("--frame", "nonsense"), "airframe 'nonsense' is not known; it is one of erle_copter, ardupilot_quad"),
        (("--speedup", "0"), "speed-up '0' is not a number from 0.001 to 100000"),
        (("--params", "absent.parm"), "parameter file 'absent.parm' cannot be read"),
        (("--out", "carrier:pigeon"), "'carrier' is not a kind of link; allowed: udp:HOST:PORT"),
        (("--home", "1,2"), "is not LAT,LON,ALT,HEADING"),
        (("--home", "95,0,0,0"), "latitude is within +-90"),
        (("--home", "0,0,45000,0"), "altitude is within -2000 to 11000 m"),
        (("--instance", "-1"), "is not a whole number from 0 to 254"),
        (("--duration", "-5"), "is not a positive number of simulated seconds"),
        (("--tcp", "99999"), "is not a port"),
        (("--estimator", "magic"), "'magic' is not known; it is one of ekf, truth"),
    ],
)
def test_a_bad_option_is_one_clear_line(core: Core, tmp_path: Path, arguments: tuple[str, ...], says: str) -> None:
    result = sitl("run", "copter", "--duration", "1", "--log-dir", str(tmp_path / "x"), *arguments, folder=tmp_path)
    assert result.returncode == 2
    assert says in result.stderr
    assert "Traceback" not in result.stderr
    assert not list(tmp_path.glob("x/*.tlog")), "nothing was begun"


def test_a_bad_parameter_file_names_the_line(core: Core, tmp_path: Path) -> None:
    (tmp_path / "bad.parm").write_text("WPNAV_SPEED 500\nRTL_ALT abc\n")
    result = sitl(*RUN, "--duration", "1", "--params", "bad.parm", folder=tmp_path)
    assert result.returncode == 2
    assert "bad.parm, line 2: 'abc' is not a number (RTL_ALT)" in result.stderr


def test_parameters_of_a_file_that_do_nothing_are_mentioned(core: Core, tmp_path: Path) -> None:
    (tmp_path / "other.parm").write_text("WPNAV_SPEED 500\nTERRAIN_CACHE_SZ 1\nEK9_ENABLE 1\n")
    result = sitl(*RUN, "--duration", "1", "--params", "other.parm", folder=tmp_path)
    assert result.returncode == 0
    assert "1 parameter of the files is not in this firmware: EK9_ENABLE" in result.stderr
    assert "1 parameter of the files has no effect here: TERRAIN_CACHE_SZ" in result.stderr


def test_a_taken_port_is_named(core: Core, tmp_path: Path) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        result = sitl("run", "copter", "--out", "none", "--tcp", str(port), "--duration", "1", folder=tmp_path)
    assert result.returncode == 2
    assert f"tcp:127.0.0.1:{port}" in result.stderr and "Traceback" not in result.stderr


def test_params_lists_every_parameter(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["params", "--frame", "erle_copter"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert "ANGLE_MAX,3000" in lines and len(lines) > 200


def test_exec_needs_a_command_that_exists(tmp_path: Path) -> None:
    assert "no command given" in sitl("exec", folder=tmp_path).stderr
    result = sitl("exec", "--", "no-such-program", folder=tmp_path)
    assert result.returncode == 2 and "'no-such-program' is not found" in result.stderr


def test_the_demo_says_what_it_lacks(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(demo.importlib.util, "find_spec", lambda name: None)
    assert main(["demo", "copter"]) == 2
    assert "needs mavsdk and matplotlib: pip install 'gym-sitl[demo]'" in capsys.readouterr().err
    assert main(["world", "show", "maze"]) == 2
    out, err = capsys.readouterr()
    assert "pip install 'gym-sitl[viz]'" in err and not out
    assert not list(tmp_path.iterdir()), "nothing was begun"


SLEEPER = """
import sys, time
start = time.monotonic()
time.sleep(40.0)
print(f"slept {time.monotonic() - start:.2f}")
sys.exit(7)
"""


@on_linux
@pytest.mark.slow
def test_exec_runs_a_script_on_the_vehicles_clock_and_returns_its_code(core: Core, tmp_path: Path) -> None:
    (tmp_path / "sleeper.py").write_text(SLEEPER)
    options = ("--out", "none", "--tcp", "0", "--speedup", "20")
    for _ in range(3):  # half a second is 25 ms of wall time, which a busy machine may take away
        result = sitl("exec", *options, "--", sys.executable, "sleeper.py", folder=tmp_path)
        assert result.returncode == 7, result.stderr
        slept = float(result.stdout.split("slept ")[1].split()[0])
        assert slept >= 39.99
        if slept < 40.5:
            break
    assert slept < 40.5
    flown = tlog_flight.read(tmp_path / "logs" / "erle_copter-0.tlog")
    assert flown["ATTITUDE"][-1, 0] > 39.0


@on_linux
@pytest.mark.parametrize("count", [(), ("--count", "2")])
def test_a_script_that_has_not_ended_within_the_duration_has_failed(
    core: Core, tmp_path: Path, count: tuple[str, ...]
) -> None:
    options = ("--out", "none", "--tcp", "0", "--speedup", "max", "--duration", "3", *count)
    result = sitl("exec", *options, "--", sys.executable, "-c", "import time; time.sleep(1e6)", folder=tmp_path)
    assert result.returncode == 124
    assert f"{sys.executable} has not ended within --duration 3 s" in result.stderr


@pytest.mark.slow
def test_the_demo_flies_its_mission_and_draws_it(core: Core, tmp_path: Path) -> None:
    pytest.importorskip("mavsdk")
    result = sitl("demo", "copter", folder=tmp_path)
    assert result.returncode == 0, result.stderr
    assert "landed and disarmed" in result.stdout
    for seq in range(1, 7):
        assert f"mission item {seq} reached" in result.stdout
    assert (tmp_path / "logs" / "demo-copter.png").read_bytes().startswith(b"\x89PNG")
    flown = tlog_flight.read(tmp_path / "logs" / "demo-copter.tlog")
    position = flown["LOCAL_POSITION_NED"]
    assert -position[:, 3].min() == pytest.approx(10.0, abs=0.5)
    assert position[:, 1].max() == pytest.approx(30.0, abs=1.5)
    assert abs(position[-1, 1]) < 1.0 and abs(position[-1, 2]) < 1.0


LEAVER = """
import subprocess, sys, time
child = subprocess.Popen(["sleep", "1000"])
print("child", child.pid, flush=True)
time.sleep(float(sys.argv[1]))
"""


@on_linux
@pytest.mark.slow
@pytest.mark.parametrize(("sleeps", "code"), [("5", 0), ("1000", 124)])
def test_exec_leaves_no_process_behind(core: Core, tmp_path: Path, sleeps: str, code: int) -> None:
    (tmp_path / "leaver.py").write_text(LEAVER)
    options = ("--out", "none", "--tcp", "0", "--duration", "20")
    result = sitl("exec", *options, "--", sys.executable, "leaver.py", sleeps, folder=tmp_path)
    assert result.returncode == code, result.stderr
    child = int(result.stdout.split("child ")[1].split()[0])
    deadline = time.monotonic() + 10.0
    while Path(f"/proc/{child}").exists() and "Z" not in Path(f"/proc/{child}/stat").read_text().split()[2]:
        assert time.monotonic() < deadline, "the script's child still runs"


RUN_ROVER = ("run", "rover", "--out", "none", "--tcp", "0", "--speedup", "max")


def test_a_run_of_a_rover_writes_a_log_that_can_be_drawn(core: Core, tmp_path: Path) -> None:
    (tmp_path / "mine.parm").write_text("WP_SPEED 0.8\nWPNAV_SPEED 500\n")
    options = ("--duration", "50", "--params", "mine.parm", "--home", "43.1,-2.5,100,90", "--instance", "3")
    result = sitl(*RUN_ROVER, *options, folder=tmp_path)
    assert result.returncode == 0, result.stderr
    assert "not in this firmware: WPNAV_SPEED" in result.stderr
    assert result.stdout.splitlines()[1] == "log: logs/erle_rover-3.tlog"
    driven = tlog_flight.read(tmp_path / "logs" / "erle_rover-3.tlog", 4)
    assert any("is using GPS" in text for _, text in driven.texts)
    assert np.degrees(driven["ATTITUDE"][-1, 3]) == pytest.approx(90.0, abs=10.0)
    plot.draw(driven, tmp_path / "drive.png", kind="rover")
    assert (tmp_path / "drive.png").read_bytes().startswith(b"\x89PNG")


def test_two_runs_of_a_rover_write_the_same_log(core: Core, tmp_path: Path) -> None:
    for _ in range(2):
        assert sitl(*RUN_ROVER, "--frame", "skid_rover", "--duration", "5", folder=tmp_path).returncode == 0
    first, second = (tmp_path / "logs" / f"skid_rover-0{n}.tlog" for n in ("", "-2"))
    assert first.read_bytes() == second.read_bytes()


@pytest.mark.parametrize(
    "arguments",
    [
        ("run", "rover", "--frame", "erle_copter"),
        ("demo", "rover", "--frame", "erle_copter"),
        pytest.param(("exec", "--vehicle", "rover", "--frame", "erle_copter", "--", sys.executable), marks=on_linux),
        ("params", "--vehicle", "rover", "--frame", "erle_copter"),
    ],
)
def test_a_frame_of_another_kind_is_refused(
    arguments: tuple[str, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("mavsdk")  # the demo asks for it first
    monkeypatch.chdir(tmp_path)
    more = ("--log-dir", "x", "--out", "none", "--tcp", "0") if arguments[0] == "run" else ()
    assert main([*arguments, *more]) == 2
    said = capsys.readouterr()
    of_rovers = ", ".join(vehicles.names("rover"))
    assert f"--frame erle_copter is a copter; those of a rover are {of_rovers}" in said.err
    assert not list(tmp_path.glob("**/*.tlog"))
    if arguments[0] == "run":
        assert main(["run", "copter", "--frame", "skid_rover", *more]) == 2
        assert "--frame skid_rover is a rover; those of a copter are erle_copter" in capsys.readouterr().err


def test_params_of_the_rover(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["params", "--vehicle", "rover"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert {"CRUISE_THROTTLE,50", "SERVO1_FUNCTION,26"} <= set(lines) and len(lines) > 150
    assert not any(line.startswith("ANGLE_MAX") for line in lines)
    assert main(["params", "--frame", "skid_rover"]) == 0
    assert "SERVO1_FUNCTION,73" in capsys.readouterr().out.splitlines()
    assert main(["params", "--vehicle", "rover", "--markdown"]) == 0
    page = capsys.readouterr().out
    assert page.startswith("# Parameters of the rover") and "## ATC" in page


def test_parameters_are_looked_for_by_words(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["params", "wpnav", "Climb"]) == 0
    assert capsys.readouterr().out == "WPNAV_SPEED_UP = 250 cm/s (10 .. 5000)\n    Climb speed limit in missions\n"
    assert main(["params", "--frame", "erle_copter", "MOT_THST_EXPO"]) == 0
    assert "(-1 .. 1, default 0.65)" in capsys.readouterr().out
    assert main(["params", "--json", "WPNAV_SPEED"]) == 0
    assert [one["name"] for one in json.loads(capsys.readouterr().out)] == [
        "RTL_SPEED", "LAND_SPEED_HIGH", "WPNAV_SPEED", "WPNAV_SPEED_UP", "WPNAV_SPEED_DN",
    ]  # fmt: skip
    assert main(["params", "WPNAV_SPED"]) == 2
    assert "no parameter of the copter has 'WPNAV_SPED'; did you mean 'WPNAV_SPEED'?" in capsys.readouterr().err
    assert main(["params", "wpnav", "parachute"]) == 2
    assert "no parameter of the copter has 'wpnav' and 'parachute'" in capsys.readouterr().err
    assert main(["params", "--markdown", "wpnav"]) == 2


@pytest.mark.slow
def test_the_demo_drives_its_mission_and_draws_it(core: Core, tmp_path: Path) -> None:
    pytest.importorskip("mavsdk")
    result = sitl("demo", "rover", folder=tmp_path)
    assert result.returncode == 0, result.stderr
    assert "square driven" in result.stdout and "disarmed" in result.stdout
    for seq in range(1, 5):
        assert f"mission item {seq} reached" in result.stdout
    assert (tmp_path / "logs" / "demo-rover.png").read_bytes().startswith(b"\x89PNG")
    position = tlog_flight.read(tmp_path / "logs" / "demo-rover.tlog")["LOCAL_POSITION_NED"]
    assert position[:, 1].max() == pytest.approx(20.0, abs=2.5)
    assert position[:, 2].max() == pytest.approx(20.0, abs=2.5)
    assert np.hypot(position[-1, 1], position[-1, 2]) < 3.5
    assert np.hypot(position[:, 4], position[:, 5]).max() < 2.0


def test_cache_lists_all_that_a_run_compiles(
    no_library: None, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SITL_CACHE_DIR", str(tmp_path))
    assert main(["cache", "show"]) == 0
    _, _, compiler, *lines = capsys.readouterr().out.splitlines()
    assert compiler.endswith("all that speeds up compiling is on")
    assert all(line.startswith("  to build  ") for line in lines)
    units = [line.removeprefix("  to build  ") for line in lines]
    assert len(set(units)) == len(units)
    for kind, unit in (
        (kind, unit) for kind in ("copter", "rover") for unit in ("advance", "receive", "transmit", "run")
    ):
        package = "vehicle" if unit == "advance" else "bridge"
        assert any(line.startswith(f"{kind}: {package}.{kind}.") and line.endswith(f".{unit}") for line in units)


def test_build_leaves_no_unit_of_a_vehicle_to_be_compiled_later() -> None:
    for kind in KINDS.values():
        built = {unit.name for entry in all_entries(kind) for unit in reached(entry)}
        own = {name for name in UNITS if f".{kind.name}." in name}
        assert own and own <= built, own - built


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="Linux")
def test_output_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    with open("/dev/full", "w") as full:
        words = [sys.executable, "-m", "sitl", "params", "WPNAV_SPEED"]
        done = subprocess.run(words, stdout=full, stderr=subprocess.PIPE, text=True, cwd=tmp_path, env=environment())
    assert done.returncode == 2
    assert done.stderr == "sitl params: its output cannot be written: No space left on device\n"
