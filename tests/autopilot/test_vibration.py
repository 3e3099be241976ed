# SPDX-License-Identifier: BSD-3-Clause
"""Levels of vibration: what a shaking accelerometer reads, and what does not count as shaking."""

from __future__ import annotations

import math

import pytest

from sitl.autopilot.vibration import CLIP, Vibration, update_vibration, vibration_levels
from sitl.core.vectors import Vec3

DT = 0.0025


def test_a_quick_shake_is_told_and_a_slow_one_is_not() -> None:
    shakes = Vibration()
    for k in range(4000):
        t = k * DT
        acc = Vec3(3.0 * math.sin(2 * math.pi * 80.0 * t), 3.0 * math.sin(2 * math.pi * 0.2 * t), -9.8)
        update_vibration(shakes, acc)
    levels = vibration_levels(shakes)
    assert levels.x == pytest.approx(3.0 / math.sqrt(2.0), rel=0.05)  # the root of the mean square
    assert levels.y < 0.15 and levels.z < 0.01
    assert shakes.clips == 0


def test_the_level_follows_with_two_hertz() -> None:
    shakes = Vibration()
    levels = []
    for k in range(400):
        update_vibration(shakes, Vec3(0.0, 0.0, 4.0 if k % 2 else -4.0))
        levels.append(vibration_levels(shakes).z)
    after = 1.0 / (2 * math.pi * 2.0)  # of the squares
    assert levels[round(after / DT)] ** 2 == pytest.approx(16.0 * (1.0 - math.exp(-1.0)), rel=0.1)


def test_samples_beyond_the_range_are_counted_and_those_that_are_no_numbers_left_out() -> None:
    shakes = Vibration()
    for acc in (Vec3(0.0, CLIP + 0.1, 0.0), Vec3(-CLIP - 1.0, 0.0, 900.0), Vec3(CLIP - 0.1, 0.0, 0.0)):
        update_vibration(shakes, acc)
    before = shakes.squares
    update_vibration(shakes, Vec3(math.nan, 0.0, 0.0))
    assert shakes.clips == 2 and shakes.squares == before
