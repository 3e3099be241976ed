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
from sitl.core.vectors import Quat, Vec3
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


# ---------------------------------------------------------------- increments, and the database of objects


def older(values: list[int], step: int, fine: float = 0.0) -> Any:
    """A sender that knows whole degrees alone, or ``fine`` ones besides."""
    readings = values + [NOTHING] * (72 - len(values))
    return mavlink.MAVLink_obstacle_distance_message(0, 0, readings, step, 0, 1000, fine, 0.0, 12)


@pytest.mark.parametrize(
    ("message", "expected"),
    [
        (older([300, 400], 45), {0: 300, 1: 400}),
        (older([300, 400], 45, 90.0), {0: 300, 2: 400}),  # increment_f counts where it is given
        (older([300, 400], 0, -90.0), {0: 300, 6: 400}),  # counter-clockwise
        (older([300, 400], 0), {}),
        (older([500] * 45 + [300], 1), {0: 500, 1: 300}),
        (older([500] * 45 + [300], 0, 1.0), {0: 500, 1: 300}),
    ],
)
def test_increments_are_whole_degrees_unless_finer_ones_are_given(
    bench: Bench, message: Any, expected: dict[int, int]
) -> None:
    looking(bench)
    assert sees(bench, message) == expected


@pytest.mark.parametrize(
    ("message", "positions"),
    [
        (distances([250], 10, 90.0, 1000), [(100.0, 202.5)]),
        (distances([250, NOTHING, 400], 90, 0.0, 1000), [(102.5, 200.0), (96.0, 200.0)]),
        (one(2, 300), [(100.0, 203.0)]),
        (place(0.0, -4.0, 0.0), [(100.0, 196.0)]),
        (distances([1100], 10, 0.0, 1000), []),
    ],
)
@pytest.mark.parametrize(("kind", "known", "kept"), [(1.0, 1, True), (2.0, 1, False), (1.0, 0, False)])
def test_objects_are_kept_where_they_were_seen_for_bendy_ruler(
    bench: Bench, message: Any, positions: Any, kind: float, known: int, kept: bool
) -> None:
    """OA_TYPE 1; the vehicle is level, looks north, and is 100 m north and 200 m east of its origin."""
    v = looking(bench)
    ap = v.autopilot
    ap.params.OA.TYPE = kind
    ap.estimate.q, ap.estimate.pos, ap.estimate.position_ok = Quat(1.0, 0.0, 0.0, 0.0), Vec3(100.0, 200.0, -5.0), known
    ap.objects.zero()
    bench.ask(message)
    found = [
        (float(ap.objects.north[k]), float(ap.objects.east[k]))
        for k in range(len(ap.objects.north))
        if ap.objects.until_ms[k]
    ]
    assert found == [pytest.approx(at, abs=0.01) for at in (positions if kept else [])]


@pytest.mark.parametrize(
    ("message", "expected"),
    [
        (one(7, 450), {7: 450}), (one(8, 450), {}), (one(0, 10), {0: 10}), (one(0, 9), {}), (one(0, 500), {0: 500}),
        (place(10.0, 0.0, 2.6), {0: 1000}), (place(10.0, 0.0, -2.6), {0: 1000}),
        (place(10.0, 0.0, 2.75), {}), (place(10.0, 0.0, -2.75), {}), (place(20.5, 0.0, 0.0), {}),
        (mavlink.MAVLink_obstacle_distance_3d_message(0, 0, 12, 65535, 5.0, 0.0, 0.0, 5.5, 20.0), {}),
        (mavlink.MAVLink_obstacle_distance_3d_message(0, 0, 1, 65535, 5.0, 0.0, 0.0, 0.0, 20.0), {}),
        (mavlink.MAVLink_obstacle_distance_message(0, 0, [49, 50] + [NOTHING] * 70, 90, 50, 1000, 0, 0, 12), {2: 50}),
        (distances([300] * 8 + [200], 45, 0.0, 1000), dict.fromkeys(range(8), 300)),
        (distances([300] * 8 + [200], -45, 0.0, 1000), dict.fromkeys(range(8), 300)),
    ],
)  # fmt: skip
def test_ranges_orientations_and_heights_that_count(bench: Bench, message: Any, expected: dict[int, int]) -> None:
    """Sectors reach 15 degrees up and down, and a second turn of readings is left out."""
    looking(bench)
    assert sees(bench, message) == expected
    (m,) = bench.telemetry("SYS_STATUS")
    assert expected == {} or m.onboard_control_sensors_health & PROXIMITY


@pytest.mark.parametrize("message", [one(0, 450), place(4.5, 0.0, 0.0), distances([450], 10, 0.0, 1000)])
def test_a_sensor_that_is_turned(bench: Bench, message: Any) -> None:
    """PRX1_YAW_CORR: ahead of it is to the right of the vehicle."""
    looking(bench).autopilot.params.PRX1.YAW_CORR = 90.0
    assert sees(bench, message) == {2: 450}


@pytest.mark.parametrize("messages", [(one(0, 100), one(0, 200)), (place(1.0, 0.0, 0.0), place(2.0, 0.0, 0.0))])
def test_readings_are_low_passed(bench: Bench, messages: Any) -> None:
    v = looking(bench)
    v.autopilot.params.PRX.FILT = 1.0
    bench.ask(messages[0])
    v.time_us += 100_000
    assert sees(bench, messages[1]) == {0: 138}
