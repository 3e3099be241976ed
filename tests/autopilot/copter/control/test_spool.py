# SPDX-License-Identifier: BSD-3-Clause
"""Motors tick by tick: spool states, throttle filter, hover throttle, slew, outputs."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.copter.control import motors, rate
from sitl.autopilot.copter.control.frames import load_frame
from sitl.autopilot.copter.control.spool import SpoolState
from sitl.autopilot.copter.control.state import DT, MotorsState, RateState
from sitl.autopilot.copter.parameters.control import Attitude, Motors
from sitl.autopilot.state import Arming
from sitl.core.border import Actuators
from sitl.core.vectors import Vec3
from tests.autopilot.copter.control.level_autopilot import arm, make_actuators, output

DOWN, IDLE, UP, FREE, SINKING = 0, 1, 2, 3, 4
WANT_DOWN, WANT_IDLE, WANT_FREE = 0, 1, 2
LIMITS = ("limit_roll", "limit_pitch", "limit_yaw", "limit_throttle_lower", "limit_throttle_upper")


def mot(**changes: float) -> Motors:
    p = Motors()
    p.SPOOL_TIME, p.SPIN_MIN, p.SPIN_ARM, p.SPIN_MAX = 0.5, 0.2, 0.1, 0.9
    for name, value in changes.items():
        p[name] = value
    return p


def spooling(state: int, desired: int, ratio: float = 1.0, thrust: float = 1.0, **changes: float) -> MotorsState:
    m = MotorsState()
    m.spool_state, m.desired_spool, m.spin_up_ratio, m.thrust_max = state, desired, ratio, thrust
    motors.spool(m, True, mot(**changes))
    return m


def hexa(ap: Any) -> Any:
    """The same vehicle with six motors on other outputs; the last has none."""
    ap.params.FRAME.CLASS = 2.0
    load_frame(ap.control.motors, ap.params)
    ap.control.motors.output[:6] = (8, 1, 2, 3, 4, -1)
    arm(ap, 0.5)
    return ap.control.motors


@pytest.mark.parametrize(
    ("state", "desired", "ratio", "thrust", "after"),
    (
        (DOWN, WANT_DOWN, 0.0, 0.0, DOWN),
        (DOWN, WANT_IDLE, 0.0, 0.0, IDLE),
        (DOWN, WANT_FREE, 0.0, 0.0, IDLE),
        (IDLE, WANT_IDLE, 0.5, 0.0, IDLE),
        (IDLE, WANT_FREE, 0.9, 0.0, IDLE),
        (IDLE, WANT_FREE, 0.998, 0.0, UP),
        (IDLE, WANT_DOWN, 0.5, 0.0, IDLE),
        (IDLE, WANT_DOWN, 0.005, 0.0, DOWN),
        (UP, WANT_FREE, 1.0, 0.5, FREE),  # the throttle is at zero: at once
        (UP, WANT_IDLE, 1.0, 0.5, SINKING),
        (FREE, WANT_FREE, 1.0, 1.0, FREE),
        (FREE, WANT_IDLE, 1.0, 1.0, SINKING),
        (FREE, WANT_DOWN, 1.0, 1.0, SINKING),
        (SINKING, WANT_FREE, 1.0, 0.5, UP),
        (SINKING, WANT_IDLE, 1.0, 0.5, SINKING),
        (SINKING, WANT_IDLE, 1.0, 0.005, IDLE),
    ),
)
def test_one_tick_of_the_spool(state: int, desired: int, ratio: float, thrust: float, after: int) -> None:
    assert spooling(state, desired, ratio, thrust).spool_state == after


@pytest.mark.parametrize(
    ("state", "desired", "ratio", "thrust", "spool_time", "down_time", "wanted"),
    (
        (IDLE, WANT_FREE, 0.5, 0.0, 0.5, 0.0, (0.5 + DT / 0.5, 0.0)),
        (IDLE, WANT_FREE, 0.5, 0.0, 0.0, 0.0, (0.5 + DT / 0.05, 0.0)),  # no faster than in 50 ms
        (IDLE, WANT_DOWN, 0.5, 0.0, 0.5, 0.0, (0.5 - DT / 0.5, 0.0)),  # MOT_SPOOL_TIM_DN 0: as up
        (IDLE, WANT_DOWN, 0.5, 0.0, 0.5, 0.25, (0.5 - DT / 0.25, 0.0)),
        (IDLE, WANT_DOWN, 0.5, 0.0, 0.5, 0.01, (0.5 - DT / 0.05, 0.0)),
        (IDLE, WANT_IDLE, 0.9, 0.0, 0.5, 0.25, (0.9 - DT / 0.25, 0.0)),  # towards MOT_SPIN_ARM over MOT_SPIN_MIN
        (IDLE, WANT_IDLE, 0.1, 0.0, 0.5, 0.25, (0.1 + DT / 0.5, 0.0)),
        (IDLE, WANT_IDLE, 0.5, 0.0, 0.5, 0.25, (0.5, 0.0)),
        (SINKING, WANT_IDLE, 1.0, 0.5, 0.5, 0.25, (1.0, 0.5 - DT / 0.25)),
        (DOWN, WANT_DOWN, 0.7, 0.7, 0.5, 0.25, (0.0, 0.0)),
        (FREE, WANT_FREE, 0.7, 0.7, 0.5, 0.25, (1.0, 1.0)),
    ),
)
def test_spin_and_thrust_ramp_over_their_times(
    state: int,
    desired: int,
    ratio: float,
    thrust: float,
    spool_time: float,
    down_time: float,
    wanted: tuple[float, float],
) -> None:
    m = spooling(state, desired, ratio, thrust, SPOOL_TIME=spool_time, SPOOL_TIM_DN=down_time)
    assert (m.spin_up_ratio, m.thrust_max) == pytest.approx(wanted)


@pytest.mark.parametrize(("throttle", "thrust", "after"), ((0.5, 0.4, UP), (0.5, 0.496, FREE), (1.5, 0.996, FREE)))
def test_power_is_free_once_it_reaches_the_throttle(throttle: float, thrust: float, after: int) -> None:
    m = MotorsState()
    m.spool_state, m.desired_spool, m.throttle, m.thrust_max = UP, WANT_FREE, throttle, thrust
    motors.spool(m, True, mot())
    assert m.spool_state == after and m.thrust_max == pytest.approx(1.0 if after == FREE else thrust + DT / 0.5)


def test_a_failed_take_off_check_keeps_the_motors_idling() -> None:
    m = MotorsState()
    m.spool_state, m.desired_spool, m.spin_up_ratio, m.blocked = IDLE, WANT_FREE, 1.0, True
    motors.spool(m, True, mot())
    assert m.spool_state == IDLE
    m.blocked = False
    motors.spool(m, True, mot())
    assert m.spool_state == UP


def test_without_a_least_spin_idling_motors_stand() -> None:
    assert spooling(IDLE, WANT_IDLE, 0.0, SPIN_MIN=0.0).spin_up_ratio == 0.0


@pytest.mark.parametrize(
    ("state", "limited"), ((DOWN, True), (IDLE, True), (UP, False), (FREE, False), (SINKING, False))
)
def test_motors_that_stand_or_idle_obey_nothing(state: int, limited: bool) -> None:
    m = spooling(state, WANT_IDLE)
    assert [bool(getattr(m, name)) for name in LIMITS] == [limited] * 5


@pytest.mark.parametrize(("state", "kept"), ((DOWN, False), (IDLE, False), (UP, False), (FREE, True), (SINKING, False)))
def test_a_boost_needs_full_power(state: int, kept: bool) -> None:
    m = MotorsState()
    m.spool_state, m.desired_spool, m.boosting, m.boost_ratio, m.unbalanced = state, WANT_FREE, True, 0.5, True
    motors.spool(m, True, mot())
    assert bool(m.boosting) == kept
    if kept:
        assert m.boost_ratio == pytest.approx(0.5 + DT / 0.5)
        m.boosting = False
        motors.spool(m, True, mot(SPOOL_TIM_DN=0.25))
        assert m.boost_ratio == pytest.approx(0.5 + DT / 0.5 - DT / 0.25)


@pytest.mark.parametrize(
    ("armed", "stop", "used", "on", "may"),
    ((1, 0, 0, 0, True), (0, 0, 0, 0, False), (1, 1, 0, 0, False), (1, 0, 1, 0, False), (1, 0, 1, 1, True)),
)
def test_motors_turn_armed_and_where_no_switch_forbids_it(armed: int, stop: int, used: int, on: int, may: bool) -> None:
    state = Arming()
    state.armed, state.emergency_stop, state.interlock_used, state.interlock_on = armed, stop, used, on
    assert bool(motors.may_turn(state)) == may


@pytest.mark.parametrize(("since", "turns"), ((1_999_999, False), (2_000_000, True)))
def test_armed_motors_stand_for_two_seconds(ap: Any, since: int, turns: bool) -> None:
    ap.arming.armed, ap.arming.armed_us, ap.control.motors.desired_spool = 1, 5, WANT_IDLE
    motors.drive_motors(ap.control.motors, ap.arming, ap.params, 5 + since)
    assert (ap.control.motors.spool_state == IDLE) == turns


@pytest.mark.parametrize(("hz", "gain"), ((0.0, 1.0), (2.0, math.tau * 2.0 * DT / (1.0 + math.tau * 2.0 * DT))))
def test_the_throttle_is_filtered_and_stays_between_0_and_1(hz: float, gain: float) -> None:
    m = MotorsState()
    m.throttle, m.throttle_in, m.throttle_filter_hz = 0.2, 0.6, hz
    motors.filter_throttle(m, True)
    assert m.throttle == pytest.approx(0.2 + gain * 0.4)
    for asked, kept in ((5.0, 1.0), (-5.0, 0.0)):
        m.throttle_in, m.throttle_filter_hz = asked, 0.0
        motors.filter_throttle(m, True)
        assert m.throttle == kept
    m.throttle = 0.5
    motors.filter_throttle(m, False)
    assert m.throttle == 0.0


@pytest.mark.parametrize(("hover", "kept"), ((0.05, 0.125), (0.4, 0.4), (0.9, 0.6875)))
def test_a_hover_throttle_is_believed_within_bounds(hover: float, kept: float) -> None:
    assert motors.hover_throttle(mot(THST_HOVER=hover)) == pytest.approx(kept)


@pytest.mark.parametrize(
    ("learn", "throttle", "hover", "after"),
    (
        (2.0, 0.5, 0.4, 0.4 + 0.1 * 0.01 / 10.01),
        (1.0, 0.3, 0.4, 0.4 - 0.1 * 0.01 / 10.01),
        (0.0, 0.5, 0.4, 0.4),
        (2.0, 0.0, 0.4, 0.4),
        (2.0, 1.0, 0.6875, 0.6875),
        (2.0, 0.01, 0.125, 0.125),
    ),
)
def test_the_hover_throttle_is_learnt_with_ten_seconds(
    learn: float, throttle: float, hover: float, after: float
) -> None:
    p = mot(HOVER_LEARN=learn, THST_HOVER=hover)
    motors.learn_hover_throttle(p, throttle, 0.01)
    assert pytest.approx(after, abs=1e-7) == p.THST_HOVER


@pytest.mark.parametrize(
    ("state", "thrust", "wanted"),
    (
        (DOWN, 0.5, 0.0),
        (IDLE, 0.5, 0.5 * 0.2),  # of MOT_SPIN_MIN
        (FREE, 0.0, 0.2),
        (FREE, 0.5, 0.2 + 0.7 * 0.5),
        (FREE, 1.0, 0.9),
        (FREE, math.nan, 0.2),
        (UP, 0.5, 0.55),
        (SINKING, 0.5, 0.55),
    ),
)
def test_commands_lie_between_spin_min_and_spin_max(state: int, thrust: float, wanted: float) -> None:
    m = MotorsState()
    m.spool_state, m.spin_up_ratio, m.lift_max, m.voltage_ratio = state, 0.5, 1.0, 1.0
    m.actuator[0], m.actuator[1], m.thrust[0] = 0.3, 0.3, thrust
    motors.command_motors(m, 1, mot(THST_EXPO=0.0))
    assert m.actuator[0] == pytest.approx(wanted) and m.actuator[1] == 0.3


def test_commands_change_no_faster_than_the_slew_times() -> None:
    m = MotorsState()
    m.spool_state, m.lift_max, m.voltage_ratio = FREE, 1.0, 1.0
    m.actuator[0], m.thrust[0], m.actuator[1], m.thrust[1] = 0.3, 1.0, 0.8, 0.0
    motors.command_motors(m, 2, mot(SLEW_UP_TIME=0.5, SLEW_DN_TIME=0.25))
    assert (m.actuator[0], m.actuator[1]) == pytest.approx((0.3 + DT / 0.5, 0.8 - DT / 0.25))


def test_demands_are_raised_for_the_thrust_that_is_left() -> None:
    m = MotorsState()
    m.roll, m.pitch, m.yaw, m.throttle, m.throttle_avg_max, m.thrust_max = 0.1, -0.2, 0.3, 0.4, 0.5, 0.6
    m.compensation_gain = 1.25
    assert tuple(motors.compensated_demands(m)) == pytest.approx((0.125, -0.25, 0.375, 0.5, 0.625, 0.75))
    m.thrust_max = 0.9
    assert motors.compensated_demands(m).throttle_max == 1.0


@pytest.mark.parametrize(
    ("least", "most", "pulses"),
    ((1000, 2000, (1500, 1000)), (1100, 1900, (1500, 1100)), (2000, 1000, (1500, 1000)), (0, 0, (1500, 1000))),
)
def test_pulses_lie_between_pwm_min_and_pwm_max(least: int, most: int, pulses: tuple[int, int]) -> None:
    m, actuators = MotorsState(), Actuators()
    m.is_plain_quad, m.count = True, 4
    m.actuator[0] = 0.5
    motors.write_actuators(m, actuators, True, least, most)
    assert (actuators.pwm[0], actuators.pwm[1]) == pulses and actuators.armed
    assert actuators.controls[0] == pytest.approx(0.5)
    motors.write_actuators(m, actuators, False, least, most)
    assert actuators.controls[0] == 0.0 and not actuators.armed


@pytest.mark.parametrize(("pulse", "control"), ((900, 0.0), (1000, 0.0), (1250, 0.25), (2000, 1.0), (2100, 1.0)))
def test_a_control_is_its_pulse_between_1000_and_2000(pulse: int, control: float) -> None:
    actuators = Actuators()
    motors.write_output(actuators, 3, pulse, True)
    assert (actuators.pwm[3], actuators.controls[3]) == (pulse, pytest.approx(control))


def test_motors_write_the_outputs_that_they_have(ap: Any) -> None:
    m, actuators = hexa(ap), make_actuators()
    ap.control.motors.throttle_in = 0.5
    output(ap, actuators)
    assert actuators.pwm[8] == actuators.pwm[1] > 1150
    assert (actuators.pwm[0], actuators.pwm[5]) == (0, 0)
    assert m.throttle_out == pytest.approx(m.throttle)


def test_of_many_motors_the_one_under_test_turns_alone(ap: Any) -> None:
    m, actuators = hexa(ap), make_actuators()
    m.test_motor, m.test_actuator = 2, 0.3
    output(ap, actuators)
    assert (actuators.pwm[1], actuators.pwm[2]) == (1300, 1000)


def test_a_plain_quad_that_is_boosted_watches_its_balance(ap: Any) -> None:
    arm(ap, 0.5)
    m = ap.control.motors
    m.boosting, m.unbalanced = True, False
    output(ap, make_actuators())
    assert not m.boosting


def test_motors_that_stand_give_no_throttle(ap: Any) -> None:
    ap.control.motors.throttle_out = 0.7
    output(ap, make_actuators())
    assert ap.control.motors.throttle_out == 0.0


@pytest.mark.parametrize("excited", (True, False))
def test_a_test_of_the_rates_adds_to_the_demands_for_one_tick(excited: bool) -> None:
    """SYSTEMID."""
    m = MotorsState()
    m.excited, m.excitation = excited, Vec3(0.1, -0.2, 0.3)
    still = Vec3(0.0, 0.0, 0.0)
    rate.control_rates(RateState(), m, still, still, Attitude())
    assert (m.roll, m.pitch, m.yaw) == ((0.1, -0.2, 0.3) if excited else (0.0, 0.0, 0.0)) and not m.excited


def test_spool_states_have_ardupilots_numbers() -> None:
    assert [int(state) for state in SpoolState] == [DOWN, IDLE, UP, FREE, SINKING]


@pytest.mark.parametrize("headroom", (200.0, 400.0))
def test_many_motors_keep_mot_yaw_headroom_as_four_do(ap: Any, headroom: float) -> None:
    """In thousandths of the range."""
    kept = []
    for frame in (1.0, 2.0):
        ap.params.FRAME.CLASS, ap.params.MOT.YAW_HEADROOM = frame, headroom
        load_frame(ap.control.motors, ap.params)
        arm(ap, 0.1)
        m = ap.control.motors
        m.yaw, m.throttle, m.throttle_in, m.throttle_avg_max, m.compensation_gain = 1.0, 0.05, 0.05, 0.05, 1.0
        motors.drive_motors(m, ap.arming, ap.params, 0)
        assert m.limit_yaw
        kept.append(float(max(m.thrust[: m.count]) - min(m.thrust[: m.count])))
    assert kept[0] == pytest.approx(kept[1]) and kept[0] == pytest.approx(min(headroom * 0.001, 0.1))
