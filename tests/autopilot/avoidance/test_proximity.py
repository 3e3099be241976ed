# SPDX-License-Identifier: BSD-3-Clause
"""What is seen around the vehicle: sectors, filter, what is left out, and the walls that are made of it."""

from __future__ import annotations

import math
from collections.abc import Sequence

import pytest

from sitl.autopilot.avoidance import obstacles, proximity, velocity
from sitl.autopilot.avoidance.proximity import Proximity
from sitl.autopilot.avoidance.state import Avoidance
from sitl.autopilot.copter.parameters import Parameters
from sitl.autopilot.params.avoidance import ProximitySensor
from sitl.core.algebra import norm2
from sitl.core.border import Sensors
from sitl.core.vectors import Vec2


def scanned(
    readings: Sequence[tuple[float, float]], p: ProximitySensor | None = None, time_us: int = 1_000_000
) -> Proximity:
    """After one scan of (angle [deg], distance [m])."""
    seen, p = Proximity(), p or ProximitySensor()
    seen.kind = proximity.MAVLINK
    add(seen, readings, p, time_us)
    return seen


def add(seen: Proximity, readings: Sequence[tuple[float, float]], p: ProximitySensor, time_us: int) -> None:
    proximity.begin_scan(seen, 0.1, 20.0, p)
    for angle, distance in readings:
        proximity.note_reading(seen, math.radians(angle), distance, p)
    proximity.end_scan(seen, time_us, 0.0)


def sectors(seen: Proximity, time_us: int = 1_000_000) -> dict[int, float]:
    return {k: float(seen.distance[k]) for k in range(proximity.SECTORS) if proximity.sees(seen, k, time_us)}


def test_a_sector_has_the_nearest_reading_within_22_5_degrees() -> None:
    seen = scanned([(0, 5.0), (22, 3.0), (-22, 4.0), (23, 9.0), (180, 7.0), (90, 30.0), (270, 0.05), (-46, math.nan)])
    assert sectors(seen) == {0: 3.0, 1: 9.0, 4: 7.0}
    assert seen.angle[0] == pytest.approx(math.radians(22))


def test_a_scan_that_meets_nothing_clears_a_sector_and_silence_all_of_them() -> None:
    seen, p = scanned([(0, 5.0), (90, 5.0)]), ProximitySensor()
    add(seen, [(90, 5.0)], p, 1_100_000)
    assert sectors(seen, 1_100_000) == {2: 5.0}
    assert proximity.has_data(seen, 1_599_999) and not proximity.has_data(seen, 1_600_000)
    assert sectors(seen, 2_100_000) == {}


def test_the_filter_follows_slowly_and_begins_afresh_after_a_gap() -> None:
    seen, p = scanned([(0, 10.0)]), ProximitySensor()
    for time_us, expected in ((1_100_000, 10.0 - 8.0 * 0.1 / (0.1 + 1.0 / (2.0 * math.pi * 0.5))), (2_100_000, 2.0)):
        proximity.begin_scan(seen, 0.1, 20.0, p)
        proximity.note_reading(seen, 0.0, 2.0, p)
        proximity.end_scan(seen, time_us, 0.5)
        assert seen.distance[0] == pytest.approx(expected)


def test_parameters_turn_ignore_and_limit_readings() -> None:
    p = ProximitySensor()
    p.IGN_ANG1, p.IGN_WID1, p.MIN, p.MAX = 90.0, 20.0, 1.0, 8.0
    readings = [(85.0, 3.0), (75.0, 4.0), (180.0, 0.5), (270.0, 9.0), (0.0, 5.0)]
    assert sectors(scanned(readings, p)) == {2: 4.0, 0: 5.0}
    p = ProximitySensor()
    p.YAW_CORR = 90.0
    assert sectors(scanned([(0.0, 5.0)], p)) == {2: 5.0}
    p.YAW_CORR, p.ORIENT = 0.0, 1.0
    assert sectors(scanned([(45.0, 5.0)], p)) == {7: 5.0}


def test_the_ground_before_a_copter_that_leans_is_left_out() -> None:
    seen, p = Proximity(), ProximitySensor()
    seen.has_height, seen.height, seen.tilt = True, 3.0, Vec2(math.sin(math.radians(20.0)), 0.0)
    add(seen, [(0.0, 7.0), (45.0, 7.0), (180.0, 7.0), (90.0, 4.0)], p, 1_000_000)
    assert sectors(seen) == {1: 7.0, 4: 7.0, 2: 4.0}
    assert 3.0 - 7.0 * math.sin(math.radians(20.0)) < proximity.GROUND


def test_a_lidar_is_read_from_right_to_left() -> None:
    sensors, seen, p = Sensors(), Proximity(), ProximitySensor()
    seen.kind = proximity.SIMULATED
    sensors.lidar_samples, sensors.lidar_fov, sensors.lidar_min, sensors.lidar_max = 5, math.pi, 0.1, 10.0
    sensors.lidar_ranges[:5] = (1.0, 2.0, 3.0, 4.0, math.inf)  # right, half right, ahead, half left, left
    sensors.lidar_count = 1
    proximity.look(seen, sensors, 1_000_000, 0.0, p)
    assert sectors(seen) == {2: 1.0, 1: 2.0, 0: 3.0, 7: 4.0}
    proximity.look(seen, sensors, 5_000_000, 0.0, p)  # no new scan
    assert seen.update_us == 1_000_000


def test_a_wall_ahead_is_avoided_and_its_margin_left() -> None:
    p, avoid = Parameters(), Avoidance()
    p.AVOID.MARGIN, p.AVOID.BACKUP_DZ = 2.0, 0.1
    b = velocity.Braking(1.0, 1.0, 0.0025, False)
    far = scanned([(0, 6.0)])
    velocity.begin(avoid)
    east = math.pi / 2
    slowed = obstacles.avoid_obstacles(avoid, far, Vec2(1.0, 5.0), east, 1_000_000, p.AVOID, b)
    assert slowed.x == pytest.approx(1.0) and 0.0 < slowed.y < 5.0 and norm2(avoid.back_min) == 0.0
    near = scanned([(0, 1.0)])
    obstacles.avoid_obstacles(avoid, near, Vec2(0.0, 0.0), east, 1_000_000, p.AVOID, b)
    assert avoid.back_min.y < 0.0


def test_a_lean_away_is_the_greater_the_nearer() -> None:
    front, right = (
        obstacles.push(scanned([(0, 2.5)]), 5.0, 1_000_000),
        obstacles.push(scanned([(90, 1.0)]), 5.0, 1_000_000),
    )
    assert (front.roll, front.pitch) == (pytest.approx(0.0), pytest.approx(0.5))  # nose up
    assert (right.roll, right.pitch) == (pytest.approx(-0.8), pytest.approx(0.0))  # to the left
    between = obstacles.push(scanned([(90, 1.0), (270, 1.0)]), 5.0, 1_000_000)
    assert between.roll == pytest.approx(0.0)
