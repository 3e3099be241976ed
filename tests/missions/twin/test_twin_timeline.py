# SPDX-License-Identifier: BSD-3-Clause
"""What a twin is given, and when, before anything flies: sticks between samples, modes with patience, a battery."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sitl.autopilot.mission.item import MissionItem
from sitl.missions.twin.agreement import Window
from sitl.missions.twin.flight_log import FlightLog
from sitl.missions.twin.inputs import Inputs, Message, Mode, Wind
from sitl.missions.twin.log_flight import Change, Segments, TwinFlight
from sitl.simulation import Core, Simulation
from tests.missions.twin.conftest import FORMATS, Log

Made = Callable[..., TwinFlight]


@pytest.fixture(scope="module")
def simulation(core: Core) -> Iterator[Simulation]:
    """A copter that nobody lets fly."""
    made = Simulation("erle_copter", core=core)
    yield made
    made.close()


@pytest.fixture
def twin(written: Log, simulation: Simulation, tmp_path: Path) -> Made:
    def make(
        inputs: Inputs | None = None, *rows: Any, changes: Any = (), change: Change | None = None, segments: Any = None
    ) -> TwinFlight:
        log = FlightLog(written(*rows))
        return TwinFlight(
            log, inputs or Inputs(), changes, simulation, tmp_path / "twin.bin", change or Change(), segments
        )  # fmt: skip

    return make


def sticks(*samples: tuple[float, tuple[float, ...]]) -> Inputs:
    return Inputs(sticks=(np.array([t for t, _ in samples]), np.array([row for _, row in samples])))


def test_sticks_move_evenly_and_switches_at_once(twin: Made) -> None:
    """The first four channels are sticks."""
    found = twin(sticks((0.0, (1000, 2000, 1500, 1500, 1100)), (1.0, (2000, 1000, 1500, 1500, 1900))))
    assert found._pulses(0.25) == [1250, 1750, 1500, 1500, 1100]
    assert found._pulses(1.0) == [2000, 1000, 1500, 1500, 1900]
    assert found._pulses(-5.0) == [1000, 2000, 1500, 1500, 1100] and found._pulses(9.0)[4] == 1900
    assert twin()._pulses(0.0) == []


def test_a_receiver_is_heard_every_twentieth_of_a_second_while_something_moves(twin: Made) -> None:
    found = twin(sticks((0.0, (1000,)), (0.1, (1100,)), (0.2, (1100,)), (0.21, (1200,)), (3.0, (1300,))))
    times = [t for (t,) in found._stick_times()]
    assert times[:5] == pytest.approx([0.02, 0.04, 0.06, 0.08, 0.1])
    assert times[5] == pytest.approx(0.21), "at once where samples are nearer to each other"
    assert len(times) == 6 + 50, "of a gap its first fifty frames alone"
    assert twin()._stick_times() == []


def acts(found: TwinFlight) -> list[float]:
    """Times of all that is done [s]."""
    return [round(1e-6 * time_us, 4) for time_us, _ in found._timeline()]


def test_what_is_done_comes_in_time_and_ends_with_the_flight(twin: Made) -> None:
    items = (MissionItem(16, 0), MissionItem(22, 3))
    inputs = Inputs(
        missions=[(0.0, items), (4.0, items)], wind=[Wind(2.0, 3.0, 90.0)],
        messages=[Message(1.0, "HEARTBEAT", {}), Message(10.0, "HEARTBEAT", {}), Message(10.001, "HEARTBEAT", {})],
        modes=[Mode(-1.0, 5, True), Mode(3.0, 4, True), Mode(5.0, 6, False)],
    )  # fmt: skip
    found = twin(inputs, changes=[(7.0, "WPNAV_SPEED", 300.0), (8.0, "RTL_ALT", 900.0)])
    assert acts(found) == [1.0, 2.0, 3.0, 4.0, 6.0, 7.0, 8.0, 10.0]
    changed = Change(params={"RTL_ALT": 500.0}, wind=(5.0, 0.0))
    found = twin(inputs, changes=[(7.0, "WPNAV_SPEED", 300.0), (8.0, "RTL_ALT", 900.0)], change=changed)
    assert acts(found) == [1.0, 3.0, 4.0, 6.0, 7.0, 10.0], "another wind and value hold all the time"


def test_what_was_there_at_arming_is_not_done_again(twin: Made) -> None:
    inputs = Inputs(messages=[Message(t, "HEARTBEAT", {}) for t in (0.0, 0.0025, 0.003)])
    assert acts(twin(inputs)) == [0.003], "after the first tick"


def test_of_one_time_missions_come_before_parameters_modes_and_messages(twin: Made) -> None:
    done: list[str] = []
    inputs = Inputs(
        missions=[(2.0, (MissionItem(16, 0),))], wind=[Wind(2.0, 3.0, 90.0)],
        modes=[Mode(-1.0, 5, True), Mode(2.0, 4, True)], messages=[Message(2.0, "HEARTBEAT", {})],
        sticks=(np.array([1.99, 2.0]), np.array([[1500.0], [1600.0]])),
    )  # fmt: skip
    found: Any = twin(inputs, changes=[(2.0, "RTL_ALT", 900.0)])
    found._upload = lambda items: done.append("mission")
    found._set = lambda name, value: done.append("parameter")
    found._follow_wind = lambda wind: done.append("wind")
    found._follow_mode = lambda mode: done.append("mode")
    found._send = lambda message: done.append("message")
    found._hear = lambda pulses: done.append("sticks")
    for _, act in found._timeline():
        act()
    assert done == ["mission", "parameter", "wind", "mode", "message", "sticks"]


def test_open_segments_begin_in_order_and_rotors_are_driven_in_between(twin: Made, monkeypatch: Any) -> None:
    from sitl.missions.twin import log_flight

    monkeypatch.setattr(log_flight, "LoggedState", lambda log: None)
    windows = (Window(1.0, 1.1), Window(1.05, 1.11))
    found = twin(segments=Segments(windows))
    assert found._segment_times() == [(1.0, windows[0]), (1.05, windows[1])]
    driven = twin(segments=Segments(windows, driven=True))
    times = [(round(t, 4), window is None) for t, window in driven._segment_times()]
    assert times == [
        (1.0, False), (1.02, True), (1.04, True), (1.05, False), (1.06, True), (1.08, True), (1.1, True),
    ]  # fmt: skip
    assert twin()._segment_times() == []


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (Change(), []),
        (Change(params={"RTL_ALT": 900.0}), ["RTL_ALT = 900"]),
        (Change(wind=(5.0, 270.0), mass="+0.5"), ["wind of 5 m/s from 270 deg", "mass +0.5 kg"]),
        (Change(faults=("gps@3", "motor:1")), ["fault gps@3", "fault motor:1"]),
    ],
)
def test_what_is_otherwise_in_words(change: Change, words: list[str]) -> None:
    assert change.words == words


def test_the_mode_that_the_logs_vehicle_was_in(twin: Made) -> None:
    found = twin(Inputs(modes=[Mode(-1.0, 5, True), Mode(3.0, 4, True), Mode(5.0, 6, False)]))
    assert [found._mode_then(t) for t in (0.0, 2.9, 3.0, 4.9, 5.0, 9.0)] == [5, 5, 4, 4, 6, 6]


def test_a_mode_that_the_logs_vehicle_took_by_itself_is_told_a_second_later_and_noted(
    twin: Made, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[int] = []
    monkeypatch.setattr(TwinFlight, "_ask_mode", lambda self, number: asked.append(number))
    found = twin(Inputs(modes=[Mode(-1.0, 5, True), Mode(8.5, 6, False)]))
    monkeypatch.setattr(found, "station", SimpleNamespace(armed=True), raising=False)
    found._follow_mode(Mode(8.5, 6, False))
    assert asked == [6]
    assert found.notes == ["7.5 s: the log's vehicle went into RTL by itself; the twin was told to"]
    found._follow_mode(Mode(9.0, 4, True))
    assert asked == [6, 4] and len(found.notes) == 1, "a pilot's own choice needs no note"
    found._follow_mode(Mode(9.0, 9, False))
    assert asked == [6, 4], "it has left that again"
    monkeypatch.setattr(found, "station", SimpleNamespace(armed=False))
    found._follow_mode(Mode(9.0, 4, True))
    assert asked == [6, 4], "nobody flies"


# ---------------------------------------------------------------- the battery


def charged(twin: Made, simulation: Simulation, volt: float, amps: float = 0.0) -> tuple[float, float, list[str]]:
    """Charge and full voltage after a log with this BAT at arming, and what is said."""
    battery = simulation.v.physics.battery
    before = float(battery.charge), float(battery.full_voltage)
    found = twin(None, ("BAT", 19_900_000, 0, volt, amps), ("BAT", 25_000_000, 0, 1.0, 99.0))
    try:
        found._charge()
        found._charge()
        return float(battery.charge), float(battery.full_voltage), found.notes
    finally:
        battery.charge, battery.full_voltage = before


@pytest.fixture
def with_battery(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(FORMATS, "BAT", ("QBff", "TimeUS,Inst,Volt,Curr"))


def test_the_battery_has_the_rest_voltage_of_the_logs(twin: Made, simulation: Simulation, with_battery: None) -> None:
    value = simulation.airframe.value
    full, resistance = float(value("battery_voltage_full")), float(value("battery_resistance"))
    assert float(value("battery_capacity")) > 0.0
    most, volts, notes = charged(twin, simulation, full)
    assert most == pytest.approx(1.0) and volts == 0.0 and notes == [], "0: the airframe's own"
    half, *_ = charged(twin, simulation, 0.93 * full)
    less, *_ = charged(twin, simulation, 0.92 * full)
    assert 0.0 < less < half < 1.0
    loaded, *_ = charged(twin, simulation, 0.93 * full - 10.0 * resistance, 10.0)
    assert loaded == pytest.approx(half), "without what the load takes"
    charging, *_ = charged(twin, simulation, 0.93 * full, -10.0)
    assert charging == pytest.approx(half)


@pytest.mark.parametrize("share", [1.2, 0.5])
def test_another_battery_is_one_of_its_voltage_and_is_told_once(
    twin: Made, simulation: Simulation, with_battery: None, share: float
) -> None:
    full = float(simulation.airframe.value("battery_voltage_full"))
    charge, volts, notes = charged(twin, simulation, share * full)
    assert charge == 1.0 and volts == pytest.approx(share * full)
    assert notes == [f"the battery is one of {share * full:.1f} V, which that of the airframe never has"]


@pytest.mark.parametrize("volt", [0.0, 1.0, float("nan")])
def test_a_voltage_that_is_none_changes_nothing(
    twin: Made, simulation: Simulation, with_battery: None, volt: float
) -> None:
    battery = simulation.v.physics.battery
    before = float(battery.charge), float(battery.full_voltage)
    assert charged(twin, simulation, volt) == (*before, [])
