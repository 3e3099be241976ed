# SPDX-License-Identifier: BSD-3-Clause
"""What others see around the vehicle, and what it tells of that."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.autopilot import arming_checks
from sitl.autopilot.avoidance.proximity import MAVLINK
from sitl.autopilot.params.firmware_parameters import Parameters
from tests.bridge.fakes import Bench, FakeRover

PROXIMITY = mavlink.MAV_SYS_STATUS_SENSOR_PROXIMITY
NOTHING = 65535


def looking(bench: Bench, kind: int = MAVLINK) -> Any:
    """A proximity sensor that hears messages, without a filter."""
    v = bench.vehicle.v
    v.time_us = 10_000_000
    v.autopilot.proximity.zero()
    v.autopilot.proximity.kind = kind
    v.autopilot.params.PRX.FILT = 0.0
    return v


def sees(bench: Bench, *messages: Any) -> dict[int, int]:
    """Distance [cm] by orientation, after these messages."""
    for message in messages:
        bench.ask(message)
    told = bench.telemetry("DISTANCE_SENSOR")
    assert [m.id for m in told] == [10 + m.orientation for m in told]
    return {m.orientation: m.current_distance for m in told}


def distances(values: list[int], step: float, offset: float, longest: int) -> Any:
    readings = values + [NOTHING] * (72 - len(values))
    return mavlink.MAVLink_obstacle_distance_message(0, 0, readings, 0, 0, longest, step, offset, 12)


def one(orientation: int, distance: int) -> Any:
    return mavlink.MAVLink_distance_sensor_message(0, 10, 500, distance, 0, 26, orientation, 255)


def place(x: float, y: float, z: float, longest: float = 20.0) -> Any:
    return mavlink.MAVLink_obstacle_distance_3d_message(0, 0, 12, 65535, x, y, z, 0.0, longest)


@pytest.mark.parametrize(
    ("message", "expected"),
    [
        (distances([250], 10, 0.0, 1000), {0: 250}),
        (distances([125, 225, 325, 425, 525], 10, -20.0, 1000), {0: 125}),
        (distances([1000 + 10 * abs(36 - k) for k in range(72)], 90 / 72, -45.0, 2000), {0: 1000, 1: 1180, 7: 1190}),
        (distances([1200], 10, 0.0, 1000), {}),
    ],
)
def test_obstacle_distances_are_told_by_sectors_as_a_real_one_does(
    bench: Bench, message: Any, expected: dict[int, int]
) -> None:
    looking(bench)
    assert sees(bench, message) == expected


def test_a_distance_sensor_is_one_sector_and_those_up_and_down_are_none(bench: Bench) -> None:
    looking(bench)
    assert sees(bench, one(0, 450), one(2, 125), one(25, 100), one(24, 100)) == {0: 450, 2: 125}
    assert sees(bench, one(2, 501)) == {0: 450}


@pytest.mark.parametrize("angle", [0, 22, 23, 90, 181, 337, 338])
def test_a_place_on_the_body_is_in_its_sector(bench: Bench, angle: int) -> None:
    looking(bench)
    x, y = 15.0 * math.cos(math.radians(angle)), 15.0 * math.sin(math.radians(angle))
    (found,) = sees(bench, place(x, y, 0.0)).items()
    assert found[0] == int((angle + 22.5) / 45) % 8 and found[1] == pytest.approx(1500, abs=1)


def test_what_is_far_above_the_level_is_left_out(bench: Bench) -> None:
    looking(bench)
    assert sees(bench, place(10.0, 0.0, -4.0)) == {}


def test_only_a_sensor_of_this_kind_hears_messages(bench: Bench) -> None:
    looking(bench, kind=10)
    assert sees(bench, one(0, 450), distances([250], 10, 0.0, 1000), place(5.0, 0.0, 0.0)) == {}


def test_silence_is_unhealthy_and_prevents_arming(bench: Bench) -> None:
    v = looking(bench)
    proximity = v.autopilot.proximity

    def state() -> tuple[bool, bool, bool, int]:
        (m,) = bench.telemetry("SYS_STATUS")
        bits = m.onboard_control_sensors_present, m.onboard_control_sensors_enabled, m.onboard_control_sensors_health
        present, enabled, health = (bool(b & PROXIMITY) for b in bits)
        return present, enabled, health, arming_checks.proximity_checks(proximity, v.time_us)

    assert state() == (True, True, False, arming_checks.NOTHING_SEEN)
    sees(bench, one(0, 450))
    assert state() == (True, True, True, 0)
    v.time_us += 500_000
    assert state() == (True, True, False, arming_checks.NOTHING_SEEN) and sees(bench) == {}
    assert arming_checks.texts(arming_checks.NOTHING_SEEN, Parameters(), "PreArm: ") == ["PreArm: PRX1: No Data"]
    proximity.kind = 0
    assert state() == (False, False, True, 0), "none is there that could fail, as ArduPilot says it"


def test_an_obstacle_nearer_than_60_cm_prevents_arming(bench: Bench) -> None:
    v = looking(bench)
    sees(bench, one(3, 61), one(1, 450))
    assert arming_checks.obstacle_check(v.autopilot.proximity, v.time_us) == 0
    sees(bench, one(1, 41))
    found = arming_checks.obstacle_check(v.autopilot.proximity, v.time_us)
    assert arming_checks.texts(found, Parameters(), "PreArm: ") == ["PreArm: Proximity 45 deg, 0.41m (want > 0.6m)"]


def test_a_rover_tells_the_same_but_for_sys_status(rover_bench: Bench) -> None:
    assert isinstance(rover_bench.vehicle, FakeRover)
    looking(rover_bench)
    assert sees(rover_bench, one(0, 450)) == {0: 450}
    (m,) = rover_bench.telemetry("SYS_STATUS")
    assert m.onboard_control_sensors_present & PROXIMITY == 0


one_bench = settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
numbers = st.floats(allow_nan=True, allow_infinity=True, width=32)


@one_bench
@given(st.lists(st.integers(0, 65535), max_size=72), numbers, numbers, st.integers(0, 65535))
def test_any_obstacle_distance_leaves_distances_in_range(
    bench: Bench, values: list[int], step: float, offset: float, longest: int
) -> None:
    looking(bench)
    assert all(0 <= cm <= longest for cm in sees(bench, distances(values, step, offset, longest)).values())


@one_bench
@given(numbers, numbers, numbers, numbers)
def test_any_place_leaves_a_state_that_can_be_told(bench: Bench, x: float, y: float, z: float, longest: float) -> None:
    v = looking(bench)
    sees(bench, place(x, y, z, longest))
    assert all(math.isfinite(d) for d in v.autopilot.proximity.distance)
