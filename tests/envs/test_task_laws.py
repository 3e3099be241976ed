# SPDX-License-Identifier: BSD-3-Clause
"""Laws that judge a step, on rows written by hand: what is paid, what ends an episode, where edges are."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sitl.envs.targets import gates, hold, landing, moving, parking, target_task, waypoints
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


# ---------------------------------------------------------------- hold


@pytest.mark.parametrize(
    ("distance", "far", "worth"),
    [(0.9, 0.0, 0.0), (1.0, 0.0, -1.0), (0.9, 10.0, 0.0), (1.0, 10.0, -0.55), (5.0, 10.0, -0.75), (20.0, 10.0, -1.0)],
)
def test_sparse_rewards(distance: float, far: float, worth: float) -> None:
    assert hold.sparse_worth(distance, 1.0, far) == pytest.approx(worth)
    out = np.zeros(2)
    hold.sparse_worths(rows(0.0, distance), 1.0, far, out)
    assert out.tolist() == pytest.approx([0.0, worth])
    hold.goal_worths(rows((1, 2, 3), (distance + 1.0, 2, 9)), rows((1, 2, 3), (0, 0, 0)),
                     rows((0, 0, 0), (1.0, 2, 0)), FLAT, 1.0, far, out)  # fmt: skip
    assert out.tolist() == pytest.approx([0.0, worth])


@pytest.mark.parametrize("width", [1, 2, 4, 8])
def test_the_mean_square_of_an_action(width: int) -> None:
    table = np.vstack([np.full(width, 9.0), np.arange(1.0, width + 1.0)])
    assert hold.mean_square(table, 1) == pytest.approx(float(np.mean(np.arange(1.0, width + 1.0) ** 2)))


def judged(distance: float, since: float, crashed: int = 0, **rule: Any) -> tuple[Any, float]:
    names = {"scale": 4.0, "radius": 1.0, "hold": 0.3, "half": 0.0, "effort": 0.5, "is_sparse": False, "seconds": 0.1}
    found, times = outcome(1, flags(crashed)), rows(since)
    holding = hold.Holding(**{k: v for k, v in {**names, **rule}.items() if k in hold.Holding._fields})
    hold.judge_hold(holding, rows((distance, 0, 0)), rows((0, 0, 0)), AXES, rows((1.0, 0.0)), times, found)
    return found, float(times[0])


def test_holding_pays_nearness_less_effort() -> None:
    found, since = judged(2.0, 0.2)
    assert found.rewards[0] == pytest.approx(10.0 + 0.1 * 0.5 - 0.25)
    assert found.paid[:2, 0].tolist() == pytest.approx([0.05, -0.25]) and since == 0.0 and not found.success[0]
    assert judged(2.0, 0.2, crashed=1)[0].paid[:2, 0].tolist() == [0.0, 0.0]
    assert judged(2.0, 0.2, effort=0.0)[0].paid[1, 0] == 9.0, "there is no such term"


@pytest.mark.parametrize(
    ("distance", "since", "after", "done"),
    [(0.99, 0.0, 0.1, False), (0.99, 0.2, 0.3, True), (1.0, 0.2, 0.0, False), (0.5, 0.5, 0.6, True)],
)
def test_it_is_held_for_a_while(distance: float, since: float, after: float, done: bool) -> None:
    found, times = judged(distance, since)
    assert times == pytest.approx(after) and bool(found.success[0]) == done and not found.terminated[0]


# ---------------------------------------------------------------- targets that move


def test_times_ahead() -> None:
    out = np.zeros((2, 3))
    moving.spread_times(rows(1.0, 5.0), 0.5, out)
    assert out.tolist() == [[1.0, 1.5, 2.0], [5.0, 5.5, 6.0]]


def test_errors_are_root_mean_squares_of_what_counts() -> None:
    sums = np.zeros((2, 2))
    assert moving.note_error(sums, 1, 100.0, False) == 0.0
    assert moving.note_error(sums, 1, 9.0, True) == pytest.approx(3.0)
    assert moving.note_error(sums, 1, 16.0, True) == pytest.approx(math.sqrt(12.5))
    assert moving.note_error(sums, 1, 99.0, False) == pytest.approx(math.sqrt(12.5))
    assert sums.tolist() == [[0.0, 0.0], [25.0, 2.0]]


@pytest.mark.parametrize(
    ("lost", "reward", "ended", "cost", "ends"),
    [(True, -5.0, False, -5.0, True), (False, -5.0, False, 0.0, False), (True, 0.0, False, 9.0, True),
     (True, -5.0, True, 0.0, True)],
)  # fmt: skip
def test_who_loses_its_target_ends(lost: bool, reward: float, ended: bool, cost: float, ends: bool) -> None:
    found = outcome()
    found.terminated[0] = ended
    moving.end_lost(0, lost, reward, found, 2)
    assert found.paid[2, 0] == cost and bool(found.terminated[0]) == ends
    assert found.rewards[0] == 10.0 + (cost if reward else 0.0)


@pytest.mark.parametrize(
    ("distance", "time", "error", "success", "ended"),
    [(0.5, 3.0, 0.5, True, False), (0.5, 2.9, 0.0, False, False), (1.0, 3.0, 1.0, False, False),
     (8.0, 3.0, 8.0, False, False), (8.1, 3.0, 8.1, False, True)],
)  # fmt: skip
def test_following(distance: float, time: float, error: float, success: bool, ended: bool) -> None:
    names = {"scale": 4.0, "half": 0.0, "radius": 1.0, "settle": 3.0, "lost": 8.0, "lost_reward": -5.0, "seconds": 0.1}
    rule, found = moving.Following(**{k: names[k] for k in moving.Following._fields}), outcome()
    noted = moving.Noted(np.zeros((1, 2)), rows(9.0))
    moving.judge_follow(rule, rows((0, distance, 5)), rows((0, 0, 0)), FLAT, rows(time), noted, found)
    assert noted.errors[0] == pytest.approx(error) and bool(found.success[0]) == success
    assert bool(found.terminated[0]) == ended and found.paid[1, 0] == (-5.0 if ended else 0.0)
    assert found.paid[0, 0] == pytest.approx(0.1 * max(1.0 - distance / 4.0, 0.0))


@pytest.mark.parametrize(
    ("curve", "phase", "at"),
    [
        (moving.EIGHT, 0.0, (0, 0, 0)), (moving.EIGHT, math.pi / 4, (math.sqrt(0.5), 0.5, 0)),
        (moving.EIGHT, math.pi / 2, (1, 0, 0)), (moving.CIRCLE, math.pi / 2, (1, 1, 0)),
        (moving.CIRCLE, math.pi, (0, 2, 0)), (moving.HELIX, math.pi, (0, 2, 0.25)),
        (moving.HELIX, 3.0 * math.pi, (0, 2, 1)),
    ],
)  # fmt: skip
def test_curves_begin_ahead_and_turn_left(curve: int, phase: float, at: Any) -> None:
    out = np.zeros((2, 3))
    times = rows((0.0, phase / 0.5))
    moving.write_curves(curve, 2.0, 1.0, rows((0.5, 0.0)), rows((1, 2, 3)), times, out)
    assert out[0].tolist() == pytest.approx([1, 2, 3])
    assert out[1].tolist() == pytest.approx([1 + 2 * at[0], 2 + 2 * at[1], 3 + 2 * at[2]])
    moving.write_curves(curve, 2.0, 0.0, rows((0.5, math.pi / 2)), rows((1, 2, 3)), times, out)
    assert out[1].tolist() == pytest.approx([1 - 2 * at[1], 2 + 2 * at[0], 3]), "turned, and on the ground"


def test_waves_are_sums_of_sines_from_their_centre() -> None:
    waves = np.zeros((1, 18))
    waves[0, 0:3], waves[0, 3:6], waves[0, 15:18] = (1.0, 2.0, 0.5), (0.5, 1.0, 0.0), (3.0, 1.0, math.pi / 2)
    out = np.zeros((2, 3))
    moving.write_waves(waves, rows((1, 2, 3)), rows((0.0, 0.7)), out)
    assert out[0].tolist() == pytest.approx([1, 2, 3])
    x = math.sin(1.4 + 0.5) - math.sin(0.5) + 0.5 * math.sin(0.7)
    assert out[1].tolist() == pytest.approx([1 + x, 2, 3 + 3 * (math.cos(0.7) - 1.0)])


# ---------------------------------------------------------------- landing


@pytest.mark.parametrize(("time", "there"), [(0, 0), (4, 4), (10, 10), (14, 6), (20, 0), (24, 4)])
def test_pads_go_there_for_ten_seconds_and_back(time: float, there: float) -> None:
    out = np.zeros((2, 3))
    landing.write_pads(rows((1, -2, 0.5)), rows((10, 20, 30)), rows((0.0, time)), out)
    assert out == pytest.approx(rows((10, 20, 30), (10 + there, 20 - 2 * there, 30 + 0.5 * there)))


def land(height: float = 0.0, away: float = 0.0, speed: float = 0.0, sinking: float = 0.2, landed: int = 0,
         climb: float = 0.0, lets_down: bool = False, pad: float = 0.0, time: float = 5.0, yaw: float = 0.0,
         **more: Any) -> tuple[Any, Any]:  # fmt: skip
    """One robot so high above its floor at 1 m, so far north of its pad of half a metre, which goes ahead."""
    names = {"pad": 0.5, "progress": 2.0, "far": 20.0, "time": -0.1, "success_reward": 50.0, "crash_reward": -20.0,
             "lost": 30.0, "lost_reward": -5.0, "settle": 1.0, "lets_down": lets_down, **more}  # fmt: skip
    rule = landing.Landing(**{k: names[k] for k in landing.Landing._fields})
    state = rows((away, 0, 1.0 + height, yaw, speed, 0, climb, 0))
    grounds = landing.Grounds(rows(1.0), rows((0, 0, 1.0)), flags(landed))
    so_far = landing.SoFar(rows((pad, 0, 0)), rows(3.0), rows(sinking), rows((9, 9, 9)), np.zeros((1, 2)), rows(0.0))
    found = outcome()
    landing.judge_land(rule, state, grounds, rows(time), so_far, found)
    return found, so_far


def test_on_the_pad_gently_is_a_success() -> None:
    found, so_far = land()
    assert found.success[0] and found.terminated[0]
    assert found.rewards[0] == pytest.approx(10.0 + 2.0 * 3.0 - 0.1 + 50.0)
    assert found.paid[:4, 0].tolist() == pytest.approx([6.0, -0.1, 50.0, 0.0]) and so_far.distance[0] == 0.0


@pytest.mark.parametrize(
    "spoil",
    [{"away": 0.5}, {"speed": landing.SLOW}, {"sinking": landing.GENTLE}, {"pad": landing.SLOW},
     {"pad": 1.0, "speed": 1.0, "time": 15.0}, {"pad": 1.0, "speed": 1.0, "yaw": math.pi}],
)  # fmt: skip
def test_beside_the_pad_or_fast_it_has_crashed(spoil: Any) -> None:
    found, _ = land(**spoil)
    assert not found.success[0] and found.terminated[0] and found.paid[2, 0] == -20.0


@pytest.mark.parametrize(
    "fits", [{"away": 0.49}, {"sinking": 0.99 * landing.GENTLE}, {"pad": 1.0, "speed": 1.0},
             {"pad": 1.0, "speed": -1.0, "time": 15.0}, {"pad": -1.0, "speed": 1.0, "yaw": math.pi}]
)  # fmt: skip
def test_with_a_pad_that_moves_it_moves_along(fits: Any) -> None:
    assert land(**fits)[0].success[0]


@pytest.mark.parametrize(
    ("given", "down"),
    [({"height": 0.99 * landing.DOWN}, True), ({"height": landing.DOWN}, False),
     ({"height": 0.0, "lets_down": True}, False), ({"height": 5.0, "landed": 1}, True),
     ({"height": 0.0, "lets_down": True, "landed": 1}, True)],
)  # fmt: skip
def test_it_is_down_by_its_height_or_where_the_autopilot_says_so(given: Any, down: bool) -> None:
    found, _ = land(**given)
    assert bool(found.terminated[0]) == down and (found.paid[2, 0] == 0.0) != down


def test_where_it_touched_counts_where_the_autopilot_lets_it_down() -> None:
    _, so_far = land(height=0.0, away=2.0, lets_down=True)
    assert so_far.touched[0].tolist() == [9.0, 9.0, 9.0] and so_far.sinking[0] == 0.2, "it stands: that stays"
    _, so_far = land(height=landing.LET_DOWN + 0.1, away=2.0, lets_down=True, climb=-0.3)
    assert so_far.touched[0, :2].tolist() == [-2.0, 0.0] and so_far.sinking[0] == 0.3
    _, so_far = land(height=0.0, away=2.0, lets_down=True, climb=-landing.STANDS - 0.01)
    assert so_far.touched[0, 0] == -2.0 and so_far.sinking[0] == 0.2


def test_a_pad_that_is_lost_ends_the_episode() -> None:
    found, so_far = land(height=5.0, away=30.1)
    assert found.terminated[0] and found.paid[3, 0] == -5.0 and found.paid[0, 0] == pytest.approx(2.0 * (3.0 - 20.0))
    assert not land(height=5.0, away=29.0)[0].terminated[0]
    assert so_far.errors[0] == pytest.approx(math.hypot(30.1, 5.0)) and land(time=0.9)[1].sums[0, 1] == 0.0


# ---------------------------------------------------------------- parking


@pytest.mark.parametrize(
    ("yaw", "to_yaw", "error"), [(0.0, 0.5, 0.5), (0.5, 0.0, 0.5), (3.0, -3.0, math.tau - 6.0), (0.0, math.pi, math.pi)]
)
def test_what_is_left_of_the_way_to_a_bay(yaw: float, to_yaw: float, error: float) -> None:
    names = {"radius": 0.5, "angle": 0.2, "speed": 0.1, "progress": 2.0, "turn_progress": 3.0, "time": -0.1,
             "success_reward": 50.0}  # fmt: skip
    rule = parking.Parking(**names)
    distance, turned, worth = parking.worth_of(rule, 1.0, 2.0, yaw, 4.0, 6.0, to_yaw)
    assert (distance, turned) == pytest.approx((5.0, error))
    near = parking.worth_of(rule, 4.0, 6.0, yaw, 4.0, 6.0, to_yaw)[2]
    assert near == pytest.approx(3.0 * error) and 10.0 < worth < 10.0 + near
    share = (worth - 10.0) / (3.0 * error)
    assert share == pytest.approx(1.0 / (1.0 + (5.0 / parking._NEAR) ** 2))


def park(x: float = 0.0, yaw: float = 0.0, speed: float = 0.0, crashed: int = 0) -> tuple[Any, Any, Any]:
    names = {"radius": 0.5, "angle": 0.2, "speed": 0.1, "progress": 2.0, "turn_progress": 3.0, "time": -0.1,
             "success_reward": 50.0}  # fmt: skip
    found, left, away = outcome(1, flags(crashed)), rows(7.0), rows(3.0)
    state = rows((x, 0, 0, yaw, speed))
    parking.judge_park(parking.Parking(**names), state, rows((0, 0, 0)), rows(0.0), left, away, found)
    return found, left, away


@pytest.mark.parametrize(
    ("given", "parked"),
    [({}, True), ({"x": 0.49}, True), ({"x": 0.5}, False), ({"yaw": -0.19}, True), ({"yaw": 0.21}, False),
     ({"speed": -0.09}, True), ({"speed": -0.1}, False), ({"speed": 0.1}, False)],
)  # fmt: skip
def test_it_is_parked_near_straight_and_still(given: Any, parked: bool) -> None:
    found, _, away = park(**given)
    assert bool(found.success[0]) == parked == bool(found.terminated[0])
    assert found.paid[3, 0] == (50.0 if parked else 0.0) and away[0] == abs(given.get("x", 0.0))


def test_parking_pays_the_way_and_the_turn() -> None:
    found, left, _ = park(x=1.0)
    assert left[0] == pytest.approx(2.0) and found.rewards[0] == pytest.approx(10.0 + 5.0 - 0.1)
    assert found.paid[:4, 0].tolist() == pytest.approx([2.0 * (3.0 - 1.0), 5.0 - 4.0, -0.1, 0.0])
    assert park(x=1.0, crashed=1)[0].paid[:4, 0].tolist() == [0.0] * 4
