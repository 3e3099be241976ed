# SPDX-License-Identifier: BSD-3-Clause
"""Steps of small logs that are written here frame by frame: who did what when, what was answered, what is left out."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from sitl.missions.tlog_replay.extract import Script, extract
from sitl.missions.tlog_replay.log import Log
from sitl.missions.tlog_replay.steps import Send, Upload
from tests.missions.tlog_replay.conftest import frame, write

Rows = list[tuple[float, bytes]]
Extract = Callable[..., Script]
NO_POSITION = "the log has no position of the vehicle: it starts at the default home"
NO_COMMANDS = "the log has no commands: modes, arming and mission are taken from what the vehicle says of itself"


def beat(time: float, armed: bool = False, mode: int = 0) -> tuple[float, bytes]:
    return time, frame("HEARTBEAT", type=2, autopilot=3, base_mode=128 * armed, custom_mode=mode)


def gcs(time: float, name: str, **fields: Any) -> tuple[float, bytes]:
    return time, frame(name, 255, 190, **{"target_system": 1, **fields})


def said(time: float, name: str, **fields: Any) -> tuple[float, bytes]:
    return time, frame(name, **fields)


def command(time: float, number: int, **fields: Any) -> tuple[float, bytes]:
    return gcs(time, "COMMAND_LONG", command=number, **fields)


def item(time: float, seq: int, number: int = 16, **fields: Any) -> tuple[float, bytes]:
    return gcs(time, "MISSION_ITEM_INT", seq=seq, frame=3, command=number, x=seq, **fields)


MODE = command(0.5, 176, param1=1.0, param2=4.0)
"""With it the log has commands: nothing is taken from what the vehicle says."""


@pytest.fixture
def script(tmp_path: Path) -> Extract:
    def of(*rows: tuple[float, bytes], begins: tuple[tuple[float, bytes], ...] = (beat(0.0), MODE)) -> Script:
        made = sorted((*begins, *rows), key=lambda row: row[0])
        return extract(Log(write(tmp_path / "made.tlog", made)))

    return of


def messages(found: Script) -> list[Send]:
    return [step for step in found.steps if isinstance(step, Send)]


def sent(found: Script) -> list[Send]:
    """But for the first one, which ``script`` adds."""
    return messages(found)[1:]


def uploads(found: Script) -> list[Upload]:
    return [step for step in found.steps if isinstance(step, Upload)]


@pytest.mark.parametrize(
    ("answers", "result"),
    [
        ([], None),
        ([(1.0, 0)], 0),  # at once
        ([(4.0, 3)], 3),  # after 3 s
        ([(4.001, 3)], None),  # which is too late
        ([(0.9, 0)], None),  # before it was asked
        ([(1.1, 5), (1.2, 0)], 5),  # the first counts
    ],
)
def test_the_answer_to_a_command(script: Extract, answers: list[tuple[float, int]], result: int | None) -> None:
    acks = [said(t, "COMMAND_ACK", command=115, result=number) for t, number in answers]
    (step,) = sent(script(command(1.0, 115), *acks))
    assert step.result == result


def test_each_command_has_its_own_answer(script: Extract) -> None:
    acks = [said(t, "COMMAND_ACK", command=c, result=r) for t, c, r in ((1.5, 115, 4), (1.6, 206, 2), (1.7, 115, 0))]
    found = script(command(1.0, 115), command(1.1, 206), command(1.2, 115), command(1.3, 115), *acks)
    assert [(step.command, step.result) for step in sent(found)] == [(115, 4), (206, 2), (115, 0), (115, None)]


@pytest.mark.parametrize("number", [410, 510, 511, 512, 519, 520, 521, 527])
def test_commands_that_ask_are_left_out(script: Extract, number: int) -> None:
    """MAV_CMD_GET_HOME_POSITION, SET_MESSAGE_INTERVAL, REQUEST_MESSAGE, ..."""
    assert sent(script(command(1.0, number))) == []


@pytest.mark.parametrize(
    "name",
    ["SET_MODE", "MANUAL_CONTROL", "RC_CHANNELS_OVERRIDE", "SET_ATTITUDE_TARGET", "SET_POSITION_TARGET_GLOBAL_INT",
     "SET_HOME_POSITION", "SET_GPS_GLOBAL_ORIGIN", "MISSION_SET_CURRENT", "MISSION_CLEAR_ALL", "COMMAND_INT"],
)  # fmt: skip
def test_what_changes_a_vehicle_is_sent_as_it_was(script: Extract, name: str) -> None:
    (time, made) = (1.0, frame(name, 255, 190, **({"target": 1} if name == "MANUAL_CONTROL" else {"target_system": 1})))
    (step,) = sent(script((time, made)))
    assert (step.name, step.time, step.sender, step.result) == (name, pytest.approx(1.0), (255, 190), None)


def test_what_cannot_be_sent_again_is_counted(script: Extract) -> None:
    found = script(
        gcs(1.0, "FENCE_POINT"), gcs(1.1, "FENCE_POINT"), gcs(1.2, "MISSION_WRITE_PARTIAL_LIST"),
        gcs(1.3, "MISSION_COUNT", count=1, mission_type=1), gcs(1.4, "MISSION_COUNT", count=1, mission_type=2),
    )  # fmt: skip
    assert sent(found) == [] == uploads(found)
    notes = [note for note in found.notes if note.startswith("left out")]
    assert sorted(notes) == [
        "left out: a fence (2 messages)", "left out: a part of a mission (1 messages)",
        "left out: fences and rally points (2 messages)",
    ]  # fmt: skip


def test_an_upload_has_its_items_in_their_order_and_its_answer(script: Extract) -> None:
    found = script(
        gcs(1.0, "MISSION_COUNT", count=3), item(1.1, 0), item(1.2, 2, 21), item(1.3, 1, 22),
        said(1.4, "MISSION_ACK", type=5),
    )  # fmt: skip
    (one,) = uploads(found)
    assert (one.time, one.sender, one.result) == (pytest.approx(1.0), (255, 190), 5)
    assert [(i.command, i.x) for i in one.items] == [(16, 0), (22, 1), (21, 2)]


@pytest.mark.parametrize(("ack", "result"), [(1.05, None), (1.2, 0), (4.2, 0), (4.3, None)])
def test_the_answer_to_an_upload_comes_after_its_last_item(script: Extract, ack: float, result: int | None) -> None:
    found = script(gcs(1.0, "MISSION_COUNT", count=2), item(1.1, 0), item(1.2, 1), said(ack, "MISSION_ACK"))
    assert [one.result for one in uploads(found)] == [result]


@pytest.mark.parametrize(
    ("rows", "whole"),
    [
        ([item(1.1, 0), item(60.9, 1)], True),
        ([item(1.1, 0), item(61.1, 1)], False),  # more than a minute
        ([item(1.1, 0)], False),
        ([item(1.1, 0), item(1.2, 0)], False),
        ([item(1.1, 0), item(1.2, 1, mission_type=1)], False),  # of a fence
        ([item(1.1, 0), (1.2, frame("MISSION_ITEM_INT", 254, 190, target_system=1, seq=1))], False),  # another's
        ([item(1.1, 0), gcs(1.2, "MISSION_ITEM", seq=1, frame=3, command=22)], True),  # the older form
    ],
)
def test_an_upload_is_whole_or_left_out(script: Extract, rows: Rows, whole: bool) -> None:
    found = script(gcs(1.0, "MISSION_COUNT", count=2), *rows)
    assert bool(uploads(found)) == whole
    assert ("left out: a mission upload that is not whole in the log (1 messages)" in found.notes) != whole


def test_an_upload_that_begins_anew_counts_once(script: Extract) -> None:
    count = [gcs(t, "MISSION_COUNT", count=2) for t in (1.0, 2.0)]
    (one,) = uploads(script(*count, item(1.1, 0), item(2.1, 0), item(2.2, 1)))
    assert one.time == pytest.approx(2.0)


def test_items_of_the_older_form_are_degrees_and_local_ones_tenths_of_millimetres(script: Extract) -> None:
    """MISSION_ITEM holds degrees or metres; MISSION_ITEM_INT 1e-7 degrees, or 1e-4 m in local frames."""
    found = script(
        gcs(1.0, "MISSION_COUNT", count=2),
        gcs(1.1, "MISSION_ITEM", seq=0, frame=6, command=16, x=-0.5, y=8.25, z=4.0, param1=1, param2=2, param3=3,
            param4=4, autocontinue=1),
        gcs(1.2, "MISSION_ITEM", seq=1, frame=1, command=16, x=-0.5, y=8.25),
    )  # fmt: skip
    ((one, two),) = [upload.items for upload in uploads(found)]
    assert tuple(one)[:10] == (16, 6, 1.0, 2.0, 3.0, 4.0, -5000000, 82500000, 4.0, 1)
    assert (two.x, two.y, two.autocontinue) == (-5000, 82500, 0)


# ---------------------------------------------------------------- what the vehicle says of itself


def observed(script: Extract, *rows: tuple[float, bytes]) -> Script:
    found = script(*rows, begins=(beat(0.0),))
    assert NO_COMMANDS in found.notes
    return found


def test_modes_and_arming_of_a_log_of_the_vehicle_alone(script: Extract) -> None:
    found = observed(script, beat(2.0, mode=4), beat(3.0, True, 4), beat(4.0, True, 3), beat(9.0, False, 3))
    steps = [(round(s.time, 3), s.command, s.fields.get("param2", s.fields["param1"])) for s in messages(found)]
    assert steps == [(0.0, 176, 0.0), (2.0, 176, 4.0), (3.0, 400, 1.0), (4.0, 176, 3.0)], "disarming is its own doing"
    assert {(s.sender, s.fields["param1"], s.result) for s in messages(found)} == {((255, 190), 1.0, 0)}


def test_sticks_of_a_log_of_the_vehicle_alone(script: Extract) -> None:
    def sticks(t: float, *pulses: int) -> tuple[float, bytes]:
        return said(t, "RC_CHANNELS", **{f"chan{k}_raw": pulse for k, pulse in enumerate(pulses, 1)})

    found = observed(
        script, sticks(1.0, 1500, 1500, 1000, 1500), sticks(2.0, 1500, 1500, 1000, 1500),
        sticks(3.0, 1500, 1500, 0, 1500), sticks(4.0, 800, 2200, 1000, 1500), sticks(5.0, 799, 1500, 1000, 1500),
        sticks(6.0, 1500, 2201, 1000, 1500),
    )  # fmt: skip
    moved = [s for s in messages(found) if s.name == "RC_CHANNELS_OVERRIDE"]
    assert [round(s.time) for s in moved] == [1, 4], "those that changed, and are pulses"
    assert moved[1].fields == {"chan1_raw": 800, "chan2_raw": 2200, "chan3_raw": 1000, "chan4_raw": 1500}


@pytest.mark.parametrize(("armed_at", "at"), [(9.0, 4.0), (3.0, 0.0), (None, 15.0)])
def test_a_mission_that_was_read_back_is_uploaded_before_arming(
    script: Extract, armed_at: float | None, at: float
) -> None:
    rows = [said(t, "MISSION_ITEM_INT", seq=seq, command=16, x=seq) for t, seq in ((1.0, 1), (1.1, 0), (2.0, 1))]
    armed = [beat(armed_at, True)] if armed_at is not None else []
    (one,) = uploads(observed(script, *rows, *armed, beat(20.0)))
    assert (one.time, one.sender, one.result) == (pytest.approx(at), (255, 190), None)
    assert [i.x for i in one.items] == [0, 1]


def test_a_mission_that_was_read_back_in_part_is_none(script: Extract) -> None:
    rows = [said(1.0, "MISSION_ITEM_INT", seq=seq, command=16) for seq in (0, 2)]
    assert uploads(observed(script, *rows)) == []


def test_a_fence_that_was_read_back_is_no_mission(script: Extract) -> None:
    rows = [said(1.0, "MISSION_ITEM_INT", seq=0, command=16, x=7)]
    rows += [said(2.0, "MISSION_ITEM_INT", seq=seq, command=5003, mission_type=1) for seq in range(3)]
    rows += [said(3.0, "MISSION_ITEM_INT", seq=0, command=5100, mission_type=2)]
    (one,) = uploads(observed(script, *rows))
    assert [(i.command, i.x) for i in one.items] == [(16, 7)]


def test_a_vehicle_that_nobody_arms_by_command_is_armed_when_it_says_so(script: Extract) -> None:
    """By its sticks, for example. Modes stay those of the commands."""
    found = script(beat(5.0, True), beat(6.0, True, 3))
    assert [(round(s.time, 3), s.command) for s in messages(found)] == [(0.5, 176), (5.0, 400)]
    assert "nobody arms the vehicle by command: it is armed when it says that it is" in found.notes
    found = script(command(4.0, 400, param1=1.0), beat(5.0, True))
    assert [s.command for s in messages(found)] == [176, 400]
    assert not any("nobody arms" in note for note in found.notes)


def test_set_points_alone_are_commands(script: Extract) -> None:
    found = script(gcs(1.0, "SET_POSITION_TARGET_LOCAL_NED"), begins=(beat(0.0),))
    assert NO_COMMANDS not in found.notes and [step.name for step in messages(found)] == [
        "SET_POSITION_TARGET_LOCAL_NED"
    ]


@pytest.mark.parametrize(("first", "told"), [(0.0, True), (1.0, True), (1.1, False)])
def test_a_log_that_begins_with_an_armed_vehicle(script: Extract, first: float, told: bool) -> None:
    found = script(beat(first, True), begins=(beat(0.0, first == 0.0), MODE))
    assert ("the log begins with an armed vehicle: here it begins on the ground" in found.notes) == told


# ---------------------------------------------------------------- home and parameters


def at(time: float, lat: int, hdg: int = 9000) -> tuple[float, bytes]:
    return said(time, "GLOBAL_POSITION_INT", lat=lat, lon=-80_000_000, alt=488_500, hdg=hdg)


@pytest.mark.parametrize(
    ("rows", "home"),
    [
        ([at(1.0, 470_000_000)], (47.0, -8.0, 488.5, 90.0)),
        ([at(1.0, 470_000_000), at(4.0, 480_000_000), at(6.0, 490_000_000)], (48.0, -8.0, 488.5, 90.0)),
        ([at(6.0, 490_000_000), at(7.0, 500_000_000)], (49.0, -8.0, 488.5, 90.0)),  # armed before the first one
        ([at(1.0, 470_000_000, 4500), at(2.0, 470_000_000, 65535)], (47.0, -8.0, 488.5, 45.0)),  # UINT16_MAX: unknown
        ([said(1.0, "GPS_RAW_INT", fix_type=2, lat=1, lon=1),
          said(2.0, "GPS_RAW_INT", fix_type=3, lat=470_000_000, lon=80_000_000, alt=488_000)], (47.0, 8.0, 488.0, 0.0)),
        ([said(1.0, "GLOBAL_POSITION_INT", lat=0, lon=0)], None),
        ([said(1.0, "GLOBAL_POSITION_INT", lat=0, lon=80_000_000, hdg=65535)], (0.0, 8.0, 0.0, 0.0)),
    ],
)  # fmt: skip
def test_home_is_where_it_stood_when_it_was_armed(script: Extract, rows: Rows, home: Any) -> None:
    found = script(beat(5.0, True), *rows)
    assert found.home == (None if home is None else pytest.approx(home))
    assert (NO_POSITION in found.notes) == (home is None)


def test_parameters_are_the_vehicles_own_before_anybody_set_them(script: Extract) -> None:
    def value(t: float, name: bytes, number: float) -> tuple[float, bytes]:
        return said(t, "PARAM_VALUE", param_id=name, param_value=number)

    found = script(
        value(1.0, b"WPNAV_SPEED", 400.0), value(2.0, b"WPNAV_SPEED", 700.0), value(1.0, b"RTL_ALT", 1800.0),
        value(1.0, b"COMPASS_OFS_X", 12.0), value(1.0, b"WPNAV_ACCEL", math.nan), value(1.0, b"WPNAV_RADIUS", 1.5),
        gcs(3.0, "PARAM_SET", param_id=b"WPNAV_RADIUS", param_value=2.0),
    )  # fmt: skip
    assert found.parameters == pytest.approx({"WPNAV_SPEED": 400.0, "RTL_ALT": 1800.0})
    assert [step.title for step in sent(found)] == ["parameter WPNAV_RADIUS = 2"]


# ---------------------------------------------------------------- steps


@pytest.mark.parametrize(
    ("name", "fields", "result", "needs"),
    [
        ("COMMAND_LONG", {"command": 400, "param1": 1.0}, None, True),
        ("COMMAND_LONG", {"command": 400, "param1": 1.0}, 0, True),
        ("COMMAND_LONG", {"command": 400, "param1": 1.0}, 4, False),  # refused then, too
        ("COMMAND_LONG", {"command": 400, "param1": 0.0}, 0, False),  # disarms
        ("COMMAND_INT", {"command": 22}, 0, True),
        ("COMMAND_LONG", {"command": 300}, 0, True),
        ("SET_MODE", {"custom_mode": 4}, None, True),
        ("COMMAND_LONG", {"command": 115}, 0, False),
        ("PARAM_SET", {"param_id": b"A", "param_value": 1.0}, None, False),
    ],
)
def test_what_waits_until_the_vehicle_is_ready(name: str, fields: Any, result: int | None, needs: bool) -> None:
    assert Send(1.0, (255, 190), name, fields, result).needs_ready == needs


def test_steps_have_titles() -> None:
    assert Send(0.0, (255, 190), "COMMAND_INT", {"command": 22}).title == "command 22"
    assert Send(0.0, (255, 190), "HEARTBEAT", {}).title == "HEARTBEAT"
    assert Upload(0.0, (255, 190), ()).title == "mission upload" and not Upload(0.0, (255, 190), ()).needs_ready
