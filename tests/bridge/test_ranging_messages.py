# SPDX-License-Identifier: BSD-3-Clause
"""What a lidar and a range-finder tell on MAVLink."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sitl.bridge.telemetry import ranging
from sitl.vehicles import load
from tests.bridge.fakes import Bench

SCAN, DOWN, SECTORS = "DEBUG_FLOAT_ARRAY", "DISTANCE_SENSOR", "OBSTACLE_DISTANCE"


def measured(bench: Bench, frame: str, ranges: Any, down: float = 1.25) -> None:
    """A scan of this airframe's lidar in the record."""
    v = bench.vehicle.v
    v.physics.airframe = load(frame).record()[()]
    v.sensors.lidar_ranges[: len(ranges)] = ranges
    v.sensors.lidar_count, v.sensors.lidar_time_us, v.sensors.rangefinder_count = 7, 600_000, 7
    v.sensors.rangefinder_range = down


def test_nothing_is_said_without_a_world(bench: Bench, rover_bench: Bench) -> None:
    for b in (bench, rover_bench):
        assert [b.telemetry(name) for name in (SCAN, DOWN, SECTORS)] == [[], [], []]


def test_the_whole_scan_comes_in_parts(rover_bench: Bench) -> None:
    ranges = np.linspace(1.0, 19.0, 271, dtype=np.float32)
    ranges[100] = math.inf
    measured(rover_bench, "erle_rover", ranges)
    parts = rover_bench.telemetry(SCAN)
    assert [p.array_id for p in parts] == [0, 1, 2, 3, 4]
    assert {p.name for p in parts} == {"LASER"} and {p.time_usec for p in parts} == {600_000}
    data = np.concatenate([p.data for p in parts]).astype(np.float32)
    assert (data[:271] == ranges).all() and np.isnan(data[271:]).all() and len(data) == 5 * 58


def test_readings_of_a_coarse_lidar_are_a_sector_each_clockwise(bench: Bench) -> None:
    ranges = np.arange(1.0, 8.0, 0.1, dtype=np.float32)  # nearest on the right, behind
    ranges[69] = math.inf
    measured(bench, "erle_copter", ranges)
    (m,) = bench.telemetry(SECTORS)
    assert (m.time_usec, m.min_distance, m.max_distance, m.frame, m.sensor_type) == (600_000, 1, 1000, 12, 0)
    assert m.angle_offset == pytest.approx(-135.0) and m.increment_f == pytest.approx(270.0 / 69)
    assert m.increment == 4
    assert m.distances[0] == 1001, "left behind: nothing"
    assert m.distances[69] == 100, "right behind"
    assert m.distances[10] == round(100 * float(ranges[59]))
    assert set(m.distances[70:]) == {65535}


def test_of_many_readings_a_sector_tells_the_nearest(rover_bench: Bench) -> None:
    ranges = np.full(271, math.inf, np.float32)
    ranges[135] = 3.0  # straight ahead
    ranges[0], ranges[270] = 2.0, 1.0  # right behind, left behind
    ranges[45] = 0.06  # 90 degrees to the right
    measured(rover_bench, "erle_rover", ranges)
    (m,) = rover_bench.telemetry(SECTORS)
    near = {k: d for k, d in enumerate(m.distances) if d != 2001}
    assert m.increment_f == pytest.approx(3.75) and m.angle_offset == pytest.approx(-135.0 + 1.875)
    assert near == {0: 100, 71: 200, 36: 300, 60: 6}
    for sector, angle in ((36, 0.0), (60, 90.0)):
        assert abs(m.angle_offset + sector * m.increment_f - angle) <= 0.5 * m.increment_f + 1e-4


def test_looking_down(bench: Bench) -> None:
    measured(bench, "erle_copter", [1.0], down=1.254)
    (m,) = bench.telemetry(DOWN)
    assert (m.min_distance, m.max_distance, m.current_distance) == (1, 5000, 125)
    assert (m.type, m.orientation, m.covariance) == (0, 25, 255)
    measured(bench, "erle_copter", [1.0], down=math.inf)
    assert bench.telemetry(DOWN)[0].current_distance == 5001


def test_a_range_beyond_the_message_is_cut() -> None:
    assert ranging.centimetres(math.inf, 700.0) == 65534, "65535 would mean unknown"
    assert ranging.centimetres(math.nan, 10.0) == 1001


def test_one_reading_is_straight_ahead(bench: Bench) -> None:
    measured(bench, "erle_copter", [2.5])
    bench.vehicle.v.physics.airframe.lidar_samples = 1
    (m,) = bench.telemetry(SECTORS)
    assert (m.distances[0], set(m.distances[1:])) == (250, {65535})
    assert (m.angle_offset, m.increment) == (0.0, 255)


def test_the_scan_repeats_at_the_interval_asked_for(rover_bench: Bench) -> None:
    measured(rover_bench, "erle_rover", np.ones(271))
    assert rover_bench.command(511, 350, 100_000) == 0
    rover_bench.client.receive()
    rover_bench.run(0.5)
    parts = list(rover_bench.client.receive(SCAN))
    assert [p.array_id for p in parts] == [0, 1, 2, 3, 4] * 5


@pytest.mark.parametrize(("ranges", "least", "longest"), [(False, 1, 5000), (True, 25, 1200)])
def test_limits_of_a_range_finder(bench: Bench, ranges: bool, least: int, longest: int) -> None:
    """Those of the airframe in a world; else what parameters say."""
    measured(bench, "erle_copter", [1.0], down=math.inf)
    down = bench.vehicle.v.physics.downward
    down.ranges, down.range_min, down.range_max = ranges, 0.25, 12.0
    (m,) = bench.telemetry(DOWN)
    assert (m.min_distance, m.max_distance, m.current_distance) == (least, longest, longest + 1)
    (m,) = bench.telemetry("RANGEFINDER")
    assert (m.distance, m.voltage) == (0.01 * longest + 1.0, 0.0)
    bench.vehicle.v.sensors.rangefinder_range = 1.25
    assert bench.telemetry("RANGEFINDER")[0].distance == 1.25
    bench.vehicle.v.sensors.rangefinder_count = 0
    assert bench.telemetry("RANGEFINDER") == []


def test_range_finder_and_sectors_come_one_after_the_other(bench: Bench) -> None:
    measured(bench, "erle_copter", [1.0], down=2.0)
    v = bench.vehicle.v
    v.time_us = 20_000_000
    seen: Any = v.autopilot.proximity
    seen.kind, seen.update_us, seen.range_min, seen.range_max = 2, v.time_us, 0.25, 15.0
    for k, metres in ((0, 3.0), (3, 4.5), (7, 6.0)):
        seen.seen_us[k], seen.distance[k] = v.time_us, metres
    told = bench.telemetry(DOWN)
    assert [(m.id, m.orientation, m.current_distance) for m in told] == [
        (0, 25, 200), (10, 0, 300), (13, 3, 450), (17, 7, 600)
    ]  # fmt: skip
    assert {(m.min_distance, m.max_distance, m.covariance, m.type) for m in told[1:]} == {(25, 1500, 0, 0)}
    assert {m.time_boot_ms for m in told} == {20_000}


@pytest.mark.parametrize(("samples", "first", "last"), [(72, 0, 71), (73, 0, 71), (2, 0, 1)])
def test_sectors_reach_from_left_to_right(bench: Bench, samples: int, first: int, last: int) -> None:
    ranges = np.full(samples, 5.0, np.float32)
    ranges[0], ranges[-1] = 2.0, 3.0  # the rightmost, the leftmost
    measured(bench, "erle_copter", ranges)
    bench.vehicle.v.physics.airframe.lidar_samples = samples
    (m,) = bench.telemetry(SECTORS)
    assert (m.distances[first], m.distances[last]) == (300, 200)
    half = 135.0 if samples <= 72 else 135.0 - 1.875
    assert m.angle_offset == pytest.approx(-half)
    assert m.angle_offset + last * m.increment_f == pytest.approx(half, abs=1e-3)
