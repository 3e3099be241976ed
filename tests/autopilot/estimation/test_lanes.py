# SPDX-License-Identifier: BSD-3-Clause
"""Two filters: which of them is flown by, and on which IMU and compass each works."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.autopilot.estimation import compass, lanes
from sitl.autopilot.estimation.alignment import RUN, TILT
from sitl.autopilot.estimation.estimator_events import EKF_LANE_SWITCHED
from sitl.core.border import ACC_SILENT, GYRO_SILENT, IMUS_DIFFER
from sitl.core.memory import words_of
from sitl.core.vectors import Quat, Vec3
from tests.autopilot.estimation import synthetic_flight as sf


@pytest.fixture
def v() -> Any:
    """A vehicle whose second filter has begun, both aligned."""
    v = sf.Copter.of(sf.new(), 0)
    ap = v.autopilot
    ap.ekf.phase = RUN
    ap.ekf.yaw_aligned = True
    ap.ekf.q = ap.estimate.q = Quat(1.0, 0.0, 0.0, 0.0)
    ap.params.EK3.ERR_THRESH = 0.2
    v.sensors.imu_state = IMUS_DIFFER
    lanes.begin_or_end(ap, v.sensors, 1_000_000)
    return v


def codes(ap: Any) -> list[int]:
    return [int(ap.events.code[k]) for k in range(ap.events.count)]


def test_the_second_filter_begins_as_a_copy_on_the_other_imu(v: Any) -> None:
    ap = v.autopilot
    assert (ap.ekf.imu, ap.second_lane.ekf.imu, ap.second_lane.runs) == (0, 1, 1)
    ap.second_lane.ekf.imu = 0
    assert words_of(ap.second_lane.ekf).tolist() == words_of(ap.ekf).tolist()


def test_it_ends_a_minute_after_the_imus_agree_again(v: Any) -> None:
    ap = v.autopilot
    v.sensors.imu_state = 0
    lanes.begin_or_end(ap, v.sensors, 1_000_000 + lanes.MERGE_US)
    assert ap.second_lane.runs == 1
    lanes.begin_or_end(ap, v.sensors, 1_000_001 + lanes.MERGE_US)
    assert ap.second_lane.runs == 0


@pytest.mark.parametrize(("silent", "first", "second"), [(0, 1, 2), (1, 2, 2), (2, 1, 1), (3, 1, 2)])
def test_a_silent_sensor_is_replaced(v: Any, silent: int, first: float, second: float) -> None:
    shown = v.autopilot.calibrated
    shown.acc, shown.acc2 = Vec3(1.0, 0.0, 0.0), Vec3(2.0, 0.0, 0.0)
    shown.gyro, shown.gyro2 = shown.acc, shown.acc2
    for of, bit in ((lanes.acc_of, ACC_SILENT), (lanes.gyro_of, GYRO_SILENT)):
        state = IMUS_DIFFER | silent * bit
        assert [of(imu, shown, state).x for imu in (0, 1)] == [first, second]


@pytest.mark.parametrize("ratio", ["variance_vel", "variance_pos", "variance_hgt"])
def test_a_failed_filter_is_left_at_once_and_one_that_is_worse_after_some_steps(v: Any, ratio: str) -> None:
    ap = v.autopilot
    setattr(ap.estimate, ratio, 0.4)
    for _ in range(100):
        lanes.compare(ap, ap.params.EK3)
    assert ap.ekf.imu == 0, "a difference below EK3_ERR_THRESH does not count"
    setattr(ap.estimate, ratio, 0.6)
    lanes.compare(ap, ap.params.EK3)
    assert ap.ekf.imu == 0
    lanes.compare(ap, ap.params.EK3)
    lanes.compare(ap, ap.params.EK3)
    assert ap.ekf.imu == 1
    setattr(ap.estimate, ratio, 1.1)
    setattr(ap.second_lane.estimate, ratio, 0.9)
    lanes.compare(ap, ap.params.EK3)
    assert ap.ekf.imu == 0
    assert codes(ap) == [EKF_LANE_SWITCHED] * 2


def test_the_compass_counts_when_it_is_asked_to(v: Any) -> None:
    ap = v.autopilot
    ap.estimate.variance_mag = 2.0
    lanes.compare(ap, ap.params.EK3)
    assert ap.ekf.imu == 0
    ap.params.EK3.AFFINITY = lanes.AFFINITY_COMPASS
    lanes.compare(ap, ap.params.EK3)
    assert ap.ekf.imu == 1


def test_a_filter_that_aligns_is_not_switched_to_but_left_in_flight(v: Any) -> None:
    ap = v.autopilot
    ap.estimate.variance_vel = 3.0
    ap.second_lane.ekf.phase = TILT
    lanes.compare(ap, ap.params.EK3)
    assert ap.ekf.imu == 0
    ap.second_lane.ekf.phase, ap.ekf.phase = RUN, TILT
    lanes.compare(ap, ap.params.EK3)
    assert ap.ekf.imu == 0, "on the ground both align"
    ap.arming.armed = True
    lanes.compare(ap, ap.params.EK3)
    assert ap.ekf.imu == 1


def test_controllers_are_told_of_the_jump(v: Any) -> None:
    ap = v.autopilot
    ap.estimate.reset_ne_count, ap.second_lane.estimate.reset_ne_count = 7, 2
    ap.estimate.pos, ap.second_lane.estimate.pos = Vec3(1.0, 2.0, -10.0), Vec3(1.5, 2.0, -9.0)
    ap.estimate.vel, ap.second_lane.estimate.vel = Vec3(0.0, 1.0, 0.0), Vec3(0.0, 3.0, 0.5)
    lanes.switch(ap)
    assert (ap.estimate.reset_ne_count, ap.estimate.reset_d_count, ap.estimate.reset_yaw_count) == (8, 1, 1)
    assert tuple(ap.estimate.pos) == (1.5, 2.0, -9.0) and tuple(ap.second_lane.estimate.pos) == (1.0, 2.0, -10.0)
    assert tuple(ap.estimate.reset_pos) == (0.5, 0.0, 1.0)
    assert tuple(ap.estimate.reset_vel) == (0.0, 2.0, 0.5)
    assert ap.estimate.reset_yaw == 0.0


def choose(v: Any, now_us: int = 20_000_000) -> int:
    v.autopilot.ekf.now_us = now_us
    return compass.better(v.autopilot.ekf, v.sensors, v.autopilot.params)


@pytest.fixture
def compasses(v: Any) -> Any:
    """The same, with three compasses that show the same and were heard just now."""
    s, params = v.sensors, v.autopilot.params.COMPASS
    for group in (params.DIA, params.DIA2, params.DIA3):
        group.X = group.Y = group.Z = 1.0
    params.OFS.X, params.OFS.Y, params.OFS.Z = 5.0, 13.0, -18.0
    params.USE = params.USE2 = params.USE3 = 1.0
    s.mag = s.mag2 = s.mag3 = Vec3(0.25, 0.0, 0.4)
    s.mag_count = 100
    for k in range(3):
        s.mag_us[k] = 20_000_000
    return v


def test_a_compass_that_shows_the_same_is_no_better(compasses: Any) -> None:
    v = compasses
    assert choose(v) == -1
    v.sensors.mag3 = Vec3(-0.25, 0.0, 0.4)
    assert choose(v) == 2
    v.autopilot.params.COMPASS.USE3 = 0.0
    assert choose(v) == -1


def test_a_silent_compass_is_left_for_the_next_one_that_is_heard(compasses: Any) -> None:
    v = compasses
    v.sensors.mag_us[0] = 19_000_000
    assert choose(v) == 1
    v.autopilot.ekf.compass = 1
    assert choose(v) == -1, "it is heard, and the third one shows the same"
    v.sensors.mag_us[1] = 19_000_000
    assert choose(v) == 2
    v.sensors.mag_us[2] = 19_000_000
    v.autopilot.ekf.compass = 2
    assert choose(v) == -1, "all are silent"
    v.sensors.mag_us[0] = 20_000_000
    assert choose(v) == 0
