# SPDX-License-Identifier: BSD-3-Clause
"""Items, quantities and states of a log's flight: where they begin, in which unit, of which sensor."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sitl.missions.twin import legs, streams
from sitl.missions.twin.flight_log import FlightLog, TwinError
from sitl.missions.twin.legs import Item, Step
from sitl.missions.twin.state import LoggedState, Series
from tests.missions.twin.conftest import FORMATS, Log
from tests.missions.twin.test_log_edges import parameter, text


def test_items_of_the_flight_alone_count(written: Log) -> None:
    log = FlightLog(written(
        text(19.0, "Mission: 1 Takeoff"), text(20.5, "Mission: 1 Takeoff"), text(25.0, "Mission: 2 WP"),
        text(29.9995, "Mission: 1 Takeoff"), text(26.0, "Reached command #2"),
    ))  # fmt: skip
    assert [(round(one.time, 3), one.item) for one in legs.begun_in(log)] == [(0.5, Item(1, 1)), (5.0, Item(2, 1))]


def test_steps_are_items_of_both_and_the_end_of_a_mission(written: Log) -> None:
    first = FlightLog(written(
        text(21.0, "Mission: 1 Takeoff"), text(24.0, "Mission: 2 WP"), text(26.0, "Mission: 3 WP"),
        ("MODE", 20_500_000, 3, 3, 2), ("MODE", 28_000_000, 6, 6, 2), ("MODE", 31_000_000, 5, 5, 2),
    ))  # fmt: skip
    second = FlightLog(written(text(21.5, "Mission: 1 Takeoff"), text(25.0, "Mission: 2 WP")))
    found = legs.steps(first, second)
    assert [(round(s.logged, 3), round(s.flown, 3), s.item) for s in found] == [
        (1.0, 1.5, Item(1, 1)), (4.0, 5.0, Item(2, 1)), (8.0, 8.0, None),
    ]  # fmt: skip
    cut = legs.windows(first, second)
    assert [tuple(round(x, 3) for x in window) for window in cut] == [
        (0.0, 1.0, 0.0), (1.0, 4.0, 0.5), (4.0, 7.0, 1.0), (8.0, 10.0, 0.0),
    ], "as long as the shorter of the two is on its way"  # fmt: skip
    assert legs.windows(second, first)[-1].end == pytest.approx(10.0)
    assert legs.windows(FlightLog(written()), second) == ()


@pytest.mark.parametrize(("by", "told"), [(0.09, False), (0.11, True), (-0.11, True)])
def test_a_tenth_of_a_second_is_out_of_step(by: float, told: bool) -> None:
    found = legs.late([Step(1.0, 1.0, Item(1, 1)), Step(5.0, 5.0 + by, Item(2, 1)), Step(7.0, 9.0, None)])
    assert bool(found) == told
    assert all(f"item 2 0.1 s {'later' if by > 0.0 else 'earlier'}" in line for line in found)


# ---------------------------------------------------------------- quantities and states


def quantity(name: str, kind: str = "copter") -> streams.Quantity:
    return next(one for one in streams.QUANTITIES[kind] if one.name == name)


def values(log: FlightLog, name: str) -> Any:
    found = quantity(name).of(log)
    return None if found is None else found.values


def test_height_and_position_count_from_arming_and_rates_do_not(written: Log) -> None:
    log = FlightLog(written(("XKF1", 24_950_000, 0, 3.0, 4.0, -1.0, 6.0, 8.0, -2.5)))
    height, position = quantity("height").of(log), quantity("position").of(log)
    assert height is not None and position is not None
    k = int(np.searchsorted(height.time, 4.95 - 1e-6))
    assert height.values[k, 0] == pytest.approx(3.0), "2.5 m above the origin, armed 0.5 m below it"
    assert position.values[k] == pytest.approx([3.0, 4.0])
    assert values(log, "climb")[k, 0] == pytest.approx(1.0) and values(log, "speed")[k, 0] == pytest.approx(5.0)


@pytest.mark.parametrize(
    ("firmware", "metres"),
    [("ArduCopter V4.6.3 (abc)", 0.02), ("ArduCopter V4.7.0 (abc)", 2.0), ("ArduCopter V5.0.0 (abc)", 2.0)],
)
def test_accelerations_are_centimetres_before_4_7(
    written: Log, monkeypatch: pytest.MonkeyPatch, firmware: str, metres: float
) -> None:
    monkeypatch.setitem(FORMATS, "RATE", ("Qff", "TimeUS,A,ADes"))
    log = FlightLog(written(("RATE", 21_000_000, 2.0, 2.0), ("RATE", 22_000_000, 2.0, 2.0), firmware=firmware))
    assert values(log, "acceleration")[0, 0] == pytest.approx(metres)


def test_charge_counts_from_arming(written: Log, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(FORMATS, "BAT", ("QBfff", "TimeUS,Inst,Volt,Curr,CurrTot"))
    rows = [("BAT", t, i, 12.0 - i, 5.0, total) for t, i, total in (
        (19_000_000, 0, 10.0), (25_000_000, 0, 60.0), (25_000_000, 1, 999.0))]  # fmt: skip
    log = FlightLog(written(*rows))
    assert values(log, "consumed").tolist() == [[0.0], [50.0]]
    assert values(log, "voltage").tolist() == [[12.0], [12.0]], "of the first battery"
    assert values(FlightLog(written()), "voltage") is None is values(FlightLog(written()), "motors")


def test_motors_are_shares_of_their_pulses_in_the_order_of_their_numbers(
    written: Log, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(FORMATS, "RCOU", ("QHHHH", "TimeUS,C1,C2,C3,C4"))
    functions = [parameter(f"SERVO{n}_FUNCTION", 30.0 + k) for n, k in ((1, 4), (2, 3), (3, 6), (4, 5))]
    functions += [parameter("MOT_PWM_MIN", 1100.0), parameter("MOT_PWM_MAX", 1900.0)]
    rows = [("RCOU", t, 1100, 1500, 1900, 2100) for t in (21_000_000, 22_000_000)]
    log = FlightLog(written(*functions, *rows, without=("PARM",)))
    assert values(log, "motors")[0].tolist() == [50.0, 0.0, 100.0, 100.0]


def test_values_between_samples_lie_on_straight_lines() -> None:
    series = Series(np.array([0.0, 1.0, 3.0]), np.array([[0.0, 1.0], [2.0, 1.0], [2.0, 5.0]]))
    assert series.at(0.5) == [1.0, 1.0] and series.at(2.0) == [2.0, 3.0] and series.at(9.0) == [2.0, 5.0]
    assert [series.is_fresh(t) for t in (0.29, 0.31, -0.31, 3.2, 3.4)] == [True, False, False, True, False]
    assert not Series(np.empty(0), np.empty((0, 1))).is_fresh(0.0)


def test_a_state_needs_attitude_and_rates(written: Log, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(TwinError, match="has no ATT: its vehicle's attitude is not known"):
        LoggedState(FlightLog(written(without=("ATT",))))
    with pytest.raises(TwinError, match="has neither RATE nor IMU"):
        LoggedState(FlightLog(written()))
    monkeypatch.setitem(FORMATS, "RATE", ("Qfff", "TimeUS,R,P,Y"))
    rates = [("RATE", t, 10.0, -20.0, 30.0) for t in (21_000_000, 22_000_000)]
    state = LoggedState(FlightLog(written(*rates)))
    assert state.rates.at(1.0) == pytest.approx(np.radians([10.0, -20.0, 30.0]))
    assert state.start.tolist() == [3.0, 4.0, 0.5] and state.motors is None and state.position == [None] * 3
    assert state.attitude.at(1.0)[2] == pytest.approx(math.pi / 2) and state.asked is not None
    assert state.times.tolist() == pytest.approx([1.0, 2.0])


def test_rates_are_those_of_the_gyros_where_no_others_are_logged(written: Log, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(FORMATS, "IMU", ("QBfff", "TimeUS,I,GyrX,GyrY,GyrZ"))
    rows = [("IMU", t, i, 0.1 + i, 0.2, 0.3) for t in (21_000_000, 22_000_000) for i in (0, 1)]
    assert LoggedState(FlightLog(written(*rows))).rates.at(1.5) == pytest.approx([0.1, 0.2, 0.3])


def test_targets_of_the_position_controller_by_either_name(written: Log, monkeypatch: pytest.MonkeyPatch) -> None:
    """PSCN.DPN, DVN, DAN (desired) before TPN, TVN, TAN (target)."""
    monkeypatch.setitem(FORMATS, "IMU", ("QBfff", "TimeUS,I,GyrX,GyrY,GyrZ"))
    monkeypatch.setitem(FORMATS, "PSCN", ("Qffffff", "TimeUS,TPN,TVN,TAN,DPN,DVN,DAN"))
    monkeypatch.setitem(FORMATS, "PSCD", ("Qfff", "TimeUS,TPD,TVD,TAD"))
    imu = [("IMU", t, 0, 0.0, 0.0, 0.0) for t in (21_000_000, 22_000_000)]
    rows = [("PSCN", 21_000_000, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0), ("PSCD", 21_000_000, 7.0, 8.0, 9.0)]
    north, east, down = LoggedState(FlightLog(written(*imu, *rows))).position
    assert north is not None and down is not None and east is None
    assert north.at(1.0) == [4.0, 5.0, 6.0] and down.at(1.0) == [7.0, 8.0, 9.0]


@pytest.mark.parametrize("kind", ["copter", "rover"])
def test_what_is_asked_for_moves_by_as_much_as_what_comes_of_it(kind: str) -> None:
    asked = [one for one in streams.QUANTITIES[kind] if one.is_asked]
    assert len(asked) == {"copter": 3, "rover": 2}[kind]
    for one in asked:
        real = quantity(one.name.removeprefix("asked_"), kind)
        assert (one.moves, one.unit, one.turns) == (real.moves, real.unit, real.turns)


def test_directions_of_one_unit_move_by_as_much_as_each_other() -> None:
    assert quantity("height").moves == quantity("position").moves == quantity("position", "rover").moves == 0.3
    assert streams.THRUST.moves == quantity("acceleration").moves == 0.3
    assert len({quantity(name).moves for name in ("roll_rate", "pitch_rate", "yaw_rate")}) == 1
    assert quantity("roll").moves == quantity("pitch").moves == 0.5 * quantity("yaw").moves
