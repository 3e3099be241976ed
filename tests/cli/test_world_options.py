# SPDX-License-Identifier: BSD-3-Clause
"""``--world`` and ``--start``."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl.cli import main
from sitl.simulation import Core
from tests.cli.command import sitl

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
