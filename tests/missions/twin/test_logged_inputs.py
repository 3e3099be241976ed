# SPDX-License-Identifier: BSD-3-Clause
"""What is read of ArduPilot's log messages CMD, MODE, MAVC, GUIP, GUIA, RCIN, XKF2: edges, older forms, absent ones."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.missions.twin import inputs
from sitl.missions.twin.flight_log import FlightLog
from tests.missions.twin.conftest import FORMATS, Log

GCS = (1, 1, 255, 190, 0)
NO_STICKS = "the log has no RCIN: nobody holds the sticks"
NO_SET_POINTS = "the log has no set-points of GUIDED (MAVC, GUIP, GUIA)"


def of(path: Any) -> inputs.Inputs:
    return inputs.of(FlightLog(path))


def item(second: float, total: int, number: int, command: int = 16, alt: float = 5.0) -> tuple[Any, ...]:
    """CMD: an item of a mission as it is written into a log."""
    t = round(second * 1e6)
    return ("CMD", t, total, number, command, 1.0, 2.0, 3.0, 4.0, 473977000, 85456000, alt, 6)


def test_a_mission_is_taken_whole_with_all_of_its_items_fields(written: Log) -> None:
    (one,) = of(written(item(22.0, 2, 0), item(22.1, 2, 1, 22, 8.0))).missions
    assert one[0] == pytest.approx(2.1), "when its last item was written"
    assert one[1][1] == (22, 6, 1.0, 2.0, 3.0, 4.0, 473977000, 85456000, 8.0, 1, 0)
    assert len(one[1]) == 2


def test_items_of_logs_without_frames_are_above_home(written: Log, monkeypatch: pytest.MonkeyPatch) -> None:
    """MAV_FRAME_GLOBAL_RELATIVE_ALT, 3: ArduPilot did not log it before."""
    monkeypatch.setitem(FORMATS, "CMD", ("QHHHffffLLf", "TimeUS,CTot,CNum,CId,Prm1,Prm2,Prm3,Prm4,Lat,Lng,Alt"))
    (one,) = of(written(item(22.0, 1, 0)[:-1])).missions
    assert [i.frame for i in one[1]] == [3]


@pytest.mark.parametrize(
    ("rows", "times"),
    [
        ([item(22.0, 2, 0)], []),  # not whole
        ([item(22.0, 2, 0), item(22.1, 2, 0), item(22.2, 2, 1)], [2.2]),  # begun again
        ([item(22.0, 2, 1), item(22.1, 2, 0)], []),  # item 0 begins a mission: the one before it is of another
        ([item(22.0, 1, 0), item(23.0, 1, 0)], [2.0]),  # the same once more
        ([item(22.0, 1, 0), item(23.0, 1, 0, 22)], [2.0, 3.0]),
        ([item(22.0, 1, 0), item(30.5, 1, 0, 22)], [2.0]),  # after the flight
        ([item(19.0, 1, 0), item(25.0, 1, 0, 22)], [-1.0, 5.0]),
    ],
)
def test_missions_that_were_there_or_came_in_flight(written: Log, rows: list[Any], times: list[float]) -> None:
    assert [time for time, _ in of(written(*rows)).missions] == pytest.approx(times)


def test_a_mission_at_the_beginning_of_a_log_that_arming_opened_was_there_before(written: Log) -> None:
    """Such a log (LOG_DISARMED 0) begins with the arming; what it writes first is what the vehicle had."""
    path = written(("ARM", 30_000_000, 0, 0), item(3.0, 1, 0), armed=False)
    assert [time for time, _ in of(path).missions] == [0.0]
    path = written(("ARM", 30_000_000, 0, 0), item(7.0, 1, 0), armed=False)
    assert [time for time, _ in of(path).missions] == pytest.approx([6.0]), "more than 5 s after the log began"


@pytest.mark.parametrize(
    ("reason", "chosen"),
    [(0, True), (1, True), (2, True), (3, False), (5, False), (17, False), (18, True), (26, True), (27, False),
     (31, True), (32, True), (52, True), (53, True), (54, False)],
)  # fmt: skip
def test_modes_that_somebody_chose_by_ardupilots_reason(written: Log, reason: int, chosen: bool) -> None:
    """ModeReason: 0 unknown, 1 RC, 2 GCS, 3 radio failsafe, 5 GCS failsafe, 26 boot, ..."""
    assert of(written(("MODE", 25_000_000, 9, 9, reason))).modes[1:] == [(5.0, 9, chosen)]


def test_modes_of_logs_without_number_and_reason(written: Log, monkeypatch: pytest.MonkeyPatch) -> None:
    """MODE.Mode alone, as ArduPilot logged once; nobody knows why it changed, so it was chosen."""
    monkeypatch.setitem(FORMATS, "MODE", ("QB", "TimeUS,Mode"))
    path = written(("MODE", 3_000_000, 4), ("MODE", 25_000_000, 9), without=("MODE",))
    assert of(path).modes == [(-17.0, 4, True), (5.0, 9, True)]


def test_modes_of_the_flight_alone(written: Log) -> None:
    assert of(written(without=("MODE",))).modes == []
    path = written(("MODE", 20_000_000, 5, 5, 3), ("MODE", 30_500_000, 9, 9, 2))
    assert of(path).modes == [(0.0, 5, True)], "that of the arming, whoever chose it; none after the flight"


def command(second: float, number: int, *p: float, result: int = 0) -> tuple[Any, ...]:
    """MAVC: a command that the vehicle was given."""
    return ("MAVC", round(second * 1e6), *GCS, number, *(*p, *(0.0,) * (4 - len(p))), 11, -12, 3.5, result, 1)


def test_a_command_is_sent_again_with_all_of_its_parameters(written: Log) -> None:
    (message,) = of(written(command(21.0, 115, 90.0, 20.0, -1.0, 1.0))).messages
    assert message.fields == {
        "frame": 0, "command": 115, "param1": 90.0, "param2": 20.0, "param3": -1.0, "param4": 1.0, "x": 11, "y": -12,
        "z": 3.5,
    }  # fmt: skip


@pytest.mark.parametrize(
    ("row", "sent"),
    [
        (command(19.9, 115), False),  # before arming
        (command(20.0, 115), True),
        (command(29.9, 115), True),
        (command(30.1, 115), False),
        (command(25.0, 176, 1.0, 4.0), False),  # DO_SET_MODE: MODE tells it
        (command(25.0, 400, 1.0), False),  # armed it is already
        (command(25.0, 400, 0.0), True),
        (command(25.0, 511, 30.0), False),  # asks for messages
        (command(25.0, 115, result=4), False),  # FAILED
        (command(25.0, 115, result=5), False),  # IN_PROGRESS
    ],
)
def test_commands_of_the_flight_that_change_something_are_sent_again(
    written: Log, row: tuple[Any, ...], sent: bool
) -> None:
    assert bool(of(written(row)).messages) == sent


def test_a_command_that_was_refused_twice_is_named_once(written: Log) -> None:
    found = of(written(command(21.0, 115, result=4), command(22.0, 115, result=2), command(23.0, 206, result=3)))
    assert "left out, for the log's vehicle refused it: command 115, command 206" in found.notes


def test_messages_come_in_the_order_of_their_times(written: Log) -> None:
    path = written(command(25.0, 115), ("GUIP", 22_000_000, 2, *[0.0] * 3, 0, *[0.0] * 6), command(21.0, 206))
    assert [message.time for message in of(path).messages] == pytest.approx([1.0, 2.0, 5.0])


@pytest.mark.parametrize(
    ("kind", "position", "velocity", "acceleration"),
    [(1, True, False, False), (2, True, False, False), (3, True, True, True), (4, False, True, True),
     (5, False, False, True)],
)  # fmt: skip
def test_what_of_a_set_point_counts_by_the_submode_of_guided(
    written: Log, kind: int, position: bool, velocity: bool, acceleration: bool
) -> None:
    """GUIP.Type is ArduCopter's ModeGuided::SubMode; the masks are those of POSITION_TARGET_TYPEMASK."""
    (message,) = of(written(("GUIP", 22_000_000, kind, *[0.0] * 3, 0, *[0.0] * 6))).messages
    mask = message.fields["type_mask"]
    assert [mask & bits == 0 for bits in (0b111, 0b111_000, 0b111_000_000)] == [position, velocity, acceleration]
    assert mask & 0b1100_0000_0000 == 0b1100_0000_0000, "neither yaw nor yaw rate"
    assert message.fields["coordinate_frame"] == 1


@pytest.mark.parametrize("kind", [0, 6, 7])
def test_take_offs_and_attitudes_are_no_positions(written: Log, kind: int) -> None:
    assert of(written(("GUIP", 22_000_000, kind, *[0.0] * 3, 0, *[0.0] * 6))).messages == []


def test_set_points_of_ardupilot_4_7_are_metres_down(written: Log) -> None:
    row = ("GUIP", 22_000_000, 3, 5.0, 3.0, -8.0, 0, 1.0, -2.0, -0.5, 0.25, -0.5, -0.75)
    (message,) = of(written(row, firmware="ArduCopter V4.7.0 (abc)")).messages
    fields = [message.fields[name] for name in ("x", "y", "z", "vx", "vy", "vz", "afx", "afy", "afz")]
    assert fields == pytest.approx([2.0, -1.0, -8.5, 1.0, -2.0, -0.5, 0.25, -0.5, -0.75])
    (message,) = of(written(row)).messages
    fields = [message.fields[name] for name in ("vx", "vy", "vz", "afx", "afy", "afz")]
    assert fields == pytest.approx([0.01, -0.02, 0.005, 0.0025, -0.005, 0.0075]), "4.5: cm, up"


def test_positions_on_the_globe_are_above_the_sea_where_that_is_nearer(written: Log) -> None:
    """It stood at 488 m: 480 m are above the sea, 9 m above home; what does not count is masked."""
    path = written(*(("GUIP", t, 3, 473978000.0, 85456000.0, alt, 0, 100.0, *[0.0] * 5)
                     for t, alt in ((22_000_000, 900.0), (23_000_000, 48_000.0))))  # fmt: skip
    found = of(path)
    low, high = (message.fields for message in found.messages)
    assert {message.name for message in found.messages} == {"SET_POSITION_TARGET_GLOBAL_INT"}
    assert (low["coordinate_frame"], low["alt"], high["coordinate_frame"], high["alt"]) == (6, 9.0, 5, 480.0)
    assert low["type_mask"] & 0b111 == 0 and low["type_mask"] & 0b111_111_000 == 0b111_111_000
    assert low["lat_int"] == pytest.approx(473978000, abs=32) and low["lon_int"] == pytest.approx(85456000, abs=8)
    assert "2 set-points of GUIDED are positions on the globe, which logs keep to about a metre" in found.notes


def test_attitudes_of_guided(written: Log, monkeypatch: pytest.MonkeyPatch) -> None:
    """GUIA: angles [deg] become the quaternion of roll, pitch, yaw; a climb rate becomes ArduPilot's thrust."""
    monkeypatch.setitem(
        FORMATS, "GUIA", ("QBfffffffff", "TimeUS,Type,Roll,Pitch,Yaw,RollRt,PitchRt,YawRt,Thrust,ClimbRt,x")
    )
    rows = [
        ("GUIA", 21_000_000, 6, 90.0, 0.0, 0.0, 10.0, -20.0, 30.0, 0.6, 0.0, 0.0),
        ("GUIA", 22_000_000, 6, 0.0, 60.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0),
        ("GUIA", 23_000_000, 6, 0.0, 0.0, -90.0, 0.0, 0.0, 0.0, 0.0, -0.5, 0.0),
        ("GUIA", 24_000_000, 6, 40.0, -30.0, 70.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    ]
    found = of(written(*rows))
    assert [message.name for message in found.messages] == ["SET_ATTITUDE_TARGET"] * 4
    roll, pitch, yaw, all_three = (message.fields for message in found.messages)
    h = math.sqrt(0.5)
    assert roll["q"] == pytest.approx((h, h, 0.0, 0.0))
    assert pitch["q"] == pytest.approx((math.cos(math.radians(30)), 0.0, 0.5, 0.0))
    assert yaw["q"] == pytest.approx((h, 0.0, 0.0, -h))
    q0, q1, q2, q3 = all_three["q"]
    assert math.degrees(math.atan2(2 * (q0 * q1 + q2 * q3), 1 - 2 * (q1**2 + q2**2))) == pytest.approx(40.0)
    assert math.degrees(math.asin(2 * (q0 * q2 - q3 * q1))) == pytest.approx(-30.0)
    assert math.degrees(math.atan2(2 * (q0 * q3 + q1 * q2), 1 - 2 * (q2**2 + q3**2))) == pytest.approx(70.0)
    rates = [math.degrees(roll[f"body_{axis}_rate"]) for axis in ("roll", "pitch", "yaw")]
    assert rates == pytest.approx([10.0, -20.0, 30.0])
    assert [one["thrust"] for one in (roll, pitch, yaw, all_three)] == pytest.approx([0.6, 1.0, 0.25, 0.5])


def test_sticks_from_five_seconds_before_arming_to_its_end(written: Log) -> None:
    path = written(("RCIN", 14_900_000, *[1111] * 6), ("RCIN", 15_100_000, *[1222] * 6), ("RCIN", 31_000_000, *[1] * 6))
    found = of(path).sticks
    assert found is not None
    assert (found[0][0], found[0][-1]) == pytest.approx((-4.9, 10.0))
    assert found[1][0].tolist() == [1222.0] * 6


@pytest.mark.parametrize("pulses", [None, (10_000_000, 1500), (21_000_000, 0)])
def test_nobody_holds_the_sticks_without_pulses_of_the_flight(written: Log, pulses: tuple[int, int] | None) -> None:
    """No RCIN; none since five seconds before arming; pulses of 0, which is no receiver."""
    rows = [("RCIN", pulses[0], *[pulses[1]] * 6)] if pulses is not None else []
    found = of(written(*rows, without=("RCIN",)))
    assert found.sticks is None and NO_STICKS in found.notes


@pytest.mark.parametrize(("gap_s", "told"), [(0.2, False), (0.3, True)])
def test_sticks_that_are_missing_for_longer_are_told(written: Log, gap_s: float, told: bool) -> None:
    """RCIN comes ten times a second; 0.25 s and less is no gap."""
    times = (21.0, 21.1, 21.1 + gap_s)
    found = of(written(*(("RCIN", round(t * 1e6), *[1500] * 6) for t in times), without=("RCIN",)))
    told_so = f"sticks are missing in the log for up to {gap_s:.1f} s: they move evenly in between"
    assert (told_so in found.notes) == told and NO_STICKS not in found.notes


def test_a_silent_wind_estimate_is_none(written: Log) -> None:
    calm = [("XKF2", t, 0, 0.03, 0.03) for t in (20_000_000, 30_000_000)]
    assert of(written(*calm)).wind == [] == of(written()).wind
    blows = [("XKF2", t, 0, north, 0.0) for t, north in ((20_000_000, 2.0), (30_000_000, 4.0))]
    wind = of(written(*blows)).wind
    assert [one.time for one in wind] == [float(k) for k in range(10)], "once a second while it is armed"
    assert (wind[0].speed, wind[5].speed) == pytest.approx((2.0, 3.0))
    assert wind[0].direction == pytest.approx(180.0), "it blows northwards: it comes from the south"


@pytest.mark.parametrize(
    ("rows", "told"),
    [
        ([("MODE", 21_000_000, 4, 4, 2)], True),
        ([("MODE", 21_000_000, 4, 4, 2), ("MODE", 23_900_000, 5, 5, 1)], False),  # less than 3 s
        ([("MODE", 21_000_000, 4, 4, 2), ("MODE", 24_100_000, 5, 5, 1)], True),
        ([("MODE", 21_000_000, 4, 4, 2), command(22.0, 115)], False),
        ([("MODE", 21_000_000, 5, 5, 2)], False),
        ([("MODE", 10_000_000, 4, 4, 2), ("MODE", 22_500_000, 5, 5, 1)], False),  # only what is flown counts
    ],
)
def test_a_flight_in_guided_without_set_points_is_told(written: Log, rows: list[Any], told: bool) -> None:
    assert (NO_SET_POINTS in of(written(*rows)).notes) == told
