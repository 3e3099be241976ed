# SPDX-License-Identifier: BSD-3-Clause
"""AUTOTUNE's measurements and rules at their edges, with goals and gains of any size."""

from __future__ import annotations

import pytest

from sitl.autopilot.copter.modes import autotune_rules as rules
from sitl.autopilot.copter.modes.autotune_gains import PITCH, YAW
from sitl.autopilot.copter.modes.state import AutotuneState, AxisGains

AGGR = 0.1


def state(**values: float) -> AutotuneState:
    t = AutotuneState()
    t.axis, t.scale = PITCH, 1.0
    for name, value in values.items():
        setattr(t, name, value)
    return t


def tuned(p: float = 0.1, d: float = 0.01, angle_p: float = 5.0) -> AxisGains:
    g = AxisGains()
    g.rate_p, g.rate_d, g.angle_p, g.error_hz = p, d, angle_p, 2.0
    return g


@pytest.mark.parametrize("goal", (0.5, 4.0))
def test_the_time_of_a_twitch_grows_until_it_has_risen(goal: float) -> None:
    """Three times what it took to half way, two seconds at the most."""
    for size, limit in ((0.99, 300_000), (1.0, 7)):
        t = state(begun_us=1_000_000, limit_us=7)
        rules.measure_rate(t, size * rules.RISEN * goal, goal, 1_100_000)
        assert t.limit_us == limit
        t = state(begun_us=1_000_000, limit_us=7)
        rules.measure_angle(t, size * rules.RISEN * goal, 0.0, goal, 1_100_000)
        assert t.limit_us == limit
    t = state(begun_us=1_000_000)
    rules.measure_rate(t, 0.0, goal, 2_000_000)
    assert t.limit_us == 2_000_000 == rules.TIMEOUT_US


@pytest.mark.parametrize("goal", (0.5, 4.0))
def test_the_least_after_the_greatest_counts_once_a_quarter_is_reached(goal: float) -> None:
    for share, low in ((0.24, 0.24), (0.26, 0.1)):
        t = state()
        for x in (share * goal, 0.1 * goal):
            rules.measure_rate(t, x, goal, 20_000)
        assert (t.rate_max, t.rate_min) == pytest.approx((share * goal, low * goal))
        t = state()
        for x in (share * goal, 0.1 * goal):
            rules.measure_angle(t, x, 0.0, goal, 20_000)
        assert (t.angle_max, t.angle_min) == pytest.approx((share * goal, low * goal))


@pytest.mark.parametrize(("after_us", "accel"), ((100_000, 20.0), (500, 2000.0), (0, 2000.0)))
def test_acceleration_is_the_rate_over_its_time_of_a_millisecond_at_least(after_us: int, accel: float) -> None:
    t = state(begun_us=1_000_000)
    rules.measure_rate(t, 2.0, 9.0, 1_000_000 + after_us)
    assert t.accel == pytest.approx(accel)
    t = state(begun_us=1_000_000)
    rules.measure_angle(t, 0.0, 2.0, 9.0, 1_000_000 + after_us)
    assert t.accel == pytest.approx(accel) and (t.rate_max, t.rate_min) == (2.0, 2.0)


@pytest.mark.parametrize(
    ("top", "low", "rate", "angle", "scale", "came_to", "left"),
    (
        (3.1, 3.1, 0.0, 0.0, 1.0, rules.MEASURED, 1.0),  # past its goal of 3
        (3.0, 3.0, 0.0, 0.0, 1.0, rules.GOES_ON, 1.0),
        (2.0, 1.79, 0.0, 0.0, 1.0, rules.MEASURED, 1.0),  # bounces
        (2.0, 1.81, 0.0, 0.0, 1.0, rules.GOES_ON, 1.0),
        (2.0, 1.9, 1.95, 0.5, 1.0, rules.MEASURED, 1.0),  # leans far, but turns back
        (2.0, 1.9, 1.9, 0.5, 1.0, rules.TOO_LARGE, 0.9),  # a smaller one
        (2.0, 1.9, 1.9, 0.49, 1.0, rules.GOES_ON, 1.0),
        (2.0, 1.9, 1.9, 0.5, 0.2, rules.TWITCH_AT_LEAST, 0.2),
        (2.0, 1.9, 1.9, 0.5, 0.21, rules.TOO_LARGE, 0.189),
    ),
)
def test_when_a_twitch_of_a_rate_is_over(
    top: float, low: float, rate: float, angle: float, scale: float, came_to: int, left: float
) -> None:
    t = state(rate_max=top, rate_min=low, scale=scale)
    assert rules.judge_rate(t, rate, angle, 3.0, 0.5, AGGR) == came_to and t.scale == pytest.approx(left)


@pytest.mark.parametrize(
    ("top", "low", "over"), ((0.31, 0.31, True), (0.3, 0.3, False), (0.2, 0.179, True), (0.2, 0.181, False))
)
def test_when_a_twitch_of_an_angle_is_over(top: float, low: float, over: bool) -> None:
    got = rules.judge_angle(state(angle_max=top, angle_min=low), 0.3, AGGR)
    assert got == (rules.MEASURED if over else rules.GOES_ON)


def test_a_single_twitch_against_the_others_is_not_believed() -> None:
    t = state(count=2)
    rules.succeed(t)
    assert (t.count, t.ignore_next) == (3, 1)
    assert not rules.fail_unless_ignored(t)
    assert (t.count, t.ignore_next) == (3, 0)
    assert rules.fail_unless_ignored(t) and t.count == 2
    t.ignore_next = True
    rules.succeed_unless_ignored(t)
    assert (t.count, t.ignore_next) == (2, 0)
    rules.succeed_unless_ignored(t)
    assert t.count == 3
    t.count = 0
    rules.fail(t)
    assert t.count == 0


@pytest.mark.parametrize(("top", "fits"), ((2.39, False), (2.41, True), (3.0, True), (3.01, False)))
def test_a_rate_fits_a_fifth_below_its_target(top: float, fits: bool) -> None:
    assert bool(rules.fits_rate(state(target=3.0, rate_max=top))) == fits


@pytest.mark.parametrize(
    ("top", "p", "d", "after", "came_to"),
    (
        (2.0, 0.1, 0.02, (0.105, 0.02), rules.CHANGED),
        (2.0, 1.95, 0.02, (2.0, 0.02), rules.NO_D),
        (3.0, 0.1, 0.02, (0.095, 0.02), rules.CHANGED),
        (4.0, 0.01, 0.02, (0.01, 0.019), rules.CHANGED),  # P is at its least: then D
        (4.0, 0.01, 0.0102, (0.01, 0.01), rules.NO_D),
    ),
)
def test_gains_that_bring_the_rate_near_its_target(
    top: float, p: float, d: float, after: tuple[float, float], came_to: int
) -> None:
    g = tuned(p, d)
    assert rules.fit_rate(state(target=3.0, rate_max=top), g, 0.01) == came_to
    assert (g.rate_p, g.rate_d) == pytest.approx(after)


def test_yaw_has_a_filter_in_place_of_d() -> None:
    g = tuned()
    for axis, value in ((YAW, 2.0), (PITCH, 0.01)):
        assert rules.get_d(state(axis=axis), g) == value
        rules.set_d(state(axis=axis), g, 7.0)
    assert (g.error_hz, g.rate_d) == (7.0, 7.0)


@pytest.mark.parametrize(
    ("low", "ignore", "d", "after", "count"),
    (
        (1.7, False, 0.02, 0.02, 3),  # it bounces
        (1.9, False, 0.02, 0.022, 1),
        (1.9, True, 0.02, 0.02, 2),
        (1.9, False, 0.0499, 0.05, rules.ENOUGH),  # the most
    ),
)
def test_d_grows_until_it_bounces(low: float, ignore: bool, d: float, after: float, count: int) -> None:
    t, g = state(rate_max=2.0, rate_min=low, count=2, ignore_next=ignore), tuned(d=d)
    assert rules.raise_d(t, g, 0.05, AGGR) == rules.CHANGED
    assert (g.rate_d, t.count) == (pytest.approx(after), count)


@pytest.mark.parametrize(
    ("low", "d", "after", "count", "came_to"),
    (
        (1.9, 0.02, 0.02, 3, rules.CHANGED),
        (1.7, 0.02, 0.019, 1, rules.CHANGED),
        (1.7, 0.0101, 0.01, rules.ENOUGH, rules.D_AT_LIMIT),
    ),
)
def test_d_shrinks_while_it_bounces(low: float, d: float, after: float, count: int, came_to: int) -> None:
    t, g = state(rate_max=2.0, rate_min=low, count=2), tuned(d=d)
    assert rules.lower_d(t, g, 0.01, AGGR) == came_to
    assert (g.rate_d, t.count) == (pytest.approx(after), count)


@pytest.mark.parametrize(
    ("top", "low", "p", "d", "after", "count", "came_to", "turned"),
    (
        (3.16, 3.16, 0.1, 0.02, (0.1, 0.02), 3, rules.CHANGED, 0),  # past 3 by half of the aggressiveness
        (3.14, 3.14, 0.1, 0.02, (0.105, 0.02), 1, rules.CHANGED, 0),
        (2.9, 2.5, 0.1, 0.02, (0.095, 0.019), 1, rules.CHANGED, 1),  # bounces just below
        (2.3, 2.0, 0.1, 0.02, (0.105, 0.02), 1, rules.CHANGED, 0),  # far below
        (2.9, 2.5, 0.1, 0.0101, (0.095, 0.01), 1, rules.NO_D, 1),
        (2.9, 2.5, 0.1, 0.01, (0.105, 0.01), 1, rules.CHANGED, 0),
        (2.9, 2.5, 0.0101, 0.02, (0.01, 0.019), 1, rules.NO_P, 1),
        (3.14, 3.14, 1.95, 0.02, (2.0, 0.02), rules.ENOUGH, rules.CHANGED, 0),
    ),
)
def test_p_grows_until_the_target_is_passed(
    top: float, low: float, p: float, d: float, after: tuple[float, float], count: int, came_to: int, turned: int
) -> None:
    t, g = state(target=3.0, rate_max=top, rate_min=low, count=2), tuned(p, d)
    assert rules.raise_p(t, g, 0.01, AGGR) == came_to
    assert (g.rate_p, g.rate_d) == pytest.approx(after)
    assert (t.count, t.backwards) == (count, turned)


@pytest.mark.parametrize(
    ("top", "angle_p", "after", "count"),
    ((0.314, 5.0, 5.0, 3), (0.316, 5.0, 4.75, 1), (0.316, 0.51, 0.5, rules.ENOUGH)),
)
def test_the_gain_of_the_angle_shrinks_until_the_target_is_not_passed(
    top: float, angle_p: float, after: float, count: int
) -> None:
    t, g = state(target=0.3, angle_max=top, count=2), tuned(angle_p=angle_p)
    rules.lower_angle_p(t, g, AGGR)
    assert (g.angle_p, t.count) == (pytest.approx(after), count)


@pytest.mark.parametrize(
    ("top", "back", "angle_p", "after", "count"),
    (
        (0.316, 0.0, 5.0, 5.0, 3),
        (0.314, 0.0, 5.0, 5.25, 1),
        (0.301, -0.21, 5.0, 5.0, 3),  # passed, and turns back
        (0.301, -0.19, 5.0, 5.25, 1),
        (0.299, -0.21, 5.0, 5.25, 1),
        (0.1, 0.0, 39.0, 40.0, rules.ENOUGH),
    ),
)
def test_the_gain_of_the_angle_grows_until_the_target_is_passed(
    top: float, back: float, angle_p: float, after: float, count: int
) -> None:
    t, g = state(target=0.3, angle_max=top, rate_max=2.0, rate_min=back, count=2), tuned(angle_p=angle_p)
    rules.raise_angle_p(t, g, AGGR)
    assert (g.angle_p, t.count) == (pytest.approx(after), count)
