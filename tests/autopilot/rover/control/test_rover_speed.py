# SPDX-License-Identifier: BSD-3-Clause
"""Speed loop: acceleration limits, feed-forward, brake, standing, what a speed comes from."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.estimation.status import VELOCITY_HORIZ
from sitl.autopilot.rover.control import speed
from sitl.autopilot.rover.control.forward_speed import estimate_forward_speed, yaw_rate
from sitl.autopilot.rover.control.state import DT, Control, SpeedState
from sitl.autopilot.rover.parameters import Parameters
from sitl.autopilot.state import Estimate, Sensors
from sitl.core.vectors import Quat, Vec3
from tests.autopilot.rover.control.rover_car import PERIOD_US, arm, finish, make_vehicle, sense, set_motion


def rolling(forward=0.0, **params):
    v = arm(make_vehicle(**params))
    set_motion(v, 0.3, forward, 0.0)
    return v


def throttle_for_speed(v, wanted):
    sense(v)
    return speed.control_speed(v.autopilot.control, wanted, v.autopilot.params)


def throttle_for_stop(v):
    sense(v)
    return speed.control_stop(v.autopilot.control, v.autopilot.params)


def drive(v, wanted):
    sense(v)
    speed.drive(v.autopilot.control, True, wanted, v.autopilot.params)


def forward(v):
    s = sense(v)
    return s.forward_ok, s.forward


def run(v, wanted, periods):
    throttle = 0.0
    for _ in range(periods):
        throttle = throttle_for_speed(v, wanted)
        finish(v)
    return throttle


def test_desired_speed_starts_at_the_present_speed_and_changes_with_accel_max():
    v = rolling(1.0, ATC_ACCEL_MAX=2.0)
    assert speed.accel_limited(v.autopilot.control, 9.0, v.autopilot.params.ATC) == 9.0
    run(v, 9.0, 5)
    assert v.autopilot.control.speed.desired == pytest.approx(1.0 + 5 * 2.0 * DT)


def test_deceleration_has_its_own_limit():
    v = rolling(5.0, ATC_DECEL_MAX=3.0)
    run(v, 0.0, 5)
    assert v.autopilot.control.speed.desired == pytest.approx(5.0 - 5 * 3.0 * DT)
    assert speed.stopping_distance(6.0, v.autopilot.params.ATC) == pytest.approx(6.0)


def test_cruise_throttle_is_fed_forward():
    v = rolling(4.0, CRUISE_SPEED=5.0, CRUISE_THROTTLE=30.0)
    assert run(v, 4.0, 3) == pytest.approx(4.0 * 0.3 / 5.0)


def test_brake_off_never_works_against_the_motion():
    v = rolling(3.0, ATC_BRAKE=0.0)
    assert run(v, 0.0, 100) == 0.0
    assert v.autopilot.control.speed.limit_low == 1
    wound_up = v.autopilot.control.speed.loop.integrator
    run(v, 0.0, 100)
    assert v.autopilot.control.speed.loop.integrator == wound_up
    assert run(rolling(3.0), 0.0, 100) < 0.0


def test_stop_stands_below_stop_speed_and_for_a_while_after():
    v = rolling(0.05)
    assert throttle_for_stop(v) == (0.0, True)
    finish(v)
    set_motion(v, 0.3, 0.5, 0.0)
    assert throttle_for_stop(v) == (0.0, True)
    for _ in range(16):
        finish(v)
    throttle, stands = throttle_for_stop(v)
    assert not stands
    assert throttle != 0.0


def test_without_a_speed_nothing_drives_and_a_stop_stands():
    v = rolling(3.0)
    v.autopilot.estimate.status_flags = 0
    assert throttle_for_speed(v, 5.0) == 0.0
    assert throttle_for_stop(v) == (0.0, True)


def test_drive_at_zero_is_a_controlled_stop():
    v = rolling(2.0)
    for _ in range(150):
        drive(v, 0.0)
        finish(v)
    assert v.autopilot.control.speed.desired == 0.0
    assert v.autopilot.control.motors.throttle < 0.0
    set_motion(v, 0.3, 0.0, 0.0)
    drive(v, 0.0)
    assert v.autopilot.control.motors.throttle == 0.0


@pytest.mark.parametrize(
    ("params", "most"),
    [
        ({"CRUISE_SPEED": 5.0, "CRUISE_THROTTLE": 30.0}, 5.0 / 0.3),
        ({"CRUISE_SPEED": 5.0, "CRUISE_THROTTLE": 2.0}, 5.0),
        ({"CRUISE_SPEED": 20.0, "CRUISE_THROTTLE": 10.0}, 30.0),
        ({"SPEED_MAX": 4.0}, 4.0),
    ],
)
def test_speed_at_full_throttle(params, most):
    assert speed.speed_max(rolling(**params).autopilot.params) == pytest.approx(most)


def test_speed_from_the_receiver_has_the_sign_of_its_course():
    v = rolling(3.0)
    v.autopilot.estimate.status_flags = 1
    v.sensors.gps_fix = 3
    v.sensors.gps_vel = (300, 400, 0)
    assert forward(v) == (True, pytest.approx(5.0))
    v.sensors.gps_vel = (-300, -400, 0)
    assert forward(v) == (True, pytest.approx(-5.0))


def test_speed_from_the_wheels():
    v = rolling(3.0)
    v.autopilot.estimate.status_flags = 0
    for k in range(100):
        v.sensors.wheel_count = k + 1
        v.sensors.wheel_distance = (-0.02 * k, -0.04 * k)
        sense(v)
        v.time_us += PERIOD_US
    assert forward(v) == (True, pytest.approx(-1.5))
    v.sensors.wheel_count += 1
    v.time_us += 600_000
    assert forward(v) == (False, 0.0), "the first sample after a gap is no speed"
    v.sensors.wheel_count += 1
    v.time_us += PERIOD_US
    assert forward(v) == (True, 0.0), "the distance is the same"
    v.time_us += 600_000
    assert forward(v) == (False, 0.0)


def test_turn_rate_about_the_vertical_of_a_leaning_body():
    leaning = Quat(math.cos(0.25), math.sin(0.25), 0.0, 0.0)
    assert yaw_rate(leaning, Vec3(0.0, 0.3, 0.4)) == pytest.approx(0.3 * math.sin(0.5) + 0.4 * math.cos(0.5))


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_bad_numbers_brake(bad):
    v = rolling(2.0)
    drive(v, bad)
    throttle_for_speed(v, bad)
    assert math.isfinite(v.autopilot.control.speed.desired)
    v.autopilot.estimate.vel = v.autopilot.estimate.vel.replace(x=bad)
    assert forward(v) == (False, 0.0)


@given(st.lists(st.floats(-30.0, 30.0), min_size=1, max_size=30), st.floats(0.1, 5.0), st.floats(0.1, 5.0))
def test_desired_speed_keeps_its_limits_whatever_is_asked(wanted, accel, decel):
    control, params = Control(), Parameters()
    params.ATC.ACCEL_MAX, params.ATC.DECEL_MAX, params.ATC.BRAKE = accel, decel, 1.0
    for desired in wanted:
        before = control.speed.desired
        control.speed.forward_ok, control.speed.forward = True, before
        assert math.isfinite(speed.control_speed(control, desired, params))
        assert abs(control.speed.desired - before) <= max(accel, decel) * DT + 1e-12
        control.tick += 1


def test_speed_sources_in_their_order():
    s, estimate, sensors = SpeedState(), Estimate(), Sensors()
    assert estimate_forward_speed(s, estimate, sensors) == (False, 0.0)
    s.wheel_ok, s.wheel = True, 1.0
    assert estimate_forward_speed(s, estimate, sensors) == (True, 1.0)
    sensors.gps_fix, sensors.gps_vel = 3, (-200, 0, 0)
    assert estimate_forward_speed(s, estimate, sensors) == (True, -2.0)
    estimate.status_flags, estimate.vel = VELOCITY_HORIZ, Vec3(3.0, 9.0, 0.0)
    assert estimate_forward_speed(s, estimate, sensors) == (True, 3.0)
