# SPDX-License-Identifier: BSD-3-Clause
"""Turn-rate and heading loops: order of the limits, starting afresh, what saturation does to the integrator."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.rover.control import motors, steering
from sitl.autopilot.rover.control.state import DT, Control
from sitl.autopilot.rover.parameters.control import Attitude
from sitl.core.constants import GRAVITY
from tests.autopilot.rover.control.rover_car import arm, finish, make_vehicle, sense, set_motion


def moving(speed=0.0, turn_rate=0.0, heading=0.0, **params):
    v = arm(make_vehicle(**params))
    set_motion(v, heading, speed, turn_rate)
    sense(v)
    return v


def out(law, v, wanted):
    ap = v.autopilot
    return law(ap.control, ap.estimate, wanted, ap.params.ATC)


def run(v, rate, periods):
    demand = 0.0
    for _ in range(periods):
        demand = out(steering.out_from_rate, v, rate)
        motors.set_steering(v.autopilot.control.motors, demand)
        finish(v)
    return demand


def test_turn_rate_grows_no_faster_than_acc_max():
    v = moving()
    run(v, 1.0, 5)
    assert v.autopilot.control.steering.turn_rate == pytest.approx(5 * math.radians(120.0) * DT)
    assert v.autopilot.control.steering.limit_right == 1


def test_turn_rate_decays_no_faster_than_dec_max():
    v = moving(ATC_STR_DEC_MAX=60.0)
    run(v, 1.0, 40)
    run(v, 0.0, 5)
    assert v.autopilot.control.steering.turn_rate == pytest.approx(1.0 - 5 * math.radians(60.0) * DT)


def test_rate_limit():
    v = moving(ATC_STR_RAT_MAX=20.0)
    run(v, 3.0, 100)
    assert v.autopilot.control.steering.turn_rate == pytest.approx(math.radians(20.0))


def test_lateral_acceleration_limit():
    v = moving(speed=8.0)
    run(v, 3.0, 100)
    assert v.autopilot.control.steering.turn_rate == pytest.approx(0.6 * GRAVITY / 8.0)


def test_first_call_starts_at_the_present_turn_rate_and_a_pause_forgets():
    v = moving(speed=2.0, turn_rate=0.5)
    run(v, 0.5, 50)
    v.autopilot.control.steering.rate.integrator = 0.3
    v.autopilot.estimate.rates = v.autopilot.estimate.rates.replace(z=-0.4)
    for _ in range(11):
        finish(v)
    assert not steering.is_active(v.autopilot.control)
    out(steering.out_from_rate, v, 0.5)
    assert v.autopilot.control.steering.turn_rate == pytest.approx(-0.4 + math.radians(120.0) * DT)
    assert v.autopilot.control.steering.rate.integrator == pytest.approx(0.0, abs=1e-3)


def test_feed_forward_and_proportional():
    v = moving(speed=1.0, ATC_STR_RAT_I=0.0, ATC_STR_ACC_MAX=0.0, ATC_STR_RAT_FF=0.5, ATC_STR_RAT_P=0.1)
    assert out(steering.out_from_rate, v, 0.8) == pytest.approx(0.8 * 0.5 + 0.8 * 0.1)


def test_integrator_rests_below_the_scaling_speed_and_learns_above():
    slow, fast = moving(speed=0.8), moving(speed=2.0)
    run(slow, 0.5, 100)
    run(fast, 0.5, 100)
    assert slow.autopilot.control.steering.rate.integrator == pytest.approx(0.0, abs=0.01)
    assert fast.autopilot.control.steering.rate.integrator > 0.1


def test_heading_gives_a_rate_that_can_stop_in_time():
    atc = Attitude()
    atc.STR_ANG_P, atc.STR_ACC_MAX = 2.0, 120.0
    assert steering.turn_rate_from_heading(0.3, 0.0, atc) == pytest.approx(0.6)
    assert steering.turn_rate_from_heading(-2.0, 0.0, atc) == pytest.approx(-math.sqrt(2 * 2.0 * math.radians(120.0)))
    assert steering.turn_rate_from_heading(-2.0, 0.4, atc) == pytest.approx(-0.4)


@given(st.floats(-math.pi, math.pi), st.floats(0.0, 3.0), st.floats(0.1, 10.0), st.just(0.0) | st.floats(1e-3, 360.0))
def test_heading_rate_points_at_the_heading_within_its_limits(error, rate_max, gain, accel):
    atc = Attitude()
    atc.STR_ANG_P, atc.STR_ACC_MAX = gain, accel
    rate = steering.turn_rate_from_heading(error, rate_max, atc)
    assert rate * error >= 0.0
    assert rate_max == 0.0 or abs(rate) <= rate_max
    if accel > 0.0:
        assert rate * rate <= 2.0 * abs(error) * math.radians(accel) * (1.0 + 1e-9)


@given(st.lists(st.floats(-20.0, 20.0), min_size=1, max_size=30), st.floats(0.0, 10.0))
def test_turn_rate_keeps_its_limits_whatever_is_asked(wanted, speed):
    control, atc = Control(), Attitude()
    atc.STR_ACC_MAX, atc.STR_RAT_MAX, atc.TURN_MAX_G = 120.0, 90.0, 0.6
    control.speed.forward_ok, control.speed.forward = True, speed
    for rate in wanted:
        before = control.steering.turn_rate
        steering.control_turn_rate(control, rate, before, atc)
        now = control.steering.turn_rate
        assert abs(now) <= math.radians(90.0) + 1e-12
        assert abs(now) * max(speed, 1.0) <= 0.6 * GRAVITY + 1e-9
        assert abs(now - before) <= math.radians(120.0) * DT + 1e-9
        control.tick += 1


def test_lateral_acceleration_to_turn_rate():
    assert steering.turn_rate_from_lat_accel(2.0, 4.0) == 0.5
    assert steering.turn_rate_from_lat_accel(2.0, 0.1) == 2.0
    assert steering.turn_rate_from_lat_accel(2.0, -0.1) == -2.0
    v = moving(speed=-4.0, ATC_STR_ACC_MAX=0.0)
    out(steering.out_from_lat_accel, v, 2.0)
    assert v.autopilot.control.steering.turn_rate == pytest.approx(-0.5)
    assert v.autopilot.control.steering.lat_accel == 2.0


def test_no_speed_no_steering_by_lateral_acceleration():
    v = moving()
    v.autopilot.control.speed.forward_ok = False
    assert out(steering.out_from_lat_accel, v, 2.0) == 0.0


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_bad_numbers_steer_straight_and_leave_no_trace(bad):
    v = moving(speed=2.0)
    for law in (steering.out_from_rate, steering.out_from_lat_accel):
        assert math.isfinite(out(law, v, bad))
        finish(v)
    assert math.isfinite(out(steering.out_from_heading, v, bad))
    assert v.autopilot.control.steering.turn_rate == 0.0
