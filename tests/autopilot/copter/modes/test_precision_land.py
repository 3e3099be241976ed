# SPDX-License-Identifier: BSD-3-Clause
"""Landing on a target (PLND_*): when it goes down, tries again and gives up; how fast it sinks over the target."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.autopilot.copter.modes import descent, precision_land
from sitl.autopilot.copter.modes.precision_land import (
    CLIMBING,
    DESCENDING,
    GIVEN_UP,
    GO_DOWN,
    RETURNING,
    STAY,
    TRY_AGAIN,
)
from sitl.autopilot.landing_target.state import FOUND, LANDING_TARGET_DID, LOST, NEVER_SEEN, OUT_OF_RANGE
from sitl.core.vectors import Vec2, Vec3
from tests.autopilot.copter.steady_copter import fly, make, told, wait

LANDS, LANDS_LATE, HOVERS = 0.0, 1.0, 2.0  # PLND_STRICT


def landing(status: int = LOST, strict: float = LANDS_LATE) -> Any:
    """A vehicle at 10 m that lost its target, 3 m to the north, just now."""
    v = fly(make(), 9)
    ap = v.autopilot
    t, p = ap.landing_target, ap.params.PLND
    p.ENABLED, p.STRICT, p.RET_MAX, p.TIMEOUT = 1.0, strict, 2.0, 4.0
    t.status, t.lost_us = status, v.time_us
    t.seen_from, t.last_pos = Vec3(0.0, 1.0, -6.0), Vec3(3.0, 0.0, 0.0)
    return v


def choose(v: Any) -> int:
    """What it does in this tick."""
    ap = v.autopilot
    return precision_land.choose(
        ap.modes.land, ap.landing_target, ap.estimate.pos, ap.events, v.time_us, ap.params.PLND
    )


@pytest.mark.parametrize(
    ("status", "strict", "action"),
    (
        (FOUND, HOVERS, GO_DOWN),
        (OUT_OF_RANGE, HOVERS, GO_DOWN),
        (LOST, LANDS, GO_DOWN),
        (NEVER_SEEN, LANDS, GO_DOWN),
        (NEVER_SEEN, LANDS_LATE, STAY),
        (NEVER_SEEN, HOVERS, STAY),
        (LOST, HOVERS, GO_DOWN),  # not for long yet
    ),
)
def test_what_it_does_without_having_tried_again(status: int, strict: float, action: int) -> None:
    assert choose(landing(status, strict)) == action


@pytest.mark.parametrize("cause", ("pause", "repositioned"))
def test_a_pause_and_the_sticks_come_first(cause: str) -> None:
    v = landing(NEVER_SEEN, HOVERS)
    setattr(v.autopilot.modes.land, cause, True)
    assert choose(v) == GO_DOWN
    assert told(v, LANDING_TARGET_DID) == []


def test_a_target_that_is_found_again_ends_the_search() -> None:
    v = landing(FOUND)
    v.autopilot.modes.land.stage = RETURNING
    assert choose(v) == GO_DOWN
    assert v.autopilot.modes.land.stage == DESCENDING


def test_it_goes_down_for_plnd_timeout_and_then_tries_again() -> None:
    v = landing()
    land = v.autopilot.modes.land
    wait(v, 3.9999)
    assert (choose(v), land.tries) == (GO_DOWN, 0)
    wait(v, 0.0001)
    assert (choose(v), land.stage, land.tries) == (TRY_AGAIN, CLIMBING, 1)
    assert told(v, LANDING_TARGET_DID) == [(float(precision_land.SAID_RETRY), 0.0)]


def test_a_try_climbs_above_where_it_saw_the_target_returns_there_and_gives_up() -> None:
    v = landing()
    ap = v.autopilot
    land = ap.modes.land
    wait(v, 4.0)
    choose(v)
    ap.estimate.pos = Vec3(0.0, 1.0, -6.7)  # 1.5 m above it was seen, less 0.8
    assert (choose(v), land.stage) == (TRY_AGAIN, CLIMBING)
    ap.estimate.pos = Vec3(0.0, 1.0, -6.8)
    assert (choose(v), land.stage) == (TRY_AGAIN, RETURNING)
    assert (choose(v), land.stage) == (TRY_AGAIN, RETURNING)
    ap.estimate.pos = Vec3(0.0, 1.0, -6.7)
    assert (choose(v), land.stage) == (STAY, GIVEN_UP)
    said = [int(a) for a, _ in told(v, LANDING_TARGET_DID)]
    assert said == [precision_land.SAID_RETRY, precision_land.SAID_RETRIED, precision_land.SAID_FAILSAFE]


@pytest.mark.parametrize(("tries", "most", "again"), ((1, 2.0, True), (2, 2.0, False), (0, 0.0, False)))
def test_it_tries_plnd_ret_max_times(tries: int, most: float, again: bool) -> None:
    v = landing()
    v.autopilot.modes.land.tries, v.autopilot.params.PLND.RET_MAX = tries, most
    wait(v, 4.0)
    assert choose(v) == (TRY_AGAIN if again else STAY)
    assert v.autopilot.modes.land.tries == tries + again


@pytest.mark.parametrize(("strict", "after"), ((LANDS_LATE, GO_DOWN), (HOVERS, STAY)))
def test_a_vehicle_that_gave_up_hovers_for_seven_seconds(strict: float, after: int) -> None:
    v = landing(NEVER_SEEN, strict)
    assert choose(v) == STAY
    wait(v, 6.9999)
    assert choose(v) == STAY
    wait(v, 0.0001)
    assert choose(v) == after
    assert told(v, LANDING_TARGET_DID) == [(float(precision_land.SAID_FAILSAFE), 0.0)]


@pytest.mark.parametrize(
    ("behave", "stage", "place"),
    (
        (0.0, CLIMBING, (0.0, 1.0, -7.5)),
        (0.0, RETURNING, (0.0, 1.0, -6.0)),
        (1.0, CLIMBING, (3.0, 0.0, -7.5)),
        (1.0, RETURNING, (3.0, 0.0, -6.0)),
    ),
)
def test_where_it_looks_for_the_target_again(behave: float, stage: int, place: tuple[float, ...]) -> None:
    v = landing()
    ap = v.autopilot
    ap.modes.land.stage, ap.params.PLND.RET_BEHAVE = stage, behave
    assert tuple(precision_land.position_to_try(ap.modes.land, ap.landing_target, ap.params.PLND)) == place


@pytest.mark.parametrize("axis", range(3))
def test_what_is_near(axis: int) -> None:
    for away, near in ((0.74, True), (-0.74, True), (0.76, False), (-0.76, False)):
        pos = [1.0, 2.0, 3.0]
        pos[axis] += away
        assert precision_land.is_near(Vec3(*pos), Vec3(1.0, 2.0, 3.0)) == near
    assert not precision_land.is_near(Vec3(1.5, 2.5, 3.5), Vec3(1.0, 2.0, 3.0))


@pytest.mark.parametrize(
    ("height", "aside", "most", "options", "rate"),
    (
        (5.0, 0.1, 2.0, 0, 1.0),
        (5.0, 2.1, 2.0, 0, 0.0),  # PLND_XY_DIST_MAX
        (5.0, 2.0, 2.0, 0, 1.0),
        (5.0, 2.1, 0.0, 0, 1.0),  # no limit
        (1.0, 0.0, 2.0, 0, 0.25),  # half of LAND_SPEED
        (1.0, 0.06, 2.0, 0, 0.15),
        (1.0, 0.15, 2.0, 0, 0.1),
        (1.0, 0.3, 2.0, 0, 0.1),
        (1.0, 0.0, 2.0, 4, 1.0),  # PLND_OPTIONS: as fast as else
        (0.35, 0.0, 2.0, 0, 1.0),
        (0.36, 0.0, 2.0, 0, 0.25),
        (1.99, 0.0, 2.0, 0, 0.25),
        (2.0, 0.0, 2.0, 0, 1.0),
    ),
)
def test_how_fast_it_sinks_over_the_target(height, aside, most, options, rate):
    v = landing(FOUND)
    t, p = v.autopilot.landing_target, v.autopilot.params
    t.measured_pos, t.away = Vec3(0.0, aside, height), Vec2(aside, 0.0)
    p.PLND.XY_DIST_MAX, p.PLND.OPTIONS, p.LAND.SPEED = most, float(options), 50.0
    assert precision_land.over_target(t, 1.0, p) == pytest.approx(rate)


@pytest.mark.parametrize(("options", "vel"), ((0, (0.0, 0.0)), (1, (1.5, -0.5)), (6, (0.0, 0.0))))
def test_a_target_moves_when_it_is_said_to(options: int, vel: tuple[float, float]) -> None:
    v = landing(FOUND)
    ap = v.autopilot
    ap.params.PLND.OPTIONS = float(options)
    ap.estimate.vel, ap.landing_target.closing = Vec3(2.0, 0.0, 0.0), Vec2(-0.5, -0.5)
    motion = precision_land.target_motion(ap.landing_target, ap.estimate, ap.params.PLND)
    assert (tuple(motion.vel), tuple(motion.acc)) == (vel, (0.0, 0.0))


@pytest.mark.parametrize(
    ("stick", "options", "before", "after"),
    ((1.0, 0, False, True), (0.0, 0, True, True), (0.0, 2, True, False), (1.0, 2, False, True), (0.0, 0, False, False)),
)
def test_sticks_take_the_place_over_for_good_or_until_they_rest(stick, options, before, after, monkeypatch):
    v = landing(FOUND)
    ap = v.autopilot
    ap.params.PLND.OPTIONS, ap.modes.land.repositioned = float(options), before
    monkeypatch.setattr(descent, "stick_velocity", lambda *args: Vec2(0.0, stick))
    done: list[tuple[Any, ...]] = []
    monkeypatch.setattr(precision_land, "follow", lambda v, sticks, height, stay: done.append((sticks.y, height, stay)))
    precision_land.descend(v)
    assert bool(ap.modes.land.repositioned) == after
    assert done == [(stick, pytest.approx(10.0), False)]


@pytest.mark.parametrize(
    ("enabled", "status", "did"),
    ((0.0, NEVER_SEEN, "plain"), (1.0, LOST, "back"), (1.0, NEVER_SEEN, "stays"), (1.0, FOUND, "goes")),
)
def test_which_descent_is_flown(enabled: float, status: int, did: str, monkeypatch: pytest.MonkeyPatch) -> None:
    v = landing(status)
    v.autopilot.params.PLND.ENABLED = enabled
    wait(v, 4.0)
    done: list[str] = []
    monkeypatch.setattr(descent, "descend", lambda *args: done.append("plain"))
    monkeypatch.setattr(precision_land, "fly_back", lambda v: done.append("back"))
    monkeypatch.setattr(
        precision_land, "follow", lambda v, sticks, height, stay: done.append("stays" if stay else "goes")
    )
    precision_land.descend(v)
    assert done == [did]


@pytest.mark.parametrize(
    ("acquired", "repositioned", "stay", "pause", "how"),
    (
        (True, False, False, False, "over"),
        (True, True, False, False, "sinks"),
        (False, False, False, False, "sinks"),
        (True, False, True, False, "hovers"),
        (False, False, True, False, "hovers"),
        (True, False, False, True, "sinks"),
    ),
)
def test_over_a_target_that_is_seen_it_sinks_as_that_asks(acquired, repositioned, stay, pause, how, monkeypatch):
    v = landing(FOUND)
    ap = v.autopilot
    ap.landing_target.acquired, ap.modes.land.repositioned, ap.modes.land.pause = acquired, repositioned, pause
    ap.landing_target.measured_pos = Vec3(0.0, 0.0, 1.0)
    ap.params.LAND.SPEED = 50.0
    done: list[Any] = []
    monkeypatch.setattr(
        precision_land.altitude, "land_at_rate_d", lambda c, rate, near: done.append((rate, bool(near)))
    )
    monkeypatch.setattr(descent, "sink", lambda *args: done.append("sinks"))
    monkeypatch.setattr(precision_land.ground, "fly", lambda *args: None)
    precision_land.follow(v, Vec2(0.0, 0.0), 1.0, stay)
    assert done == [{"over": (0.25, True), "hovers": (0.0, False), "sinks": "sinks"}[how]]
    done.clear()
    precision_land.follow(v, Vec2(0.0, 0.0), 30.0, stay)
    if how == "over":
        assert done == [(0.25, False)]


@pytest.mark.parametrize("landed_maybe", (0, 1))
def test_near_the_ground_the_place_is_held_softly(landed_maybe: int, monkeypatch: pytest.MonkeyPatch) -> None:
    v = landing(FOUND)
    v.autopilot.arming.landed_maybe = landed_maybe
    done: list[Any] = []
    monkeypatch.setattr(precision_land.position_start, "soften_for_landing_ne", lambda *args: done.append("soft"))
    monkeypatch.setattr(precision_land.position, "input_vel_accel_ne", lambda c, vel, acc: done.append(tuple(vel)))
    assert not precision_land.hold_position(v, Vec2(1.0, 2.0))
    assert done == ["soft"] * landed_maybe + [(1.0, 2.0)]
