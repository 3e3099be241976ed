# SPDX-License-Identifier: BSD-3-Clause
"""Motors: spool states, thrust curve, pulses, hover throttle, throttle priorities."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.copter.control import motors, throttle_mix, thrust_curve
from sitl.autopilot.copter.control.control_step import drive
from sitl.autopilot.copter.control.spool import DesiredSpoolState, SpoolState
from sitl.autopilot.copter.control.state import DT, MotorsState
from sitl.autopilot.copter.parameters.control import Motors
from tests.autopilot.copter.control.level_autopilot import arm, output


def run_until(ap, actuators, state, most=2000):
    """Ticks until the spool is in ``state``."""
    for k in range(most):
        if ap.control.motors.spool_state == state:
            return k
        output(ap, actuators)
    raise AssertionError(f"spool state {state} not reached, it is {ap.control.motors.spool_state}")


def test_disarmed_motors_get_the_shortest_pulse(ap, actuators):
    ap.control.motors.desired_spool = 2
    throttle_mix.set_throttle_out(ap.control, ap.params, 0.5, True, 0.0)
    output(ap, actuators)
    assert list(actuators.pwm[:4]) == [1000] * 4
    assert not any(actuators.controls)
    assert actuators.armed == 0


def test_spool_up_takes_spool_time_to_idle_and_follows_the_throttle(ap, actuators):
    ap.arming.armed = 1
    ap.arming.armed_us = -3_000_000
    ap.control.motors.desired_spool = DesiredSpoolState.THROTTLE_UNLIMITED
    ticks = run_until(ap, actuators, SpoolState.SPOOLING_UP)
    assert ticks * DT == pytest.approx(0.5, abs=0.01)
    assert actuators.pwm[0] == pytest.approx(1150, abs=1)
    throttle_mix.set_throttle_out(ap.control, ap.params, 0.4, True, 0.0)
    ticks = run_until(ap, actuators, SpoolState.THROTTLE_UNLIMITED)
    assert ticks * DT == pytest.approx(0.4 * 0.5, abs=0.01)
    ap.control.motors.desired_spool = DesiredSpoolState.SHUT_DOWN
    assert run_until(ap, actuators, SpoolState.GROUND_IDLE) * DT == pytest.approx(0.5, abs=0.01)
    assert run_until(ap, actuators, SpoolState.SHUT_DOWN) * DT == pytest.approx(0.5, abs=0.01)


def test_armed_motors_idle_at_spin_arm_after_the_arming_delay(ap, actuators):
    ap.arming.armed = 1
    for time_us in range(0, 4_000_000, 2500):
        ap.control.motors.desired_spool = DesiredSpoolState.GROUND_IDLE
        drive(ap, actuators, time_us)
        if time_us == 1_990_000:
            assert actuators.pwm[0] == 1000
    assert actuators.pwm[0] == pytest.approx(1100, abs=1)


def test_disarming_stops_at_once(ap, actuators):
    arm(ap)
    output(ap, actuators)
    assert actuators.pwm[0] > 1300
    ap.arming.armed = 0
    output(ap, actuators)
    assert list(actuators.pwm[:4]) == [1000] * 4


@given(st.floats(0.0, 1.0), st.floats(-1.0, 1.0))
def test_thrust_curve_inverts_the_motor(thrust, expo):
    command = thrust_curve.command_from_thrust(thrust, expo, 1.0, 1.0)
    assert 0.0 <= command <= 1.0
    if expo > -0.99:
        assert (1 - expo) * command + expo * command * command == pytest.approx(thrust, abs=1e-6)


def test_thrust_stays_as_the_battery_empties(ap):
    ap.params.MOT_BAT_VOLT_MAX, ap.params.MOT_BAT_VOLT_MIN = 12.8, 9.6
    ap.battery.voltage = 11.0
    for _ in range(100):
        thrust_curve.compensate(ap.control.motors, ap.battery, ap.estimate, ap.params.MOT)
    m = ap.control.motors
    demand = 0.3
    command = thrust_curve.command_from_thrust(
        demand * float(m.compensation_gain), 0.65, float(m.lift_max), float(m.voltage_ratio)
    )
    effective = command * 11.0 / 12.8
    assert 0.35 * effective + 0.65 * effective**2 == pytest.approx(demand, rel=1e-3)


def test_compensation_is_off_by_default(ap):
    ap.battery.voltage = 11.0
    thrust_curve.compensate(ap.control.motors, ap.battery, ap.estimate, ap.params.MOT)
    assert ap.control.motors.compensation_gain == 1.0


@pytest.mark.parametrize(("mix", "after"), [(0.3004, 0.3), (0.5, 0.5 - 0.5 * 0.0025), (0.2, 0.2 + 2.0 * 0.0025)])
def test_the_priority_of_attitude_falls_and_rises_no_further_than_its_goal(ap, mix, after):
    attitude, m = ap.control.attitude, ap.control.motors
    attitude.mix, attitude.mix_desired = mix, 0.3
    m.throttle, m.throttle_out = 0.3, 0.5
    throttle_mix.follow_mix(attitude, m, 0.4)
    assert attitude.mix == pytest.approx(after, abs=1e-12)


def test_resistance_is_learnt_from_steps_of_current():
    m = MotorsState()
    voltage = 0.0
    for k in range(400):
        current = 10.0 + 10.0 * (k // 20 % 2)
        voltage = thrust_curve.resting_voltage(m, 12.6 - 0.02 * current, current)
    assert m.resistance == pytest.approx(0.02, rel=0.1)
    assert voltage == pytest.approx(12.6, abs=0.05)


def test_resistance_is_no_more_than_what_the_drop_since_the_highest_voltage_explains():
    m = MotorsState()
    m.voltage_reference, m.current_reference, m.current_max, m.resistance = 12.6, 1.0, 11.0, 1.0
    m.voltage_slow, m.current_slow = 12.0, 10.0  # the same voltage at more current: no resistance
    assert thrust_curve.resting_voltage(m, 12.0, 11.0) == pytest.approx(12.0 + 11.0 * 0.06)
    assert m.resistance == pytest.approx(0.6 / 10.0)


def test_air_is_thinner_up_high():
    assert thrust_curve.air_density_ratio(0.0) == 1.0
    assert thrust_curve.air_density_ratio(5000.0) == pytest.approx(0.601, abs=0.002)


def test_hover_throttle_is_learnt(ap):
    ap.control.motors.throttle = 0.5
    for _ in range(5000):
        motors.learn_hover_throttle(ap.params.MOT, ap.control.motors.throttle, 0.01)
    assert motors.hover_throttle(ap.params.MOT) == pytest.approx(0.5, abs=2e-3)
    ap.params.MOT_HOVER_LEARN = 0.0
    ap.control.motors.throttle = 0.2
    motors.learn_hover_throttle(ap.params.MOT, ap.control.motors.throttle, 0.01)
    assert motors.hover_throttle(ap.params.MOT) == pytest.approx(0.5, abs=2e-3)


def test_angle_boost_keeps_the_lift(ap):
    ap.control.attitude.cos_lean = math.cos(0.5)
    throttle_mix.set_throttle_out(ap.control, ap.params, 0.3, True, 0.0)
    assert ap.control.motors.throttle_in * math.cos(0.5) == pytest.approx(0.3)
    throttle_mix.set_throttle_out(ap.control, ap.params, 0.3, False, 0.0)
    assert ap.control.motors.throttle_in == 0.3


def test_upside_down_throttle_is_cut(ap):
    ap.control.attitude.cos_lean = -0.5
    throttle_mix.set_throttle_out(ap.control, ap.params, 0.6, True, 0.0)
    assert ap.control.motors.throttle_in == 0.0


def test_priority_rises_quickly_and_falls_slowly(ap):
    throttle_mix.set_mix_max(ap.control.attitude, ap.params.ATC, 1.0)
    ticks = 0
    while ap.control.attitude.mix < 0.5:
        throttle_mix.follow_mix(ap.control.attitude, ap.control.motors, 0.35)
        ticks += 1
    assert ticks * DT == pytest.approx(0.2, abs=0.01)
    throttle_mix.set_mix_min(ap.control.attitude, ap.params.ATC)
    ap.control.motors.throttle_out = ap.control.motors.throttle = 0.35
    throttle_mix.follow_mix(ap.control.attitude, ap.control.motors, 0.35)
    assert ap.control.attitude.mix == pytest.approx(0.5 - 0.5 * DT)


def test_slew_limit():
    assert motors.slew(0.2, 1.0, 0.5, 0.0) == pytest.approx(0.2 + DT / 0.5)
    assert motors.slew(0.8, 0.0, 0.0, 0.25) == pytest.approx(0.8 - DT / 0.25)
    assert motors.slew(0.8, 0.0, 0.0, 0.0) == 0.0


@given(st.floats(0.0, 1.0), st.floats(0.1, 1.0))
def test_boosted_throttle_keeps_the_lift_at_any_lean(throttle, cos_lean):
    assert throttle_mix.boosted(throttle, cos_lean) * cos_lean == pytest.approx(throttle)


@given(st.floats(0.0, 1.0), st.floats(0.2, 0.6), st.floats(0.0, 1.0))
def test_throttle_for_attitude_lies_between_the_demand_and_hovering(throttle, hover, mix):
    top = throttle_mix.throttle_average_max(throttle, hover, mix)
    assert throttle <= top <= max(throttle, hover) + 1e-12


@pytest.mark.parametrize(("desired", "end"), [(0, 0), (1, 1), (2, 3)])
def test_the_spool_ends_where_it_is_told_to_and_stops_at_once_when_disabled(desired, end):
    m, p = MotorsState(), Motors()
    p.SPOOL_TIME, p.SPIN_MIN, p.SPIN_ARM = 0.5, 0.15, 0.1
    for _ in range(1000):
        m.desired_spool = desired
        motors.spool(m, True, p)
        assert 0.0 <= m.spin_up_ratio <= 1.0 and 0.0 <= m.thrust_max <= 1.0
    assert m.spool_state == end
    motors.spool(m, False, p)
    assert m.spool_state == SpoolState.SHUT_DOWN and m.thrust_max == 0.0 and m.limit_roll


def test_the_motor_under_test_turns_alone():
    m = MotorsState()
    m.count, m.test_motor, m.test_actuator = 6, 3, 0.4
    motors.drive_test_motor(m)
    assert list(m.actuator) == [0.0, 0.0, 0.4, 0.0, 0.0, 0.0, 0.0, 0.0]
