# SPDX-License-Identifier: BSD-3-Clause
"""Compensation of battery and air; the lean that the thrust allows; priority of attitude over throttle."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.copter.control import control_step, throttle_mix, thrust_curve
from sitl.autopilot.copter.control.state import DT, AttitudeState, MotorsState
from sitl.autopilot.copter.parameters.control import Attitude
from sitl.core.vectors import Vec3
from tests.autopilot.copter.control.level_autopilot import make_actuators, output
from tests.autopilot.copter.control.test_spool import mot


@pytest.mark.parametrize(
    ("resting", "low", "full", "ratio"),
    (
        (11.0, 9.6, 12.8, 11.0 / 12.8),
        (14.0, 9.6, 12.8, 1.0),
        (8.0, 9.6, 12.8, 0.75),  # MOT_BAT_VOLT_MIN
        (5.0, 1.0, 12.8, 0.6),  # no less than 60 %
        (2.0, 9.6, 12.8, 1.0),  # that is no battery: less than a quarter of the least
        (2.4, 9.6, 12.8, 0.75),
        (math.nan, 9.6, 12.8, 1.0),
        (11.0, 12.8, 12.8, 1.0),  # no range
        (11.0, 9.6, 0.0, 1.0),
    ),
)
def test_the_voltage_that_counts(resting: float, low: float, full: float, ratio: float) -> None:
    m, p = MotorsState(), mot(BAT_VOLT_MIN=low, BAT_VOLT_MAX=full, THST_EXPO=0.5)
    m.voltage_ratio = 1.0
    for _ in range(100):
        thrust_curve.compensate_voltage(m, resting, p)
    assert m.voltage_ratio == pytest.approx(ratio, abs=1e-6)
    assert m.lift_max == pytest.approx(0.5 * ratio + 0.5 * ratio * ratio)


def test_the_voltage_is_followed_with_half_a_hertz() -> None:
    m, p = MotorsState(), mot(BAT_VOLT_MIN=9.6, BAT_VOLT_MAX=12.8)
    m.voltage_ratio = 1.0
    thrust_curve.compensate_voltage(m, 9.6, p)
    gain = math.tau * 0.5 * 0.1 / (1.0 + math.tau * 0.5 * 0.1)
    assert m.voltage_ratio == pytest.approx(1.0 - 0.25 * gain)


@pytest.mark.parametrize(("expo", "kept"), ((2.0, 1.0), (-2.0, -1.0)))
def test_the_curve_of_thrust_is_between_minus_one_and_one(expo: float, kept: float) -> None:
    for thrust in (0.0, 0.3, 1.0):
        wild, kept_command = (thrust_curve.command_from_thrust(thrust, e, 1.0, 1.0) for e in (expo, kept))
        assert wild == kept_command
    m = MotorsState()
    m.voltage_ratio = 0.5
    thrust_curve.compensate_voltage(m, 6.4, mot(BAT_VOLT_MIN=6.4, BAT_VOLT_MAX=12.8, THST_EXPO=expo))
    v = m.voltage_ratio
    assert m.lift_max == pytest.approx(v * (1.0 - kept) + kept * v * v)


@pytest.mark.parametrize(
    ("origin", "altitude", "gain"),
    ((1, 0.0, 1.0), (1, 2000.0, 1.0 / thrust_curve.air_density_ratio(2000.0)), (0, 2000.0, 1.0), (1, 9500.0, 2.0)),
)
def test_thin_air_needs_more(ap: Any, origin: int, altitude: float, gain: float) -> None:
    ap.estimate.origin_set, ap.estimate.origin_alt = origin, altitude - 100.0
    ap.estimate.pos = Vec3(0.0, 0.0, -100.0)
    thrust_curve.compensate(ap.control.motors, ap.battery, ap.estimate, ap.params.MOT)
    assert ap.control.motors.compensation_gain == pytest.approx(gain)


def test_thick_air_needs_less_and_weak_lift_counts_as_a_tenth_at_least(ap: Any) -> None:
    ap.estimate.origin_set, ap.estimate.origin_alt = 1, -900.0
    thrust_curve.compensate(ap.control.motors, ap.battery, ap.estimate, ap.params.MOT)
    gain = ap.control.motors.compensation_gain
    assert gain < 1.0 and gain == pytest.approx(1.0 / thrust_curve.air_density_ratio(-900.0))
    for altitude, kept in ((-5000.0, -1000.0), (20000.0, 11000.0)):
        assert thrust_curve.air_density_ratio(altitude) == thrust_curve.air_density_ratio(kept)


@pytest.mark.parametrize(("current", "voltage"), ((0.0, 12.0), (-1.0, 12.0)))
def test_without_a_current_the_voltage_is_as_it_is_measured(current: float, voltage: float) -> None:
    m = MotorsState()
    m.resistance = 0.1
    assert thrust_curve.resting_voltage(m, voltage, current) == voltage
    assert (m.voltage_slow, m.current_max) == (0.0, 0.0)


@pytest.mark.parametrize(("tick", "renewed"), ((0, True), (40, True), (39, False), (41, False)))
def test_battery_and_air_are_looked_at_ten_times_a_second(ap: Any, tick: int, renewed: bool) -> None:
    ap.control.tick, ap.control.motors.compensation_gain = tick, 3.0
    output(ap, make_actuators())
    assert (ap.control.motors.compensation_gain == 1.0) == renewed
    assert ap.control.tick == tick + 1


def test_a_second_start_of_the_controllers_changes_nothing(ap: Any) -> None:
    control = ap.control
    assert (control.pos_ne.speed_max, control.pos_ne.accel_max) == (10.0, 2.5)
    assert (control.pos_d.speed_down, control.pos_d.speed_up, control.pos_d.accel_max) == (1.5, 2.5, 1.0)
    control.motors.compensation_gain, control.pos_ne.speed_max, control.pos_d.speed_up = 1.2, 3.0, 1.1
    control.attitude.mix = 0.9
    control_step.init(control, ap.estimate, ap.params)
    assert (control.motors.compensation_gain, control.pos_ne.speed_max, control.pos_d.speed_up) == (1.2, 3.0, 1.1)
    assert control.attitude.mix == 0.9


@pytest.mark.parametrize(
    ("throttle", "thrust_max", "lean"),
    ((0.4, 1.0, 60.0), (0.0, 1.0, 90.0), (0.9, 1.0, 0.0), (0.2, 0.5, 60.0), (0.4, 0.0, 0.0)),
)
def test_the_lean_which_four_fifths_of_the_throttle_hold(throttle: float, thrust_max: float, lean: float) -> None:
    state = AttitudeState()
    state.lean_max = 0.3
    for _ in range(4000):
        throttle_mix.update_lean_max(state, throttle, thrust_max, 1.0)
    assert math.degrees(state.lean_max) == pytest.approx(lean, abs=1e-3)


def test_the_lean_limit_follows_with_its_time_constant_and_is_ten_degrees_at_least() -> None:
    state = AttitudeState()
    throttle_mix.update_lean_max(state, 0.4, 1.0, 1.0)
    assert state.lean_max == pytest.approx(math.radians(60.0) * 0.02 / 1.02)
    assert math.degrees(throttle_mix.lean_limit(state)) == pytest.approx(10.0)
    state.lean_max = 0.5
    assert throttle_mix.lean_limit(state) == 0.5


@pytest.mark.parametrize(("tick", "thrust_max", "renewed"), ((8, 1.0, True), (9, 1.0, False), (9, 0.0, True)))
def test_the_lean_limit_is_renewed_every_eighth_tick(ap: Any, tick: int, thrust_max: float, renewed: bool) -> None:
    ap.control.tick, ap.control.motors.thrust_max, ap.control.attitude.lean_max = tick, thrust_max, 0.5
    throttle_mix.set_throttle_out(ap.control, ap.params, 0.3, True, 1.5)
    assert (ap.control.attitude.lean_max != 0.5) == renewed
    assert ap.control.motors.throttle_filter_hz == 1.5


@pytest.mark.parametrize(
    ("cos_lean", "factor"), ((1.0, 1.0), (0.5, 2.0), (0.1, 10.0), (0.05, 5.0), (0.0, 0.0), (-0.5, 0.0))
)
def test_throttle_is_raised_in_a_lean_and_fades_beyond_84_degrees(cos_lean: float, factor: float) -> None:
    assert throttle_mix.boosted(0.3, cos_lean) == pytest.approx(0.3 * factor)


@pytest.mark.parametrize(("enabled", "asked", "wanted"), ((1.0, True, 0.6), (0.0, True, 0.3), (1.0, False, 0.3)))
def test_a_boost_for_the_lean_needs_atc_angle_boost(ap: Any, enabled: float, asked: bool, wanted: float) -> None:
    ap.params.ATC.ANGLE_BOOST, ap.control.attitude.cos_lean = enabled, 0.5
    throttle_mix.set_throttle_out(ap.control, ap.params, 0.3, asked, 0.0)
    assert ap.control.motors.throttle_in == pytest.approx(wanted) and ap.control.attitude.throttle_in == 0.3


@pytest.mark.parametrize(
    ("throttle", "mix", "wanted"),
    ((0.3, 0.0, 0.3), (0.3, 0.5, 0.15 + 0.2), (0.3, 1.0, 0.4), (0.6, 0.5, 0.6), (0.1, 2.0, 0.8)),
)
def test_how_far_attitude_may_raise_the_throttle(throttle: float, mix: float, wanted: float) -> None:
    assert throttle_mix.throttle_average_max(throttle, 0.4, mix) == pytest.approx(wanted)


@pytest.mark.parametrize(("ratio", "wanted"), ((0.0, 0.1), (0.5, 0.3), (1.0, 0.5), (-1.0, 0.1), (2.0, 0.5)))
def test_the_priority_of_attitude_lies_between_its_ends(ratio: float, wanted: float) -> None:
    state, p = AttitudeState(), Attitude()
    p.THR_MIX_MIN, p.THR_MIX_MAN, p.THR_MIX_MAX = 0.1, 0.2, 0.5
    throttle_mix.set_mix_max(state, p, ratio)
    assert state.mix_desired == pytest.approx(wanted)
    throttle_mix.set_mix_man(state, p)
    assert state.mix_desired == pytest.approx(0.2)
    throttle_mix.set_mix_min(state, p)
    assert state.mix_desired == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("mix", "desired", "asked", "out", "after"),
    (
        (0.5, 0.1, 0.2, 0.3, 0.5 - 0.5 * DT),  # (0.3 - 0.2) / (0.4 - 0.2): just what is used
        (0.9, 0.1, 0.2, 0.3, 0.5),
        (0.9, 0.6, 0.2, 0.3, 0.6),
        (0.9, 0.1, 0.2, 0.6, 0.9 - 0.5 * DT),  # above hovering: 0.6 / 0.4
        (2.0, 0.1, 0.2, 0.6, 1.5),
        (0.9, 0.1, 0.5, 0.3, 0.9 - 0.5 * DT),  # less came out than was asked for
        (0.1, 0.05, 0.3, 0.3, 0.1),  # never below 0.1
        (5.0, 9.0, 0.3, 0.3, 5.0),  # nor above 5
    ),
)
def test_the_priority_falls_to_what_the_mixer_uses(
    mix: float, desired: float, asked: float, out: float, after: float
) -> None:
    state, m = AttitudeState(), MotorsState()
    state.mix, state.mix_desired, m.throttle, m.throttle_out = mix, desired, asked, out
    throttle_mix.follow_mix(state, m, 0.4)
    assert state.mix == pytest.approx(after)


@pytest.mark.parametrize(
    ("change", "dip", "before", "wanted"),
    (
        (10.0, 1.0, 0.04, 0.04 + 0.05 * (0.1 - 0.04)),  # a tenth of the change over the highest current
        (10.0, 0.2, 0.04, 0.04 - 0.05 * (0.04 - 0.02)),
        (0.0, 1.0, 0.04, 0.04),
        (10.0, -1.0, 0.04, 0.04),  # more voltage at more current says nothing
    ),
)
def test_resistance_moves_towards_what_a_step_of_current_shows(
    change: float, dip: float, before: float, wanted: float
) -> None:
    m = MotorsState()
    m.resistance, m.voltage_slow, m.current_slow, m.current_max = before, 12.0, 10.0, 20.0
    m.voltage_reference, m.current_reference = 99.0, 0.0  # bounds nothing
    voltage = 12.0 - dip
    resting = thrust_curve.resting_voltage(m, voltage, 10.0 + change)
    assert m.resistance == pytest.approx(wanted)
    assert resting == pytest.approx(voltage + (10.0 + change) * m.resistance)
    share = 0.1 / (0.1 + 0.5)
    assert m.voltage_slow == pytest.approx(12.0 - share * dip) and m.current_slow == pytest.approx(
        10.0 + share * change
    )
