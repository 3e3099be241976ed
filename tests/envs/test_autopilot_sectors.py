# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle that sends OBSTACLE_DISTANCE and no whole scans, as a real one does."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401
from sitl.bridge.telemetry import ranging
from sitl.envs.mavlink.telemetry import SECTORS, StepTelemetry

COPTER = "GazeboOfficeErleCopterLIDAR-v0"


def test_sectors_are_spread_over_the_readings(monkeypatch):
    whole = gym.make(COPTER, observation="scan")
    seen, _ = whole.reset(seed=2)
    monkeypatch.setattr(ranging, "MESSAGES", (ranging.obstacle_distance, ranging.distance_sensor))
    sectors = gym.make(COPTER, observation="scan")
    rough, _ = sectors.reset(seed=2)
    assert sectors.unwrapped.robot.link(0).inbox.scan_kind is SECTORS
    assert rough == pytest.approx(seen, abs=0.0051)
    assert not np.array_equal(rough, seen)
    for action in (0, 1, 2, 0):
        seen, rough = whole.step(action)[0], sectors.step(action)[0]
        assert rough == pytest.approx(seen, abs=0.0051)


def test_a_sector_that_was_not_measured_is_out_of_range():
    heard = StepTelemetry(3)
    heard.scan_kind, heard.angles = SECTORS, np.radians([-90.0, 0.0, 90.0])
    distances = [65535] * 72
    distances[0], distances[18], distances[54] = 150, 250, 1001  # ahead, right, left: beyond the range
    fields = SECTORS.decode(SECTORS.payload(distances=distances, max_distance=1000, increment=5))
    heard._sectors(fields)
    assert heard.scan[:3].tolist() == [2.5, 1.5, np.inf]
    assert heard.scans == 1
