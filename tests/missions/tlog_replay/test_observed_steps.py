# SPDX-License-Identifier: BSD-3-Clause
"""What a log of the vehicle alone tells: modes, arming, sticks, missions that were read back; home and parameters."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.missions.tlog_replay.extract import Script
from tests.missions.tlog_replay.conftest import MODE, Extract, beat
from tests.missions.tlog_replay.test_extracted_steps import Rows, command, gcs, messages, said, sent, uploads

NO_POSITION = "the log has no position of the vehicle: it starts at the default home"
NO_COMMANDS = "the log has no commands: modes, arming and mission are taken from what the vehicle says of itself"


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
