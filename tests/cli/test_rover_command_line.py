# SPDX-License-Identifier: BSD-3-Clause
"""The ``sitl`` command with a rover."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from sitl import vehicles
from sitl.cli import main
from sitl.logs import flight, plot
from sitl.simulation import Core
from tests.cli.command import sitl

RUN = ("run", "rover", "--out", "none", "--tcp", "0", "--speedup", "max")


def test_a_run_of_a_rover_writes_a_log_that_can_be_drawn(core: Core, tmp_path: Path) -> None:
    (tmp_path / "mine.parm").write_text("WP_SPEED 0.8\nWPNAV_SPEED 500\n")
    options = ("--duration", "50", "--params", "mine.parm", "--home", "43.1,-2.5,100,90", "--instance", "3")
    result = sitl(*RUN, *options, folder=tmp_path)
    assert result.returncode == 0, result.stderr
    assert "not in this firmware: WPNAV_SPEED" in result.stderr
    assert result.stdout.splitlines()[1] == "log: logs/erle_rover-3.tlog"
    driven = flight.read(tmp_path / "logs" / "erle_rover-3.tlog", 4)
    assert any("is using GPS" in text for _, text in driven.texts)
    assert np.degrees(driven["ATTITUDE"][-1, 3]) == pytest.approx(90.0, abs=10.0)
    plot.draw(driven, tmp_path / "drive.png", kind="rover")
    assert (tmp_path / "drive.png").read_bytes().startswith(b"\x89PNG")


def test_two_runs_of_a_rover_write_the_same_log(core: Core, tmp_path: Path) -> None:
    for _ in range(2):
        assert sitl(*RUN, "--frame", "skid_rover", "--duration", "5", folder=tmp_path).returncode == 0
    first, second = (tmp_path / "logs" / f"skid_rover-0{n}.tlog" for n in ("", "-2"))
    assert first.read_bytes() == second.read_bytes()


@pytest.mark.parametrize(
    "arguments",
    [
        ("run", "rover", "--frame", "erle_copter"),
        ("demo", "rover", "--frame", "erle_copter"),
        ("exec", "--vehicle", "rover", "--frame", "erle_copter", "--", sys.executable),
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


@pytest.mark.slow
def test_the_demo_drives_its_mission_and_draws_it(core: Core, tmp_path: Path) -> None:
    pytest.importorskip("mavsdk")
    result = sitl("demo", "rover", folder=tmp_path)
    assert result.returncode == 0, result.stderr
    assert "square driven" in result.stdout and "disarmed" in result.stdout
    for seq in range(1, 5):
        assert f"mission item {seq} reached" in result.stdout
    assert (tmp_path / "logs" / "demo-rover.png").read_bytes().startswith(b"\x89PNG")
    position = flight.read(tmp_path / "logs" / "demo-rover.tlog")["LOCAL_POSITION_NED"]
    assert position[:, 1].max() == pytest.approx(20.0, abs=2.5)
    assert position[:, 2].max() == pytest.approx(20.0, abs=2.5)
    assert np.hypot(position[-1, 1], position[-1, 2]) < 3.5
    assert np.hypot(position[:, 4], position[:, 5]).max() < 2.0
