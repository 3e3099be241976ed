# SPDX-License-Identifier: BSD-3-Clause
"""The estimate in closed loop: default noise, the Erle-Copter, a flight by set-points and a square, several seeds."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from benchmarks.recorded.pilot import POSITION_ONLY, VELOCITY_ONLY
from sitl.physics.native import truth
from sitl.simulation import Core
from tests.flights.aviator import Aviator

SEEDS = range(6)
GPS_POSITION, GPS_VELOCITY, BAROMETER, MAGNETOMETER = range(4)
"""Order of ``ekf.nis_sum``."""


def legs(p: Aviator) -> Iterator[None]:
    """20 m north, 3 m/s east, a stop, a 30 m square; one step every 0.1 s."""
    plan = [(12.0, POSITION_ONLY, (20.0, 0.0, -10.0))]
    plan += [(10.0, VELOCITY_ONLY, (0.0, 3.0, 0.0)), (4.0, VELOCITY_ONLY, (0.0, 0.0, 0.0))]
    plan += [(10.0, POSITION_ONLY, (n, e, -12.0)) for n, e in ((0.0, 30.0), (30.0, 30.0), (30.0, 0.0), (0.0, 0.0))]
    for seconds, mask, vector in plan:
        for _ in range(round(seconds * 10)):
            p.setpoint(mask, position=vector, velocity=vector)
            p.fly(0.1)
            yield


def fly(core: Core, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """(position errors [m], attitude errors [deg], sums of normalised innovations squared, their counts)"""
    p = Aviator(core, "erle_copter", seed=seed).ready()
    ekf = p.ap.ekf
    sums, counts = np.array(ekf.nis_sum), np.array(ekf.nis_count)
    p.arm()
    p.take_off(10.0)
    position, attitude = [], []
    for _ in legs(p):
        true, estimate = truth.read(p.simulation.v), p.ap.estimate
        position.append(np.array(estimate.pos) - true.pos)
        attitude.append((np.degrees(np.array(estimate.euler) - true.euler) + 180.0) % 360.0 - 180.0)
    return np.array(position), np.array(attitude), np.array(ekf.nis_sum) - sums, np.array(ekf.nis_count) - counts


@pytest.mark.parametrize("seed", SEEDS)
def test_position_within_a_metre_and_attitude_within_a_degree(core: Core, seed: int) -> None:
    position, attitude, _, _ = fly(core, seed)
    assert np.sqrt(np.mean(np.sum(np.square(position), axis=1))) < 1.0
    assert np.sqrt(np.mean(np.square(attitude), axis=0)).max() < 1.0


def test_innovations_agree_with_their_covariances(core: Core) -> None:
    """Their normalised squares average 1 over all seeds, each sensor by itself."""
    flights = [fly(core, seed)[2:] for seed in SEEDS]
    counts = sum(count for _, count in flights)
    ratio = sum(total for total, _ in flights) / counts
    assert counts.min() > 2000
    assert ratio[GPS_POSITION] == pytest.approx(1.0, abs=0.2)
    assert ratio[GPS_VELOCITY] == pytest.approx(1.0, abs=0.1)
    assert ratio[BAROMETER] == pytest.approx(1.0, abs=0.15)
    assert ratio[MAGNETOMETER] == pytest.approx(1.0, abs=0.2)
