# SPDX-License-Identifier: BSD-3-Clause
"""Logs are flown: the same commands, the same mission; and what goes otherwise is said."""

from __future__ import annotations

import argparse
import re
import shlex
from pathlib import Path

import numpy as np
import pytest

from sitl.logs import flight
from sitl.missions.cli import replay
from sitl.recording.recording import read
from sitl.simulation import Core
from tests.missions.tlog_replay.logged_flights import fly_mission, frame, rows, system_of, write


def typed(text: str) -> int:
    """Exit code of ``replay ...``."""
    parser = argparse.ArgumentParser()
    replay.add_parser(parser.add_subparsers())
    options = parser.parse_args(shlex.split(text))
    return int(options.function(options))


def test_the_mission_is_flown_again(flight_log: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert typed(f"replay {flight_log} --log-dir {tmp_path} --seed 9") == 0
    assert "otherwise" not in capsys.readouterr().out
    then, now = flight.read(flight_log), flight.read(tmp_path / "flight-replay.tlog")
    assert [seq for _, seq in now.reached] == [seq for _, seq in then.reached] != []
    paths = []
    for flown in (then, now):
        armed = next(t for t, state in flown.armed if state)
        position = flown["LOCAL_POSITION_NED"]
        paths.append([np.interp(np.arange(0.0, 40.0), position[:, 0] - armed, position[:, k]) for k in (1, 2, 3)])
    assert np.max(np.abs(np.array(paths[0]) - np.array(paths[1]))) < 2.0


def test_twice_the_same(flight_log: Path, tmp_path: Path) -> None:
    assert typed(f"replay {flight_log} --rec {tmp_path}/a.rec") == 0
    assert typed(f"replay {flight_log} --rec {tmp_path}/b.rec --speedup 100000") == 0
    first, second = read(tmp_path / "a.rec"), read(tmp_path / "b.rec")
    assert first.entries == second.entries and first.end == second.end
    assert typed(f"replay {tmp_path}/a.rec --exact") == 0


def test_another_system_id(core: Core, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = fly_mission(tmp_path, core, system=42)
    assert typed(f"replay {log}") == 0
    assert "vehicle 42 is a copter" in capsys.readouterr().out


def test_a_log_of_the_vehicle_alone(flight_log: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """It is armed and AUTO as the vehicle was; its mission is not in the log, and that is said."""
    alone = write(tmp_path / "alone.tlog", [(t, raw) for t, raw in rows(flight_log) if system_of(raw) == 1])
    typed(f"replay {alone}")
    assert "note: the log has no commands" in capsys.readouterr().out


def test_what_is_refused_now_is_said(flight_log: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    made = rows(flight_log)
    command = frame("COMMAND_LONG", 255, 190, target_system=1, target_component=1, command=2520)
    wrong = frame("PARAM_SET", 255, 190, target_system=1, target_component=1, param_id=b"NO_SUCH", param_value=1.0)
    made += [(50.0, command), (50.1, frame("COMMAND_ACK", command=2520, result=0)), (50.2, wrong)]
    log = write(tmp_path / "more.tlog", sorted(made, key=lambda row: row[0]))
    assert typed(f"replay {log}") == 1
    said = capsys.readouterr().out
    assert re.search(r"otherwise than in the log: 50\.\d s: command 2520 was ACCEPTED then, is UNSUPPORTED now\n", said)
    assert re.search(r"note: 50\.\d s: there is no parameter NO_SUCH\n", said)


def test_answers_are_heard_when_they_come(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Also when nobody says anything for a long time after a command."""
    beat = frame("HEARTBEAT", type=10, autopilot=3, custom_mode=4)
    changed = frame("HEARTBEAT", type=10, autopilot=3, custom_mode=0)
    log = write(tmp_path / "quiet.tlog", [(t, beat if t < 4 else changed) for t in range(20)])
    assert typed(f"replay {log}") == 0
    assert "otherwise" not in capsys.readouterr().out
