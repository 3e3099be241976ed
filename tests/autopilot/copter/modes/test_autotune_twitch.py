# SPDX-License-Identifier: BSD-3-Clause
"""A twitch of AUTOTUNE: how large it is, which way it goes, what is measured of it, and when it is over."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.copter.modes import autotune_gains as gains
from sitl.autopilot.copter.modes import autotune_rules as rules
from sitl.autopilot.copter.modes import autotune_twitch as twitch
from sitl.autopilot.copter.modes.autotune_gains import PITCH, ROLL, YAW, YAW_D
from sitl.autopilot.copter.modes.state import AutotuneState
from sitl.core.vectors import Euler, Vec3
from tests.autopilot.copter.steady_copter import fly, make, told, turn_to, wait

STEPS = (rules.RATE_D_UP, rules.RATE_D_DOWN, rules.RATE_P_UP, rules.ANGLE_P_DOWN, rules.ANGLE_P_UP)


def tuning(axis: int, step: int) -> Any:
    """A vehicle before a twitch."""
    v = fly(make(), 15)
    gains.remember(v)
    t, p = v.autopilot.modes.autotune, v.autopilot.params
    for k in (ROLL, PITCH, YAW):
        gains.read(p.ATC, k, gains.found(t, k))
    t.axis, t.step, t.scale, t.phase = axis, step, 1.0, gains.TUNING
    return v


@pytest.mark.parametrize("axis", (ROLL, PITCH, YAW, YAW_D))
def test_motors_can_be_asked_for_more_rate_with_less_gain(axis: int) -> None:
    v = tuning(axis, rules.RATE_D_UP)
    p = v.autopilot.params
    g = gains.found(v.autopilot.modes.autotune, axis)
    p.MOT.THST_HOVER, g.rate_d, g.rate_p = 0.25, 0.0, 0.2
    share = 0.7 if axis >= YAW else 1.0
    assert twitch.rate_step(v, g) == pytest.approx(share * 2.0 * 0.25 / 0.2)
    p.MOT.THST_HOVER = 0.05
    assert twitch.rate_step(v, g) == pytest.approx(share * 2.0 * 0.125 / 0.2)  # MOT_THST_HOVER is taken to be no less
    p.MOT.THST_HOVER = 0.9
    assert twitch.rate_step(v, g) == pytest.approx(share * 2.0 * 0.5 / 0.2)


def test_ds_kick_is_that_of_the_slower_filter() -> None:
    v = tuning(ROLL, rules.RATE_D_UP)
    p, g = v.autopilot.params, v.autopilot.modes.autotune.roll
    p.MOT.THST_HOVER, g.rate_p, g.rate_d, p.ATC.RAT_RLL.FLTD, g.error_hz = 0.25, 0.1, 0.01, 20.0, 0.0
    dt = 0.0025
    a = dt / (dt + 1.0 / (2.0 * math.pi * 20.0))
    assert twitch.rate_step(v, g) == pytest.approx(0.5 / (0.1 + 0.01 * a * (1.0 - a) ** 3 / dt))
    g.error_hz = 5.0
    a = dt / (dt + 1.0 / (2.0 * math.pi * 5.0))
    assert twitch.rate_step(v, g) == pytest.approx(0.5 / (0.1 + 0.01 * a * (1.0 - a) ** 3 / dt))


@pytest.mark.parametrize(
    ("axis", "step", "rate", "target"),
    (
        (ROLL, rules.RATE_D_UP, 1000.0, 180.0),
        (PITCH, rules.RATE_P_UP, 100.0, 100.0),
        (ROLL, rules.RATE_P_UP, 1.0, 45.0),
        (YAW, rules.RATE_D_UP, 1000.0, 90.0),
        (YAW_D, rules.RATE_P_UP, 1.0, 15.0),
        (ROLL, rules.ANGLE_P_DOWN, 1000.0, 15.0),  # half of ANGLE_MAX
        (PITCH, rules.ANGLE_P_UP, 50.0, 12.5),
        (PITCH, rules.ANGLE_P_UP, 1.0, 10.0),  # a third of it
        (YAW, rules.ANGLE_P_UP, 1000.0, 30.0),
        (YAW_D, rules.ANGLE_P_UP, 1.0, 5.0),
        (YAW, rules.ANGLE_P_DOWN, 40.0, 10.0),
    ),
)
def test_twitches_stay_within_what_is_safe(axis, step, rate, target, monkeypatch):
    v = tuning(axis, step)
    monkeypatch.setattr(twitch, "rate_step", lambda v, g: math.radians(rate))
    v.autopilot.params.ANGLE_MAX = 3000.0
    gains.found(v.autopilot.modes.autotune, axis).angle_p = 4.0
    assert math.degrees(twitch.target(v)) == pytest.approx(target)


def test_a_twitch_that_leaned_too_far_is_made_smaller_but_no_smaller_than_the_least(monkeypatch):
    v = tuning(ROLL, rules.RATE_D_UP)
    monkeypatch.setattr(twitch, "rate_step", lambda v, g: 100.0)
    v.autopilot.modes.autotune.scale = 0.5
    assert math.degrees(twitch.target(v)) == pytest.approx(90.0)
    v.autopilot.modes.autotune.scale = 0.2
    assert math.degrees(twitch.target(v)) == pytest.approx(45.0)


@pytest.mark.parametrize("backwards", (False, True))
@pytest.mark.parametrize("axis", (ROLL, PITCH, YAW, YAW_D))
def test_what_is_measured_is_about_the_axis_in_the_direction_of_the_twitch(axis: int, backwards: bool) -> None:
    v = tuning(axis, rules.RATE_D_UP)
    t, est = v.autopilot.modes.autotune, v.autopilot.estimate
    t.backwards = backwards
    est.rates, est.euler = Vec3(0.1, 0.2, 0.3), Euler(0.4, 0.5, 3.1)
    sign = -1.0 if backwards else 1.0
    place = min(axis, YAW)
    assert twitch.axis_rate(v) == pytest.approx(sign * (0.1, 0.2, 0.3)[place])
    assert twitch.axis_angle(v) == pytest.approx(sign * (0.4, 0.5, 3.1)[place])
    t.start_angle = sign * -3.1
    assert twitch.turned(v) == pytest.approx(math.remainder(twitch.axis_angle(v) + sign * 3.1, 2 * math.pi))
    assert tuple(twitch.along(axis, 2.0)) == tuple(2.0 if k == place else 0.0 for k in range(3))


@pytest.mark.parametrize("step", STEPS)
def test_a_twitch_begins_from_the_present_motion(step: int) -> None:
    v = tuning(PITCH, step)
    t, est = v.autopilot.modes.autotune, v.autopilot.estimate
    est.rates, est.euler = Vec3(0.1, 0.2, 0.3), Euler(0.4, 0.5, 0.6)
    t.rate_max, t.rate_min, t.angle_max, t.angle_min, t.accel, t.twitching = 1.0, -1.0, 1.0, -1.0, 1.0, False
    twitch.begin(v)
    assert (t.start_rate, t.start_angle, t.begun_us, t.limit_us) == (0.2, 0.5, v.time_us, 2_000_000)
    assert (t.rate_max, t.rate_min, t.angle_max, t.angle_min, t.accel) == (0.0,) * 5
    assert t.twitching
    by_angle = step in (rules.ANGLE_P_DOWN, rules.ANGLE_P_UP)
    assert t.rate == (0.2 if by_angle else 0.0)  # rates are measured from that of the start, those of angles are not
    assert pytest.approx(0.01 * t.pitch.rate_p) == v.autopilot.params.ATC.RAT_PIT.I


@pytest.mark.parametrize("backwards", (False, True))
@pytest.mark.parametrize("axis", (ROLL, PITCH, YAW))
def test_a_rate_is_asked_for_on_top_of_that_of_the_start(axis: int, backwards: bool) -> None:
    v = tuning(axis, rules.RATE_D_UP)
    t, control = v.autopilot.modes.autotune, v.autopilot.control
    t.target, t.start_rate, t.backwards = 2.0, 0.25, backwards
    twitch.command_rate(v)
    expected = [0.0, 0.0, 0.0]
    expected[axis] = -2.25 if backwards else 2.25
    assert tuple(control.attitude.rate_target) == tuple(expected)


@pytest.mark.parametrize("backwards", (False, True))
def test_the_target_of_an_angle_jumps_once(backwards: bool) -> None:
    v = tuning(YAW, rules.ANGLE_P_UP)
    t, target, p = v.autopilot.modes.autotune, v.autopilot.control.attitude, v.autopilot.params.ATC
    turn_to(v, 0.3)
    t.target, t.backwards, p.RATE_FF_ENAB = 0.2, backwards, 1.0
    twitch.command_angle(v, True)
    jumped = 0.1 if backwards else 0.5
    assert target.target_euler.yaw == pytest.approx(jumped)
    twitch.command_angle(v, False)
    assert target.target_euler.yaw == pytest.approx(jumped)
    assert p.RATE_FF_ENAB == 1.0


def test_an_angle_jumps_in_the_first_tick_only_also_where_nothing_has_turned_yet() -> None:
    v = tuning(YAW, rules.ANGLE_P_UP)
    t, target = v.autopilot.modes.autotune, v.autopilot.control.attitude
    twitch.begin(v)
    for _ in range(4):
        wait(v, 0.0025)
        twitch.run(v)
    assert target.target_euler.yaw == pytest.approx(t.target)


@pytest.mark.parametrize("step", (rules.RATE_D_UP, rules.ANGLE_P_UP))
def test_a_twitch_that_nothing_answers_ends_by_its_time_and_is_logged(step: int) -> None:
    v = tuning(ROLL, step)
    t = v.autopilot.modes.autotune
    twitch.begin(v)
    t.limit_us = 10_000_000
    for _ in range(3):
        wait(v, 0.0025)
        twitch.run(v)
    assert t.limit_us == 3 * 7_500  # it must have risen to 63 % in a third of the time
    assert (t.came_to, told(v, gains.AUTOTUNE_DID)) == (rules.GOES_ON, [])
    t.target, t.rate_max, t.angle_max, t.limit_us = 1.0, 0.9, 0.9, 7_500
    twitch.run(v)
    assert t.came_to == rules.MEASURED
    assert told(v, gains.AUTOTUNE_DID) == [(gains.MEASURED, 0.0)]


def test_rates_are_filtered_at_twice_the_filter_of_d_and_at_10_hz_for_yaw() -> None:
    for axis, hertz in ((ROLL, 2.0 * 15.0), (YAW, 10.0)):
        v = tuning(axis, rules.RATE_D_UP)
        gains.loop(v.autopilot.params.ATC, axis).FLTD = 15.0
        twitch.begin(v)
        v.autopilot.estimate.rates = Vec3(0.4, 0.4, 0.4)
        wait(v, 0.0025)
        twitch.run(v)
        gain = 0.0025 / (0.0025 + 1.0 / (2.0 * math.pi * hertz))
        assert v.autopilot.modes.autotune.rate == pytest.approx(0.4 * gain)


def measured(kind: str, samples: tuple[float, ...], goal: float) -> Any:
    """What is known after samples 10 ms apart."""
    t = AutotuneState()
    t.begun_us, t.limit_us = 1_000_000, rules.TIMEOUT_US
    for k, x in enumerate(samples, 1):
        now = 1_000_000 + 10_000 * k
        if kind == "rate":
            rules.measure_rate(t, x, goal, now)
        else:
            rules.measure_angle(t, x, 0.0, goal, now)
    return t


@pytest.mark.parametrize("kind", ("rate", "angle"))
@pytest.mark.parametrize(
    ("samples", "most", "least"),
    (
        ((0.2, 0.5, 0.4, 0.45), 0.5, 0.4),  # the least is that after the greatest
        ((0.2, 0.5, 0.4, 0.6), 0.6, 0.6),
        ((0.2, 0.1), 0.2, 0.2),  # not before a quarter of the goal is reached
        ((0.25, 0.1), 0.25, 0.25),
        ((0.26, 0.1), 0.26, 0.1),
    ),
)
def test_the_greatest_and_the_least_after_it_are_measured(kind, samples, most, least):
    t = measured(kind, samples, 1.0)
    assert (getattr(t, f"{kind}_max"), getattr(t, f"{kind}_min")) == (most, least)


@pytest.mark.parametrize("kind", ("rate", "angle"))
@pytest.mark.parametrize(
    ("samples", "limit"),
    (((0.6,), 30_000), ((0.632,), 2_000_000), ((0.6, 0.631, 0.632, 0.7), 60_000), ((0.1,) * 90, 2_000_000)),
)
def test_a_twitch_has_three_times_the_time_to_63_percent_and_at_most_2_s(kind, samples, limit):
    assert measured(kind, samples, 1.0).limit_us == limit


def test_the_acceleration_is_up_to_the_greatest_rate() -> None:
    assert measured("rate", (0.1, 0.5, 0.4), 1.0).accel == pytest.approx(0.5 / 0.02)
    t = AutotuneState()
    rules.measure_angle(t, 0.0, 0.5, 1.0, 20_000)
    rules.measure_angle(t, 0.0, -0.2, 1.0, 30_000)
    rules.measure_angle(t, 0.0, -0.1, 1.0, 40_000)
    assert (t.rate_max, t.rate_min, t.accel) == pytest.approx((0.5, -0.2, 25.0))


@pytest.mark.parametrize(
    ("most", "least", "rate", "angle", "scale", "came_to", "scale_after"),
    (
        (1.01, 1.01, 0.5, 0.0, 1.0, rules.MEASURED, 1.0),
        (1.0, 1.0, 0.5, 0.0, 1.0, rules.GOES_ON, 1.0),
        (1.0, 0.89, 0.9, 0.0, 1.0, rules.MEASURED, 1.0),  # it bounced by more than a tenth
        (1.0, 0.91, 0.95, 0.0, 1.0, rules.GOES_ON, 1.0),
        (0.5, 0.5, 0.6, 0.3, 1.0, rules.MEASURED, 1.0),
        (0.5, 0.5, 0.5, 0.3, 1.0, rules.TOO_LARGE, 0.9),
        (0.5, 0.5, 0.5, 0.299, 1.0, rules.GOES_ON, 1.0),
        (0.5, 0.5, 0.5, 0.3, 0.2, rules.TWITCH_AT_LEAST, 0.2),
        (0.5, 0.5, 0.5, 0.3, 0.21, rules.TOO_LARGE, 0.189),
    ),
)
def test_when_a_twitch_of_a_rate_is_over(most, least, rate, angle, scale, came_to, scale_after):
    t = AutotuneState()
    t.rate_max, t.rate_min, t.scale = most, least, scale
    assert rules.judge_rate(t, rate, angle, 1.0, 0.3, 0.1) == came_to
    assert t.scale == pytest.approx(scale_after)


@pytest.mark.parametrize(
    ("most", "least", "came_to"),
    ((1.0, 1.0, rules.GOES_ON), (1.01, 1.01, rules.MEASURED), (1.0, 0.91, rules.GOES_ON), (1.0, 0.89, rules.MEASURED)),
)
def test_when_a_twitch_of_an_angle_is_over(most: float, least: float, came_to: int) -> None:
    t = AutotuneState()
    t.angle_max, t.angle_min = most, least
    assert rules.judge_angle(t, 1.0, 0.1) == came_to


@pytest.mark.parametrize(("step", "goal"), ((rules.RATE_D_UP, 1.0), (rules.RATE_D_DOWN, 1.0), (rules.RATE_P_UP, 1.05)))
def test_only_for_p_a_rate_must_pass_its_target(step: int, goal: float) -> None:
    v = tuning(ROLL, step)
    t = v.autopilot.modes.autotune
    t.target = 1.0
    for rate, came_to in ((goal - 0.01, rules.GOES_ON), (goal + 0.01, rules.MEASURED)):
        t.rate = rate
        assert twitch.come_of_rate(t, v, 0.1) == came_to


@pytest.mark.parametrize(("axis", "limit"), ((ROLL, 15.0), (PITCH, 15.0), (YAW, 30.0), (YAW_D, 30.0)))
def test_a_rate_may_lean_half_of_the_limit_and_turn_30_degrees(axis: int, limit: float) -> None:
    for off, came_to in ((-0.1, rules.GOES_ON), (0.1, rules.TOO_LARGE)):
        v = tuning(axis, rules.RATE_D_UP)
        v.autopilot.params.ANGLE_MAX = 3000.0
        t = v.autopilot.modes.autotune
        t.target = 10.0
        angle = math.radians(limit + off)
        v.autopilot.estimate.euler = Euler(angle, angle, angle)
        assert twitch.come_of_rate(t, v, 0.1) == came_to


def counted(axis: int = ROLL, **fields: float) -> tuple[Any, Any]:
    """(AUTOTUNE's state, gains) in the middle of a step."""
    v = tuning(axis, rules.RATE_D_UP)
    t = v.autopilot.modes.autotune
    t.target, t.rate_max, t.rate_min, t.count = 1.0, 0.9, 0.9, 2
    for name, x in fields.items():
        setattr(t, name, x)
    g = gains.found(t, axis)
    g.rate_p, g.rate_d, g.angle_p, g.error_hz = 0.2, 0.01, 5.0, 2.0
    return t, g


@pytest.mark.parametrize(("most", "fits"), ((0.79, False), (0.81, True), (1.0, True), (1.01, False)))
def test_d_is_measured_at_a_rate_just_below_the_target(most: float, fits: bool) -> None:
    assert rules.fits_rate(counted(rate_max=most)[0]) == fits


def test_p_is_fitted_to_the_target_and_then_d() -> None:
    t, g = counted(rate_max=0.5)
    assert (rules.fit_rate(t, g, 0.005), g.rate_p) == (rules.CHANGED, pytest.approx(0.21))
    g.rate_p = 1.95
    assert (rules.fit_rate(t, g, 0.005), g.rate_p) == (rules.NO_D, 2.0)
    t.rate_max, g.rate_p = 1.1, 0.02
    assert (rules.fit_rate(t, g, 0.005), g.rate_p, g.rate_d) == (rules.CHANGED, pytest.approx(0.019), 0.01)
    g.rate_p = 0.0101
    assert (rules.fit_rate(t, g, 0.005), g.rate_p, g.rate_d) == (rules.CHANGED, 0.01, pytest.approx(0.0095))
    assert (rules.fit_rate(t, g, 0.0094), g.rate_d) == (rules.NO_D, 0.0094)


def test_a_rate_at_its_target_is_not_too_slow() -> None:
    t, g = counted(rate_max=1.0)
    rules.fit_rate(t, g, 0.005)
    assert g.rate_p == pytest.approx(0.19)


def test_more_d_until_it_bounces_or_is_at_its_most() -> None:
    t, g = counted(rate_min=0.7)
    rules.raise_d(t, g, 0.02, 0.1)
    assert (t.count, bool(t.ignore_next), g.rate_d) == (3, True, 0.01)
    t.rate_min = 0.9
    rules.raise_d(t, g, 0.02, 0.1)  # the first failure after a success is not believed
    assert (t.count, bool(t.ignore_next), g.rate_d) == (3, False, 0.01)
    rules.raise_d(t, g, 0.02, 0.1)
    assert (t.count, g.rate_d) == (2, pytest.approx(0.011))
    rules.raise_d(t, g, 0.0121, 0.1)
    assert (t.count, g.rate_d) == (rules.ENOUGH, pytest.approx(0.0121))


def test_less_d_until_it_does_not_bounce() -> None:
    t, g = counted(rate_min=0.7)
    assert rules.lower_d(t, g, 0.005, 0.1) == rules.CHANGED
    assert (t.count, bool(t.ignore_next), g.rate_d) == (1, True, pytest.approx(0.0095))
    t.rate_min = 0.9
    assert rules.lower_d(t, g, 0.005, 0.1) == rules.CHANGED  # nor the first success after a failure
    assert (t.count, bool(t.ignore_next)) == (1, False)
    rules.lower_d(t, g, 0.005, 0.1)
    assert t.count == 2
    t.rate_min = 0.7
    assert rules.lower_d(t, g, 0.0094, 0.1) == rules.D_AT_LIMIT
    assert (t.count, g.rate_d) == (rules.ENOUGH, 0.0094)


def test_more_p_until_the_target_is_passed() -> None:
    t, g = counted(rate_max=1.06, rate_min=1.06)
    assert (rules.raise_p(t, g, 0.005, 0.1), t.count) == (rules.CHANGED, 3)
    t.rate_max = t.rate_min = 1.04
    t.ignore_next = False
    assert (rules.raise_p(t, g, 0.005, 0.1), t.count, g.rate_p) == (rules.CHANGED, 2, pytest.approx(0.21))
    g.rate_p = 1.95
    assert (rules.raise_p(t, g, 0.005, 0.1), t.count, g.rate_p) == (rules.CHANGED, rules.ENOUGH, 2.0)


@pytest.mark.parametrize(
    ("axis", "most", "d", "takes"),
    (
        (ROLL, 0.9, 0.01, True),
        (ROLL, 0.8, 0.01, False),  # too slow to tell
        (ROLL, 1.0, 0.01, False),
        (ROLL, 0.9, 0.005, False),  # D is at its least
        (YAW, 0.9, 2.0, True),
    ),
)
def test_a_bounce_just_below_the_target_takes_from_both_gains(axis: int, most: float, d: float, takes: bool) -> None:
    t, g = counted(axis, rate_max=most, rate_min=0.5, backwards=True)
    rules.set_d(t, g, d)
    assert rules.raise_p(t, g, 0.005, 0.1) == rules.CHANGED
    assert t.count == 1
    assert g.rate_p == pytest.approx(0.19 if takes else 0.21)
    assert rules.get_d(t, g) == pytest.approx(0.95 * d if takes else d)
    assert bool(t.backwards) != takes  # the same side again


def test_a_bounce_at_the_least_gains_ends_the_step() -> None:
    t, g = counted(rate_min=0.5)
    g.rate_p = 0.0101
    assert (rules.raise_p(t, g, 0.005, 0.1), g.rate_p) == (rules.NO_P, 0.01)
    t, g = counted(rate_min=0.5)
    assert (rules.raise_p(t, g, 0.0096, 0.1), g.rate_d) == (rules.NO_D, 0.0096)
    t, g = counted(YAW, rate_min=0.5)
    assert (rules.raise_p(t, g, 1.95, 0.1), g.error_hz) == (rules.CHANGED, 1.95)


def test_angle_p_goes_down_until_the_target_is_not_passed() -> None:
    t, g = counted(angle_max=1.06)
    rules.lower_angle_p(t, g, 0.1)
    assert (t.count, bool(t.ignore_next), g.angle_p) == (1, True, pytest.approx(4.75))
    t.angle_max = 1.04
    rules.lower_angle_p(t, g, 0.1)
    assert (t.count, g.angle_p) == (1, pytest.approx(4.75))
    rules.lower_angle_p(t, g, 0.1)
    assert t.count == 2
    t.angle_max, g.angle_p = 1.06, 0.51
    rules.lower_angle_p(t, g, 0.1)
    assert (t.count, g.angle_p) == (rules.ENOUGH, 0.5)


@pytest.mark.parametrize(
    ("angle", "most", "least", "passes"),
    (
        (1.06, 1.0, 0.0, True),
        (1.04, 1.0, 0.0, False),
        (1.04, 1.0, -0.11, True),
        (1.04, 1.0, -0.09, False),
        (1.0, 1.0, -0.5, False),
    ),
)
def test_angle_p_goes_up_until_the_target_is_passed_or_it_turns_back(angle, most, least, passes):
    t, g = counted(angle_max=angle, rate_max=most, rate_min=least)
    rules.raise_angle_p(t, g, 0.1)
    assert (t.count, g.angle_p) == ((3, 5.0) if passes else (1, pytest.approx(5.25)))
    assert bool(t.ignore_next) == passes


def test_angle_p_at_its_most_ends_the_step() -> None:
    t, g = counted(angle_max=0.5)
    g.angle_p = 39.0
    rules.raise_angle_p(t, g, 0.1)
    assert (t.count, g.angle_p) == (rules.ENOUGH, 40.0)
