# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from tests.bridge.fakes import HOME, Bench

POSITION, VELOCITY, ACCELERATION, POS_VEL = 0xDF8, 0xDC7, 0xC3F, 0xDC0


@pytest.fixture
def guided(bench: Bench) -> Bench:
    bench.vehicle.locate()
    bench.vehicle.v.autopilot.modes.number = 4
    estimate = bench.vehicle.v.autopilot.estimate
    estimate.euler, estimate.pos = (0.0, 0.0, math.pi / 2), (100.0, 200.0, -10.0)
    return bench


def local(
    mask: int,
    frame: int = 1,
    p: Any = (1, 2, -3),
    v: Any = (4, 5, 6),
    a: Any = (7, 8, 9),
    yaw: Any = (0.5, 0.25),
) -> Any:
    return mavlink.MAVLink_set_position_target_local_ned_message(0, 1, 1, frame, mask, *p, *v, *a, *yaw)


def call(bench: Bench, message: Any) -> tuple[Any, ...]:
    """What the autopilot was asked to do by one set-point."""
    bench.autopilot.calls.clear()
    assert bench.ask(message) == []
    assert len(bench.autopilot.calls) <= 1
    return tuple(bench.autopilot.calls[0]) if bench.autopilot.calls else ()


def test_kinds(guided: Bench) -> None:
    no_yaw = (False, 0.0, False, 0.0, False)
    assert call(guided, local(POSITION)) == ("guided_position", (1, 2, -3), no_yaw)
    assert call(guided, local(VELOCITY)) == ("guided_velocity", (4, 5, 6), (0, 0, 0), no_yaw)
    assert call(guided, local(0xC07)) == ("guided_velocity", (4, 5, 6), (7, 8, 9), no_yaw)
    assert call(guided, local(POS_VEL)) == (
        "guided_position_velocity",
        (1, 2, -3),
        (4, 5, 6),
        (0, 0, 0),
        no_yaw,
    )
    assert call(guided, local(0xC00)) == (
        "guided_position_velocity",
        (1, 2, -3),
        (4, 5, 6),
        (7, 8, 9),
        no_yaw,
    )
    assert call(guided, local(ACCELERATION)) == ("guided_acceleration", (7, 8, 9), no_yaw)


def test_mavsdk_masks(guided: Bench) -> None:
    assert call(guided, local(2503)) == (
        "guided_velocity",
        (4, 5, 6),
        (0, 0, 0),
        (True, 0.5, False, 0.25, False),
    )
    assert call(guided, local(2552))[0] == "guided_position"
    name, velocity, _, yaw = call(guided, local(1479, frame=8))
    assert name == "guided_velocity" and velocity == pytest.approx((-5.0, 4.0, 6.0))
    assert yaw == (False, 0.5, True, 0.25, True)


@pytest.mark.parametrize(("frame", "place"), [
    (1, (1, 2, -3)), (7, (101, 202, -13)), (8, (98, 201, -13)), (9, (98, 201, -13))
])  # fmt: skip
def test_local_frames(guided: Bench, frame: int, place: tuple[float, ...]) -> None:
    assert call(guided, local(POSITION, frame))[1] == pytest.approx(place)


@pytest.mark.parametrize("message", [
    local(POSITION, frame=0), local(POSITION, frame=12), local(0xFFF), local(0xC38),
    local(VELOCITY, v=(math.nan, 0, 0)), local(POSITION, p=(0, math.inf, 0)), local(2503, yaw=(math.nan, 0)),
])  # fmt: skip
def test_what_cannot_be_flown_stops(guided: Bench, message: Any) -> None:
    assert call(guided, message) == ("guided_stop",)


def test_numbers_that_are_ignored_may_be_anything(guided: Bench) -> None:
    bad = (math.nan,) * 3
    assert call(guided, local(POSITION, v=bad, a=bad, yaw=bad[:2]))[0] == "guided_position"


def test_a_force_is_not_flown(guided: Bench) -> None:
    assert call(guided, local(ACCELERATION | 0x200)) == ()


@pytest.mark.parametrize("mode", [0, 3, 5, 6, 9])
def test_other_modes_ignore_set_points(guided: Bench, mode: int) -> None:
    guided.vehicle.v.autopilot.modes.number = mode
    assert call(guided, local(POSITION)) == ()
    assert call(guided, mavlink.MAVLink_set_attitude_target_message(0, 1, 1, 0, [1, 0, 0, 0], 0, 0, 0, 0.5)) == ()


@pytest.mark.parametrize(("frame", "z"), [(0, 594.0), (5, 594.0), (3, 10.0), (6, 10.0), (10, 10.0), (11, 10.0)])
def test_global_frames(guided: Bench, frame: int, z: float) -> None:
    message = mavlink.MAVLink_set_position_target_global_int_message(
        0, 1, 1, frame, POSITION, HOME[0] + 1000, HOME[1], z, 0, 0, 0, 0, 0, 0, 0, 0
    )
    name, place, _ = call(guided, message)
    assert name == "guided_position" and place == pytest.approx((11.132, 0.0, -10.0), abs=0.01)


def test_global_places_that_do_not_exist(guided: Bench) -> None:
    def at(frame: int, lat: int, alt: float) -> Any:
        return mavlink.MAVLink_set_position_target_global_int_message(
            0, 1, 1, frame, POSITION, lat, HOME[1], alt, 0, 0, 0, 0, 0, 0, 0, 0
        )

    assert call(guided, at(1, HOME[0], 10.0)) == ("guided_stop",)
    assert call(guided, at(6, HOME[0], math.nan)) == ("guided_stop",)
    assert call(guided, at(6, 2_000_000_000, 10.0)) == ()


def test_attitude(guided: Bench) -> None:
    def target(mask: int, q: Any = (2, 0, 0, 0), thrust: float = 0.5) -> Any:
        return mavlink.MAVLink_set_attitude_target_message(0, 1, 1, mask, list(q), 0.1, 0.2, 0.3, thrust)

    name, q, rates, thrust = call(guided, target(7))
    assert (name, q, rates, thrust) == ("guided_attitude", (1, 0, 0, 0), (0, 0, 0), 0.5)
    name, q, rates, _ = call(guided, target(128))
    assert q is None and rates == pytest.approx((0.1, 0.2, 0.3))
    assert call(guided, target(7 | 64)) == ()
    for bad in (target(0, (0, 0, 0, 0)), target(0, (math.nan, 0, 0, 0)), target(7, thrust=math.inf)):
        assert call(guided, bad) == ()
