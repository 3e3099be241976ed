# SPDX-License-Identifier: BSD-3-Clause
"""Commands at the ends of what their parameters may be: NaN, infinity, the last value that is taken, the next one."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sitl.autopilot.aux_switch import LOW
from sitl.bridge.dialect import message
from sitl.bridge.services import command_table
from sitl.bridge.services.command import Entry, from_long
from sitl.bridge.services.mount import MountService
from tests.bridge.fakes import HOME, Bench, FakeRover, FakeVehicle
from tests.bridge.test_commands import command_int

ACCEPTED, REJECTED, DENIED, UNSUPPORTED, FAILED = range(5)
NAN, INF = math.nan, math.inf
HERE = HOME[:2]


@pytest.fixture
def located(bench: Bench) -> Bench:
    bench.vehicle.locate()
    return bench


@pytest.mark.parametrize(
    ("number", "params"),
    [
        (400, (1,)), (176, (1, 4)), (183, (9, 1500)), (181, (0, 1)), (182, (0, 1, 1)), (184, (9, 1500, 1, 1)),
        (246, (1,)), (420, (0, 0)), (510, (30,)), (511, (30, 100_000)), (512, (30,)), (520, (1,)), (2600, (0,)),
        (206, (0,)), (207, (1,)), (218, (9, 2)), (224, (0,)), (42007, (1,)), (42006, (90,)), (42429, (1,)),
        (42651, (1, 50)),
    ],
)  # fmt: skip
def test_a_parameter_that_a_command_needs_must_be_a_number(bench: Bench, number: int, params: Any) -> None:
    """NaN is MAVLink's "not given"; infinity is no value of any."""
    for k in range(len(params)):
        assert bench.command(number, *params[:k], NAN, *params[k + 1 :]) == DENIED
    assert bench.command(number, *params, *[INF] * (7 - len(params))) == DENIED
    assert bench.command(number, -INF) == DENIED
    assert not bench.autopilot.calls and not bench.vehicle.reboots


@pytest.mark.parametrize(
    ("kind", "number", "params", "needed"),
    [
        (FakeVehicle, 22, (0, 0, 0, 0, 0, 0, 10), {7}), (FakeVehicle, 84, (0, 0, 0, 0, 0, 0, 10), {7}),
        (FakeVehicle, 115, (90, 0, 0, 0), {1}), (FakeVehicle, 178, (1, 3), {1, 2}), (FakeVehicle, 185, (1,), {1}),
        (FakeVehicle, 193, (0,), {1}), (FakeVehicle, 195, (0, 0, 0, 0, -35, 149, 10), {5, 6, 7}),
        (FakeVehicle, 201, (0, 0, 0, 0, -35, 149, 10), {5, 6, 7}), (FakeVehicle, 208, (1,), {1}),
        (FakeVehicle, 209, (1, 0, 10, 2), {1, 2, 3, 4}), (FakeVehicle, 20, (), set()), (FakeVehicle, 21, (), set()),
        (FakeVehicle, 179, (0, 0, 0, 0, -35, 149, 600), {5, 6, 7}),
        (FakeRover, 178, (1, 3), {1, 2}), (FakeRover, 194, (1,), {1}), (FakeRover, 209, (1, 0, 10, 2), {1, 2, 3, 4}),
        (FakeRover, 218, (9, 2), {1, 2}),
    ],
)  # fmt: skip
def test_what_commands_of_a_firmware_need(kind: type[FakeVehicle], number: int, params: Any, needed: set[int]) -> None:
    """NaN, "not given", is DENIED in these and in no other."""
    given = [*params, *[0] * (7 - len(params))]
    for k in range(1, 8):
        bench = Bench(kind())
        bench.vehicle.locate()
        result = bench.command(number, *given[: k - 1], NAN, *given[k:])
        assert (result == DENIED) == (k in needed), k


@pytest.mark.parametrize(("number", "params"), [(400, (1,)), (176, (1, 4)), (300, ()), (410, ()), (520, (1,))])
def test_parameters_that_are_not_given_are_zero(located: Bench, number: int, params: Any) -> None:
    assert located.command(number, *params, *[NAN] * (7 - len(params))) == ACCEPTED


@pytest.mark.parametrize(
    ("number", "params", "result"),
    [
        (176, (255, 4), ACCEPTED), (176, (256, 4), DENIED), (176, (257, 4), DENIED), (176, (-1, 4), DENIED),
        (176, (128, 4), DENIED),  # no MAV_MODE_FLAG_CUSTOM_MODE_ENABLED
        (176, (1, 2.0**32), FAILED), (176, (1, 2.0**33), FAILED),
        (218, (9, 0), ACCEPTED), (218, (9, 1), ACCEPTED), (218, (9, 3), DENIED), (218, (9, -1), DENIED),
        (218, (9, 0.5), DENIED), (218, (9.5, 2), DENIED),
        (183, (9, 0), ACCEPTED), (183, (9, 3000), ACCEPTED), (183, (9, 3001), DENIED), (183, (9, -1), DENIED),
        (184, (9, 3000, 1, 1), ACCEPTED), (184, (9, 3001, 1, 1), DENIED), (184, (9, -1, 1, 1), DENIED),
        (184, (9, 1500, 32767, 1), ACCEPTED), (184, (9, 1500, 32768, 1), DENIED), (184, (9, 1500, -32768, 1), DENIED),
        (182, (0, 32768, 1), DENIED), (182, (0, -32768, 1), DENIED),
        (246, (1,), ACCEPTED), (246, (3,), ACCEPTED), (246, (0,), UNSUPPORTED), (246, (2,), UNSUPPORTED),
        (246, (4,), UNSUPPORTED),
        (300, (0, 1), DENIED), (300, (1, 0), DENIED),
        (400, (0.5,), UNSUPPORTED), (400, (-1,), UNSUPPORTED),
        (601, (0,), FAILED), (601, (65535,), FAILED), (601, (65536,), DENIED), (601, (-1,), DENIED),
        (42007, (1,), ACCEPTED), (42007, (3,), ACCEPTED), (42007, (0,), DENIED), (42007, (4,), DENIED),
        (42007, (1.5,), DENIED),
        (207, (0,), ACCEPTED), (207, (1,), ACCEPTED), (207, (2,), ACCEPTED), (207, (3,), FAILED), (207, (-1,), FAILED),
        (207, (0, 15), ACCEPTED), (207, (0, 16), FAILED), (207, (0, -1), FAILED),
        (2600, (0,), ACCEPTED), (2600, (1,), ACCEPTED), (2600, (-1,), FAILED),
        (520, (2,), FAILED), (32, (1,), ACCEPTED), (32, (255,), ACCEPTED), (32, (255.5,), DENIED),
        (5300, (0,), FAILED), (532, (1,), FAILED), (532, (3,), DENIED), (532, (6,), FAILED), (532, (7,), DENIED),
        (42701, (1,), DENIED), (42701, (3,), ACCEPTED), (42701, (4,), UNSUPPORTED), (42700, (0,), DENIED),
        (198, (), ACCEPTED), (197, (), ACCEPTED), (202, (), ACCEPTED), (203, (0, 0, 0, 0, 1), ACCEPTED),
        (204, (2,), FAILED), (205, (), FAILED), (1000, (), FAILED), (1001, (), FAILED), (211, (1, 1), FAILED),
        (216, (1,), ACCEPTED), (2000, (0, 0, 1), FAILED), (2000, (-1, 0, 1), UNSUPPORTED), (2001, (0,), ACCEPTED),
        (245, (1,), DENIED), (42428, (), ACCEPTED), (42651, (0, 50), ACCEPTED), (42651, (1, 50), ACCEPTED),
    ],
)  # fmt: skip
def test_ends_of_parameters(located: Bench, number: int, params: Any, result: int) -> None:
    assert located.command(number, *params) == result


def test_a_pulse_of_the_longest_kind_is_sent(bench: Bench) -> None:
    for pulse in (0, 3000):
        bench.command(183, 9, pulse)
    assert bench.autopilot.calls == [("set_servo", 9, 0), ("set_servo", 9, 3000)]


@pytest.mark.parametrize(("position", "level"), [(0, LOW), (1, LOW + 1), (2, LOW + 2)])
def test_a_function_of_a_switch_is_run_at_its_position(bench: Bench, position: int, level: int) -> None:
    assert bench.command(218, 41, position) == ACCEPTED
    assert bench.autopilot.calls == [("run_aux_function", 41, level)]


@pytest.mark.parametrize("armed", [0, 1])
def test_an_armed_vehicle_is_rebooted_by_force_alone(bench: Bench, armed: int) -> None:
    bench.vehicle.v.autopilot.arming.armed = armed
    assert bench.command(246, 1, 0, 0, 0, 0, 20190225) == (FAILED if armed else ACCEPTED)
    assert bench.command(246, 1, 0, 0, 0, 0, 20190226) == ACCEPTED
    assert bench.command(246, 3, 0, 0, 0, 0, 20190226) == ACCEPTED
    assert bench.vehicle.reboots == 3 - armed


def test_the_sets_of_sources_count_from_one(bench: Bench) -> None:
    for number in (1, 2, 3):
        bench.command(42007, number)
    assert bench.autopilot.calls == [("choose_sources", 0), ("choose_sources", 1), ("choose_sources", 2)]


def test_items_are_chosen_within_the_mission(bench: Bench) -> None:
    """DENIED beyond its end; p2 1 runs a complete mission again."""
    bench.autopilot.items = (1, 2, 3)
    assert [bench.command(224, seq) for seq in (0, 2, 3, -1)] == [ACCEPTED, ACCEPTED, DENIED, DENIED]
    resets: list[bool] = []
    bench.autopilot.set_current_item = lambda seq, reset=False: resets.append(reset) or True  # type: ignore[method-assign, func-returns-value]
    for p2 in (0, 1, 2):
        bench.command(224, 1, p2)
    assert resets == [False, True, False]


# ---------------------------------------------------------------- locations


@pytest.mark.parametrize(
    ("lat", "lon", "result"),
    [(900_000_000, 0, ACCEPTED), (-900_000_000, 0, ACCEPTED), (900_000_001, 0, FAILED), (-900_000_001, 0, FAILED),
     (1, 1_800_000_000, ACCEPTED), (1, -1_800_000_000, ACCEPTED), (1, 1_800_000_001, FAILED),
     (1, -1_800_000_001, FAILED)],
)  # fmt: skip
def test_the_ends_of_the_earth(located: Bench, lat: int, lon: int, result: int) -> None:
    assert command_int(located, 179, 0, lat, lon, 10.0) == result
    assert command_int(located, 201, 0, lat, lon, 10.0) == result


@pytest.mark.parametrize(("number", "denied"), [(192, DENIED), (611, DENIED)])
def test_locations_that_are_refused_before_the_command_is_run(located: Bench, number: int, denied: int) -> None:
    assert command_int(located, number, 0, 900_000_001, 0, 10.0) == denied
    assert command_int(located, number, 0, 1, 1_800_000_001, 10.0) == denied


@pytest.mark.parametrize(("alt", "result"), [(83_000.0, ACCEPTED), (-83_000.0, ACCEPTED), (83_001.0, DENIED),
                                             (-83_001.0, DENIED)])  # fmt: skip
def test_altitudes_that_ardupilot_keeps(located: Bench, alt: float, result: int) -> None:
    assert command_int(located, 179, 0, *HERE, alt) == result
    assert located.command(179, 0, 0, 0, 0, -35.0, 149.0, alt) == result


@pytest.mark.parametrize(("frame", "result"), [(0, ACCEPTED), (5, ACCEPTED), (3, ACCEPTED), (6, ACCEPTED), (1, DENIED),
                                               (2, DENIED), (8, DENIED), (12, DENIED)])  # fmt: skip
def test_frames_of_locations(located: Bench, frame: int, result: int) -> None:
    """MAV_FRAME: global ones, by the sea or by home, in both numberings."""
    for number in (179, 195):
        assert command_int(located, number, frame, *HERE, 10.0) == result
    found = command_int(located, 192, frame, *HERE, 10.0, -1, 1)
    assert found == result


@pytest.mark.parametrize(
    ("p2", "mode", "result"),
    [(1, 0, ACCEPTED), (3, 0, ACCEPTED), (0, 0, DENIED), (2, 0, DENIED), (-1, 0, DENIED), (2.0**31, 0, DENIED),
     (0, 4, ACCEPTED), (1, 4, ACCEPTED)],
)  # fmt: skip
def test_a_reposition_in_another_mode_needs_the_bit_that_changes_it(
    located: Bench, p2: float, mode: int, result: int
) -> None:
    """MAV_DO_REPOSITION_FLAGS_CHANGE_MODE, 1."""
    located.vehicle.v.autopilot.modes.number = mode
    assert command_int(located, 192, 0, *HERE, 600.0, -1, p2) == result
    assert located.autopilot.mode() == (4 if result == ACCEPTED else mode)


@pytest.mark.parametrize(("speed", "asked"), [(-1.0, []), (0.0, []), (2.5, [("change_reposition_speed", 2.5)])])
def test_the_speed_of_a_reposition(located: Bench, speed: float, asked: list[Any]) -> None:
    located.vehicle.v.autopilot.modes.number = 4
    assert command_int(located, 192, 0, *HERE, 600.0, speed, 0) == ACCEPTED
    assert [c for c in located.autopilot.calls if c[0] == "change_reposition_speed"] == asked
    located.autopilot.ok = False
    assert command_int(located, 192, 0, *HERE, 600.0, speed, 0) == FAILED


def test_nowhere_is_no_location_to_fly_to(located: Bench) -> None:
    assert command_int(located, 192, 0, 0, 0, 600.0, -1, 1) == DENIED
    assert located.autopilot.calls == []


def test_home_by_p1_is_here_and_by_a_location_there(located: Bench) -> None:
    assert located.command(179, 1, 0, 0, 0, 10.0, 20.0, 30.0) == ACCEPTED
    assert located.command(179, 0, 0, 0, 0, 10.0, 20.0, 30.0) == ACCEPTED
    assert located.command(179, 0.5, 0, 0, 0, 10.0, 20.0, 30.0) == FAILED
    assert located.command(179, 0, 0, 0, 0, 0.0, 0.0, 30.0) == ACCEPTED
    calls = [c for c in located.autopilot.calls if c[0].startswith("set_home")]
    assert calls == [("set_home_here",), ("set_home", 100_000_000, 200_000_000, 30.0), ("set_home_here",)]


def test_an_origin_is_set_once(located: Bench) -> None:
    assert command_int(located, 611, 0, *HERE, 10.0) == FAILED
    located.vehicle.v.autopilot.estimate.origin_set = False
    assert command_int(located, 611, 0, *HERE, 10.0) == ACCEPTED
    assert command_int(located, 611, 0, 0, 1, 10.0) == ACCEPTED, "on the equator"


def test_checks_before_arming_are_not_made_in_flight(bench: Bench) -> None:
    assert bench.command(401) == ACCEPTED and bench.autopilot.calls == [("run_prearm_checks",)]
    bench.vehicle.v.autopilot.arming.armed = 1
    assert bench.command(401) == REJECTED and len(bench.autopilot.calls) == 1


def test_home_is_told_where_there_is_one(bench: Bench) -> None:
    assert bench.command(410) == FAILED
    bench.vehicle.locate()
    assert bench.command(410) == ACCEPTED


@pytest.mark.parametrize(
    ("params", "result"),
    [
        ((0, 0, 0, 0), FAILED),  # where it is: nobody knows
        ((0, 0, 47.0, 8.0), ACCEPTED), ((0, 0, 90.0, 180.0), ACCEPTED), ((0, 0, -90.0, -180.0), ACCEPTED),
        ((0, 0, 90.1, 8.0), FAILED), ((0, 0, 47.0, 180.1), FAILED), ((0, 0, 0.0, 8.0), ACCEPTED),
        ((0, 7, 47.0, 8.0), ACCEPTED), ((0, 8, 47.0, 8.0), FAILED), ((0, -1, 47.0, 8.0), FAILED),
    ],
)  # fmt: skip
def test_compasses_by_a_heading_need_a_location(bench: Bench, params: Any, result: int) -> None:
    assert bench.command(42006, *params) == result


@pytest.mark.parametrize(("mask", "found"), [(0, (True, True, True)), (2, (False, True, False))])
def test_compasses_by_a_heading_are_those_of_the_mask(bench: Bench, mask: int, found: tuple[bool, ...]) -> None:
    """One that shows nothing is off by all of the field."""
    assert bench.command(42006, 90, mask, 47.0, 8.0) == ACCEPTED
    offsets = [bench.vehicle.parameters[f"COMPASS_OFS{n}_Z"] for n in ("", "2", "3")]
    assert tuple(abs(offset) > 300.0 for offset in offsets) == found


@pytest.mark.parametrize(
    ("frame", "z", "result"),
    [(0, NAN, FAILED), (5, NAN, FAILED), (0, 10.0, DENIED), (0, 0.0, DENIED), (3, NAN, DENIED), (6, NAN, DENIED)],
)
def test_an_external_position_has_no_altitude(located: Bench, frame: int, z: float, result: int) -> None:
    """MAV_CMD_EXTERNAL_POSITION_ESTIMATE; the estimator has a receiver, and does not take it."""
    assert command_int(located, 43003, frame, *HERE, z) == result
    assert located.autopilot.calls == []


class Mount:
    """Keeps what it was asked for."""

    def __init__(self) -> None:
        self.asked: list[tuple[Any, ...]] = []

    def look_at(self, *location: float) -> None:
        self.asked.append(location)

    def look_ahead(self) -> None:
        self.asked.append(())


@pytest.mark.parametrize("number", [195, 201])
@pytest.mark.parametrize(
    ("frame", "location", "result", "asked"),
    [
        (0, (*HERE, 600.0), ACCEPTED, [(*HERE, 600.0)]), (5, (*HERE, 600.0), ACCEPTED, [(*HERE, 600.0)]),
        (3, (*HERE, 10.0), ACCEPTED, [(*HERE, HOME[2] + 10.0)]),
        (6, (*HERE, 10.0), ACCEPTED, [(*HERE, HOME[2] + 10.0)]),
        (10, (*HERE, 10.0), ACCEPTED, [(*HERE, HOME[2] + 10.0)]),  # a plain, as nobody knows the ground
        (0, (0, 0, 0.0), ACCEPTED, [()]), (0, (1, 0, 0.0), ACCEPTED, [(1, 0, 0.0)]),
        (0, (0, 1, 0.0), ACCEPTED, [(0, 1, 0.0)]), (0, (0, 0, 1.0), ACCEPTED, [(0, 0, 1.0)]),
        (0, (900_000_000, -1_800_000_000, 1.0), ACCEPTED, [(900_000_000, -1_800_000_000, 1.0)]),
        (0, (900_000_001, 0, 1.0), FAILED, []), (0, (0, 1_800_000_001, 1.0), FAILED, []),
        (1, (*HERE, 10.0), DENIED, []), (8, (*HERE, 10.0), DENIED, []),
    ],
)  # fmt: skip
def test_a_rovers_gimbal_looks_at_a_location_or_ahead_again(
    number: int, frame: int, location: Any, result: int, asked: Any
) -> None:
    bench = Bench(FakeRover())
    bench.vehicle.locate()
    mount: Any = Mount()
    bench.bridge.services[MountService] = mount
    assert command_int(bench, number, frame, *location) == result
    assert mount.asked == asked


def test_over_ground_of_unknown_height_it_looks_nowhere(monkeypatch: pytest.MonkeyPatch) -> None:
    bench = Bench(FakeRover())
    bench.vehicle.locate()
    mount: Any = Mount()
    bench.bridge.services[MountService] = mount
    monkeypatch.setattr(bench.bridge.locations, "_ground", lambda lat, lon: None)
    assert command_int(bench, 195, 10, *HERE, 10.0) == FAILED and mount.asked == []


@pytest.mark.parametrize("speed", [0.0, -1.0, 2.0])
def test_a_reposition_without_a_speed_asks_for_none(located: Bench, speed: float) -> None:
    located.vehicle.v.autopilot.modes.number = 4
    assert command_int(located, 192, 3, *HERE, 10.0, speed, 1.0) == ACCEPTED
    asked = [call[1:] for call in located.autopilot.calls if call[0] == "change_reposition_speed"]
    assert asked == ([(speed,)] if speed > 0.0 else [])


def test_a_reposition_at_a_speed_that_is_refused_fails_and_goes_nowhere(located: Bench) -> None:
    located.vehicle.v.autopilot.modes.number = 4
    located.autopilot.change_reposition_speed = lambda speed: False  # type: ignore[attr-defined]
    assert command_int(located, 192, 3, *HERE, 10.0, 2.0, 1.0) == FAILED
    assert not [call for call in located.autopilot.calls if call[0] == "guided_position"]


def test_a_reposition_needs_an_altitude(located: Bench) -> None:
    assert command_int(located, 192, 3, *HERE, NAN, -1.0, 1.0) == DENIED and not located.autopilot.calls


@pytest.mark.parametrize(
    ("params", "asked"),
    [
        ((0, 0), (False, 15)), ((0, 1), (False, 1)), ((0, 2), (False, 2)), ((0, 15), (False, 15)), ((1, 0), (True, 15)),
    ],
)  # fmt: skip
def test_fences_are_switched_one_by_one_or_all(
    located: Bench, params: Any, asked: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Bits as of FENCE_TYPE; 0 means all."""
    done: list[Any] = []
    monkeypatch.setattr(command_table, "switch_by_user", lambda fence, on, which, *rest: done.append((on, which)))
    assert located.command(207, *params) == ACCEPTED and done == [asked]


def test_a_reposition_needs_guided(located: Bench) -> None:
    located.autopilot.set_mode = lambda number: False  # type: ignore[method-assign]
    assert command_int(located, 192, 3, *HERE, 10.0, -1.0, 1.0) == FAILED
    assert not [call for call in located.autopilot.calls if call[0] == "guided_position"]


@pytest.mark.parametrize(
    ("params", "result"),
    [
        ((1, 2), ACCEPTED), ((1, 4), FAILED), ((1, 6), ACCEPTED), ((0, 4), ACCEPTED), ((2, 0), ACCEPTED),
        ((2, 4), FAILED), ((2.5, 0), FAILED), ((-0.5, 0), FAILED), ((1, 16), FAILED), ((1, -1), FAILED),
        ((0.5, 4), ACCEPTED),
    ],
)  # fmt: skip
def test_a_fence_that_there_is_not_is_not_switched_on(located: Bench, params: Any, result: int) -> None:
    """FENCE_TYPE 3: height and circle."""
    located.vehicle.parameters.update({"FENCE_TYPE": 3.0})
    assert located.command(207, *params) == result


@pytest.mark.parametrize(
    ("place", "taken"),
    [
        ((90.0, 180.0, 83_000.0), True), ((-90.0, -180.0, -83_000.0), True), ((90.1, 0.0, 0.0), False),
        ((-90.1, 0.0, 0.0), False), ((0.0, 180.1, 0.0), False), ((0.0, -180.1, 0.0), False),
        ((0.0, 0.0, 83_001.0), False), ((0.0, 0.0, -83_001.0), False),
    ],
)  # fmt: skip
@pytest.mark.parametrize("off_earth", [False, True])
def test_locations_in_degrees_are_on_earth(place: Any, taken: bool, off_earth: bool) -> None:
    """Of commands that leave it to the protocol; the others answer such a location by themselves."""
    kind = message("COMMAND_LONG")
    fields = kind.decode(kind.payload(command=179, param5=place[0], param6=place[1], param7=place[2]))
    entry = Entry(lambda *what: ACCEPTED, has_location=True, off_earth=off_earth)
    found = from_long(fields, entry)
    assert (found is not None) == (taken or (off_earth and abs(place[2]) < 83_000.5))
    if found is not None:
        assert (found.lat, found.lon) == tuple(round(1e7 * float(np.float32(degrees))) for degrees in place[:2])
