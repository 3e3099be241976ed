# SPDX-License-Identifier: BSD-3-Clause
"""ZIGZAG: its stages, its sweep from line to line, and what it says."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.copter.modes import loiter, zigzag
from sitl.autopilot.copter.modes.zigzag import BY_ITSELF, BY_STICKS, STORING, A, B
from sitl.autopilot.modes import ModeResult
from sitl.core.vectors import Vec2, Vec3
from tests.autopilot.copter.steady_copter import fly, make, told, turn_to, wait


def between_points(stage: int = BY_STICKS) -> Any:
    """A vehicle that hovers 10 m north of A and east of the line to B, which is 40 m north of A."""
    v = fly(make(), zigzag.ZIGZAG)
    assert zigzag.start(v) == ModeResult.ACCEPTED
    state = v.autopilot.modes.zigzag
    state.a, state.b, state.has_a, state.has_b, state.stage = Vec2(0.0, 0.0), Vec2(40.0, 0.0), True, True, stage
    move(v, 10.0, 5.0)
    v.autopilot.params.ZIGZ.AUTO_ENABLE = 1.0
    return v


def move(v: Any, n: float, e: float) -> None:
    """Put the vehicle, and its path, somewhere at rest."""
    v.autopilot.estimate.pos = Vec3(n, e, -10.0)
    v.autopilot.control.pos_ne.pos_desired = Vec2(n, e)


def target(v: Any) -> tuple[float, float]:
    """Where the leg that was asked for ends, NE [m]."""
    nav = v.autopilot.modes.nav
    return (float(nav.request.x), float(nav.request.y))


def arrived(v: Any) -> None:
    """At the end of its way, with the waiting time over."""
    nav = v.autopilot.modes.nav
    nav.target, nav.reached = Vec3(*target(v), -10.0), True
    zigzag.arrive(v)


def test_it_begins_without_points() -> None:
    v = between_points(BY_ITSELF)
    state = v.autopilot.modes.zigzag
    state.point, state.sweeping, state.suspended = B, True, True
    assert zigzag.start(v) == ModeResult.ACCEPTED
    assert (state.stage, state.point) == (STORING, A)
    assert not (state.has_a or state.has_b or state.sweeping or state.suspended)


def test_two_points_that_differ_end_the_storing() -> None:
    v = between_points(STORING)
    state = v.autopilot.modes.zigzag
    state.has_a = state.has_b = False
    zigzag.choose(v, A)
    assert (tuple(state.a), bool(state.has_a), bool(state.has_b), state.stage) == ((10.0, 5.0), True, False, STORING)
    zigzag.choose(v, B)
    assert (tuple(state.b), bool(state.has_b), state.stage) == ((10.0, 5.0), True, STORING)  # the same place
    move(v, 10.0, 25.0)
    zigzag.choose(v, B)
    assert (tuple(state.b), state.stage) == ((10.0, 25.0), BY_STICKS)
    assert told(v, zigzag.ZIGZAG_DID) == [(0.0, 0.0), (1.0, 0.0), (1.0, 0.0)]


@pytest.mark.parametrize(("point", "n"), ((A, 0.0), (B, 40.0)))
def test_a_point_of_the_switch_is_flown_to_at_the_present_height(point: int, n: float) -> None:
    v = between_points()
    state, nav = v.autopilot.modes.zigzag, v.autopilot.modes.nav
    state.sweeping = state.suspended = state.sideways = True
    state.reached_us = nav.speed_ne = nav.speed_up = nav.speed_down = 7
    v.autopilot.control.pos_d.pos_desired = -12.0
    zigzag.choose(v, point)
    assert target(v) == (n, 5.0) and nav.request.z == -12.0
    assert (state.stage, state.point, state.reached_us) == (BY_ITSELF, point, 0)
    assert not (state.sweeping or state.suspended or state.sideways)
    assert nav.speed_ne == nav.speed_up == nav.speed_down == 0.0
    assert told(v, zigzag.ZIGZAG_DID) == [(2.0 + point, 0.0)]


def test_one_way_begins_where_the_last_one_ended() -> None:
    v = between_points()
    zigzag.choose(v, A)
    nav = v.autopilot.modes.nav
    nav.target, nav.reached = Vec3(0.0, 5.0, -11.0), True
    move(v, 0.3, 5.2)  # not quite there
    nav.speed_ne = 3.0
    zigzag.choose(v, B)
    assert target(v) == (40.0, 5.0) and nav.request.z == -11.0
    assert nav.speed_ne == 3.0


@pytest.mark.parametrize(("direction", "e", "n"), ((0, 5.0, 10.0), (1, 25.0, 10.0), (3, -15.0, 10.0)))
def test_a_sweep_steps_aside_first_to_the_side_of_zigz_direction(direction: int, e: float, n: float) -> None:
    v = between_points()
    p, state = v.autopilot.params.ZIGZ, v.autopilot.modes.zigzag
    p.DIRECTION, p.SIDE_DIST = float(direction), 20.0
    turn_to(v, 0.01 if direction == 0 else 0.0)
    state.line = 9
    zigzag.sweep(v)
    if direction == 0:
        e = 25.0  # forward is along the line: the nearer side of both
    assert target(v) == pytest.approx((n, e))
    assert (bool(state.sweeping), bool(state.sideways), state.line, state.stage) == (True, True, 0, BY_ITSELF)
    assert told(v, zigzag.ZIGZAG_DID) == [(5.0 + direction, 0.0)]


@pytest.mark.parametrize(("asked", "used"), ((0.0, 0.1), (0.05, 0.1), (100.0, 100.0), (500.0, 100.0)))
def test_the_side_step_has_limits(asked: float, used: float) -> None:
    v = between_points()
    v.autopilot.params.ZIGZ.SIDE_DIST, v.autopilot.params.ZIGZ.DIRECTION = asked, 9.0
    zigzag.sweep(v)  # left is the last of the directions
    assert target(v) == pytest.approx((10.0, 5.0 - used))


@pytest.mark.parametrize(
    ("enabled", "stage", "sweeps"),
    ((1, BY_STICKS, True), (0, BY_STICKS, False), (1, STORING, False), (1, BY_ITSELF, False)),
)
def test_only_from_the_sticks_and_when_enabled_it_sweeps(enabled: int, stage: int, sweeps: bool) -> None:
    v = between_points(stage)
    v.autopilot.params.ZIGZ.AUTO_ENABLE = float(enabled)
    zigzag.sweep(v)
    assert bool(v.autopilot.modes.zigzag.sweeping) == sweeps


def test_a_sweep_goes_from_line_to_line_until_it_has_flown_them() -> None:
    v = between_points()
    p, state = v.autopilot.params.ZIGZ, v.autopilot.modes.zigzag
    p.DIRECTION, p.SIDE_DIST, p.LINE_NUM, p.WP_DELAY = 1.0, 10.0, 2.0, 0.0
    zigzag.sweep(v)
    way = [target(v)]
    for _ in range(3):
        arrived(v)
        way.append(target(v))
    assert way == [(10.0, 15.0), (40.0, 15.0), (40.0, 25.0), (0.0, 25.0)]
    assert state.line == 2
    arrived(v)
    assert (state.stage, bool(state.sweeping)) == (BY_STICKS, False)
    assert told(v, zigzag.ZIGZAG_DID) == [(6.0, 0.0), (3.0, 1.0), (6.0, 1.0), (2.0, 2.0), (4.0, 0.0)]


def test_a_sweep_of_minus_one_lines_does_not_end() -> None:
    v = between_points()
    p, state = v.autopilot.params.ZIGZ, v.autopilot.modes.zigzag
    p.LINE_NUM, p.WP_DELAY = -1.0, 0.0
    zigzag.sweep(v)
    for _ in range(8):
        arrived(v)
    assert (state.line, bool(state.sweeping)) == (4, True)


def test_it_waits_at_the_end_of_a_way() -> None:
    v = between_points()
    state = v.autopilot.modes.zigzag
    v.autopilot.params.ZIGZ.WP_DELAY = 2.0
    zigzag.choose(v, A)
    zigzag.arrive(v)
    assert state.reached_us == v.time_us
    wait(v, 1.9999)
    zigzag.arrive(v)
    assert state.stage == BY_ITSELF
    wait(v, 0.0001)
    zigzag.arrive(v)
    assert state.stage == BY_STICKS


@pytest.mark.parametrize("sideways", (True, False))
def test_a_suspended_sweep_goes_on_as_it_was(sideways: bool) -> None:
    v = between_points()
    state = v.autopilot.modes.zigzag
    zigzag.sweep(v)
    if not sideways:
        v.autopilot.params.ZIGZ.WP_DELAY, v.autopilot.params.ZIGZ.LINE_NUM = 0.0, 5.0
        arrived(v)
    line, point = state.line, state.point
    v.autopilot.modes.loiter.brake_us = v.time_us
    zigzag.suspend(v)
    assert (state.stage, bool(state.suspended), bool(state.sweeping)) == (BY_STICKS, True, False)
    assert v.autopilot.modes.loiter.brake_us == 0
    zigzag.suspend(v)
    assert state.suspended
    zigzag.sweep(v)
    assert (state.stage, bool(state.suspended), bool(state.sweeping)) == (BY_ITSELF, False, True)
    assert (bool(state.sideways), state.line, state.point) == (sideways, line, point)


def test_a_way_to_a_point_is_not_suspended() -> None:
    v = between_points()
    state = v.autopilot.modes.zigzag
    zigzag.choose(v, A)
    zigzag.suspend(v)
    assert (state.stage, bool(state.suspended)) == (BY_ITSELF, False)


@pytest.mark.parametrize("stage", (STORING, BY_STICKS, BY_ITSELF))
def test_it_gives_back_what_it_flies_by_itself(stage: int) -> None:
    v = between_points(stage)
    state = v.autopilot.modes.zigzag
    state.sweeping = True
    zigzag.give_back(v)
    assert not state.sweeping
    assert state.stage == (BY_STICKS if stage == BY_ITSELF else stage)
    assert told(v, zigzag.ZIGZAG_DID) == ([(4.0, 0.0)] if stage == BY_ITSELF else [])


@pytest.mark.parametrize(
    ("stage", "landed", "flown"), ((BY_ITSELF, 0, "way"), (BY_ITSELF, 1, "loiter"), (BY_STICKS, 0, "loiter"))
)
def test_on_the_ground_the_sticks_fly(stage, landed, flown, monkeypatch):
    v = between_points(stage)
    v.autopilot.arming.landed = landed
    ran: list[str] = []
    monkeypatch.setattr(zigzag, "run_line", lambda v: ran.append("way"))
    monkeypatch.setattr(loiter, "run", lambda v: ran.append("loiter"))
    zigzag.run(v)
    assert ran == [flown]


@pytest.mark.parametrize("pending", (0, 1))
def test_it_arrives_when_its_leg_is_flown(pending: int, monkeypatch: pytest.MonkeyPatch) -> None:
    v = between_points(BY_ITSELF)
    v.autopilot.modes.nav.request_pending = pending
    monkeypatch.setattr(zigzag.waypoint, "advance", lambda *args: True)
    v.autopilot.params.ZIGZ.WP_DELAY = 5.0
    zigzag.run_line(v)
    assert (v.autopilot.modes.zigzag.reached_us != 0) == (pending == 0)


@pytest.mark.parametrize(
    ("did", "line", "lines", "said"),
    (
        (0, 0, 5, "ZIGZAG: point A stored"),
        (1, 0, 5, "ZIGZAG: point B stored"),
        (2, 0, 5, "ZIGZAG: moving to A"),
        (3, 5, 5, "ZIGZAG: moving to B (line 5/5)"),
        (3, 6, 5, "ZIGZAG: moving to B"),
        (2, 1, -1, "ZIGZAG: moving to A"),
        (4, 3, 5, "ZIGZAG: manual control"),
        (5, 1, 5, "ZIGZAG: moving to forward"),
        (8, 1, 5, "ZIGZAG: moving to left"),
    ),
)
def test_what_it_says(did: int, line: int, lines: int, said: str) -> None:
    assert zigzag.text(did, line, lines) == said


def test_a_line_through_two_points_is_met_at_right_angles() -> None:
    v = between_points()
    state = v.autopilot.modes.zigzag
    state.a, state.b = Vec2(1.0, 1.0), Vec2(4.0, 5.0)
    here = Vec2(7.0, -2.0)
    for point, at in ((A, state.a), (B, state.b)):
        place = zigzag.position_on_line(state, point, here)
        assert (place.x - at.x) * 3.0 + (place.y - at.y) * 4.0 == pytest.approx(0.0)
        assert (place.x - here.x) * 4.0 - (place.y - here.y) * 3.0 == pytest.approx(0.0)
    aside = zigzag.position_beside(state, here, math.pi, 10.0)
    assert (aside.x, aside.y) == pytest.approx((7.0 - 8.0, -2.0 + 6.0))
