# SPDX-License-Identifier: BSD-3-Clause
"""Planned legs keep their limits, are smooth, and end where they should."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.autopilot.navigation.leg import LegError, Limits, Profile, axis_limits, plan, write
from sitl.autopilot.navigation.leg_motion import clear, evaluate, finished, remaining, step
from sitl.autopilot.navigation.state import SEGMENTS, Leg
from sitl.core.algebra import ZERO
from sitl.core.vectors import Vec3

DEFAULT = Limits(10.0, 2.5, 1.0, 0.3)
limits = st.builds(
    Limits,
    st.floats(0.1, 100.0),
    st.floats(0.1, 20.0),
    st.floats(0.1, 50.0),
    st.one_of(st.just(0.0), st.floats(0.01, 2.0)),
)


def record(profile: Profile, length: float):
    """The leg in a record."""
    leg = Leg()
    write(leg, profile, ZERO, Vec3(1.0, 0.0, 0.0), length)
    return leg


def check(profile: Profile, length: float, within: Limits, v0: float = 0.0) -> None:
    """Continuous in distance, speed and acceleration; inside the limits; at the end at the end."""
    leg = record(profile, length)
    near = 1e-6 * max(1.0, length, within.speed, within.acceleration)
    for k in range(1, len(profile.segments)):
        t = profile.segments[k].t
        before = evaluate(leg, np.nextafter(t, 0.0)) if t > profile.segments[k - 1].t else evaluate(leg, t)
        assert before == pytest.approx(evaluate(leg, t), abs=near), f"segment {k}"
    top = max(within.speed, abs(v0)) * (1.0 + 1e-6)
    for t in np.linspace(0.0, profile.duration, 200):
        _, v, a = evaluate(leg, float(t))
        assert -1e-6 - abs(v0) <= v <= top
        assert abs(a) <= within.acceleration * (1.0 + 1e-6) + 1e-6
    for s in profile.segments:
        assert abs(s.j) <= within.jerk * (1.0 + 1e-6)
    assert evaluate(leg, profile.duration) == (length, 0.0, 0.0)
    assert evaluate(leg, profile.duration + 1e6) == (length, 0.0, 0.0)


@given(st.one_of(st.floats(1e-4, 1.0), st.floats(1.0, 4e7)), limits)
@settings(max_examples=60, deadline=None)
def test_rest_to_rest(length: float, within: Limits) -> None:
    """Any length with any limits: smooth, limited, symmetric, and no more segments than fit."""
    profile = plan(length, within)
    assert len(profile.segments) <= SEGMENTS
    check(profile, length, within)
    half = evaluate(record(profile, length), 0.5 * profile.duration)
    assert half[0] == pytest.approx(0.5 * length, rel=1e-6)
    assert profile.turn_in == pytest.approx(min(profile.turn_in, profile.turn_out))


@given(st.floats(30.0, 1e4), st.floats(0.0, 8.0), st.floats(-1.0, 1.0), st.floats(1.0, 10.0))
@settings(max_examples=40, deadline=None)
def test_from_the_middle_of_a_leg(length: float, v0: float, a0: float, speed: float) -> None:
    """A leg planned anew under way (DO_CHANGE_SPEED) starts at the present speed and acceleration."""
    within = DEFAULT._replace(speed=speed)
    profile = plan(length, within, v0, a0)
    assert evaluate(record(profile, length), 0.0) == pytest.approx((0.0, v0, a0), abs=1e-9)  # below it there is none
    check(profile, length, within, v0 + 1.0)


def test_slower_without_a_dip() -> None:
    """A leg under way that is faster than its new limit comes down to the limit and stays there."""
    profile = plan(60.0, DEFAULT._replace(speed=3.0), 3.5, 2.3)
    leg = record(profile, 60.0)
    speeds = np.array([evaluate(leg, t)[1] for t in np.arange(0.0, profile.turn_out, 0.01)])
    assert speeds.min() >= 3.0 - 1e-6
    assert speeds[-1] == pytest.approx(3.0)


def test_thirty_metres_as_recorded() -> None:
    """ArduPilot's default limits over 30 m: it peaks below 6 m/s and takes just over 10 s."""
    profile = plan(30.0, DEFAULT)
    assert profile.duration == pytest.approx(10.28, abs=0.01)
    assert max(s.v for s in profile.segments) == pytest.approx(5.84, abs=0.01)


def test_snap_limit_costs_its_rise() -> None:
    """A long leg takes the rise longer for each pair of pulses than one limited in jerk only."""
    soft, hard = plan(500.0, DEFAULT).duration, plan(500.0, DEFAULT._replace(rise=0.0)).duration
    assert soft == pytest.approx(hard + 0.3, abs=1e-6)


def test_no_length() -> None:
    """A leg to where the vehicle is, is over at once."""
    leg = record(plan(0.0, DEFAULT), 0.0)
    assert leg.segments == 1
    assert finished(leg)
    assert evaluate(leg, 5.0) == (0.0, 0.0, 0.0)


def test_path_time_stops_at_the_end() -> None:
    """Steps move path time on to the duration and no further; a cleared leg is nothing."""
    leg = record(plan(5.0, DEFAULT), 5.0)
    while not finished(leg):
        before = remaining(leg)
        step(leg, 0.1)
        assert remaining(leg) < before
    step(leg, 10.0)
    assert leg.elapsed == leg.duration
    assert leg.k == leg.segments - 1
    clear(leg)
    assert evaluate(leg, 1.0) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("length", "within"),
    [
        (math.nan, DEFAULT),
        (math.inf, DEFAULT),
        (-1.0, DEFAULT),
        (1.0, DEFAULT._replace(speed=0.0)),
        (1.0, DEFAULT._replace(jerk=math.nan)),
        (1.0, DEFAULT._replace(rise=-0.1)),
    ],
)
def test_refused(length: float, within: Limits) -> None:
    """Numbers that make no leg are refused by name."""
    with pytest.raises(LegError, match="leg: "):
        plan(length, within)


def test_axis_limits() -> None:
    """A slanted leg is limited by whichever axis is used up first."""
    assert axis_limits(Vec3(1.0, 0.0, 0.0), 10.0, 2.5, 1.5) == 10.0
    assert axis_limits(Vec3(0.0, 0.0, -1.0), 10.0, 2.5, 1.5) == 2.5
    assert axis_limits(Vec3(0.0, 0.0, 1.0), 10.0, 2.5, 1.5) == 1.5
    assert axis_limits(Vec3(0.6, 0.0, -0.8), 10.0, 2.5, 1.5) == pytest.approx(2.5 / 0.8)
    assert axis_limits(Vec3(0.995, 0.0, 0.0999), 10.0, 2.5, 1.5) == pytest.approx(10.0 / 0.995)


@given(st.floats(0.5, 8.0), st.floats(0.0, 2.5), st.floats(0.5, 4.0), st.floats(1.05, 3.0))
@settings(max_examples=60, deadline=None)
def test_slowing_down_never_turns_back(speed: float, acceleration: float, limit: float, spare: float) -> None:
    """A limit lowered on the way, with little room: as slow as it can be and still stop at the end, not before it."""
    within = Limits(limit, 2.5, 1.0, 0.3)
    jerk = 0.6  # what the rise of 0.3 s leaves of 1, at the least
    peak = speed + 0.5 * acceleration * acceleration / jerk
    length = spare * (peak * (peak / 2.5 + 2.5 / jerk) + 4.0 * speed + 8.0)  # enough to stop
    leg = record(plan(length, within, speed, acceleration), length)
    for t in np.linspace(0.0, leg.duration, 200):
        p, v, _ = evaluate(leg, float(t))
        assert v > -1e-6
        assert p < length + 1e-6
    assert evaluate(leg, float(leg.duration)) == (length, 0.0, 0.0)


def test_a_leg_that_slows_down_from_above_its_limit_goes_on_forwards() -> None:
    """The limit was lowered twice: its deceleration brings it below the limit already, and is not made greater."""
    within = Limits(7.0, 4.0, 0.7, 0.2)
    profile = plan(300.0, within, 9.3, -3.0, 3.5)
    leg = record(profile, 300.0)
    lowest = min(evaluate(leg, float(t)).vel for t in np.linspace(0.0, profile.duration, 200))
    assert lowest == pytest.approx(9.3 - 0.5 * 3.0 * 3.0 / profile.segments[0].j, abs=0.01)
    assert len(profile.segments) == 6  # no braking before the deceleration is taken away


def test_an_end_speed_above_the_limit_is_refused() -> None:
    with pytest.raises(LegError, match=r"leg: end speed 3\.5 must be within the limit 3\.0"):
        plan(50.0, DEFAULT._replace(speed=3.0), 0.0, 0.0, 3.5)


def test_a_motion_far_outside_of_the_limits_is_refused() -> None:
    """To take 3.6 m/s^2 away by 0.01 m/s^3 would lead to the other side of the earth first."""
    with pytest.raises(LegError, match=r"it would lead 10[0-9]+ km away"):
        plan(300.0, Limits(2.0, 0.01, 0.01), 1.34, 3.59)
