# SPDX-License-Identifier: BSD-3-Clause
"""A rover's motors and outputs at their limits: which demand gives way, what says so, pulses, the motor test."""

from __future__ import annotations

import math

import pytest

from sitl.autopilot.rover.control import control_step, mixer, motors, servos
from sitl.autopilot.rover.control.state import TEST_LEFT, TEST_RIGHT, TEST_STEERING, TEST_THROTTLE, Control, MotorsState
from sitl.autopilot.rover.parameters.control import Motors
from tests.autopilot.rover.control.rover_car import arm, finish, make_vehicle


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
    ("motor", "function"), ((TEST_THROTTLE, 70), (TEST_STEERING, 26), (TEST_LEFT, 73), (TEST_RIGHT, 74))
)
def test_a_pulse_of_the_motor_test_goes_to_its_motor_only(motor: int, function: int) -> None:
    v = make_vehicle()
    m = v.autopilot.control.motors
    m.test_motor, m.test_pulse = motor, 1234
    got = {f: servos.function_pulse(m, f, True, v.autopilot.params.SERVO[0]) for f in (26, 70, 73, 74)}
    assert [f for f, width in got.items() if width == 1234] == [function]


@pytest.mark.parametrize(
    ("function", "silent", "pulse"),
    ((70, False, 1700), (70, True, 0), (73, True, 0), (74, True, 0), (26, True, 1700), (99, False, 0)),
)
def test_silent_motors_get_no_pulse_but_wheels_steer(function: int, silent: bool, pulse: int) -> None:
    v = make_vehicle()
    m = v.autopilot.control.motors
    m.out_throttle = m.out_steering = m.out_left = m.out_right = 0.5
    assert servos.function_pulse(m, function, silent, v.autopilot.params.SERVO[0]) == pulse


@pytest.mark.parametrize(("before", "kept"), ((0.0, 2.0), (-1.0, 2.0), (0.5, 0.5)))
def test_position_control_starts_with_the_limits_of_cruising_unless_it_has_some(before: float, kept: float) -> None:
    v = make_vehicle(CRUISE_SPEED=2.0, ATC_DECEL_MAX=1.5, ATC_TURN_MAX_G=0.3)
    c = v.autopilot.control.position
    c.speed_max, c.accel_max, c.jerk_max = before, 9.0, 9.0
    control_step.init(v.autopilot.control, v.autopilot.params)
    assert c.speed_max == kept
    own = before <= 0.0
    assert (c.accel_max, c.jerk_max) == ((1.5, 1.5) if own else (9.0, 9.0))
    if own:
        assert c.lat_accel_max == pytest.approx(0.3 * 9.80665)


@pytest.mark.parametrize(("stop", "throttle"), ((0, 0.5), (1, 0.0)))
def test_an_emergency_stop_is_as_disarmed(stop: int, throttle: float) -> None:
    v = arm(make_vehicle(MOT_SLEWRATE=0.0))
    v.autopilot.arming.emergency_stop = stop
    motors.set_throttle(v.autopilot.control.motors, True, 0.5, v.autopilot.params.MOT)
    tick = int(v.autopilot.control.tick)
    finish(v)
    assert v.autopilot.control.motors.out_throttle == throttle and v.actuators.armed == 1 - stop
    assert v.autopilot.control.tick == tick + 1
