# SPDX-License-Identifier: BSD-3-Clause
"""Laws that judge a step, on rows written by hand: what is paid, what ends an episode, where edges are."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sitl.envs.targets import gates, target_task, waypoints
from sitl.envs.targets.target_task import Beginning, Ends, Outcome, Outside
from sitl.envs.tasks import count_crashes

AXES, FLAT = np.ones(3), np.array([1.0, 1.0, 0.0])


def flags(*values: int) -> Any:
    return np.array(values, bool)


def outcome(count: int = 1, crashed: Any = None) -> Any:
    """Of robots that were given 10 before."""
    none = np.zeros(count, bool)
    crashed = none.copy() if crashed is None else crashed
    return Outcome(crashed, none.copy(), np.full(count, 10.0), none.copy(), np.full((4, count), 9.0))


def rows(*values: Any) -> Any:
    return np.array(values, float)


# ---------------------------------------------------------------- all tasks


@pytest.mark.parametrize(
    ("distance", "half", "worth"),
    [(0.0, 0.0, 1.0), (1.0, 0.0, 0.75), (4.0, 0.0, 0.0), (5.0, 0.0, 0.0), (0.0, 2.0, 1.0), (2.0, 2.0, 0.5),
     (6.0, 2.0, 0.1)],
)  # fmt: skip
def test_nearness_of_a_scale_of_four_metres(distance: float, half: float, worth: float) -> None:
    assert target_task.nearness(distance, 4.0, half) == pytest.approx(worth)


def test_distances_count_axes() -> None:
    state, positions = rows((9, 9, 9), (1, 2, 3)), rows((0, 0, 0), (0, 0, 0), (2, 4, 5))
    assert target_task.distance_of(state, 1, positions, 2, AXES) == pytest.approx(3.0)
    assert target_task.distance_of(state, 1, positions, 2, FLAT) == pytest.approx(math.sqrt(5.0))
    assert target_task.distance_of(state, 1, positions, 2, np.array([2.0, 0.0, 1.0])) == pytest.approx(math.sqrt(8.0))


@pytest.mark.parametrize(
    ("scan", "touched", "ends", "crashed"),
    [
        ((1.0, 2.0), 0, True, False), ((0.3, 0.19), 0, True, True), ((0.2, 9.0), 0, True, False),
        ((0.0, 9.0), 0, True, False), ((1.0, 2.0), 1, True, True), ((1.0, 2.0), 1, False, False),
        ((-1.0, 2.0), 0, True, False), ((math.nan, math.inf), 0, True, False),
    ],
)  # fmt: skip
def test_crashes_are_near_readings_and_touches(scan: Any, touched: int, ends: bool, crashed: bool) -> None:
    """A reading of 0 is none, as in the paper's code; 0.2 m is not below 0.2 m."""
    out = flags(1, 1)
    scans = np.array([scan, (9.0, 9.0)], np.float32)
    assert count_crashes(scans, float(np.float32(0.2)), np.array([touched, 0]), ends, out) == int(crashed)
    assert out.tolist() == [crashed, False]


@pytest.mark.parametrize(("z", "ends", "crashed"), [(0.1, True, True), (0.2, True, False), (0.1, False, False)])
def test_who_sinks_to_the_floor_has_crashed(z: float, ends: bool, crashed: bool) -> None:
    by = Beginning(np.full((2, 1), 9.0, np.float32), np.zeros(2, int), 0.2, True, rows(0.2, 0.2), ends)
    rewards, terminated, out = rows(5.0, 5.0), flags(0, 0), flags(0, 0)
    target_task.begin_step(by, rows((0, 0, z), (0, 0, 3)), rewards, terminated, out)
    assert rewards.tolist() == [0.0, 0.0] and terminated.tolist() == out.tolist() == [crashed, False]


@pytest.mark.parametrize(
    ("at", "out"),
    [((0, 0, 0), False), ((10, 20, 30), False), ((-1, -2, -3), False), ((10.1, 0, 0), True), ((0, 20.1, 0), True),
     ((0, 0, 30.1), True), ((-1.1, 0, 0), True), ((0, -2.1, 0), True), ((0, 0, -3.1), True)],
)  # fmt: skip
@pytest.mark.parametrize("ends", [True, False])
def test_the_arena_has_six_ends(at: Any, out: bool, ends: bool) -> None:
    by = Outside(rows((-1, -2, -3)), rows((10, 20, 30)), -7.0, ends, -20.0)
    rewards, terminated, paid = rows(1.0), flags(0), rows(9.0)
    found = Ends(flags(0), flags(0), flags(0), paid)
    target_task.end_step(by, rows(at), flags(1), rewards, terminated, found)
    cost = -7.0 if out and ends else 0.0
    assert (rewards[0], paid[0], bool(terminated[0])) == (1.0 + cost, cost, out and ends)
    assert bool(found.outside[0]) == out and bool(found.reached[0])


def test_a_crash_pays_its_own_and_has_reached_nothing() -> None:
    by = Outside(rows((-1, -1, -1)), rows((1, 1, 1)), -7.0, True, -20.0)
    rewards, terminated = rows(5.0), flags(1)
    found = Ends(flags(1), flags(1), flags(1), rows(9.0))
    target_task.end_step(by, rows((5, 0, 0)), flags(1), rewards, terminated, found)
    assert rewards[0] == -20.0 and not found.reached[0] and not found.outside[0] and found.paid[0] == 0.0


@pytest.mark.parametrize(("yaw", "seen"), [(0.0, (3, 4)), (math.pi / 2, (4, -3)), (math.pi, (-3, -4))])
def test_offsets_are_along_the_heading_and_the_last_target_comes_again(yaw: float, seen: Any) -> None:
    pose, positions = rows((0, 0, 0, 0), (1, 2, 3, yaw)), rows((0, 0, 0), (0, 0, 0), (9, 9, 9), (4, 6, 8))
    out = np.full((2, 8), 7.0)
    target_task.write_offsets(pose, positions, np.array([0, 1]), 2, 2, out, 1)
    assert out[1].tolist() == pytest.approx([7.0, *seen, 5.0, *seen, 5.0, 7.0])


# ---------------------------------------------------------------- waypoints


@pytest.mark.parametrize(
    ("x", "passed", "at", "distance"), [(9.0, False, 0, 1.0), (9.1, True, 1, 10.9), (10.0, True, 1, 10.0)]
)
def test_a_waypoint_is_passed_within_its_radius(x: float, passed: bool, at: int, distance: float) -> None:
    number, near = np.array([0]), waypoints.Nearing(rows(4.0), rows(0.0), flags(0))
    waypoints.pass_targets(rows((x, 0, 0)), rows((10, 0, 0), (20, 0, 0)), 1.0, 1.0, number, near)
    assert (bool(near.passed[0]), number[0]) == (passed, at)
    assert near.gain[0] == pytest.approx(4.0 - (10.0 - x)) and near.distance[0] == pytest.approx(distance)


def test_behind_the_last_waypoint_none_is_passed() -> None:
    number, near = np.array([1, 2]), waypoints.Nearing(rows(4.0, 0.5), rows(0.0, 0.0), flags(0, 0))
    both = rows((0, 0, 0), (20, 0, 5), (0, 0, 0), (20, 0, 5))
    waypoints.pass_targets(rows((20, 0, 5), (20, 0, 5)), both, 1.0, 1.0, number, near)
    assert number.tolist() == [2, 2] and near.passed.tolist() == [True, False]
    near = waypoints.Nearing(rows(0.0), rows(0.0), flags(0))
    waypoints.pass_targets(rows((20, 3, 9)), both[:2], 0.0, 1.0, np.array([1]), near)
    assert near.distance[0] == pytest.approx(3.0), "heights do not count for who does not fly"


def test_waypoints_are_paid_and_the_last_one_ends() -> None:
    found = outcome(3, flags(0, 0, 1))
    prices = waypoints.Prices(2.0, 5.0, -0.1)
    going = waypoints.pay_targets(prices, rows(1.5, -1.0, 1.0), flags(1, 1, 0), np.array([1, 4, 2]), 4, found)
    assert going == 1 and found.rewards.tolist() == pytest.approx([10 + 3 + 5 - 0.1, 10 - 2 + 5 - 0.1, 10 + 2 - 0.1])
    assert found.paid[:3].T.tolist() == [[3.0, 5.0, -0.1], [-2.0, 5.0, -0.1], [0.0, 0.0, 0.0]]
    assert found.success.tolist() == found.terminated.tolist() == [False, True, False]


# ---------------------------------------------------------------- gates

GATE = (10.0, 0.0, 2.0, 0.0, 2.0, 1.0)
"""Ahead, 2 m wide, 1 m high."""


@pytest.mark.parametrize(
    ("before", "now", "passed"),
    [
        ((9, 0, 2), (11, 0, 2), True), ((11, 0, 2), (9, 0, 2), False), ((9, 0, 2), (9.9, 0, 2), False),
        ((9, 0, 2), (10, 0, 2), True), ((10, 0, 2), (11, 0, 2), False),
        ((9, 1, 2), (11, 1, 2), True), ((9, 1.1, 2), (11, 1.1, 2), False), ((9, -1.1, 2), (11, -1.1, 2), False),
        ((9, 0, 2.5), (11, 0, 2.5), True), ((9, 0, 2.6), (11, 0, 2.6), False), ((9, 0, 1.4), (11, 0, 1.4), False),
        ((9, 2, 2), (11, -2, 2), True), ((9, 2, 2), (13, -2, 2), True), ((9.9, 2, 2), (11, 0, 2), False),
        ((9, 0, 1), (11, 0, 3), True), ((9, 0, 1), (13, 0, 3), True), ((9.9, 0, 1), (11, 0, 3), False),
    ],
)  # fmt: skip
def test_a_gate_is_passed_in_its_direction_within_its_frame(before: Any, now: Any, passed: bool) -> None:
    out = flags(not passed)
    gates.cross_gates(rows(before), rows(now), rows(GATE), np.array([1]), np.array([0]), out)
    assert bool(out[0]) == passed


def test_gates_turn_with_their_yaw_and_begin_anew_each_lap() -> None:
    north = (0.0, 10.0, 2.0, math.pi / 2, 2.0, 1.0)
    table = rows(GATE, north, GATE, (0, 0, 0, 0, 0, 0))
    at, out = np.array([3, 1]), flags(0, 0)
    gates.cross_gates(rows((0.5, 9, 2), (9, 0, 2)), rows((0.5, 11, 2), (11, 0, 2)), table, np.array([2, 1]), at, out)
    assert out.tolist() == [True, True], "the fourth of two is the second; the second of one the first"
    gates.cross_gates(rows((0.5, 11, 2), (9, 0, 2)), rows((0.5, 9, 2), (11, 0, 2)), table, np.array([2, 1]), at, out)
    assert out.tolist() == [False, True]


def pay(at: int, passed: int, before: Any = (0, 0, 2), now: Any = (3, 0, 2), lap: Any = (2.0, 0.0, 0.0),
        crashed: int = 0, far: float = 20.0) -> tuple[Any, Any, Any]:  # fmt: skip
    """Two gates, two laps, at 8 s; a metre is 2, a gate 5, a step -0.1."""
    found, laps, number, was = outcome(1, flags(crashed)), rows(lap), np.array([at]), rows(before)
    positions = rows((10, 0, 2), (0, 10, 2), (10, 0, 2), (0, 10, 2))
    prices, course = gates.GatePrices(2.0, far, 5.0, -0.1), gates.Course(positions, np.array([2]), 2)
    gates.pay_gates(prices, was, rows(now), course, rows(8.0), gates.Runs(number, laps, flags(passed)), found)
    assert was.tolist() == rows(now).tolist()
    return found, number[0], laps[0].tolist()


def test_progress_to_a_gate_is_paid() -> None:
    found, at, laps = pay(0, 0)
    assert found.rewards[0] == pytest.approx(10.0 + 6.0 - 0.1) and found.paid[:3, 0].tolist() == [6.0, 0.0, -0.1]
    assert (at, laps) == (0, [2.0, 0.0, 0.0]) and not found.success[0] and not found.terminated[0]
    assert pay(0, 0, (0, 0, 0), (0, 0, 4))[0].paid[0, 0] == pytest.approx(0.0), "heights count"
    assert pay(0, 0, (0, 0, 2), (0, 0, 4))[0].paid[0, 0] == pytest.approx(2.0 * (10.0 - math.sqrt(104.0)))
    assert pay(0, 0, (-5, 0, 2), (4, 0, 2), far=8.0)[0].paid[0, 0] == pytest.approx(2.0 * (8.0 - 6.0))
    crashed = pay(0, 1, crashed=1)[0]
    assert crashed.paid[:3, 0].tolist() == [0.0, 0.0, 0.0] and crashed.rewards[0] > 10.0


def test_laps_have_their_times() -> None:
    found, at, laps = pay(0, 1)
    assert (at, laps, found.paid[1, 0]) == (1, [2.0, 0.0, 0.0], 5.0)
    assert pay(1, 1)[1:] == (2, [8.0, 6.0, 6.0])
    assert pay(1, 1, lap=(2.0, 9.0, 4.0))[2] == [8.0, 6.0, 4.0], "the shortest one stays"
    found, at, laps = pay(3, 1, lap=(2.0, 9.0, 7.0))
    assert (at, laps) == (4, [8.0, 6.0, 6.0]) and found.success[0] and found.terminated[0]
