# SPDX-License-Identifier: BSD-3-Clause
"""Position control on ArduPilot's SITL rover: the recorded drive to a point, reverse, jumps of the estimate."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.control.pid import Gains
from sitl.autopilot.control.shaping import Motion2
from sitl.autopilot.rover.control import motors, position, speed, steering
from sitl.autopilot.rover.control.state import DT, PositionState
from sitl.autopilot.state import Estimate
from sitl.core.algebra import ZERO2, dot2, horizontal, norm2
from sitl.core.vectors import Vec2, Vec3
from tests.autopilot.rover.control.rover_car import RECORDED, Car, arm, finish, make_vehicle, sense

number = st.floats(-50.0, 50.0)


def ready(heading=0.0, **params):
    car = Car(arm(make_vehicle(**{**RECORDED, **params})), heading)
    ap = car.v.autopilot
    position.set_limits(ap.control.position, 5.0, 1.0, steering.lat_accel_max(ap.params.ATC), 1.0)
    assert position.init(ap.control.position, ap.estimate)
    return car


def standing(n, e):
    return Motion2(Vec2(n, e), ZERO2, ZERO2)


def pos_error(ap):
    return ap.control.position.pos_target - horizontal(ap.estimate.pos)


def follow_target(ap):
    position.follow_target(ap.control, ap.estimate, ap.arming.armed, ap.params)


def follow(car, backward=False):
    """One period towards what the targets say."""
    v, ap = car.v, car.v.autopilot
    c = ap.control.position
    sense(v)
    c.reversed = backward
    follow_target(ap)
    speed.drive(ap.control, True, c.desired_speed, ap.params)
    demand = steering.out_from_rate(ap.control, ap.estimate, c.desired_turn_rate, ap.params.ATC)
    motors.set_steering(ap.control.motors, demand)
    finish(v)
    car.move()


def test_point_20_m_to_the_right_as_recorded():
    """A real ArduRover, GUIDED: 3 m away at 7.8 s, 1 m at 9.2 s, peak 3.96 m/s, and swings out 1.45 m to the north."""
    car = ready()
    target = Vec2(0.0, 20.0)
    away, speeds, north = [], [], []
    for _ in range(500):
        position.input_pos(car.v.autopilot.control.position, target)
        follow(car)
        away.append(math.dist(car.position, target))
        speeds.append(car.speed)
        north.append(car.position[0])
    times = np.arange(500) * DT + 0.08
    assert times[np.argmax(np.array(away) < 3.0)] == pytest.approx(7.8, abs=0.2)
    assert times[np.argmax(np.array(away) < 1.0)] == pytest.approx(9.2, abs=0.2)
    assert max(speeds) == pytest.approx(3.96, abs=0.03)
    assert max(north) == pytest.approx(1.45, abs=0.2)


def test_a_car_keeps_the_speed_of_its_tightest_turn_where_a_skid_steered_one_waits():
    wide, tight = ready(), ready(SERVO1_FUNCTION=73.0, SERVO3_FUNCTION=74.0)
    for car in (wide, tight):
        ap = car.v.autopilot
        sense(car.v)
        position.set_pos_vel_accel(ap.control.position, Motion2(ZERO2, Vec2(0.0, 3.0), ZERO2))
        follow_target(ap)
        assert ap.control.position.desired_turn_rate > 0.5
    least = math.sqrt(0.5 * 0.6 * 9.80665 * 0.9)
    assert wide.v.autopilot.control.position.desired_speed == pytest.approx(least)
    assert tight.v.autopilot.control.position.desired_speed == pytest.approx(0.0)


def test_backwards():
    car = ready()
    for _ in range(700):
        position.input_pos(car.v.autopilot.control.position, Vec2(-10.0, 1.0))
        follow(car, backward=True)
    assert math.dist(car.position, (-10.0, 1.0)) < 0.6
    assert abs(math.remainder(car.heading, 2 * math.pi)) < 0.5


def test_smooth_path_is_followed():
    car = ready()
    omega, radius = 0.2, 10.0
    worst = 0.0
    for k in range(1500):
        a = omega * k * DT
        s, c = math.sin(a), math.cos(a)
        pos, direction = Vec2(radius * s, radius * (1 - c)), Vec2(c, s)
        path = Motion2(pos, direction * (radius * omega), Vec2(-s, c) * (radius * omega**2))
        position.set_pos_vel_accel(car.v.autopilot.control.position, path)
        follow(car)
        if k > 750:
            worst = max(worst, norm2(pos_error(car.v.autopilot)))
    assert worst < 0.6


def test_target_follows_a_jump_of_the_estimate():
    car = ready()
    ap = car.v.autopilot
    for _ in range(50):
        position.input_pos(ap.control.position, Vec2(10.0, 0.0))
        follow(car)
    before = pos_error(ap)
    ap.estimate.pos = ap.estimate.pos.replace(x=ap.estimate.pos.x + 5.0)
    ap.estimate.reset_ne_count += 1
    follow_target(ap)
    assert pos_error(ap) == pytest.approx(before, abs=0.05)


def test_the_velocity_wanted_follows_a_jump_too():
    c, estimate = PositionState(), Estimate()
    c.pos_error, c.vel_error, c.vel_desired = Vec2(1.0, 2.0), Vec2(0.5, -0.25), Vec2(9.0, 9.0)
    estimate.pos, estimate.vel, estimate.reset_ne_count = Vec3(10.0, 20.0, -1.0), Vec3(3.0, 4.0, 5.0), 1
    position.follow_reset(c, estimate)
    assert (c.pos_target, c.vel_desired) == (Vec2(11.0, 22.0), Vec2(3.5, 3.75))
    c.vel_error = Vec2(0.0, 0.0)
    position.follow_reset(c, estimate)  # once a jump
    assert c.vel_desired == Vec2(3.5, 3.75)


def test_disarmed_or_lost_it_brakes():
    car = ready()
    ap = car.v.autopilot
    for _ in range(50):
        position.input_pos(ap.control.position, Vec2(10.0, 3.0))
        follow(car)
    before = float(ap.control.speed.desired)
    ap.estimate.position_ok = 0
    follow_target(ap)
    assert ap.control.position.desired_turn_rate == 0.0
    assert ap.control.position.desired_speed == pytest.approx(before - 1.0 * DT)
    assert not position.init(ap.control.position, ap.estimate)


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_bad_targets_are_not_taken_over(bad):
    car = ready()
    ap = car.v.autopilot
    before = list(ap.control.position.pos_target)
    position.input_pos(ap.control.position, Vec2(bad, 0.0))
    position.input_pos_vel_accel(ap.control.position, Motion2(ZERO2, Vec2(bad, 0.0), ZERO2))
    position.set_pos_vel_accel(ap.control.position, Motion2(ZERO2, ZERO2, Vec2(0.0, bad)))
    assert list(ap.control.position.pos_target) == before


@pytest.mark.parametrize("speed_max", [5.0, 0.25])
def test_a_way_straight_back_begins_with_a_turn(speed_max):
    """Also of a vehicle that is never fast: else nothing turns it, and it drives away for ever."""
    car = ready(PSC_POS_P=1.0)
    ap = car.v.autopilot
    position.set_limits(ap.control.position, speed_max, 1.0, steering.lat_accel_max(ap.params.ATC), 1.0)
    position.set_pos_vel_accel(ap.control.position, standing(-10.0, 0.0))
    follow(car)
    assert ap.control.position.desired_lat_accel > 0.0


@given(number, number, number, number)
def test_the_correction_points_at_the_target_and_is_no_faster_than_the_limit(n, e, north, east):
    c = PositionState()
    position.set_limits(c, 3.0, 1.0, 2.0, 1.0)
    c.pos_target = Vec2(n, e)
    vel = position.control_position(c, Vec2(north, east), 0.8)
    assert norm2(vel) <= 3.0 + 1e-6
    assert dot2(vel, Vec2(n - north, e - east)) >= 0.0
    assert norm2(c.pos_target - Vec2(north, east)) <= math.hypot(n - north, e - east) + 1e-9


@given(st.floats(-5.0, 5.0), st.floats(0.0, 5.0), st.booleans())
def test_a_car_keeps_moving_its_way(along, slowest, backward):
    c = PositionState()
    c.reversed = backward
    size = abs(along) + 0.5
    out = position.speed_along(c, along, size, slowest)
    assert (-out if backward else out) >= min(size, slowest)


def test_the_velocity_loop_on_its_record_alone():
    c = PositionState()
    c.vel_target = Vec2(2.0, -1.0)
    gains = Gains(
        p=0.5, i=1.0, d=0.0, ff=0.1, d_ff=0.0, i_max=0.01, pd_max=0.0, target_hz=0.0, error_hz=0.0, derivative_hz=0.0
    )
    out = position.control_velocity(c, ZERO2, gains)
    assert norm2(c.vel_integrator) == pytest.approx(0.01)
    assert tuple(out - c.vel_integrator) == pytest.approx((1.2, -0.6))
