# SPDX-License-Identifier: BSD-3-Clause
"""Edges of what is read of a log: which time armed is a flight, where it began, which lane and which unit counts."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sitl.autopilot.copter.firmware import FIRMWARE
from sitl.logs.tlog import LogError
from sitl.missions.twin import gaps, taken_parameters
from sitl.missions.twin.flight_log import FlightLog, TwinError
from sitl.missions.twin.streams import QUANTITIES
from tests.missions.twin.conftest import FORMATS, Log


def text(t: float, words: str) -> tuple[Any, ...]:
    return ("MSG", round(t * 1e6), words.encode())


def parameter(name: str, value: float, t: float = 1.0, default: float = 0.0) -> tuple[Any, ...]:
    return ("PARM", round(t * 1e6), name.encode(), value, default)


# ---------------------------------------------------------------- which flight


@pytest.mark.parametrize(("seconds", "flights"), [(2.9, 1), (3.0, 2), (3.1, 2)])
def test_three_seconds_armed_are_a_flight(written: Log, seconds: float, flights: int) -> None:
    path = written(("ARM", 10_000_000, 1, 0), ("ARM", round((10.0 + seconds) * 1e6), 0, 0))
    assert len(FlightLog(path).flights) == flights


@pytest.mark.parametrize(("climb", "moved"), [(0.9, False), (1.0, True), (1.1, True)])
def test_a_copter_that_climbed_a_metre_flew(written: Log, climb: float, moved: bool) -> None:
    found = FlightLog(written(height=climb), must_move=False)
    assert (found.stands == "") == moved


def test_a_flight_that_the_log_does_not_end_goes_to_its_last_message(written: Log) -> None:
    log = FlightLog(written(("ARM", 20_000_000, 1, 0), without=("ARM",)))
    assert log.span == (20.0, 30.0, False) and log.span.length == 10.0


def test_arming_that_is_told_twice_is_one(written: Log) -> None:
    log = FlightLog(written(("ARM", 22_000_000, 1, 0), ("ARM", 29_000_000, 0, 0)))
    assert [(span.armed, span.disarmed) for span in log.flights] == [(20.0, 29.0)]


def test_events_tell_of_arming_where_there_is_no_arm(written: Log, monkeypatch: pytest.MonkeyPatch) -> None:
    """EV.Id 10 armed, 11 disarmed; other events are something else."""
    monkeypatch.setitem(FORMATS, "EV", ("QB", "TimeUS,Id"))
    events = [("EV", round(t * 1e6), number) for t, number in ((21.0, 15), (20.5, 10), (25.0, 28), (28.0, 11))]
    assert FlightLog(written(*events, without=("ARM",))).span == (20.5, 28.0, True)


def test_a_log_that_arming_did_not_open_did_not_miss_it(written: Log) -> None:
    with pytest.raises(TwinError, match="never armed for 3 s"):
        FlightLog(written(("ARM", 30_000_000, 0, 0), parameter("LOG_DISARMED", 1.0), armed=False))


# ---------------------------------------------------------------- where it was


def test_what_was_at_arming_is_the_last_value_before(written: Log) -> None:
    log = FlightLog(written())
    values = np.array([1.0, 2.0, 3.0])
    assert log.at_arming(np.array([-1.0, 0.0, 1.0]), values) == 2.0, "one at the moment itself counts"
    assert log.at_arming(np.array([-1.0, -0.5, 0.01]), values) == 2.0
    assert log.at_arming(np.array([0.5, 1.0, 2.0]), values) == 1.0, "else the first one after"


def test_home_is_of_the_first_message_that_has_a_position(written: Log, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(FORMATS, "GPS", ("QBLLf", "TimeUS,I,Lat,Lng,Alt"))
    monkeypatch.setitem(FORMATS, "AHR2", ("QLLf", "TimeUS,Lat,Lng,Alt"))
    gps = [("GPS", t, 0, 10_000_000, 20_000_000, 30.0) for t in (19_000_000, 25_000_000)]
    ahrs = [("AHR2", t, lat, lat, 40.0) for t, lat in ((19_000_000, 0), (25_000_000, 50_000_000))]
    assert FlightLog(written(*gps, *ahrs, without=("POS",))).home()[:3] == pytest.approx((1.0, 2.0, 30.0)), "0, 0: none"
    assert FlightLog(written(*gps, without=("POS", "ATT"))).home() == pytest.approx((1.0, 2.0, 30.0, 0.0))
    with pytest.raises(TwinError, match="tells no position"):
        FlightLog(written(without=("POS",))).home()


@pytest.mark.parametrize(("yaw", "heading"), [(-90.0, 270.0), (360.0, 0.0), (359.5, 359.5)])
def test_the_heading_of_home_is_within_a_circle(written: Log, yaw: float, heading: float) -> None:
    log = FlightLog(written(("ATT", 20_000_000, *[0.0] * 5, yaw), without=("ATT",)))
    assert log.home()[3] == pytest.approx(heading)


def test_a_log_without_words_of_its_version_is_of_today(written: Log) -> None:
    assert FlightLog(written()).version == (4, 5)
    with pytest.raises(LogError):
        FlightLog(written(without=("MSG",)))


def test_times_that_go_back_are_left_out(written: Log) -> None:
    rows = [("ATT", t, *[float(k)] * 6) for k, t in enumerate((21_000_000, 22_000_000, 22_000_000, 23_000_000))]
    table = FlightLog(written(*rows, without=("ATT",))).table("ATT")
    assert table.time.tolist() == pytest.approx([21.0, 22.0, 23.0]) and table["Yaw"].tolist() == [0.0, 1.0, 3.0]


# ---------------------------------------------------------------- parameters


def taken(path: Any) -> taken_parameters.Taken:
    return taken_parameters.taken(FlightLog(path), FIRMWARE.table)


@pytest.mark.parametrize(
    "name",
    ["INS_ACCOFFS_X", "COMPASS_DIA_X", "SERVO1_MIN", "BATT_MONITOR", "FRAME_CLASS", "LOG_BITMASK", "SERIAL1_BAUD",
     "EK3_SRC1_POSXY", "GPS1_TYPE", "ARMING_CHECK", "SYSID_THISMAV", "SIM_GPS1_LAG_MS", "MOT_PWM_MIN", "SR0_POSITION"],
)  # fmt: skip
def test_what_is_the_airframes_own_is_not_taken_over(written: Log, name: str) -> None:
    value = 4.0 if name != "FRAME_CLASS" else 1.0
    found = taken(written(parameter(name, value)))
    assert name not in found.values and name not in found.missing and found.own == 2


@pytest.mark.parametrize("name", ["RTL_ALT", "ATC_ANG_RLL_P", "EK3_POSNE_M_NSE", "SIM_WIND_SPD", "BATT_FS_LOW_ACT"])
def test_what_says_how_it_is_flown_is(written: Log, name: str) -> None:
    found = taken(written(parameter(name, 4.0)))
    assert found.values[name] == 4.0 and found.own == 1


def test_changes_in_flight_are_told_once_each(written: Log) -> None:
    rows = [parameter("RTL_ALT", value, t) for value, t in (
        (1000.0, 1.0), (1200.0, 19.0), (1200.0, 21.0), (1500.0, 22.0), (1500.0, 23.0), (900.0, 30.5))]  # fmt: skip
    found = taken(written(*rows, parameter("XYZ_NONE", 1.0, 2.0), parameter("XYZ_NONE", 2.0, 22.0)))
    assert found.values["RTL_ALT"] == 1200.0, "as it was at arming"
    assert [(round(t, 3), name, value) for t, name, value in found.changes] == [(2.0, "RTL_ALT", 1500.0)]


def test_values_that_are_none_are_passed_over(written: Log) -> None:
    found = taken(written(parameter("RTL_ALT", math.nan), parameter("RTL_SPEED", math.inf)))
    assert "RTL_ALT" not in found.values and "RTL_SPEED" not in found.values


def test_notes_count_and_name_at_most_eight(written: Log) -> None:
    one = taken(written(parameter("XYZ_A", 1.0)))
    assert one.notes()[0] == "1 parameter of the log not in this autopilot: XYZ_A"
    many = taken(written(*(parameter(f"XYZ_{k}", 1.0) for k in range(9))))
    names = ", ".join(f"XYZ_{k}" for k in range(8))
    assert many.notes()[0] == f"9 parameters of the log not in this autopilot: {names}, ..."
    eight = taken(written(*(parameter(f"XYZ_{k}", 1.0) for k in range(8))))
    assert eight.notes()[0].endswith(names)
    assert taken(written()).notes() == [
        "1 parameters are the log's; 1 that tell of hardware, calibration, ports and logs are the airframe's"
    ]


# ---------------------------------------------------------------- what the log lacks


@pytest.mark.parametrize(
    ("mode", "told"),
    [("AUTO", True), ("Auto", True), ("LOITER", False)],
)
def test_only_auto_waits_for_a_start(written: Log, mode: str, told: bool) -> None:
    found = gaps.uncommanded_start(FlightLog(written()), [(-1.0, mode)], [], None)
    assert (found is not None) == told and found in (None, 0.0)


@pytest.mark.parametrize(
    ("at", "command", "told"),
    [(0.5, 300, False), (1.5, 300, False), (1.9, 300, True), (0.5, 22, True)],
)
def test_a_start_counts_until_the_vehicle_lifts(written: Log, at: float, command: int, told: bool) -> None:
    """It is half a metre up at 1.6 s."""
    found = gaps.uncommanded_start(FlightLog(written()), [(-1.0, "AUTO")], [(at, command)], None)
    assert (found is not None) == told


@pytest.mark.parametrize(("pulse", "told"), [(1149, True), (1150, True), (1151, False)])
def test_a_throttle_raised_by_more_than_fifty_microseconds_is_a_start(written: Log, pulse: float, told: bool) -> None:
    pulses = np.array([[1500.0, 1500.0, 1100.0], [1500.0, 1500.0, pulse], [1500.0, 1500.0, 1100.0]])
    sticks = (np.array([0.0, 1.0, 5.0]), pulses)
    found = gaps.uncommanded_start(FlightLog(written()), [(-1.0, "AUTO")], [], sticks)
    assert (found is not None) == told
    two = (sticks[0], pulses[:, :2])
    assert gaps.uncommanded_start(FlightLog(written()), [(-1.0, "AUTO")], [], two) == 0.0, "no throttle channel"
    later = (np.array([2.0, 3.0, 5.0]), pulses)
    assert gaps.uncommanded_start(FlightLog(written()), [(-1.0, "AUTO")], [], later) == 0.0, "after it lifted"


@pytest.mark.parametrize(("letters", "volts"), [("Qff", 12.0), ("Qhh", None)])
def test_the_battery_of_arducopter_3_is_one(
    written: Log, monkeypatch: pytest.MonkeyPatch, letters: str, volts: float | None
) -> None:
    """CURR of 3.4 and 3.5 holds volts; before, hundredths of them."""
    monkeypatch.setitem(FORMATS, "CURR", (letters, "TimeUS,Volt,Curr"))
    log = FlightLog(written(("CURR", 21_000_000, 12, 3), ("CURR", 22_000_000, 12, 3)))
    found = next(one for one in QUANTITIES["copter"] if one.name == "voltage").of(log)
    assert (None if found is None else float(found.values[0, 0])) == volts
