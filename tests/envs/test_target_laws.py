# SPDX-License-Identifier: BSD-3-Clause
"""Laws that judge steps of holding, following, landing and parking, on rows written by hand."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sitl.envs.targets import hold, landing, moving, parking
from sitl.envs.tasks_v1 import TRACK
from tests.envs.test_task_laws import AXES, FLAT, flags, outcome, rows


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


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_each_axis_counts_as_much_as_it_is_given(axis: int) -> None:
    """One metre along an axis that counts twice is two metres away, whatever is between it and the goal on others."""
    axes, there = np.zeros(3), np.full((1, 3), 5.0)
    axes[axis], there[0, axis] = 2.0, 1.0
    out = np.zeros(1)
    hold.goal_worths(there, np.zeros((1, 3)), np.zeros((1, 3)), axes, 1.0, 10.0, out)
    assert out[0] == pytest.approx(-(0.5 + 0.5 * 0.2))
    hold.goal_worths(np.zeros((1, 3)), there, np.zeros((1, 3)), axes, 1.0, 10.0, out)
    assert out[0] == pytest.approx(-(0.5 + 0.5 * 0.2))
    hold.goal_worths(np.zeros((1, 3)), np.zeros((1, 3)), there, axes, 1.0, 10.0, out)
    assert out[0] == pytest.approx(-(0.5 + 0.5 * 0.2))
    names = {"scale": 4.0, "half": 0.0, "radius": 9.0, "settle": 0.0, "lost": 8.0, "lost_reward": 0.0, "seconds": 0.1}
    noted = moving.Noted(np.zeros((1, 2)), np.zeros(1))
    moving.judge_follow(moving.Following(**names), there, np.zeros((1, 3)), axes, rows(1.0), noted, outcome())
    assert noted.errors[0] == pytest.approx(2.0)


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
         crashed: int = 0, **more: Any) -> tuple[Any, Any]:  # fmt: skip
    """One robot so high above its floor at 1 m, so far north of its pad of half a metre, which goes ahead."""
    names = {"pad": 0.5, "progress": 2.0, "far": 20.0, "time": -0.1, "success_reward": 50.0, "crash_reward": -20.0,
             "lost": 30.0, "lost_reward": -5.0, "settle": 1.0, "lets_down": lets_down, **more}  # fmt: skip
    rule = landing.Landing(**{k: names[k] for k in landing.Landing._fields})
    state = rows((away, 0, 1.0 + height, yaw, speed, 0, climb, 0))
    grounds = landing.Grounds(rows(1.0), rows((0, 0, 1.0)), flags(landed))
    so_far = landing.SoFar(rows((pad, 0, 0)), rows(3.0), rows(sinking), rows((9, 9, 9)), np.zeros((1, 2)), rows(0.0))
    found = outcome(1, flags(crashed))
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


def test_of_a_crash_no_term_of_a_landing_is_told() -> None:
    assert land(crashed=1, lost_reward=-5.0)[0].paid[:4, 0].tolist() == [0.0, 0.0, 0.0, 0.0]
    assert land(height=5.0, away=30.1, crashed=1)[0].paid[:4, 0].tolist() == [0.0, 0.0, 0.0, 0.0]


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


def test_the_track_is_an_oval_of_six_gates_that_are_flown_through_counter_clockwise() -> None:
    """24 m wide and 16 m long about a point 10 m ahead; each gate looks along the oval."""
    assert len(TRACK) == 6
    angles = [math.atan2(gate.y / 12.0, (gate.x - 10.0) / 8.0) for gate in TRACK]
    assert np.diff(np.degrees(np.unwrap(angles))) == pytest.approx([60.0] * 5) and angles[2] == pytest.approx(0.0)
    for gate, angle in zip(TRACK, angles, strict=True):
        assert math.hypot((gate.x - 10.0) / 8.0, gate.y / 12.0) == pytest.approx(1.0)
        assert math.cos(gate.yaw - angle - math.pi / 2) == pytest.approx(1.0) and 1.5 <= gate.z <= 3.5
