# SPDX-License-Identifier: BSD-3-Clause
"""Laws that write observations and take actions, on rows written by hand: frames, signs, bounds, NaN."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sitl.core.algebra import quat_from_euler
from sitl.core.vectors import Euler, Vec2
from sitl.envs import gathering
from sitl.envs.actions import scale_actions, take_boxed, take_chosen
from sitl.envs.costs import write_distances
from sitl.envs.gathering import Known, Last, gather
from sitl.envs.judge import write_errors
from sitl.envs.observations import Digits, digits_of
from sitl.envs.parts import write_directions, write_headings
from sitl.envs.pictures import write_poses
from sitl.envs.robots.true_state import write_true_reports, write_truth
from sitl.envs.session import write_crash_rewards
from sitl.envs.starts import Grid, flood, mark_free
from sitl.worlds import World
from sitl.worlds.contact import Volume
from sitl.worlds.shapes import Box, Cylinder, Start

QUARTER = math.pi / 2


def rows(*values: Any) -> Any:
    return np.array(values, float)


def narrow(*values: Any) -> Any:
    return np.array(values, np.float32)


def world(*solids: Any) -> World:
    return World("plain", solids, (Start("middle", (0.0, 0.0, 0.0), 0.0),))


# ---------------------------------------------------------------- actions


@pytest.mark.parametrize(
    ("action", "taken"),
    [((0.0, 0.0), True), ((-1.0, 2.0), True), ((1.0, -2.0), True), ((1.01, 0.0), False), ((0.0, -2.01), False),
     ((math.nan, 0.0), False), ((0.0, math.inf), False)],
)  # fmt: skip
def test_boxed_actions_are_taken_within_their_bounds_or_not_at_all(action: Any, taken: bool) -> None:
    out = np.full((2, 2), 9.0)
    assert take_boxed(narrow((0.5, 0.5), action), narrow(-1.0, -2.0), narrow(1.0, 2.0), out) == taken
    wanted = narrow((0.5, 0.5), action).astype(float).tolist() if taken else [[9.0, 9.0], [9.0, 9.0]]
    assert out.tolist() == wanted


@pytest.mark.parametrize(("number", "taken"), [(0, True), (3, True), (4, False), (-1, False)])
def test_chosen_actions_are_numbers_below_their_count(number: int, taken: bool) -> None:
    out = np.array([7, 7])
    assert take_chosen(np.array([1, number]), 4, out) == taken
    assert out.tolist() == ([1, number] if taken else [7, 7])


def test_normalised_actions_are_stretched_into_their_columns() -> None:
    out = np.full((2, 4), 9.0)
    scale_actions(rows((1.0, -0.5), (0.0, 1.0)), np.array([3, 1]), rows(2.0, 10.0), rows(0.5, 4.0), out)
    assert out.tolist() == [[9.0, 8.0, 9.0, 2.5], [9.0, 14.0, 9.0, 2.0]]


# ---------------------------------------------------------------- observations


@pytest.mark.parametrize(
    ("readings", "digits"),
    [((0.2, 9.0, 1.99), (0, 1)), ((5.0, 9.0, 6.0), (5, 6)), ((6.9, 9.0, 99.0), (6, 6)),
     ((math.inf, 9.0, math.nan), (8, 0)), ((-math.inf, 9.0, 0.0), (8, 0))],
)  # fmt: skip
def test_digits_of_the_paper(readings: Any, digits: Any) -> None:
    """Every second reading; infinity is digit 8, the greatest one is 6."""
    out = np.full((1, 2), 7)
    digits_of(narrow(readings), 2, 8, 6, out)
    assert out[0].tolist() == list(digits)


@pytest.mark.parametrize(("yaw", "seen"), [(0.0, (1, 0)), (QUARTER, (0, 1)), (math.pi, (-1, 0)), (-QUARTER, (0, -1))])
def test_headings_and_directions_are_cosine_and_sine(yaw: float, seen: Any) -> None:
    out = np.full((1, 4), 9.0)
    write_headings(rows((1, 2, 3, yaw)), out, 1)
    assert out[0].tolist() == pytest.approx([9.0, *seen, 9.0], abs=1e-12)
    write_directions(rows(yaw), out, 2)
    assert out[0].tolist() == pytest.approx([9.0, seen[0], *seen], abs=1e-12)


@pytest.mark.parametrize(
    ("yaw", "true", "error"),
    [(0.5, 0.2, 0.3), (3.0, -3.0, 6.0 - math.tau), (-3.0, 3.0, math.tau - 6.0), (math.pi, 0.0, -math.pi)],
)
def test_errors_are_estimate_less_truth(yaw: float, true: float, error: float) -> None:
    out = np.full((1, 4), 9.0)
    write_errors(rows((1, 5, 2, yaw)), rows((0.5, 7, 2, true)), out)
    assert out[0].tolist() == pytest.approx([0.5, -2.0, 0.0, error])


def test_rewards_of_crashes_alone() -> None:
    out = np.full(2, 9.0)
    write_crash_rewards(np.array([True, False]), rows(-20.0, -3.0), out)
    assert out.tolist() == [-20.0, 0.0]


# ---------------------------------------------------------------- truth


@pytest.mark.parametrize(
    ("yaw", "velocity", "base"),
    [(0.0, (1, -2, -3), (0.5, 0)), (QUARTER, (2, 1, -3), (0, 0.5)), (math.pi, (-1, 2, -3), (-0.5, 0))],
)
def test_true_states_are_in_the_worlds_frame_and_the_robots(yaw: float, velocity: Any, base: Any) -> None:
    """NED to x forward, y left, z up; the heading clockwise from north becomes a yaw counter-clockwise."""
    q = quat_from_euler(Euler(0.1, 0.2, yaw))
    out = np.full((1, 12), 9.0)
    write_truth(rows((10, 20, -30)), rows((1, 2, 3)), rows(tuple(q)), rows((0.3, 0.4, 0.5)), 0.5, out)
    x, y, z, turned = out[0, :4].tolist()
    assert (x, y, z) == pytest.approx((10 + base[0], -20 - base[1], 30))
    assert math.cos(turned + yaw) == pytest.approx(1.0)
    assert out[0, 4:8].tolist() == pytest.approx([*velocity, -0.5])
    assert out[0, 8:].tolist() == pytest.approx([0.1, 0.2, 0.3, 0.4])


@pytest.mark.parametrize(("yaw", "wind"), [(0.0, (4, -5)), (QUARTER, (5, 4)), (math.pi, (-4, 5))])
def test_true_reports_are_along_the_heading(yaw: float, wind: Any) -> None:
    q = quat_from_euler(Euler(0.3, -0.2, yaw))
    out = np.full((1, 9), 9.0)
    write_true_reports(rows((1, 2, -9)), rows((4, 5, 6)), rows(tuple(q)), rows(12.5), rows(3.0), rows(0.75), out)
    assert out[0].tolist() == pytest.approx([1, -2, 9, 12.5, 3.0, 0.75, *wind, -6])


@pytest.mark.parametrize(("heading", "at"), [(0.0, (0.2, 0.1)), (QUARTER, (-0.1, 0.2)), (math.pi, (-0.2, -0.1))])
def test_cameras_are_on_the_body_and_look_down(heading: float, at: Any) -> None:
    """Mounted 0.7 m ahead, 0.1 m right, 0.3 m down on a body whose base is half a metre ahead of its origin."""
    out = np.full((1, 7), 9.0)
    state = rows((1.0, 2.0, 3.0, -heading, 0, 0, 0, 0, 0.0, 0.0, 0, 0))
    write_poses(state, 0.5, rows(0.7, 0.1, 0.3, 0.4), out)
    assert out[0, :3].tolist() == pytest.approx([1.0 + at[0], -2.0 + at[1], -3.0 + 0.3])
    wanted = quat_from_euler(Euler(0.0, -0.4, heading))
    assert abs(float(np.dot(out[0, 3:], tuple(wanted)))) == pytest.approx(1.0)
    state[0, 8:10] = 0.3, 0.2
    write_poses(state, 0.0, rows(0.0, 0.0, 0.0, 0.0), out)
    wanted = quat_from_euler(Euler(0.3, 0.2, heading))
    assert abs(float(np.dot(out[0, 3:], tuple(wanted)))) == pytest.approx(1.0)


# ---------------------------------------------------------------- solids


@pytest.mark.parametrize(
    ("at", "distance"),
    [
        ((0, 0, 0), 3.0),
        ((0, 2, 0), 3.0),
        ((6.5, 0, 0), 1.5),
        ((4.0, 0, 0), None),
        ((0, 0, 1.9), 3.0),
        ((0, 0, 5.0), 4.0),
    ],
)
def test_the_nearest_solid_is_measured_from_the_outline(at: Any, distance: float | None) -> None:
    """A box 4 m ahead, 1 m long, 8 m wide, from the floor to 2 m; a robot of half a metre, 1 m high."""
    solids = world(Box((4.0, 0.0, 1.0), (1.0, 8.0, 2.0)))
    out = np.zeros(1)
    write_distances(solids.geometry.solids, rows(at), 0.5, 0.0, 1.0, out)
    if distance is None:
        assert out[0] < 0.0, "inside"
    elif at[2] < 2.0:
        assert out[0] == pytest.approx(distance)
    else:
        assert out[0] >= 3.0, "above it"


def test_without_solids_all_is_far() -> None:
    out = np.zeros(1)
    write_distances(world().geometry.solids, rows((0, 0, 0)), 0.5, 0.0, 1.0, out)
    assert out[0] == math.inf


@pytest.mark.parametrize(("margin", "free"), [(0.0, 2), (0.6, 1), (5.0, 0)])
def test_cells_are_free_where_a_robot_stands_with_a_margin(margin: float, free: int) -> None:
    """Five cells of 1 m northwards from a post of 0.5 m; the robot has 0.9 m."""
    solids = world(Cylinder((0.0, 0.0, 1.0), 0.5, 2.0))
    cells = np.full((5, 1), 9)
    grid, robot = Grid(Vec2(0.0, 0.0), 1.0), Volume(Vec2(50.0, 50.0), -1.0, -0.1, 0.9)
    mark_free(solids.geometry.solids, grid, robot, margin, cells)
    assert set(cells.reshape(-1).tolist()) <= {0, 1}
    assert cells.reshape(-1).tolist() == [int(k > 1.4 + margin) for k in range(5)] and cells[2:].sum() >= free - 2
    above = Volume(Vec2(0.0, 0.0), -9.0, -8.0, 0.9)
    mark_free(solids.geometry.solids, grid, above, 0.0, cells)
    assert cells.reshape(-1).tolist() == [1] * 5, "it flies over it"


def test_connected_cells_are_flooded() -> None:
    free = np.array([[1, 0, 1], [1, 0, 1], [1, 1, 0], [0, 0, 1]])
    flood(free, 0, 0, np.zeros(free.size, int))
    assert free.tolist() == [[2, 0, 1], [2, 0, 1], [2, 2, 0], [0, 0, 1]], "not over corners"
    flood(free, 1, 2, np.zeros(free.size, int))
    assert free.tolist() == [[2, 0, 2], [2, 0, 2], [2, 2, 0], [0, 0, 1]]


# ---------------------------------------------------------------- what is gathered

KNOWN = Known(
    rows((1, 2, 3), (4, 5, 6)), rows((11, 12), (13, 14)), rows((21, 22), (23, 24)), rows((31,), (32,)),
    rows((41,), (42,)), narrow((51, 52), (53, 54)),
)  # fmt: skip
LAST = Last(rows((0.5, -0.5), (0.25, 0.75)), np.array([1, 0]), np.array([True, False]))


def gathered(*blocks: Any, low: float = -100.0, high: float = 100.0, known: Known = KNOWN, last: Last = LAST) -> Any:
    width = max(to + count for _, _, to, count in blocks)
    out = np.full((2, width), 9.0, np.float32)
    gather(np.array(blocks), known, last, np.full(width, low, np.float32), np.full(width, high, np.float32), out)
    return out.tolist()


@pytest.mark.parametrize(
    ("source", "first", "seen"),
    [
        ("STATE", 1, [[2, 3], [5, 6]]), ("TRUTH", 0, [[11, 12], [13, 14]]), ("REPORTS", 0, [[21, 22], [23, 24]]),
        ("SCAN", 0, [[51, 52], [53, 54]]), ("ACTIONS", 0, [[0.5, -0.5], [0, 0]]), ("CHOSEN", 0, [[0, 1], [0, 0]]),
        ("CHOSEN", 1, [[1, 0], [0, 0]]),
    ],
)  # fmt: skip
def test_numbers_come_from_their_source(source: str, first: int, seen: Any) -> None:
    """Before the first action there was none."""
    assert gathered((getattr(gathering, source), first, 0, 2)) == seen


def test_parts_stand_beside_each_other() -> None:
    found = gathered((gathering.TRUE_REPORTS, 0, 1, 1), (gathering.COMPUTED, 0, 0, 1), (gathering.STATE, 2, 2, 1))
    assert found == [[41, 31, 3], [42, 32, 6]]


def test_what_is_beyond_the_bounds_is_at_them_and_nan_stays() -> None:
    known = KNOWN._replace(state=rows((-math.inf, 2, math.inf), (math.nan, 0.5, 9)))
    found = gathered((gathering.STATE, 0, 0, 3), low=-1.0, high=1.0, known=known)
    assert found[0] == [-1.0, 1.0, 1.0] and math.isnan(found[1][0]) and found[1][1:] == [0.5, 1.0]


@pytest.mark.parametrize(
    ("readings", "parts", "taken"),
    [(100, 5, 5), (102, 5, 6), (99, 5, 6), (8, 5, 8), (5, 5, 5), (4, 5, 4), (1, 5, 1), (8, 1000, 8), (7, 1, 1)],
)
def test_digits_take_every_so_many_readings_or_each_of_few(readings: int, parts: int, taken: int) -> None:
    """Every (readings // parts)-th, and where the division has a remainder one more."""
    scan = np.arange(readings, dtype=np.float32)[None] % 7.0 + 0.5
    robot: Any = SimpleNamespace(scan=scan, count=1, digit_when_inf=6, range_max=6.9)
    digits = Digits(parts=parts)
    space: Any = digits.space(robot)
    assert space.nvec.tolist() == [7] * taken
    every = max(readings // parts, 1)
    assert digits.observe(robot)[0].tolist() == [k % 7 for k in range(0, readings, every)]
    space = Digits(when_inf=9, parts=parts).space(robot)
    assert space.nvec.tolist() == [10] * taken, "whatever inf gives is in the space"
