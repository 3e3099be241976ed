# SPDX-License-Identifier: BSD-3-Clause
"""The course of AUTOTUNE: who may enter, what interrupts it, when it is level, what follows a twitch."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.copter.control import attitude
from sitl.autopilot.copter.modes import autotune
from sitl.autopilot.copter.modes import autotune_gains as gains
from sitl.autopilot.copter.modes import autotune_rules as rules
from sitl.autopilot.copter.modes.autotune_gains import PITCH, ROLL, YAW, YAW_D
from sitl.autopilot.modes import ModeResult
from sitl.core.vectors import Euler, Vec2, Vec3
from tests.autopilot.copter.steady_copter import fly, make, told, turn_to, wait


def flying(mode: int = 2) -> Any:
    """In the air in a mode that AUTOTUNE may be entered from."""
    v = fly(make(), mode)
    v.autopilot.modes.pilot.throttle_zero = False
    return v


def tuning(axis: int = ROLL, step: int = rules.RATE_D_UP) -> Any:
    """In the middle of it."""
    v = flying()
    assert autotune.start(v) == ModeResult.ACCEPTED
    v.autopilot.modes.number = autotune.AUTOTUNE
    t = v.autopilot.modes.autotune
    t.axis, t.step = axis, step
    return v


@pytest.mark.parametrize(
    ("chosen", "done", "axis"),
    (
        (7, 0, ROLL),
        (7, 1, PITCH),
        (7, 3, YAW),
        (7, 7, 4),
        (15, 7, YAW_D),
        (4, 0, YAW),
        (5, 1, YAW),
        (0, 0, 4),
        (8, 0, 3),
    ),
)
def test_axes_come_in_turn(chosen: int, done: int, axis: int) -> None:
    assert autotune.next_axis(chosen, done) == axis


@pytest.mark.parametrize(
    ("mode", "armed", "landed", "low", "axes", "result"),
    (
        (0, 1, 0, False, 7, 0),
        (2, 1, 0, False, 7, 0),
        (5, 1, 0, False, 7, 0),
        (16, 1, 0, False, 7, 0),
        (4, 1, 0, False, 7, ModeResult.INIT_FAILED),
        (2, 0, 0, False, 7, ModeResult.INIT_FAILED),
        (2, 1, 1, False, 7, ModeResult.INIT_FAILED),
        (2, 1, 0, True, 7, ModeResult.INIT_FAILED),
        (2, 1, 0, False, 0, ModeResult.INIT_FAILED),
    ),
)
def test_it_is_entered_by_hand_in_the_air_with_an_axis_to_tune(mode, armed, landed, low, axes, result):
    v = flying(mode)
    ap = v.autopilot
    ap.arming.armed, ap.arming.landed, ap.modes.pilot.throttle_zero = armed, landed, low
    ap.params.AUTOTUNE.AXES = float(axes)
    assert autotune.start(v) == result
    assert told(v, gains.AUTOTUNE_DID) == ([] if result else [(gains.STARTED, 0.0)])


@pytest.mark.parametrize(
    ("mode", "located", "holds"), ((5, 1, True), (16, 1, True), (2, 1, False), (0, 1, False), (5, 0, False))
)
def test_it_holds_its_place_when_the_mode_before_did(mode: int, located: int, holds: bool) -> None:
    v = flying(mode)
    v.autopilot.estimate.position_ok = located
    v.autopilot.estimate.pos = Vec3(3.0, 4.0, -10.0)
    turn_to(v, 0.7)
    assert autotune.start(v) == ModeResult.ACCEPTED
    t = v.autopilot.modes.autotune
    assert (bool(t.holds_position), tuple(t.hold_pos), t.heading) == (holds, (3.0, 4.0), 0.7)


def test_it_begins_anew_goes_on_after_a_pause_and_tries_what_it_found() -> None:
    v = flying()
    t, p = v.autopilot.modes.autotune, v.autopilot.params
    p.ATC.RAT_RLL.D = 0.5
    t.done, t.overridden_us = 1, 5
    assert autotune.start(v) == ModeResult.ACCEPTED
    assert (t.phase, t.axis, t.done, t.step, bool(t.backwards), t.overridden_us) == (
        gains.TUNING,
        ROLL,
        0,
        rules.RATE_D_UP,
        True,
        0,
    )
    assert t.roll.rate_d == 0.2  # D is no larger
    assert t.roll_before.rate_d == 0.5
    assert pytest.approx(0.1 * t.roll_before.rate_p) == p.ATC.RAT_RLL.I
    t.phase, t.axis, t.done, t.count = gains.PAUSED, YAW, 3, 2
    p.ATC.RAT_RLL.P = 0.33
    wait(v, 1.0)
    assert autotune.start(v) == ModeResult.ACCEPTED
    assert (t.phase, t.axis, t.done, t.count, t.level_us) == (gains.TUNING, YAW, 3, 2, v.time_us)
    assert t.roll_before.rate_p == 0.33
    t.phase, t.done = gains.FOUND, 7
    assert autotune.start(v) == ModeResult.ACCEPTED
    assert t.phase == gains.TRIED
    assert told(v, gains.AUTOTUNE_DID) == [(gains.STARTED, 0.0), (gains.STARTED, 0.0), (gains.TRIES, 7.0)]


@pytest.mark.parametrize(("stick", "place_moves"), (("roll", True), ("pitch", True), ("yaw", False), ("climb", False)))
def test_a_stick_interrupts_it_and_half_a_second_later_it_goes_on(stick: str, place_moves: bool) -> None:
    v = tuning()
    ap = v.autopilot
    t, sticks = ap.modes.autotune, ap.modes.pilot
    assert not autotune.is_overridden(v, 0.0, True)
    ap.estimate.pos = Vec3(1.0, 2.0, -10.0)
    if stick != "climb":
        setattr(sticks, stick, 0.1)
    ap.params.ATC.RAT_RLL.P = 9.0
    assert autotune.is_overridden(v, 0.5 if stick == "climb" else 0.0, True)
    assert t.roll_before.rate_p == ap.params.ATC.RAT_RLL.P
    assert t.roll_before.rate_i == ap.params.ATC.RAT_RLL.I
    assert (tuple(t.hold_pos) == (1.0, 2.0)) == place_moves
    for name in ("roll", "pitch", "yaw"):
        setattr(sticks, name, 0.0)
    turn_to(v, 0.4)
    wait(v, 0.5)
    assert autotune.is_overridden(v, 0.0, True)
    assert t.heading == 0.0
    t.twitching = True
    v.time_us += 1
    assert not autotune.is_overridden(v, 0.0, True)
    assert (t.heading, bool(t.twitching), t.level_us) == (v.autopilot.estimate.yaw, False, v.time_us)


def test_what_interrupts_it_is_told_once_a_second_while_it_flies() -> None:
    v = tuning()
    v.time_us = 60_000_000
    v.autopilot.modes.pilot.yaw = 0.2
    for _ in range(21):
        assert autotune.is_overridden(v, 0.0, True)
        wait(v, 0.1)
    assert told(v, gains.AUTOTUNE_DID)[1:] == [(gains.OVERRIDDEN, 0.0)] * 3
    v.autopilot.modes.pilot.yaw = 0.0
    for _ in range(20):
        assert autotune.is_overridden(v, 0.0, False)  # nothing flies it: that is not told
        wait(v, 0.1)
    assert len(told(v, gains.AUTOTUNE_DID)) == 4


def test_sticks_do_not_interrupt_what_is_not_tuning() -> None:
    v = tuning()
    v.autopilot.modes.autotune.phase = gains.TRIED
    v.autopilot.modes.pilot.roll = 0.5
    assert not autotune.is_overridden(v, 1.0, False)
    assert v.autopilot.modes.autotune.overridden_us == 0


@pytest.mark.parametrize(
    ("n", "e", "yaw", "roll", "pitch"),
    (
        (10.0, 0.0, 0.0, 0.0, 5.0),  # north of its place: nose up, back south
        (-10.0, 0.0, 0.0, 0.0, -5.0),
        (0.0, 10.0, 0.0, -5.0, 0.0),  # east of it: left wing down
        (10.0, 0.0, 0.5 * math.pi, 5.0, 0.0),
        (40.0, 0.0, 0.0, 0.0, 10.0),  # no more than 10 deg
        (0.09, 0.0, 0.0, 0.0, 0.0),
        (0.11, 0.0, 0.0, 0.0, 0.055),
    ),
)
def test_it_leans_back_to_its_place_by_the_distance(n: float, e: float, yaw: float, roll: float, pitch: float) -> None:
    v = tuning()
    t = v.autopilot.modes.autotune
    t.holds_position, t.hold_pos = True, Vec2(100.0, -50.0)
    v.autopilot.estimate.pos = Vec3(100.0 + n, -50.0 + e, -10.0)
    turn_to(v, yaw)
    lean = autotune.hold(v)
    assert (math.degrees(lean.roll), math.degrees(lean.pitch)) == pytest.approx((roll, pitch), abs=1e-6)
    t.holds_position = False
    assert autotune.hold(v) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("axis", "east", "heading", "turned"),
    (
        (ROLL, 4.9, 0.0, 0.0),  # near: the heading stays
        (ROLL, 5.0, 0.0, 90.0),  # the way back is ahead or behind, so that roll leans little
        (ROLL, 5.0, -20.0, -90.0),  # the nearer of both
        (PITCH, 5.0, 0.0, 0.0),  # ... or beside
        (PITCH, 5.0, 84.0, 180.0 - 180.0),
        (PITCH, 5.0, 96.0, 180.0),
    ),
)
def test_far_off_it_turns_so_that_the_tuned_axis_leans_little(
    axis: int, east: float, heading: float, turned: float
) -> None:
    v = tuning(axis)
    t = v.autopilot.modes.autotune
    t.holds_position, t.hold_pos, t.heading = True, Vec2(0.0, 0.0), math.radians(heading)
    v.autopilot.estimate.pos = Vec3(0.0, east, -10.0)
    autotune.hold(v)
    assert math.degrees(math.remainder(t.heading - math.radians(turned), 2 * math.pi)) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("seconds", (1.0, 2.0, 4.0, 9.0))
@pytest.mark.parametrize(
    ("kind", "limit"), (("roll", 2.5), ("pitch", 2.5), ("yaw", 2.5), ("p", 5.0), ("q", 5.0), ("r", 7.5))
)
def test_what_is_level_widens_with_the_time_that_it_takes(kind: str, limit: float, seconds: float) -> None:
    v = tuning()
    wait(v, seconds)
    t, est = v.autopilot.modes.autotune, v.autopilot.estimate
    lean = attitude.Lean(math.radians(3.0), math.radians(-4.0))
    t.heading = math.radians(179.0)
    limit *= min(seconds / 2.0, 2.0)
    for share, level in ((0.99, True), (1.01, False)):
        off = math.radians(share * limit)
        for sign in (1.0, -1.0):
            est.euler = Euler(
                lean.roll + (sign * off if kind == "roll" else 0.0),
                lean.pitch + (sign * off if kind == "pitch" else 0.0),
                math.remainder(t.heading + (sign * off if kind == "yaw" else 0.0), 2 * math.pi),
            )
            est.rates = Vec3(*(sign * off if kind == name else 0.0 for name in "pqr"))
            one_sided = kind in "pqr" and sign < 0.0
            assert autotune.is_level(v, lean) == (level or one_sided)


def test_a_twitch_begins_when_it_was_level_for_a_quarter_of_a_second() -> None:
    v = tuning()
    t = v.autopilot.modes.autotune
    wait(v, 0.249)
    autotune.level(v)
    assert not t.twitching
    wait(v, 0.001)
    autotune.level(v)
    assert t.twitching
    t.twitching = False
    v.autopilot.estimate.euler = Euler(0.5, 0.0, 0.0)
    autotune.level(v)
    assert t.level_us == v.time_us and not t.twitching
    v.autopilot.estimate.euler = Euler(0.0, 0.0, 0.0)
    t.phase = gains.FOUND
    wait(v, 1.0)
    autotune.level(v)
    assert not t.twitching


@pytest.mark.parametrize("came_to", (rules.MEASURED, rules.TOO_LARGE, rules.TWITCH_AT_LEAST, rules.GOES_ON))
def test_what_a_twitch_came_to(came_to: int) -> None:
    v = tuning()
    t = v.autopilot.modes.autotune
    t.came_to, t.twitching, t.backwards, t.target = came_to, True, False, 2.0
    t.rate_max = 1.0  # too slow for measuring D: P must grow
    p_before, t.reported_us = t.roll.rate_p, v.time_us
    wait(v, 0.5)
    if came_to == rules.GOES_ON:
        t.phase = gains.FOUND  # nothing to conclude, nor to fly
    autotune.tune(v)
    assert (t.roll.rate_p > p_before) == (came_to == rules.MEASURED)
    assert bool(t.backwards) == (came_to == rules.MEASURED)
    failed = came_to == rules.TWITCH_AT_LEAST
    assert (t.phase == gains.FAILED) == failed
    assert bool(t.twitching) == (came_to == rules.GOES_ON)
    assert ((gains.FAILURE, float(rules.TWITCH_AT_LEAST)) in told(v, gains.AUTOTUNE_DID)) == failed
    if came_to in (rules.MEASURED, rules.TOO_LARGE):
        assert (t.came_to, t.levelling_us) == (rules.GOES_ON, v.time_us)


def test_how_far_it_is_is_told_every_two_seconds() -> None:
    v = tuning(PITCH, rules.RATE_P_UP)
    t = v.autopilot.modes.autotune
    t.reported_us, t.count = v.time_us, 1
    v.autopilot.estimate.euler = Euler(0.5, 0.0, 0.0)  # never level: no twitch
    for _ in range(40):
        wait(v, 0.1)
        autotune.tune(v)
    share = 100 * 1 // rules.ENOUGH
    progress = (float(gains.PROGRESS), float(PITCH * 10000 + rules.RATE_P_UP * 1000 + share))
    assert told(v, gains.AUTOTUNE_DID)[1:] == [progress] * 2
    t.count = rules.ENOUGH + 3
    wait(v, 2.0)
    autotune.tune(v)
    assert told(v, gains.AUTOTUNE_DID)[-1][1] % 1000 == 100.0


@pytest.mark.parametrize(
    ("step", "follows"),
    (
        (rules.RATE_D_UP, rules.RATE_D_DOWN),
        (rules.RATE_D_DOWN, rules.RATE_P_UP),
        (rules.RATE_P_UP, rules.ANGLE_P_DOWN),
        (rules.ANGLE_P_DOWN, rules.ANGLE_P_UP),
    ),
)
def test_steps_follow_each_other_after_enough_successes(
    step: int, follows: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    v = tuning(ROLL, step)
    t = v.autopilot.modes.autotune
    monkeypatch.setattr(autotune, "change_gains", lambda v: rules.CHANGED)
    t.count, t.scale, t.ignore_next = rules.ENOUGH - 1, 0.5, True
    autotune.learn(v)
    assert (t.step, t.count) == (step, rules.ENOUGH - 1)
    t.count = rules.ENOUGH
    autotune.learn(v)
    assert (t.step, t.count, t.scale, bool(t.ignore_next)) == (follows, 0, 1.0, False)


@pytest.mark.parametrize(
    ("axis", "accel", "cdeg"),
    ((ROLL, 100.0, math.degrees(10000.0)), (PITCH, 0.1, 4000.0), (YAW, 0.1, 1000.0), (YAW, 30.0, math.degrees(3000.0))),
)
def test_an_axis_ends_with_a_margin_of_its_angle_p_and_its_acceleration(axis, accel, cdeg, monkeypatch):
    v = tuning(axis, rules.ANGLE_P_UP)
    t = v.autopilot.modes.autotune
    monkeypatch.setattr(autotune, "change_gains", lambda v: rules.CHANGED)
    g = gains.found(t, axis)
    t.count, t.accel, g.angle_p = rules.ENOUGH, accel, 10.0
    t.done = (1 << axis) - 1
    autotune.learn(v)
    assert (g.angle_p, g.accel) == pytest.approx((9.0, cdeg))
    assert t.done == (1 << (axis + 1)) - 1
    assert (gains.COMPLETE, float(axis)) in told(v, gains.AUTOTUNE_DID)
    if axis == YAW:
        assert t.phase == gains.FOUND
        assert told(v, gains.AUTOTUNE_DID)[-1] == (gains.SUCCESS, 0.0)
        assert t.yaw_before.rate_p == v.autopilot.params.ATC.RAT_YAW.P
    else:
        assert (t.axis, t.step, t.phase) == (axis + 1, rules.RATE_D_UP, gains.TUNING)


def test_angle_p_is_no_less_than_half() -> None:
    v = tuning(ROLL, rules.ANGLE_P_UP)
    t = v.autopilot.modes.autotune
    t.count, t.roll.angle_p, t.angle_max, t.target = rules.ENOUGH, 0.51, 2.0, 1.0
    autotune.learn(v)
    assert t.roll.angle_p == 0.5


@pytest.mark.parametrize(("came_to", "fails"), ((rules.NO_D, True), (rules.NO_P, True), (rules.D_AT_LIMIT, False)))
def test_gains_that_cannot_be_found_end_it(came_to: int, fails: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    v = tuning()
    t = v.autopilot.modes.autotune
    monkeypatch.setattr(autotune, "change_gains", lambda v: came_to)
    v.autopilot.params.ATC.RAT_RLL.P = 99.0
    autotune.learn(v)
    assert (t.phase == gains.FAILED) == fails
    assert (t.roll_before.rate_p == v.autopilot.params.ATC.RAT_RLL.P) == fails
    assert told(v, gains.AUTOTUNE_DID)[-1] == ((gains.FAILURE, float(came_to)) if fails else (gains.D_LIMIT, 0.0))


@pytest.mark.parametrize(("hz", "kept"), ((0.5, 1.0), (2.0, 2.0), (9.0, 5.0)))
def test_yaws_error_filter_begins_within_its_limits(hz: float, kept: float) -> None:
    v = tuning()
    t = v.autopilot.modes.autotune
    t.done, t.yaw.error_hz, t.yaw.rate_d = 3, hz, 0.7
    autotune.tune_next_axis(v)
    assert (t.axis, t.yaw.error_hz, t.yaw.rate_d) == (YAW, kept, 0.7)


def test_its_texts_name_axes_steps_and_gains() -> None:
    v = tuning()
    t = v.autopilot.modes.autotune
    t.yaw.rate_p, t.yaw.rate_d, t.yaw.angle_p, t.yaw.accel = 0.5, 0.01, 4.0, 12345.6
    assert autotune.texts(gains.PROGRESS, 12075, t) == ["Pitch Rate P Up 75%"]
    assert autotune.texts(gains.COMPLETE, YAW, t)[1] == "Yaw(E) Rate: P:0.500, I:0.050, D:0.0100"
    t.roll.rate_p = 0.25
    assert autotune.texts(gains.COMPLETE, ROLL, t)[1].startswith("Roll Rate: P:0.250, I:0.250,")
    assert autotune.texts(gains.TRIES, 5, t) == ["Pilot Testing gains for Roll Yaw(E)"]
    assert autotune.texts(gains.SAVED, 10, t) == ["Saved gains for Pitch Yaw(D)"]
    assert autotune.texts(gains.MEASURED, 0, t) == []
    assert autotune.parameters(1 << YAW) == (
        "ATC_RAT_YAW_P", "ATC_RAT_YAW_I", "ATC_RAT_YAW_FLTE", "ATC_ANG_YAW_P", "ATC_ACCEL_Y_MAX",
    )  # fmt: skip
    assert autotune.parameters(9)[:5] == (
        "ATC_RAT_RLL_P", "ATC_RAT_RLL_I", "ATC_RAT_RLL_D", "ATC_ANG_RLL_P", "ATC_ACCEL_R_MAX",
    )  # fmt: skip
    assert "ATC_RAT_YAW_D" in autotune.parameters(9)
