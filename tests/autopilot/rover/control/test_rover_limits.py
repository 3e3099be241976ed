# SPDX-License-Identifier: BSD-3-Clause
"""A rover's controllers at their limits: which demand gives way and what says so, defaults, times, edges."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.control.pid import Gains
from sitl.autopilot.control.shaping import Motion2
from sitl.autopilot.rover.control import forward_speed, mixer, motors, position, servos, speed, steering
from sitl.autopilot.rover.control.state import (
    DT,
    TEST_LEFT,
    TEST_RIGHT,
    TEST_STEERING,
    TEST_THROTTLE,
    Control,
    MotorsState,
    PositionState,
    SpeedState,
    SteeringState,
)
from sitl.autopilot.rover.parameters.control import Attitude, Motors
from sitl.autopilot.state import Estimate
from sitl.core.algebra import ZERO2
from sitl.core.border import Sensors
from sitl.core.vectors import Vec2, Vec3
from tests.autopilot.rover.control.rover_car import arm, finish, make_vehicle, set_motion

GRAVITY = 9.80665


def said(m: MotorsState) -> set[str]:
    names = ("left", "right", "lower", "upper")
    return {name for name in names if getattr(m, f"limit_{name}")}


@pytest.mark.parametrize(
    ("steering_asked", "throttle", "mix", "asymmetry", "sides", "flags"),
    (
        (0.3, 0.5, 0.5, 1.0, (0.8, 0.2), set()),
        (-0.3, -0.5, 0.5, 1.0, (-0.8, -0.2), set()),
        (0.5, 0.5, 0.5, 1.0, (1.0, 0.0), set()),  # just fits
        (2.0, 0.0, 0.5, 1.0, (1.0, -1.0), set()),
        (0.0, 2.0, 0.5, 1.0, (1.0, 1.0), {"upper"}),
        (0.0, -2.0, 0.5, 1.0, (-1.0, -1.0), {"lower"}),
        (0.0, -0.8, 0.5, 2.0, (-1.0, -1.0), {"lower"}),  # backwards half as strong
        (0.0, -0.25, 0.5, 2.0, (-0.5, -0.5), set()),
        (0.0, -0.5, 0.5, 0.5, (-0.5, -0.5), set()),  # an asymmetry below 1 is 1
        (-0.6, 0.8, 0.5, 1.0, (1.0 / 7.0, 1.0), {"left", "upper"}),
        (0.6, -0.8, 0.5, 1.0, (-1.0 / 7.0, -1.0), {"right", "lower"}),
        (0.6, -0.8, 1.0, 1.0, (0.2, -1.0), {"lower"}),  # steering is kept
        (0.6, -0.8, 0.0, 1.0, (-0.6, -1.0), {"right"}),  # throttle is kept
        (0.6, 0.8, 0.0, 1.0, (1.0, 0.6), {"right"}),
        (0.6, 0.8, 2.0, 1.0, (1.0, -0.2), {"upper"}),  # MOT_STR_THR_MIX is within 0 .. 1
        (0.6, 0.8, -1.0, 1.0, (1.0, 0.6), {"right"}),
    ),
)
def test_left_and_right_of_a_skid_steered_rover(
    steering_asked: float, throttle: float, mix: float, asymmetry: float, sides: tuple[float, float], flags: set[str]
) -> None:
    m = MotorsState()
    assert tuple(mixer.mix_skid(m, steering_asked, throttle, mix, asymmetry)) == pytest.approx(sides)
    assert said(m) == flags


@pytest.mark.parametrize(("throttle", "room"), ((0.25, 0.75), (0.0, 0.5), (-0.25, 0.5), (0.9, 0.75)))
def test_weak_reverse_leaves_most_room_for_steering_at_a_quarter_of_throttle(throttle: float, room: float) -> None:
    """Twice as weak backwards: the motors have -0.5 .. 1, the middle is 0.25."""
    for way, flag in ((1.0, "right"), (-1.0, "left")):
        m = MotorsState()
        mixer.mix_skid(m, way, throttle, 1.0, 2.0)
        assert flag in said(m)
        m = MotorsState()
        mixer.mix_skid(m, way * (room - 1e-6), 0.25 if throttle == 0.9 else throttle, 1.0, 2.0)
        assert flag not in said(m)


@pytest.mark.parametrize(
    ("throttle", "least", "expo", "out"),
    (
        (0.5, 0.0, 0.0, 0.5),
        (0.5, 0.2, 0.0, 0.6),
        (-0.5, 0.2, 0.0, -0.6),
        (0.25, 0.0, 1.0, 0.5),
        (0.25, 0.0, 2.0, 0.25),  # no such curve
        (0.25, 0.0, -2.0, 0.25),
        (1.5, 0.0, 0.5, 1.0),
        (1.0, 0.0, -1.0, 1.0),
        (0.75, 0.0, -1.0, 0.5),  # 2 x 0.5 - 0.25
    ),
)
def test_the_curve_of_the_throttle(throttle: float, least: float, expo: float, out: float) -> None:
    assert mixer.thrust_curve(throttle, least, expo) == pytest.approx(out)


@pytest.mark.parametrize(("percent", "limit"), ((100.0, 1.0), (60.0, 0.6), (0.0, 0.05), (150.0, 1.0)))
def test_the_throttle_limit_is_between_five_percent_and_all(percent: float, limit: float) -> None:
    p = Motors()
    p.THR_MAX = percent
    assert motors.throttle_max(p) == pytest.approx(limit)
    m = MotorsState()
    for asked in (9.0, -9.0):
        motors.set_throttle(m, True, asked, p)
        assert m.throttle == pytest.approx(math.copysign(limit, asked))
    motors.set_throttle(m, False, 0.0, p)
    assert m.throttle != 0.0, "disarmed demands are not taken"


@pytest.mark.parametrize(
    ("percent", "most", "least"), ((10.0, 100.0, 0.1), (-5.0, 100.0, 0.0), (50.0, 100.0, 0.2), (50.0, 10.0, 0.1))
)
def test_the_least_throttle_is_a_fifth_at_most(percent: float, most: float, least: float) -> None:
    p = Motors()
    p.THR_MIN, p.THR_MAX = percent, most
    assert motors.throttle_min(p) == pytest.approx(least)


@pytest.mark.parametrize(
    ("armed", "steering_out", "throttle", "flags"),
    (
        (True, 0.0, 0.0, set()),
        (False, 0.0, 0.0, {"left", "right", "lower", "upper"}),
        (True, -1.0, 0.0, {"left"}),
        (True, 1.0, 0.0, {"right"}),
        (True, 0.99, 0.0, set()),
        (True, 0.0, 0.6, {"upper"}),
        (True, 0.0, -0.6, {"lower"}),
        (True, 0.0, 0.59, set()),
    ),
)
def test_demands_at_their_ends_are_said(armed: bool, steering_out: float, throttle: float, flags: set[str]) -> None:
    m = MotorsState()
    motors.flag_limits(m, armed, steering_out, throttle, 0.6)
    assert said(m) == flags


@pytest.mark.parametrize(
    ("asked", "last", "out", "flags"),
    ((0.5, 0.0, 0.02, {"upper"}), (-0.5, 0.0, -0.02, {"lower"}), (0.01, 0.0, 0.01, set()), (0.3, 0.3, 0.3, set())),
)
def test_a_slew_rate_holds_the_throttle_back_and_says_so(
    asked: float, last: float, out: float, flags: set[str]
) -> None:
    m = MotorsState()
    m.throttle, m.throttle_last = asked, last
    motors.slew_throttle(m, 100.0)
    assert m.throttle == m.throttle_last == pytest.approx(out) and said(m) == flags
    m.throttle = 0.9
    motors.slew_throttle(m, 0.0)
    assert m.throttle == 0.9


@pytest.mark.parametrize(("ticks", "out"), ((4, 0.0), (5, -0.5), (99, -0.5)))
def test_a_motor_pauses_before_it_turns_round(ticks: int, out: float) -> None:
    m = MotorsState()
    assert motors.delay_reversal(m, 1, 0.5, 100, 0.1) == 0.5
    assert motors.delay_reversal(m, 1, 0.0, 101, 0.1) == 0.0
    assert motors.delay_reversal(m, 2, -0.5, 101, 0.1) == -0.5, "the other motor does not"
    assert motors.delay_reversal(m, 1, -0.5, 100 + ticks, 0.1) == out
    assert motors.delay_reversal(m, 1, 0.3, 100 + ticks, 0.0) == 0.3


@pytest.mark.parametrize(
    ("at", "base", "wanted", "learns"),
    (
        (4.0, 1.0, 0.1, True),
        (1.0, 1.0, 0.4, False),
        (-4.0, 1.0, -0.1, True),
        (4.0, 0.0, 0.4, False),
        (0.0, 1.0, 0.4, False),
    ),
)
def test_steering_shrinks_above_its_base_speed(at: float, base: float, wanted: float, learns: bool) -> None:
    m = MotorsState()
    m.steering = 0.4
    assert motors.scaled_steering(m, at, base) == pytest.approx(wanted)
    assert said(m) == (set() if learns else {"left", "right"})


@pytest.mark.parametrize(
    ("known", "scaled", "throttle", "armed", "out"),
    (
        (1, True, 0.1, True, 0.1),
        (0, True, 0.1, True, 0.4),  # without a speed it is not shrunk
        (1, False, 0.1, True, 0.4),
        (1, False, -0.1, True, -0.4),
        (1, False, 0.0, True, 0.4),
        (1, False, -0.1, False, 0.4),
        (1, True, 0.1, False, 0.4),
    ),
)
def test_the_steering_of_a_car(known: int, scaled: bool, throttle: float, armed: bool, out: float) -> None:
    control, p = Control(), Motors()
    p.SPD_SCA_BASE, p.THR_MAX = 1.0, 100.0
    m = control.motors
    control.speed.forward, control.speed.forward_ok = 4.0, known
    m.steering, m.throttle, m.scale_steering = 0.4, throttle, scaled
    m.out_left = m.out_right = 0.7
    motors.drive_car(control, armed, p)
    assert m.out_steering == pytest.approx(out)
    assert (m.out_left, m.out_right) == (0.0, 0.0)
    assert m.out_throttle == pytest.approx(throttle if armed else 0.0)


@pytest.mark.parametrize(
    ("motor", "outs"),
    (
        (TEST_THROTTLE, (0.6, 0.0, 0.0, 0.0)),
        (TEST_STEERING, (0.0, 0.5, 0.0, 0.0)),
        (TEST_LEFT, (0.0, 0.0, 0.6, 0.0)),
        (TEST_RIGHT, (0.0, 0.0, 0.0, 0.6)),
    ),
)
def test_each_motor_of_a_test_alone_begins_at_the_least_throttle(motor: int, outs: tuple[float, ...]) -> None:
    m, p = MotorsState(), Motors()
    p.THR_MIN, p.THR_MAX = 20.0, 100.0
    m.test_motor, m.test_value = motor, 0.5
    motors.run_motor_test(m, p)
    assert (m.out_throttle, m.out_steering, m.out_left, m.out_right) == pytest.approx(outs)
    m.test_value = 7.0
    motors.run_motor_test(m, p)
    assert max(m.out_throttle, m.out_steering, m.out_left, m.out_right) == 1.0


@pytest.mark.parametrize(
    ("armed", "throttle", "turning", "skid", "moves"),
    ((1, 0.1, 0.0, 0, 1), (1, 0.0, 0.5, 0, 0), (1, 0.0, 0.5, 1, 1), (0, 0.1, 0.5, 1, 0), (1, 0.0, 0.0, 1, 0)),
)
def test_it_moves_with_throttle_and_a_skid_steered_one_with_steering(
    armed: int, throttle: float, turning: float, skid: int, moves: int
) -> None:
    functions = {"SERVO1_FUNCTION": 73.0, "SERVO3_FUNCTION": 74.0} if skid else {}
    v = make_vehicle(**functions)
    m = v.autopilot.control.motors
    m.throttle, m.steering = throttle, turning
    assert bool(motors.is_moving(m, bool(armed), v.autopilot.params)) == bool(moves)


@pytest.mark.parametrize(("first", "third", "skid"), ((73.0, 74.0, True), (73.0, 70.0, False), (26.0, 74.0, False)))
def test_a_skid_steered_rover_has_a_left_and_a_right_motor(first: float, third: float, skid: bool) -> None:
    v = make_vehicle(SERVO1_FUNCTION=first, SERVO3_FUNCTION=third)
    assert bool(motors.is_skid(v.autopilot.params)) == skid


@pytest.mark.parametrize(("output", "number"), ((0, 26), (2, 70), (3, 0), (-1, 0), (4, 0)))
def test_outputs_that_there_are_not_have_no_function(output: int, number: int) -> None:
    assert servos.function_of(make_vehicle().autopilot.params, output) == number


@pytest.mark.parametrize(
    ("width", "control"), ((0, 0.0), (1500, 0.0), (1000, -1.0), (2000, 1.0), (1750, 0.5), (900, -1.0), (2200, 1.0))
)
def test_a_control_is_its_pulse_around_1500(width: int, control: float) -> None:
    v = make_vehicle()
    assert servos.set_servo(v.autopilot.params, v.actuators, 15, width)
    assert (v.actuators.pwm[15], v.actuators.controls[15]) == (width, pytest.approx(control))
    assert not servos.set_servo(v.autopilot.params, v.actuators, -1, width)
    assert not servos.set_servo(v.autopilot.params, v.actuators, 16, width)


@pytest.mark.parametrize(("function", "channel"), ((1, 2), (51, 0), (66, 15), (50, -1), (67, -1), (26, -1), (0, -1)))
def test_an_output_may_pass_a_channel_of_the_receiver_on(function: int, channel: int) -> None:
    assert servos.receiver_channel(2, function) == channel


@pytest.mark.parametrize(
    ("function", "silent", "pulse"),
    ((70, False, 1700), (70, True, 0), (73, True, 0), (74, True, 0), (26, True, 1700), (99, False, 0)),
)
def test_silent_motors_get_no_pulse_but_wheels_steer(function: int, silent: bool, pulse: int) -> None:
    v = make_vehicle()
    m = v.autopilot.control.motors
    m.out_throttle = m.out_steering = m.out_left = m.out_right = 0.5
    assert servos.function_pulse(m, function, silent, v.autopilot.params.SERVO[0]) == pulse


@pytest.mark.parametrize(
    ("motor", "function"), ((TEST_THROTTLE, 70), (TEST_STEERING, 26), (TEST_LEFT, 73), (TEST_RIGHT, 74))
)
def test_a_pulse_of_the_motor_test_goes_to_its_motor_only(motor: int, function: int) -> None:
    v = make_vehicle()
    m = v.autopilot.control.motors
    m.test_motor, m.test_pulse = motor, 1234
    got = {f: servos.function_pulse(m, f, True, v.autopilot.params.SERVO[0]) for f in (26, 70, 73, 74)}
    assert [f for f, width in got.items() if width == 1234] == [function]


def atc(**values: float) -> Attitude:
    p = Attitude()
    for name, value in values.items():
        p[name] = value
    return p


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


def shaped(**values: Any) -> PositionState:
    c = PositionState()
    position.set_limits(c, 3.0, 1.0, 2.0, 1.0)
    for name, value in values.items():
        setattr(c, name, value)
    return c


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
