# SPDX-License-Identifier: BSD-3-Clause
"""Steps of small logs that are written here frame by frame: who did what when, what was answered, what is left out."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.missions.tlog_replay.extract import Script
from sitl.missions.tlog_replay.steps import Send, Upload
from tests.missions.tlog_replay.conftest import Extract, frame

Rows = list[tuple[float, bytes]]


def gcs(time: float, name: str, **fields: Any) -> tuple[float, bytes]:
    return time, frame(name, 255, 190, **{"target_system": 1, **fields})


def said(time: float, name: str, **fields: Any) -> tuple[float, bytes]:
    return time, frame(name, **fields)


def command(time: float, number: int, **fields: Any) -> tuple[float, bytes]:
    return gcs(time, "COMMAND_LONG", command=number, **fields)


def item(time: float, seq: int, number: int = 16, **fields: Any) -> tuple[float, bytes]:
    return gcs(time, "MISSION_ITEM_INT", seq=seq, frame=3, command=number, x=seq, **fields)


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
