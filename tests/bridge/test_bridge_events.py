# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from sitl.autopilot import events
from sitl.autopilot.arming_checks import ARMED, DISARMED
from sitl.autopilot.estimation.estimator_events import EKF_ORIGIN_SET
from sitl.autopilot.events import EVENT_RING
from sitl.autopilot.hits import HIT_GROUND
from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.mission.notes import OutputItem
from sitl.autopilot.modes import MODE_CHANGED
from sitl.autopilot.notes import ChecksFailed, CurrentChanged, ItemReached, ParametersFound, Switched, Text
from sitl.bridge.services.statustext import StatusTextService
from tests.bridge.fakes import Bench


def emit(bench: Bench, code: int, a: float = 0.0, b: float = 0.0) -> None:
    v = bench.vehicle.v
    events.emit(v.autopilot.events, int(v.time_us), code, a, b)


def texts(bench: Bench) -> list[str]:
    return [m.text for m in bench.client.receive("STATUSTEXT")]


def test_texts_of_a_flight(bench: Bench) -> None:
    bench.run(3.0)
    assert texts(bench) == ["Barometer 1 calibration complete", "ArduPilot Ready"]
    emit(bench, ARMED)
    emit(bench, HIT_GROUND, 0.499648)
    emit(bench, DISARMED)
    bench.run(0.1)
    assert texts(bench) == ["Arming motors", "SIM Hit ground at 0.499648 m/s", "Disarming motors"]
    bench.run(1.0)
    assert texts(bench) == []


def test_a_full_ring_loses_the_oldest_only(bench: Bench) -> None:
    bench.run(3.0)
    texts(bench)
    for _ in range(EVENT_RING + 10):
        emit(bench, ARMED)
    bench.run(0.1)
    assert len(texts(bench)) == EVENT_RING


def test_origin_and_home_are_told_when_they_come(bench: Bench) -> None:
    bench.vehicle.locate()
    emit(bench, EKF_ORIGIN_SET)
    bench.run(0.1)
    found = bench.client.receive()
    assert {"HOME_POSITION", "GPS_GLOBAL_ORIGIN"} <= {m.get_type() for m in found}
    assert "Field Elevation Set: 584m" in [m.text for m in found if m.get_type() == "STATUSTEXT"]


def test_a_mode_change_is_told_by_a_heartbeat_at_once(bench: Bench) -> None:
    bench.run(1.0)
    bench.client.receive()
    bench.vehicle.v.autopilot.modes.number = 6
    emit(bench, MODE_CHANGED, 6.0)
    bench.bridge.on_events()
    bench.bridge.flush()
    assert [m.custom_mode for m in bench.client.receive("HEARTBEAT")] == [6]


def test_progress_of_a_mission(bench: Bench) -> None:
    bench.bridge.report([ItemReached(3), Text(6, "Reached command #3"), CurrentChanged(4)])
    bench.bridge.flush()
    found = bench.client.receive()
    assert [m.get_type() for m in found] == ["MISSION_ITEM_REACHED", "STATUSTEXT", "MISSION_CURRENT"]
    assert found[0].seq == 3


def test_long_texts_come_in_pieces(bench: Bench) -> None:
    old = bench.connect(version=1)
    say = bench.bridge.get(StatusTextService).say
    for length in (1, 49, 50, 51, 100, 120):
        bench.bridge.channels[1].port.version = 1
        say(4, "x" * length)
        bench.bridge.flush()
        pieces = bench.client.receive("STATUSTEXT")
        assert "".join(p.text for p in pieces) == "x" * length
        assert [p.chunk_seq for p in pieces] == list(range(len(pieces)))
        assert (pieces[0].id != 0) == (length > 50)
        assert len(pieces[-1].text) < 50 or length == 50
        (first,) = old.receive("STATUSTEXT")
        assert first.text == "x" * min(length, 50)


def test_each_note_is_passed_on_to_whom_it_is_for(bench: Bench) -> None:
    bench.run(3.0)
    bench.client.receive()
    item = MissionItem(181, p1=1.0, p2=1.0)
    done: list[Any] = []
    bench.bridge.carry_out = done.append  # type: ignore[method-assign]
    bench.bridge.switched = lambda *what: done.append(what)  # type: ignore[method-assign]
    bench.bridge.keep_parameters = done.append  # type: ignore[method-assign]
    bench.bridge.autopilot.refusal_texts = lambda failed: [f"Arm: {failed}", "Arm: other"]  # type: ignore[method-assign]
    bench.bridge.report([OutputItem(item), Switched(9, 2), ParametersFound(("A", "B")), ChecksFailed(5), Text(6, "x")])
    assert done == [item, (9, 2), ("A", "B")]
    said = [(m.severity, m.text) for m in bench.client.receive("STATUSTEXT")]
    assert said == [(2, "Arm: 5"), (2, "Arm: other"), (6, "x")]


@pytest.mark.parametrize("is_sent", [True, False])
def test_an_item_that_only_logs_have_is_told_to_listeners_alone(bench: Bench, is_sent: bool) -> None:
    reached: list[int] = []
    bench.bridge.listeners = [SimpleNamespace(reached=reached.append)]  # type: ignore[assignment, list-item]
    bench.client.receive()
    bench.bridge.report([ItemReached(3, is_sent)])
    assert [m.seq for m in bench.client.receive("MISSION_ITEM_REACHED")] == ([3] if is_sent else [])
    assert reached == [3]


def test_parameters_that_the_firmware_has_found_are_kept(bench: Bench) -> None:
    bench.client.receive()
    bench.vehicle.v.autopilot.params["MOT_THST_HOVER"] = 0.25
    bench.bridge.keep_parameters(("MOT_THST_HOVER",))
    assert bench.vehicle.parameters["MOT_THST_HOVER"] == 0.25
    bench.run(0.1)
    assert [(m.param_id, m.param_value) for m in bench.client.receive("PARAM_VALUE")] == [("MOT_THST_HOVER", 0.25)]
