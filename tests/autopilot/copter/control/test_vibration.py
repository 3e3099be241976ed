# SPDX-License-Identifier: BSD-3-Clause
"""Vibration: when it is found and when it is over, the height's own rate of change, throttle without acceleration."""

from __future__ import annotations

import math

import pytest

from sitl.autopilot.control.pid import Blocked, Pid
from sitl.autopilot.copter.control import vibration_compensation
from sitl.autopilot.copter.control.state import DT, VibrationState
from sitl.autopilot.copter.control.vibration_compensation import BEGINS, ENDS, NOTHING
from sitl.autopilot.state import Estimate
from sitl.core.constants import GRAVITY


def looks(state: VibrationState, speed: float, height: float, first: int, last: int, watched: bool = True) -> list[int]:
    """What ``watch`` sees from tenth of a second ``first`` to ``last``, when the estimate is off by so much."""
    est = Estimate()
    est.innovation_vel_d, est.innovation_pos_d = speed, height
    return [vibration_compensation.watch(state, est, watched, 100_000 * k) for k in range(first, last)]


def test_it_begins_after_a_second_and_ends_after_fifteen_good_ones() -> None:
    state = VibrationState()
    assert looks(state, 1.5, 0.5, 1, 12) == [NOTHING] * 11 and not state.found
    assert looks(state, 1.5, 0.5, 12, 14) == [BEGINS, NOTHING] and state.found
    assert set(looks(state, 0.7, 0.5, 14, 400)) == {NOTHING} and state.found, "better, but not good"
    assert looks(state, 0.1, 0.5, 400, 552) == [NOTHING] * 151 + [ENDS] and not state.found


@pytest.mark.parametrize(
    ("speed", "height", "watched"), [(0.9, 0.5, True), (1.5, 0.2, True), (-1.5, -0.5, True), (1.5, 0.5, False)]
)
def test_nothing_else_is_vibration(speed: float, height: float, watched: bool) -> None:
    state = VibrationState()
    assert set(looks(state, speed, height, 1, 300, watched)) == {NOTHING} and not state.found


def test_the_rate_of_the_height_does_not_see_a_bias_of_the_acceleration() -> None:
    state, est, speeds = VibrationState(), Estimate(), []
    for k in range(4000):
        t = k * DT
        est.pos = (0.0, 0.0, 2.0 * math.sin(t))
        est.acc_ned = (0.0, 0.0, -2.0 * math.sin(t) + 2.0)
        vibration_compensation.follow_height(state, est)
        speeds.append(state.vel - 2.0 * math.cos(t))
    assert max(map(abs, speeds[800:])) < 0.05
    assert state.bias == pytest.approx(-2.0, abs=0.05)


def test_throttle_follows_the_speed_and_stops_at_its_ends() -> None:
    pid, free, least = Pid(), Blocked(False, False), Blocked(True, False)
    off = vibration_compensation.throttle_without_acceleration(pid, 0.0, 2.0, 5.0, 0.4, free)
    assert off == pytest.approx(0.25 * 2.0 * 0.4 / GRAVITY)
    for _ in range(400):
        vibration_compensation.throttle_without_acceleration(pid, 1.0, 0.0, 5.0, 0.4, free)
    one_second = pid.integrator
    assert one_second == pytest.approx(5.0 * 0.125 * 0.4 / GRAVITY)
    vibration_compensation.throttle_without_acceleration(pid, 1.0, 0.0, 5.0, 0.4, least)
    assert pid.integrator == one_second
    vibration_compensation.throttle_without_acceleration(pid, -1.0, 0.0, 5.0, 0.4, least)
    assert pid.integrator < one_second


@pytest.mark.parametrize(("speed", "height", "runs"), [(1.0, 0.5, False), (1.1, 0.3, False), (1.01, 0.31, True)])
def test_it_runs_away_above_both_limits(speed: float, height: float, runs: bool) -> None:
    assert (BEGINS in looks(VibrationState(), speed, height, 1, 20)) == runs


@pytest.mark.parametrize(("speed", "ends"), [(0.5, True), (0.51, False)])
def test_it_is_good_at_half_a_metre_a_second(speed: float, ends: bool) -> None:
    state = VibrationState()
    state.found = True
    assert (ENDS in looks(state, speed, 0.5, 1, 160)) == ends


def test_disarmed_it_is_good() -> None:
    state = VibrationState()
    state.found = True
    assert ENDS in looks(state, 5.0, 5.0, 1, 160, watched=False)


def test_a_good_moment_starts_the_second_anew_and_a_bad_one_the_fifteen() -> None:
    state = VibrationState()
    looks(state, 1.5, 0.5, 1, 11)
    looks(state, 0.0, 0.0, 11, 12)
    assert BEGINS not in looks(state, 1.5, 0.5, 12, 23) and BEGINS in looks(state, 1.5, 0.5, 23, 24)
    looks(state, 0.0, 0.0, 24, 170)
    looks(state, 0.6, 0.0, 170, 171)
    assert ENDS not in looks(state, 0.0, 0.0, 171, 322) and ENDS in looks(state, 0.0, 0.0, 322, 323)
