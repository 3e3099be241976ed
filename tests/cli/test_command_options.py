# SPDX-License-Identifier: BSD-3-Clause
"""``sitl physics``, ``--physics``, ``--world`` and ``--start``: what they take and what they say."""

from __future__ import annotations

import socket
from pathlib import Path

import pytest

from sitl.cli import main, parser
from sitl.simulation import Core
from tests.cli.command import sitl


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("physics", "copter", "--listen", "udp:4560"), "'udp' is not known"),
        (("physics", "copter", "--listen", "tcp:here"), "'here' is not a port"),
        (("physics", "copter", "--listen", "tcp:70000"), "'70000' is not a port"),
        (("physics", "copter", "--frame", "erle_rover"), "erle_rover is a rover"),
        (("physics", "rover", "--world", "nowhere"), "nowhere"),
        (("run", "copter", "--physics", "hil:tcp:127.0.0.1:4560", "--world", "maze"), "other end"),
        (("run", "copter", "--physics", "hil:tcp:127.0.0.1:4560", "--seed", "3"), "other end"),
        (("run", "copter", "--physics", "hil:tcp:127.0.0.1:4560", "--estimator", "truth"), "other end"),
        (("run", "copter", "--physics", "hil:4560"), "hil:tcp:HOST:PORT"),
        (("run", "copter", "--physics", "gazebo"), "'gazebo' is not known"),
        (("run", "copter", "--link-loss", "2"), "link fault loss 2.0 is not a share from 0 to 1"),
        (("run", "copter", "--link-delay", "0.2-0.4"), "--link-delay '0.2-0.4' is not SECONDS|LOW..HIGH"),
        (("run", "copter", "--link-cut", "5"), "--link-cut '5' is not BEGIN..END"),
        (("run", "copter", "--autopilot", "ardupilot:tcp:127.0.0.1:1", "--link-loss", "0.2"), "only those of our"),
    ],
)
def test_mistakes_are_one_line(words: tuple[str, ...], said: str, tmp_path: Path, capsys, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    if words[0] == "run":
        words = (*words, "--out", "none", "--tcp", "0")
    assert main(words) == 2
    err = capsys.readouterr().err
    assert said in err and len(err.splitlines()) == 1


def test_a_port_that_is_taken(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        done = sitl("physics", "copter", "--listen", f"tcp:127.0.0.1:{taken.getsockname()[1]}", folder=tmp_path)
    assert done.returncode == 2 and "cannot be opened" in done.stderr


def test_what_is_there_by_default() -> None:
    options = parser().parse_args(["physics", "rover"])
    assert (options.physics, options.listen, options.seed, options.instance) == ("native", "tcp", 0, 0)


RUN = ("--out", "none", "--tcp", "0", "--speedup", "max", "--duration", "3")


@pytest.mark.parametrize("start", [(), ("--start", "floor"), ("--start=-1,0.5,0,90",)])
def test_a_run_in_a_world(core: Core, tmp_path: Path, start: tuple[str, ...]) -> None:
    result = sitl("run", "copter", "--world", "office_erlecopter", *start, *RUN, folder=tmp_path)
    assert result.returncode == 0, result.stderr
    assert (tmp_path / "logs").exists()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--world", "nowhere"), "world 'nowhere' is not known"),
        (("--start", "floor"), "start 'floor' needs a world"),
        (("--world", "office_erlecopter", "--start", "roof"), "has no start 'roof'; it has original, floor"),
        (("--world", "office_erlecopter", "--start", "0,0,3,0"), "a vehicle stands on the floor at power-on"),
        (("--world", "missing.toml"), "missing.toml"),
    ],
)
def test_what_cannot_be_is_said(
    options: tuple[str, ...], said: str, capsys: pytest.CaptureFixture[str], tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert main(["run", "copter", *options, *RUN]) == 2
    assert said in capsys.readouterr().err


def test_a_start_that_is_no_pose(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["run", "copter", "--world", "maze", "--start", "1,2,x", *RUN])
    assert "neither the name of a start pose nor X,Y,Z,YAW" in capsys.readouterr().err


def test_a_run_over_a_bad_link(core: Core, tmp_path: Path) -> None:
    faults = ("--link-loss", "0.2", "--link-delay", "0.2..0.4", "--link-cut", "1..2", "--link-cut=2.5..2.6")
    result = sitl("run", "rover", *faults, *RUN, folder=tmp_path)
    assert result.returncode == 0, result.stderr
