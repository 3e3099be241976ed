# SPDX-License-Identifier: BSD-3-Clause
"""Which gains AUTOTUNE's parameters hold: in twitches, between them, when it is tried, left and disarmed."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.autopilot.copter.modes import autotune_gains as gains
from sitl.autopilot.copter.modes.autotune_gains import PITCH, ROLL, YAW, YAW_D
from tests.autopilot.copter.steady_copter import fly, make, told

HELD = (
    (ROLL, "RAT_RLL", "ANG_RLL_P", "ACCEL_R_MAX"),
    (PITCH, "RAT_PIT", "ANG_PIT_P", "ACCEL_P_MAX"),
    (YAW, "RAT_YAW", "ANG_YAW_P", "ACCEL_Y_MAX"),
)
"""Axis, and the parameters ATC_* that hold its gains."""


def tuned() -> Any:
    """A vehicle whose gains from before are 1, 2, .. and whose gains found are a hundred more."""
    v = fly(make(), 15)
    t, p = v.autopilot.modes.autotune, v.autopilot.params.ATC
    for axis, loop, angle, accel in HELD:
        g = getattr(p, loop)
        g.P, g.I, g.D, g.FLTE, g.FLTT = (10.0 * axis + k for k in range(1, 6))
        setattr(p, angle, 10.0 * axis + 6.0)
        setattr(p, accel, 10.0 * axis + 7.0)
        gains.read(p, axis, gains.before(t, axis))
        f = gains.found(t, axis)
        f.rate_p, f.rate_i, f.rate_d, f.error_hz, f.target_hz, f.angle_p, f.accel = (
            100.0 + 10.0 * axis + k for k in range(1, 8)
        )
    return v


def held(v: Any, axis: int) -> tuple[float, ...]:
    """P, I, D, FLTE, FLTT, angle P and greatest acceleration of the parameters of an axis."""
    p = v.autopilot.params.ATC
    _, loop, angle, accel = HELD[axis]
    g = getattr(p, loop)
    return (g.P, g.I, g.D, g.FLTE, g.FLTT, getattr(p, angle), getattr(p, accel))


def old(axis: int) -> tuple[float, ...]:
    """What ``held`` gives for the gains from before."""
    return tuple(10.0 * axis + k for k in range(1, 8))


@pytest.mark.parametrize("axis", (ROLL, PITCH, YAW))
def test_between_twitches_the_gains_are_those_from_before_with_a_tenth_of_p_as_i(axis: int) -> None:
    v = tuned()
    v.autopilot.modes.autotune.axis = axis
    v.autopilot.params.ATC.RAT_RLL.P = 77.0
    gains.steady(v)
    for other in (ROLL, PITCH, YAW):
        expected = list(old(other))
        if other == axis:
            expected[1] = pytest.approx(0.1 * expected[0])
        assert list(held(v, other)) == expected


@pytest.mark.parametrize("axis", (ROLL, PITCH, YAW, YAW_D))
def test_in_a_twitch_one_axis_has_those_found_without_filter_and_limit(axis: int) -> None:
    v = tuned()
    v.autopilot.modes.autotune.axis = axis
    gains.twitch(v)
    place = min(axis, YAW)
    p = 101.0 + 10.0 * place
    assert held(v, place) == (p, pytest.approx(0.01 * p), p + 2.0, p + 3.0, 0.0, p + 5.0, 0.0)
    for other in {ROLL, PITCH, YAW} - {place}:
        assert held(v, other) == old(other)


@pytest.mark.parametrize("done", range(8))
def test_those_found_are_used_on_the_axes_that_were_tuned_only(done: int) -> None:
    v = tuned()
    v.autopilot.modes.autotune.done = done
    gains.use(v)
    for axis in (ROLL, PITCH, YAW):
        p = 101.0 + 10.0 * axis
        share = 0.1 if axis == YAW else 1.0  # yaw's I is a tenth of its P, as after ArduPilot's AUTOTUNE
        used = (p, pytest.approx(share * p), p + 2.0, p + 3.0, old(axis)[4], p + 5.0, p + 6.0)
        assert held(v, axis) == (used if done >> axis & 1 else old(axis))


def test_yaws_d_alone_is_used_as_yaw() -> None:
    v = tuned()
    v.autopilot.modes.autotune.done = 1 << YAW_D
    gains.use(v)
    assert held(v, YAW)[:2] == (121.0, pytest.approx(12.1))


@pytest.mark.parametrize("phase", range(7))
def test_gains_are_tried_only_when_all_axes_are_tuned(phase: int) -> None:
    v = tuned()
    t = v.autopilot.modes.autotune
    t.phase, t.done = phase, 7
    found = phase in (gains.FOUND, gains.TRIED, gains.RETURNED)
    assert gains.has_found(t) == found
    gains.try_gains(v, True)
    assert told(v, gains.AUTOTUNE_DID) == [(gains.TRIES, 7.0) if found else (gains.INCOMPLETE, 0.0)]
    assert t.phase == (gains.TRIED if found else phase)
    assert (held(v, ROLL)[0] == 101.0) == found


def test_what_a_client_set_since_is_what_a_trial_gives_back() -> None:
    v = tuned()
    t = v.autopilot.modes.autotune
    t.phase, t.done = gains.RETURNED, 7
    v.autopilot.params.ATC.RAT_RLL.P = 55.0
    gains.try_gains(v, True)
    gains.try_gains(v, True)  # again: those tried do not become those from before
    gains.try_gains(v, False)
    assert held(v, ROLL)[0] == 55.0
    assert t.phase == gains.RETURNED
    assert told(v, gains.AUTOTUNE_DID)[-1] == (gains.RESTORED, 0.0)


@pytest.mark.parametrize(
    ("phase", "next_phase", "restored"),
    (
        (gains.IDLE, gains.IDLE, False),
        (gains.TUNING, gains.PAUSED, True),
        (gains.FOUND, gains.RETURNED, False),
        (gains.TRIED, gains.RETURNED, True),
        (gains.RETURNED, gains.RETURNED, False),
        (gains.FAILED, gains.FAILED, False),
        (gains.PAUSED, gains.PAUSED, False),
    ),
)
def test_leaving_the_mode_takes_out_what_it_put_in(phase: int, next_phase: int, restored: bool) -> None:
    v = tuned()
    t = v.autopilot.modes.autotune
    t.phase = phase
    v.autopilot.params.ATC.RAT_PIT.P = 99.0
    gains.leave(v)
    assert t.phase == next_phase
    assert held(v, PITCH)[0] == (old(PITCH)[0] if restored else 99.0)
    assert told(v, gains.AUTOTUNE_DID) == ([] if phase == gains.IDLE else [(gains.STOPPED, 0.0)])


@pytest.mark.parametrize("landed", (True, False))
@pytest.mark.parametrize("phase", range(7))
def test_disarming_on_the_ground_keeps_what_was_found_and_not_given_back(phase: int, landed: bool) -> None:
    v = tuned()
    t = v.autopilot.modes.autotune
    t.phase, t.done = phase, 3
    v.autopilot.params.ATC.RAT_RLL.P = 99.0
    gains.settle(v, landed)
    saves = landed and phase in (gains.FOUND, gains.TRIED)
    restores = not saves and phase in (gains.TUNING, gains.TRIED)
    assert held(v, ROLL)[0] == (101.0 if saves else old(ROLL)[0] if restores else 99.0)
    assert told(v, gains.AUTOTUNE_DID) == ([(gains.SAVED, 3.0)] if saves else [])
    assert t.phase == gains.IDLE
