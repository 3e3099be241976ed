# SPDX-License-Identifier: BSD-3-Clause
"""A rover's loops of speed, steering and position at their limits; what a speed comes from."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.control.pid import Gains
from sitl.autopilot.control.shaping import Motion2
from sitl.autopilot.rover.control import forward_speed, position, speed, steering
from sitl.autopilot.rover.control.state import DT, Control, PositionState, SpeedState, SteeringState
from sitl.autopilot.rover.parameters.control import Attitude
from sitl.autopilot.state import Estimate
from sitl.core.algebra import ZERO2
from sitl.core.border import Sensors
from sitl.core.vectors import Vec2, Vec3
from tests.autopilot.rover.control.rover_car import arm, finish, make_vehicle, set_motion

GRAVITY = 9.80665


def atc(**values: float) -> Attitude:
    p = Attitude()
    for name, value in values.items():
        p[name] = value
    return p


def shaped(**values: Any) -> PositionState:
    c = PositionState()
    position.set_limits(c, 3.0, 1.0, 2.0, 1.0)
    for name, value in values.items():
        setattr(c, name, value)
    return c


@pytest.mark.parametrize(("own", "accel", "wanted"), ((0.0, 1.5, 1.5), (3.0, 1.5, 3.0), (0.0, 0.0, 0.0)))
def test_deceleration_is_that_of_acceleration_where_it_has_none_of_its_own(
    own: float, accel: float, wanted: float
) -> None:
    p = atc(DECEL_MAX=own, ACCEL_MAX=accel, STR_DEC_MAX=own, STR_ACC_MAX=accel)
    assert speed.decel_max(p) == wanted
    assert steering.turn_decel_max(p) == pytest.approx(math.radians(wanted))


@pytest.mark.parametrize(
    ("at", "decel", "distance"), ((4.0, 2.0, 4.0), (-4.0, 2.0, 4.0), (4.0, 0.0, 0.0), (1.0, 0.001, 50.0))
)
def test_the_distance_to_stop(at: float, decel: float, distance: float) -> None:
    assert speed.stopping_distance(at, atc(DECEL_MAX=decel)) == pytest.approx(distance)


@pytest.mark.parametrize(
    ("last", "wanted", "got"),
    (
        (1.0, 9.0, 1.0 + 2.0 * DT),
        (1.0, 0.0, 1.0 - 4.0 * DT),  # slowing has its own limit
        (-1.0, -9.0, -1.0 - 2.0 * DT),
        (-1.0, 0.0, -1.0 + 4.0 * DT),
        (1.0, -1.0, 1.0 - 2.0 * DT),
        (1.0, 1.0, 1.0),
    ),
)
def test_a_wanted_speed_changes_with_its_accelerations(last: float, wanted: float, got: float) -> None:
    control = Control()
    control.speed.desired = last
    control.tick, control.speed.last_tick = 100, 100
    p = atc(ACCEL_MAX=2.0, DECEL_MAX=4.0)
    assert speed.accel_limited(control, wanted, p) == pytest.approx(got)
    p.ACCEL_MAX = 0.0
    assert speed.accel_limited(control, wanted, p) == wanted


@pytest.mark.parametrize(
    ("cruise", "throttle", "fastest", "wanted"),
    (
        (4.0, 50.0, 0.0, 8.0),
        (4.0, 5.0, 0.0, 30.0),
        (1.0, 5.0, 0.0, 20.0),
        (4.0, 4.9, 0.0, 4.0),
        (4.0, 100.0, 0.0, 4.0),
        (4.0, 101.0, 0.0, 4.0),
        (4.0, 50.0, 6.0, 6.0),
        (-4.0, 50.0, 0.0, 0.0),
        (4.0, 50.0, 99.0, 30.0),
    ),
)
def test_the_speed_at_full_throttle(cruise: float, throttle: float, fastest: float, wanted: float) -> None:
    p = make_vehicle(CRUISE_SPEED=cruise, CRUISE_THROTTLE=throttle, SPEED_MAX=fastest).autopilot.params
    assert speed.speed_max(p) == pytest.approx(wanted)


def test_without_a_cruise_speed_nothing_is_fed_forward() -> None:
    p = make_vehicle(CRUISE_SPEED=0.0, CRUISE_THROTTLE=50.0).autopilot.params
    assert speed.cruise_throttle(3.0, p.CRUISE) == 0.0
    p.CRUISE.SPEED = 2.0
    assert speed.cruise_throttle(-3.0, p.CRUISE) == pytest.approx(-0.75)


@pytest.mark.parametrize(
    ("desired", "throttle", "out", "low", "high"),
    (
        (1.0, 0.5, 0.5, 0, 0),
        (1.0, -0.5, 0.0, 1, 0),
        (1.0, 0.0, 0.0, 1, 0),
        (-1.0, 0.5, 0.0, 0, 1),
        (-1.0, -0.5, -0.5, 0, 0),
        (0.0, -0.5, 0.0, 1, 0),
        (0.0, 0.5, 0.0, 0, 1),
    ),
)
def test_without_a_brake_no_throttle_works_against_the_motion(
    desired: float, throttle: float, out: float, low: int, high: int
) -> None:
    s = SpeedState()
    s.desired = desired
    assert speed.without_brake(s, throttle) == out and (s.limit_low, s.limit_high) == (low, high)


@pytest.mark.parametrize(("at", "stop_speed", "stands"), ((0.1, 0.1, True), (0.11, 0.1, False), (-0.1, -0.1, True)))
def test_a_stop_stands_at_atc_stop_speed(at: float, stop_speed: float, stands: bool) -> None:
    v = arm(make_vehicle(ATC_STOP_SPEED=stop_speed))
    set_motion(v, 0.0, at, 0.0)
    for _ in range(20):  # the stop of the start is forgotten
        finish(v)
    control = v.autopilot.control
    control.speed.forward, control.speed.forward_ok, control.speed.desired = at, True, 0.0
    assert speed.control_stop(control, v.autopilot.params).stands == stands
    assert (control.speed.stop_tick != 0) == stands


def test_a_stop_straightens_the_wheels() -> None:
    v = arm(make_vehicle())
    m = v.autopilot.control.motors
    m.steering, m.throttle = 0.7, 0.7
    assert speed.stop(v.autopilot.control, True, v.autopilot.params)
    assert (m.steering, m.throttle) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("rate", "wanted", "left", "right"),
    ((2.0, 1.0, 0, 1), (-2.0, -1.0, 1, 0), (1.0, 1.0, 0, 1), (-1.0, -1.0, 1, 0), (0.9, 0.9, 0, 0)),
)
def test_a_limit_of_the_turn_is_said(rate: float, wanted: float, left: int, right: int) -> None:
    s = SteeringState()
    assert steering.limited(s, rate, -1.0, 1.0) == wanted and (s.limit_left, s.limit_right) == (left, right)


@pytest.mark.parametrize(
    ("last", "rate", "wanted"),
    ((0.5, 9.0, 0.5 + 2.0), (0.5, 0.0, 0.5 - 1.0), (0.5, -9.0, 0.5 - 1.0), (-0.5, -9.0, -0.5 - 2.0), (0.0, 9.0, 2.0)),
)
def test_a_turn_rate_grows_and_decays_with_limits_of_its_own(last: float, rate: float, wanted: float) -> None:
    s = SteeringState()
    s.turn_rate = last
    p = atc(STR_ACC_MAX=120.0, STR_DEC_MAX=60.0)
    change = (wanted - last) * math.radians(60.0) * DT
    assert steering.limited_acceleration(s, rate, p) == pytest.approx(last + change)
    p.STR_ACC_MAX = p.STR_DEC_MAX = 0.0
    assert steering.limited_acceleration(s, rate, p) == rate


@pytest.mark.parametrize(
    ("known", "at", "limit"),
    ((1, 10.0, 0.5 * GRAVITY / 10.0), (1, -10.0, 0.5 * GRAVITY / 10.0), (0, 10.0, 3.0), (1, 1000.0, math.radians(1.0))),
)
def test_a_turn_keeps_the_lateral_acceleration_but_one_degree_a_second(known: int, at: float, limit: float) -> None:
    control = Control()
    control.speed.forward, control.speed.forward_ok = at, known
    p = atc(TURN_MAX_G=0.5)
    for way in (3.0, -3.0):
        assert steering.limited_turn_rate(control, way, p) == pytest.approx(math.copysign(limit, way))


@pytest.mark.parametrize(("g", "wanted"), ((0.5, 0.5), (0.05, 0.1), (-1.0, 0.1)))
def test_lateral_acceleration_is_a_tenth_of_gravity_at_least(g: float, wanted: float) -> None:
    assert steering.lat_accel_max(atc(TURN_MAX_G=g)) == pytest.approx(wanted * GRAVITY)


def test_negative_limits_are_none() -> None:
    c = PositionState()
    position.set_limits(c, -1.0, -1.0, -1.0, -1.0)
    assert (c.speed_max, c.accel_max, c.lat_accel_max, c.jerk_max) == (0.0, 0.0, 0.0, 0.0)


def test_it_starts_where_the_vehicle_is_and_as_it_moves_forwards() -> None:
    c, est = (
        shaped(pos_error=Vec2(1.0, 1.0), vel_target=Vec2(1.0, 1.0), accel_target=Vec2(1.0, 1.0), reversed=True),
        Estimate(),
    )
    est.position_ok, est.pos, est.vel, est.acc_ned = 1, Vec3(1.0, 2.0, 3.0), Vec3(4.0, 5.0, 6.0), Vec3(7.0, 8.0, 9.0)
    est.reset_ne_count = 3
    assert position.init(c, est)
    assert (c.pos_target, c.vel_desired, c.accel_desired) == ((1.0, 2.0), (4.0, 5.0), (7.0, 8.0))
    assert (c.pos_error, c.vel_target, c.accel_target, c.reversed, c.reset_count) == (ZERO2, ZERO2, ZERO2, 0, 3)


@pytest.mark.parametrize("missing", ("accel_max", "lat_accel_max", "jerk_max"))
def test_without_limits_a_target_is_not_shaped(missing: str) -> None:
    c = shaped(accel_desired=Vec2(0.2, 0.0), vel_desired=Vec2(1.0, 0.0))
    setattr(c, missing, 0.0)
    position.input_pos(c, Vec2(9.0, 0.0))
    assert c.accel_desired == (0.2, 0.0) and c.vel_desired.x == pytest.approx(1.0 + 0.2 * DT)
    assert c.pos_target.x == pytest.approx(DT + 0.1 * DT * DT)


@pytest.mark.parametrize(
    ("gain", "jerk", "error", "kept"),
    (
        (0.5, 0.0, 50.0, 0.5 / 0.25 + 9.0 / 2.0),  # 1 m/s^2: 0.5 a / p^2 + v^2 / (2 a)
        (2.0, 1.0, 50.0, 0.25 * 0.25 + 9.0 / 1.0),  # jerk over gain is the lesser acceleration
        (0.5, 1.0, 2.0, 2.0),
        (0.0, 1.0, 50.0, 50.0),
    ),
)
def test_a_target_too_far_ahead_waits(gain: float, jerk: float, error: float, kept: float) -> None:
    c = shaped(jerk_max=jerk, pos_target=Vec2(error, 0.0))
    velocity = position.control_position(c, ZERO2, gain)
    assert c.pos_target.x == c.pos_error.x == pytest.approx(kept)
    if kept < error:
        assert velocity.x == pytest.approx(3.0)


def test_the_velocity_loop_has_a_derivative_and_filters() -> None:
    c, gains = shaped(), Gains(0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0)
    c.vel_target = Vec2(1.0, 0.0)
    assert position.control_velocity(c, ZERO2, gains) == ZERO2, "no kick at the start"
    assert position.control_velocity(c, Vec2(0.1, 0.0), gains).x == pytest.approx(-0.1 / DT)
    slow = gains._replace(p=1.0, d=0.0, error_hz=1.0)
    x = math.tau * DT
    error = 0.9
    assert position.control_velocity(c, ZERO2, slow).x == pytest.approx(error + x / (1.0 + x) * (1.0 - error))


@pytest.mark.parametrize(("radius", "skid", "wanted"), ((0.9, False, 0.9), (-1.0, False, 0.0), (0.9, True, 0.0)))
def test_a_skid_steered_rover_turns_on_the_spot(radius: float, skid: bool, wanted: float) -> None:
    functions = {"SERVO1_FUNCTION": 73.0, "SERVO3_FUNCTION": 74.0} if skid else {}
    assert position.turn_radius(make_vehicle(TURN_RADIUS=radius, **functions).autopilot.params) == pytest.approx(wanted)


@pytest.mark.parametrize(
    ("backward", "along", "size", "lateral", "aside"),
    (
        (False, -1.0, 1.0, 0.0, True),
        (False, 1.0, 1.0, 0.0, False),
        (False, -1.0, 0.3, 0.0, False),  # hardly a way
        (False, -1.0, 0.31, 0.0, True),
        (False, -1.0, 1.0, 0.01, False),  # it turns already
        (False, -1.0, 1.0, -0.02, False),
        (False, -1.0, 1.0, -0.009, True),
        (True, 1.0, 1.0, 0.0, True),
        (True, -1.0, 1.0, 0.0, False),
        (False, 0.0, 1.0, 0.0, False),
    ),
)
def test_a_way_straight_back_begins_to_the_right(
    backward: bool, along: float, size: float, lateral: float, aside: bool
) -> None:
    c = shaped(reversed=backward)
    assert position.lateral_or_aside(c, along, size, lateral) == (0.01 if aside else lateral)


def test_a_slow_vehicle_knows_its_way_back_by_half_its_speed() -> None:
    c = shaped(speed_max=0.2)
    assert position.lateral_or_aside(c, -1.0, 0.11, 0.0) == 0.01 and position.lateral_or_aside(c, -1.0, 0.1, 0.0) == 0.0


@pytest.mark.parametrize(
    "fault", (lambda ap: setattr(ap.arming, "armed", 0), lambda ap: setattr(ap.estimate, "position_ok", 0))
)
def test_without_arming_or_a_position_it_brakes_straight_on(fault: Any) -> None:
    v = arm(make_vehicle())
    ap = v.autopilot
    position.set_limits(ap.control.position, 3.0, 1.0, 2.0, 1.0)
    position.init(ap.control.position, ap.estimate)
    position.set_pos_vel_accel(ap.control.position, Motion2(Vec2(5.0, 5.0), ZERO2, ZERO2))
    ap.control.position.desired_lat_accel = 1.0
    fault(ap)
    position.follow_target(ap.control, ap.estimate, ap.arming.armed, ap.params)
    c = ap.control.position
    assert (c.desired_speed, c.desired_turn_rate, c.desired_lat_accel) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(("backward", "way"), ((False, 1.0), (True, -1.0)))
def test_a_vehicle_that_stands_turns_the_way_it_is_about_to_go(backward: bool, way: float) -> None:
    v = arm(make_vehicle(TURN_RADIUS=0.0))
    control = v.autopilot.control
    c = control.position
    c.reversed, c.vel_target, c.accel_target = backward, ZERO2, Vec2(0.0, 0.5)
    position.drive_towards(control, 0.0, v.autopilot.params)
    assert c.desired_speed == 0.0 and c.desired_turn_rate == pytest.approx(0.5 * way)


@pytest.mark.parametrize(("dt_us", "known"), ((20_000, True), (500_000, True), (500_001, False), (0, False)))
def test_wheels_tell_a_speed_between_samples_within_half_a_second(dt_us: int, known: bool) -> None:
    s, sensors = SpeedState(), Sensors()
    s.wheel_count, s.wheel_us, s.wheel_distance = 1, 1_000_000, 2.0
    sensors.wheel_count, sensors.wheel_distance = 2, (2.5, 2.1)
    forward_speed.sense_wheels(s, sensors, 1_000_000 + dt_us)
    assert bool(s.wheel_ok) == known
    assert s.wheel == pytest.approx(0.3 / (dt_us * 1e-6) if known else 0.0)
    assert (s.wheel_count, s.wheel_us, s.wheel_distance) == (2, 1_000_000 + dt_us, pytest.approx(2.3))


@pytest.mark.parametrize(("silent_us", "known"), ((500_000, True), (500_001, False)))
def test_wheels_that_are_silent_for_half_a_second_tell_nothing(silent_us: int, known: bool) -> None:
    s, sensors = SpeedState(), Sensors()
    s.wheel_count = sensors.wheel_count = 3
    s.wheel_us, s.wheel_ok = 1_000_000, True
    forward_speed.sense_wheels(s, sensors, 1_000_000 + silent_us)
    assert bool(s.wheel_ok) == known


def test_the_speed_of_wheels_is_filtered_at_ten_hertz() -> None:
    s, sensors = SpeedState(), Sensors()
    s.wheel_count, s.wheel_ok, s.wheel = 1, True, 1.0
    sensors.wheel_count, sensors.wheel_distance = 2, (0.04, 0.04)
    forward_speed.sense_wheels(s, sensors, 20_000)
    x = math.tau * 10.0 * 0.02
    assert s.wheel == pytest.approx(1.0 + x / (1.0 + x) * (2.0 - 1.0))


@pytest.mark.parametrize(("pause", "kept"), ((1, True), (5, True), (6, False)))
def test_a_position_controller_that_paused_for_a_tenth_of_a_second_forgets(pause: int, kept: bool) -> None:
    v = arm(make_vehicle())
    ap = v.autopilot
    position.set_limits(ap.control.position, 3.0, 1.0, 2.0, 1.0)
    position.init(ap.control.position, ap.estimate)
    position.follow_target(ap.control, ap.estimate, True, ap.params)
    c = ap.control.position
    c.vel_integrator = Vec2(0.1, 0.0)
    ap.params.PSC.VEL.I, ap.params.PSC.VEL.IMAX = 0.1, 1.0
    for _ in range(pause):
        finish(v)
    position.follow_target(ap.control, ap.estimate, True, ap.params)
    assert (c.vel_integrator.x == pytest.approx(0.1)) == kept
    assert c.started
