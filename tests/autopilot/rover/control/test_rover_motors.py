# SPDX-License-Identifier: BSD-3-Clause
"""Motors: outputs and pulses, slew and limit flags, steering's mirror, skid mixing, disarmed and tested motors."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.rover.control import mixer, motors, servos
from sitl.autopilot.rover.control.state import DT, TEST_STEERING, TEST_THROTTLE, Control, MotorsState
from sitl.autopilot.rover.parameters.control import Motors
from tests.autopilot.rover.control.rover_car import arm, finish, make_vehicle, set_motion

SKID = {"SERVO1_FUNCTION": 73.0, "SERVO3_FUNCTION": 74.0}
unit = st.floats(-1.0, 1.0)


def pulses(v):
    return tuple(int(p) for p in v.actuators.pwm[:4])


def demand(v, steering, throttle, periods=1, scaled=True):
    ap = v.autopilot
    m = ap.control.motors
    for _ in range(periods):
        if scaled:
            motors.set_steering(m, steering)
        else:
            motors.set_steering_unscaled(m, steering)
        motors.set_throttle(m, ap.arming.armed, throttle, ap.params.MOT)
        finish(v)


def test_car_outputs():
    v = arm(make_vehicle(MOT_SLEWRATE=0.0))
    demand(v, 0.5, -0.25)
    assert pulses(v) == (1700, 0, 1400, 0)
    assert v.actuators.controls[0] == pytest.approx(0.4)
    assert v.actuators.controls[2] == pytest.approx(-0.2)
    assert v.actuators.armed == 1


def test_pulse_is_cut_towards_trim_and_reversible():
    v = make_vehicle(SERVO1_TRIM=1510.0, SERVO1_MIN=1000.0, SERVO1_MAX=2000.0)
    assert servos.pulse(v.autopilot.params.SERVO[0], 0.4999) == 1510 + 244
    assert servos.pulse(v.autopilot.params.SERVO[0], -0.4999) == 1510 - 254
    v.autopilot.params.SERVO1_REVERSED = 1.0
    assert servos.pulse(v.autopilot.params.SERVO[0], 2.0) == 1000
    assert servos.pulse(v.autopilot.params.SERVO[0], math.nan) == 1510


def test_throttle_slews_and_says_so():
    v = arm(make_vehicle())
    demand(v, 0.0, 0.5)
    assert v.autopilot.control.motors.throttle == pytest.approx(0.02)
    assert v.autopilot.control.motors.limit_upper == 1
    demand(v, 0.0, 0.5, 30)
    assert v.autopilot.control.motors.throttle == pytest.approx(0.5)
    assert v.autopilot.control.motors.limit_upper == 0
    demand(v, 0.0, -0.5)
    assert v.autopilot.control.motors.limit_lower == 1


def test_throttle_limit():
    v = arm(make_vehicle(MOT_THR_MAX=60.0, MOT_SLEWRATE=0.0))
    demand(v, 0.0, 1.0)
    assert v.autopilot.control.motors.out_throttle == pytest.approx(0.6)
    assert v.autopilot.control.motors.limit_upper == 1


@pytest.mark.parametrize(("speed", "out", "limited"), [(0.5, 0.4, 1), (2.0, 0.2, 0), (-0.5, -0.4, 1), (-4.0, -0.1, 0)])
def test_steering_shrinks_with_speed_and_is_mirrored_backwards(speed, out, limited):
    v = arm(make_vehicle())
    set_motion(v, 0.0, speed, 0.0)
    demand(v, 0.4, 0.0)
    assert v.autopilot.control.motors.out_steering == pytest.approx(out)
    assert v.autopilot.control.motors.limit_left == limited
    assert v.autopilot.control.motors.limit_right == limited


def test_unscaled_steering_is_mirrored_by_throttle():
    v = arm(make_vehicle(MOT_SLEWRATE=0.0))
    set_motion(v, 0.0, 4.0, 0.0)
    demand(v, 0.4, 0.1, scaled=False)
    assert v.autopilot.control.motors.out_steering == pytest.approx(0.4)
    demand(v, 0.4, -0.1, scaled=False)
    assert v.autopilot.control.motors.out_steering == pytest.approx(-0.4)


@pytest.mark.parametrize(("safe", "throttle_pulse"), [(0.0, 1500), (1.0, 0)])
def test_disarmed_wheels_steer_but_do_not_drive(safe, throttle_pulse):
    v = make_vehicle(MOT_SAFE_DISARM=safe)
    demand(v, 0.5, 1.0)
    assert pulses(v) == (1700, 0, throttle_pulse, 0)
    assert v.actuators.armed == 0
    m = v.autopilot.control.motors
    assert (m.limit_left, m.limit_right, m.limit_lower, m.limit_upper) == (1, 1, 1, 1)
    assert not motors.is_moving(m, False, v.autopilot.params)


def test_skid_outputs():
    v = arm(make_vehicle(MOT_SLEWRATE=0.0, **SKID))
    assert motors.is_skid(v.autopilot.params)
    demand(v, 0.25, 0.5)
    assert pulses(v) == (1800, 0, 1600, 0)
    demand(v, 0.5, 0.0)
    assert pulses(v) == (1700, 0, 1300, 0)
    v.autopilot.arming.armed = 0
    demand(v, 0.5, 0.0)
    assert pulses(v) == (1500, 0, 1500, 0)


@pytest.mark.parametrize(
    ("mix", "right", "steering_cut"),
    [(0.5, 1.0 / 7.0, 1), (1.0, -0.2, 0), (0.2, 0.4171428571, 1)],
)
def test_sharing_of_what_the_motors_have(mix, right, steering_cut):
    m = MotorsState()
    assert mixer.mix_skid(m, 0.6, 0.8, mix, 1.0) == pytest.approx((1.0, right))
    assert (m.limit_left, m.limit_right, m.limit_lower, m.limit_upper) == (0, steering_cut, 0, 1)


def test_weak_backwards_thrust_is_made_up_for():
    assert mixer.mix_skid(MotorsState(), 0.4, 0.0, 0.5, 2.0) == pytest.approx((0.4, -0.8))
    m = MotorsState()
    assert mixer.mix_skid(m, 1.0, 0.0, 0.5, 2.0) == pytest.approx((0.5, -1.0))
    assert m.limit_right == 1


@given(unit, unit, st.floats(0.2, 1.0), st.floats(1.0, 4.0))
def test_skid_mixer_stays_in_range_and_turns_the_right_way(steering, throttle, mix, asymmetry):
    m = MotorsState()
    left, right = mixer.mix_skid(m, steering, throttle, mix, asymmetry)
    assert -1.0 - 1e-9 <= left <= 1.0 + 1e-9
    assert -1.0 - 1e-9 <= right <= 1.0 + 1e-9
    assert (left - right) * steering >= -1e-9
    if m.limit_left + m.limit_right + m.limit_lower + m.limit_upper == 0:
        even_left = left / asymmetry if left < 0.0 else left
        even_right = right / asymmetry if right < 0.0 else right
        assert even_left + even_right == pytest.approx(2.0 * throttle, abs=1e-9)
        assert even_left - even_right == pytest.approx(2.0 * steering, abs=1e-9)


@given(st.floats(0.01, 1.0), st.floats(0.0, 0.2), st.floats(-1.0, 1.0))
def test_thrust_curve_is_odd_and_keeps_its_ends(throttle, least, expo):
    out = mixer.thrust_curve(throttle, least, expo)
    assert 0.0 < out <= 1.0 + 1e-9
    assert mixer.thrust_curve(-throttle, least, expo) == -out
    assert mixer.thrust_curve(1.0, least, expo) == pytest.approx(1.0)
    assert mixer.thrust_curve(0.0, least, expo) == 0.0


def test_thrust_curve_undoes_a_quadratic():
    assert mixer.thrust_curve(0.25, 0.0, 1.0) == pytest.approx(0.5)
    assert mixer.thrust_curve(0.5, 0.1, 0.0) == pytest.approx(0.55)


def test_pause_at_a_change_of_direction():
    v = arm(make_vehicle(MOT_REV_DELAY=0.1, MOT_SLEWRATE=0.0))
    demand(v, 0.0, 0.5)
    outputs = []
    for _ in range(6):
        demand(v, 0.0, -0.5)
        outputs.append(float(v.autopilot.control.motors.out_throttle))
    assert outputs == [0.0] * 4 + [-0.5, -0.5]


def set_servo(v, output, width):
    return servos.set_servo(v.autopilot.params, v.actuators, output, width)


def test_free_outputs_belong_to_do_set_servo():
    v = arm(make_vehicle())
    assert set_servo(v, 1, 1234)
    assert set_servo(v, 8, 1800)
    assert not set_servo(v, 2, 1900)
    assert not set_servo(v, 16, 1900)
    finish(v)
    assert pulses(v) == (1500, 1234, 1500, 0)
    v.autopilot.params.SERVO3_FUNCTION = 0.0
    finish(v)
    assert pulses(v)[2] == 0
    assert set_servo(v, 2, 1900)
    finish(v)
    assert pulses(v)[2] == 1900, "it falls silent once"


def test_receiver_through():
    v = arm(make_vehicle(SERVO2_FUNCTION=1.0, SERVO4_FUNCTION=57.0))
    v.autopilot.rc.channels[1] = 1111
    v.autopilot.rc.channels[6] = 1777
    finish(v)
    assert pulses(v) == (1500, 1111, 1500, 1777)


def test_motor_test_drives_one_motor_alone():
    v = arm(make_vehicle())
    m = v.autopilot.control.motors
    demand(v, 0.5, 0.5)
    m.test_motor, m.test_value = TEST_THROTTLE, 0.3
    finish(v)
    assert pulses(v) == (1500, 0, 1620, 0)
    m.test_pulse = 1555
    finish(v)
    assert pulses(v) == (1500, 0, 1555, 0)
    m.test_motor, m.test_value, m.test_pulse = TEST_STEERING, -1.0, 0
    finish(v)
    assert pulses(v) == (1100, 0, 1500, 0)


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_bad_demands_are_none(bad):
    v = arm(make_vehicle(MOT_SLEWRATE=0.0))
    demand(v, bad, bad)
    assert pulses(v) == (1500, 0, 1500, 0)


@given(unit, unit, st.one_of(st.just(0.0), st.floats(0.1, 1000.0)))
def test_slew_limit_approaches_the_demand(throttle, last, rate):
    out = motors.slew_limited(throttle, last, rate)
    assert min(throttle, last) <= out <= max(throttle, last)
    if rate > 0.0:
        assert abs(out - last) <= rate * 0.01 * DT + 1e-12


def test_outputs_on_their_records_alone():
    control, mot = Control(), Motors()
    mot.THR_MAX, mot.SPD_SCA_BASE = 100.0, 1.0
    m = control.motors
    m.steering, m.throttle, m.scale_steering = 0.8, 0.3, True
    control.speed.forward_ok, control.speed.forward = True, 4.0
    motors.drive_car(control, True, mot)
    assert (m.out_steering, m.out_throttle) == pytest.approx((0.2, 0.3))
    mot.STR_THR_MIX, mot.THST_ASYM = 0.5, 1.0
    m.steering = 0.1
    motors.drive_skid(control, True, mot)
    assert (m.out_left, m.out_right) == pytest.approx((0.4, 0.2))
    m.test_motor, m.test_value = TEST_THROTTLE, 0.5
    motors.run_motor_test(m, mot)
    assert (m.out_steering, m.out_throttle, m.out_left, m.out_right) == (0.0, 0.5, 0.0, 0.0)
