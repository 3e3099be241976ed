# SPDX-License-Identifier: BSD-3-Clause
"""What a lidar and a range-finder tell on MAVLink."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sitl.bridge.telemetry import sensors
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
    assert sensors.centimetres(math.inf, 700.0) == 65534, "65535 would mean unknown"
    assert sensors.centimetres(math.nan, 10.0) == 1001


def test_one_reading_is_straight_ahead() -> None:
    assert sensors.sectors((2.5,), 0.0) == ([2.5], 0.0, 0.0)


def test_the_scan_repeats_at_the_interval_asked_for(rover_bench: Bench) -> None:
    measured(rover_bench, "erle_rover", np.ones(271))
    assert rover_bench.command(511, 350, 100_000) == 0
    rover_bench.client.receive()
    rover_bench.run(0.5)
    parts = list(rover_bench.client.receive(SCAN))
    assert [p.array_id for p in parts] == [0, 1, 2, 3, 4] * 5
