# SPDX-License-Identifier: BSD-3-Clause
"""PID: filters, anti-windup, inputs that are not numbers."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.control.pid import (
    Blocked,
    Gains,
    Pid,
    lowpass_gain,
    relax_integrator,
    reset_filter,
    update_pid,
    update_pid_directional,
)
from sitl.core.records import as_dict

DT = 0.0025


def fresh(integrator=0.0):
    pid = Pid()
    pid.integrator = integrator
    return pid


def saturating(pid, target, measurement, saturated=False, kp=0.0, ki=0.0, kd=0.0, imax=0.5, hz_error=0.0, pd_max=0.0):
    gains = Gains(kp, ki, kd, 0.0, 0.0, imax, pd_max, 0.0, hz_error, 0.0)
    return update_pid(pid, target, measurement, DT, saturated, gains)


def test_proportional_only():
    assert saturating(fresh(), 1.0, 0.25, kp=2.0) == pytest.approx(1.5)


def test_first_input_makes_no_derivative_kick():
    assert saturating(fresh(), 100.0, 0.0, kd=1.0) == 0.0


def test_derivative_of_a_ramp():
    pid = fresh()
    for k in range(4):
        out = saturating(pid, 0.01 * k, 0.0, kd=1.0)
    assert out == pytest.approx(0.01 / DT)


@given(st.floats(-1.0, 1.0), st.floats(-5.0, 5.0))
def test_integrator_of_a_saturated_loop_only_shrinks(start, error):
    pid = fresh(start)
    for _ in range(50):
        saturating(pid, error, 0.0, saturated=True, ki=1.0, imax=2.0)
        assert abs(pid.integrator) <= abs(start) + 5.0 * DT


def test_integrator_stays_within_imax():
    pid = fresh()
    for _ in range(2000):
        saturating(pid, 10.0, 0.0, ki=1.0, imax=0.3)
    assert pid.integrator == pytest.approx(0.3)


@pytest.mark.parametrize(("error", "blocked"), [(1.0, True), (-1.0, False)])
def test_directional_limit_blocks_one_direction(error, blocked):
    pid = fresh()
    gains = Gains(0.0, 1.0, 0.0, 0.0, 0.0, 9.0, 0.0, 0.0, 0.0, 0.0)
    update_pid_directional(pid, error, 0.0, DT, Blocked(False, True), gains)
    assert (pid.integrator == 0.0) is blocked


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_bad_numbers_give_zero_and_leave_no_trace(bad):
    pid = fresh(0.1)
    saturating(pid, 1.0, 0.0, kp=1.0, ki=1.0)
    before = as_dict(pid)
    assert saturating(pid, bad, 0.0, kp=1.0, ki=1.0) == 0.0
    assert saturating(pid, 0.0, bad, kp=1.0, ki=1.0) == 0.0
    assert as_dict(pid) == before


def test_pd_limit():
    assert saturating(fresh(), 10.0, 0.0, kp=1.0, pd_max=0.4) == 0.4


def test_error_filter_follows_with_its_time_constant():
    pid, hz = fresh(), 2.0
    saturating(pid, 0.0, 0.0, hz_error=hz)
    for _ in range(round(1.0 / (2 * math.pi * hz) / DT)):
        saturating(pid, 1.0, 0.0, hz_error=hz)
    assert pid.error == pytest.approx(1 - math.exp(-1), abs=0.02)


def test_no_cut_off_means_no_filter():
    assert lowpass_gain(0.0, DT) == 1.0
    assert 0.0 < lowpass_gain(20.0, DT) < 1.0


def test_relaxing_integrator_decays():
    pid = fresh(1.0)
    for _ in range(400):
        relax_integrator(pid, 0.2, DT, 0.16)
    assert pid.integrator == pytest.approx(0.2, abs=0.01)


FREE = Blocked(False, False)


def directional(pid, error, blocked=FREE, ki=0.5):
    return update_pid_directional(pid, error, 0.0, DT, blocked, Gains(2.0, ki, 0.1, 0.3, 0.0, 9.0, 0.0, 0.0, 0.0, 0.0))


@pytest.mark.parametrize("error", [1.0, -1.0])
def test_the_output_holds_all_terms_with_their_signs(error):
    """A steady error: P and feed-forward stand, and the integral grows with it."""
    gains = Gains(2.0, 0.5, 0.1, 0.3, 0.2, 9.0, 0.0, 0.0, 0.0, 0.0)
    for update in (
        lambda pid: update_pid(pid, error, 0.0, DT, False, gains),
        lambda pid: update_pid_directional(pid, error, 0.0, DT, Blocked(False, False), gains),
    ):
        pid = fresh()
        outs = [update(pid) for _ in range(400)]
        assert outs[0] == pytest.approx(error * (2.3 + 0.5 * DT))
        assert outs[-1] == pytest.approx(error * (2.3 + 0.5 * 1.0))
        assert pid.integrator == pytest.approx(error * 0.5)


def test_derivative_and_feed_forward_of_a_moving_target():
    """With a filter of the target: the target that counts is the filtered one, and its derivative is its own."""
    pid, gains = fresh(), Gains(0.0, 0.0, 0.0, 1.0, 0.5, 0.0, 0.0, 4.0, 0.0, 0.0)
    update_pid(pid, 0.0, 0.0, DT, False, gains)
    out = update_pid(pid, 1.0, 0.0, DT, False, gains)
    gain = lowpass_gain(4.0, DT)
    assert out == pytest.approx(gain + 0.5 * gain / DT)
    pid, gains = fresh(), Gains(0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0)
    update_pid(pid, 0.0, 0.0, DT, False, gains)
    assert update_pid(pid, 0.0, 1.0, DT, False, gains) == pytest.approx(-gain / DT)
    assert update_pid(pid, 0.0, 1.0, DT, False, gains) == pytest.approx(-gain / DT * (1.0 - gain))
    assert lowpass_gain(4.0, DT) == pytest.approx(math.tau * 4.0 * DT / (1.0 + math.tau * 4.0 * DT))


@pytest.mark.parametrize("start", [0.3, -0.3])
def test_a_saturated_loop_unwinds(start):
    pid = fresh(start)
    saturating(pid, -math.copysign(1.0, start), 0.0, saturated=True, ki=1.0)
    assert pid.integrator == pytest.approx(start - math.copysign(DT, start))
    saturating(pid, math.copysign(1.0, start), 0.0, saturated=True, ki=1.0)
    assert pid.integrator == pytest.approx(start - math.copysign(DT, start))


@pytest.mark.parametrize("error", [1.0, -1.0])
def test_each_direction_is_blocked_on_its_own(error):
    for blocked, grows in ((Blocked(error < 0.0, error > 0.0), False), (Blocked(error > 0.0, error < 0.0), True)):
        pid = fresh()
        directional(pid, error, blocked)
        assert (pid.integrator != 0.0) is grows


def test_no_integral_gain_forgets_the_integrator():
    pid = fresh(0.4)
    assert directional(pid, 1.0, ki=0.0) == pytest.approx(2.3) and pid.integrator == 0.0


def test_relaxing_integrator_has_the_time_constant():
    pid = fresh(1.0)
    relax_integrator(pid, 0.2, DT, 0.16)
    assert pid.integrator == pytest.approx(1.0 - 0.8 * DT / (DT + 0.16))


def test_a_lowered_limit_holds_at_once_also_without_an_error():
    for blocked in (FREE, Blocked(True, True)):
        pid = fresh(0.5)
        gains = Gains(0.0, 1.0, 0.0, 0.0, 0.0, 0.3, 0.0, 0.0, 0.0, 0.0)
        update_pid_directional(pid, 0.0, 0.0, DT, blocked, gains)
        assert pid.integrator == 0.3


@pytest.mark.parametrize("bad", [(math.nan, 0.0), (0.0, math.inf)])
def test_a_loop_that_knows_directions_takes_no_bad_numbers_either(bad):
    pid = fresh(0.1)
    before = as_dict(pid)
    gains = Gains(1.0, 1.0, 0.0, 0.0, 0.0, 9.0, 0.0, 0.0, 0.0, 0.0)
    assert update_pid_directional(pid, *bad, DT, FREE, gains) == 0.0 and as_dict(pid) == before


@pytest.mark.parametrize(("error", "wanted"), [(10.0, 0.4), (-10.0, -0.4), (0.2, 0.2)])
def test_the_limit_of_p_and_d_holds_both_ways_and_leaves_the_rest(error, wanted):
    gains = Gains(1.0, 0.0, 0.0, 0.5, 0.0, 9.0, 0.4, 0.0, 0.0, 0.0)
    assert update_pid(fresh(), error, 0.0, DT, False, gains) == pytest.approx(wanted + 0.5 * error)


def test_a_loop_that_was_reset_takes_its_next_input_as_it_is():
    pid = fresh()
    saturating(pid, 1.0, 0.0, kd=1.0, hz_error=1.0)
    reset_filter(pid)
    assert saturating(pid, 5.0, 0.0, kd=1.0, hz_error=1.0) == 0.0
    assert (pid.error, pid.target_derivative) == (5.0, 0.0)
