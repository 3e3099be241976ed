# SPDX-License-Identifier: BSD-3-Clause
"""What is found in a log, and how it is flown again: the same commands, the same mission."""

from __future__ import annotations

import argparse
import re
import shlex
from pathlib import Path

import numpy as np
import pytest

from sitl.logs import tlog_flight
from sitl.logs.tlog import LogError
from sitl.missions.cli import replay
from sitl.missions.tlog_replay.extract import extract
from sitl.missions.tlog_replay.log import Log
from sitl.missions.tlog_replay.steps import Send, Upload
from sitl.recording.recording import read
from sitl.simulation import Core
from tests.missions.tlog_replay.conftest import HOME, ITEMS, fly_mission, frame, rows, system_of, write

BEAT = {"type": 2, "autopilot": 3, "mavlink_version": 3}


def test_a_mission_flight(flight_log: Path) -> None:
    log = Log(flight_log)
    assert (log.system, log.kind) == (1, "copter")
    script = extract(log)
    assert script.home == pytest.approx(HOME, abs=1.5)
    (uploaded,) = [step for step in script.steps if isinstance(step, Upload)]
    assert [(i.frame, i.command, i.x, i.y, i.z) for i in uploaded.items] == ITEMS
    commands = [step.command for step in script.steps if isinstance(step, Send) and step.command]
    assert commands == [176, 400, 176, 300]  # what only asks for messages is left out
    assert next(step.title for step in script.steps if isinstance(step, Send)) == "parameter WPNAV_SPEED = 300"
    assert [step.time for step in script.steps] == sorted(step.time for step in script.steps)


def test_a_log_of_the_vehicle_alone(flight_log: Path, tmp_path: Path) -> None:
    alone = [(t, raw) for t, raw in rows(flight_log) if system_of(raw) == 1]
    script = extract(Log(write(tmp_path / "alone.tlog", alone)))
    assert script.notes[0].startswith("the log has no commands")
    commands = [(s.command, s.fields["param2"] if s.command == 176 else 1) for s in script.steps if isinstance(s, Send)]
    assert (176, 3.0) in commands and (400, 1) in commands


def test_an_upload_in_old_items_with_a_repeat(tmp_path: Path) -> None:
    gcs = {"system": 255, "component": 190}
    made = [
        (0.0, frame("HEARTBEAT", system=7, **BEAT)),
        (1.0, frame("MISSION_COUNT", **gcs, target_system=7, count=2)),
        (1.1, frame("MISSION_ITEM", **gcs, target_system=7, seq=0, frame=0, command=16, x=47.5, y=8.25, z=400)),
        (1.2, frame("MISSION_ITEM", **gcs, target_system=7, seq=0, frame=0, command=16, x=47.5, y=8.25, z=400)),
        (1.3, frame("MISSION_ITEM", **gcs, target_system=7, seq=1, frame=3, command=22, z=10)),
        (1.4, frame("MISSION_ACK", system=7, target_system=255)),
        (2.0, frame("MISSION_COUNT", **gcs, target_system=7, count=5)),
        (3.0, frame("MISSION_COUNT", **gcs, target_system=9, count=2)),
        (4.0, frame("COMMAND_LONG", **gcs, target_system=9, command=400, param1=1)),
    ]
    script = extract(Log(write(tmp_path / "old.tlog", made)))
    (uploaded,) = [step for step in script.steps if isinstance(step, Upload)]
    assert [(i.command, i.x, i.y) for i in uploaded.items] == [(16, 475000000, 82500000), (22, 0, 0)]
    assert uploaded.result == 0
    assert "left out: a mission upload that is not whole in the log (1 messages)" in script.notes
    assert "the log has no position of the vehicle: it starts at the default home" in script.notes


def test_what_is_no_log_of_a_vehicle(tmp_path: Path) -> None:
    path = tmp_path / "x.tlog"
    path.write_bytes(b"no log at all, but text that is long enough")
    with pytest.raises(LogError, match="holds no MAVLink frame"):
        Log(path)
    with pytest.raises(LogError, match="cannot be read: No such file"):
        Log(tmp_path / "absent.tlog")
    write(path, [(0.0, frame("HEARTBEAT", system=255, component=190, type=6, autopilot=8))])
    with pytest.raises(LogError, match="no HEARTBEAT of an autopilot"):
        Log(path)
    write(path, [(0.0, frame("HEARTBEAT", system=3, **{**BEAT, "type": 1}))])
    with pytest.raises(LogError, match="vehicle 3 is of MAV_TYPE 1, neither a multicopter nor a rover"):
        Log(path)
    write(path, [(k, frame("HEARTBEAT", system=3 + k, **BEAT)) for k in range(2)])
    with pytest.raises(LogError, match="has vehicles 3, 4: say which one with --system N"):
        Log(path)
    assert Log(path, system=4).system == 4
    with pytest.raises(LogError, match="has no vehicle 9; it has 3, 4"):
        Log(path, system=9)


def test_a_companion_may_have_the_vehicles_system_id(tmp_path: Path) -> None:
    made = [
        (0.0, frame("HEARTBEAT", **BEAT)),
        (1.0, frame("COMMAND_LONG", component=191, target_system=1, command=400, param1=1)),
        (1.1, frame("COMMAND_ACK", command=400)),
        (2.0, frame("SET_POSITION_TARGET_LOCAL_NED", component=191, target_system=1, vx=1.0)),
        (3.0, frame("COMMAND_LONG", component=154, target_system=255, command=512)),
    ]
    script = extract(Log(write(tmp_path / "companion.tlog", made)))
    assert [(s.name, s.sender) for s in script.steps if isinstance(s, Send)] == [
        ("COMMAND_LONG", (1, 191)),
        ("SET_POSITION_TARGET_LOCAL_NED", (1, 191)),
    ]
    assert script.notes == ["the log has no position of the vehicle: it starts at the default home"]


def test_a_clock_that_is_set_while_the_log_is_written(tmp_path: Path) -> None:
    times = [0.0, 1.0, 2.0, 700_000_000.0, 700_000_001.0, 5000.0, 5001.5, 5001.0, 5002.0]
    log = Log(write(tmp_path / "set.tlog", [(t, frame("HEARTBEAT", **BEAT)) for t in times]))
    assert [message.time for message in log.messages] == pytest.approx([0.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.5, 4.5, 5.0])
    assert "the clock of the log was set 2 times: what it jumped is left out" in extract(log).notes


def typed(text: str) -> int:
    """Exit code of ``replay ...``."""
    parser = argparse.ArgumentParser()
    replay.add_parser(parser.add_subparsers())
    options = parser.parse_args(shlex.split(text))
    return int(options.function(options))


def test_the_mission_is_flown_again(flight_log: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert typed(f"replay {flight_log} --log-dir {tmp_path} --seed 9") == 0
    assert "otherwise" not in capsys.readouterr().out
    then, now = tlog_flight.read(flight_log), tlog_flight.read(tmp_path / "flight-replay.tlog")
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


def test_a_log_of_the_vehicle_alone_is_flown(
    flight_log: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It is armed and AUTO as the vehicle was; its mission is not in the log, and that is said."""
    alone = write(tmp_path / "alone.tlog", [(t, raw) for t, raw in rows(flight_log) if system_of(raw) == 1])
    typed(f"replay {alone}")
    assert "note: the log has no commands" in capsys.readouterr().out


def test_what_is_refused_now_is_said(flight_log: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    made = rows(flight_log)
    command = frame("COMMAND_LONG", 255, 190, target_system=1, target_component=1, command=213)
    wrong = frame("PARAM_SET", 255, 190, target_system=1, target_component=1, param_id=b"NO_SUCH", param_value=1.0)
    made += [(50.0, command), (50.1, frame("COMMAND_ACK", command=213, result=0)), (50.2, wrong)]
    log = write(tmp_path / "more.tlog", sorted(made, key=lambda row: row[0]))
    assert typed(f"replay {log}") == 1
    said = capsys.readouterr().out
    assert re.search(r"otherwise than in the log: 50\.\d s: command 213 was ACCEPTED then, is UNSUPPORTED now\n", said)
    assert re.search(r"note: 50\.\d s: there is no parameter NO_SUCH\n", said)


def test_answers_are_heard_when_they_come(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Also when nobody says anything for a long time after a command."""
    beat = frame("HEARTBEAT", type=10, autopilot=3, custom_mode=4)
    changed = frame("HEARTBEAT", type=10, autopilot=3, custom_mode=0)
    log = write(tmp_path / "quiet.tlog", [(t, beat if t < 4 else changed) for t in range(20)])
    assert typed(f"replay {log}") == 0
    assert "otherwise" not in capsys.readouterr().out
