# SPDX-License-Identifier: BSD-3-Clause
"""What is found in a log."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl.logs.tlog import LogError
from sitl.missions.tlog_replay.extract import extract
from sitl.missions.tlog_replay.log import Log
from sitl.missions.tlog_replay.steps import Send, Upload
from tests.missions.tlog_replay.logged_flights import HOME, ITEMS, frame, rows, system_of, write

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
