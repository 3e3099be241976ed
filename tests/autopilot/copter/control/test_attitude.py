# SPDX-License-Identifier: BSD-3-Clause
"""Attitude: from any attitude to any other, in plain Python with a simple body."""

from __future__ import annotations

import itertools
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.copter.control import attitude
from sitl.autopilot.copter.control.attitude_error import body_rates, euler_rates, split_error, thrust_quaternion
from sitl.autopilot.copter.control.attitude_target import AttitudeGains, attitude_control, limit_rates
from sitl.autopilot.copter.control.state import DT
from sitl.autopilot.copter.control.throttle_mix import set_throttle_out
from sitl.core.algebra import multiply, normalise, quat_from_rotation_vector, quat_norm_squared, rotate
from sitl.core.vectors import Euler, Quat, Vec3
from tests.autopilot.copter.control.level_autopilot import (
    arm,
    make_actuators,
    make_autopilot,
    output,
    parts,
    set_attitude,
    turn,
)

R = math.sqrt(0.5)
AWKWARD = [
    (1.0, 0.0, 0.0, 0.0),
    (0.0, 1.0, 0.0, 0.0),  # upside down
    (0.0, 0.0, 0.0, 1.0),  # facing back
    (R, 0.0, R, 0.0),  # nose straight up
    (R, R, 0.0, 0.0),
    (-0.5, 0.5, -0.5, 0.5),
    (0.9, -0.1, 0.2, -0.4),
]
components = st.floats(-1.0, 1.0)
UP = Vec3(0.0, 0.0, -1.0)


def test_period_agrees_with_the_vehicles():
    from sitl.core.constants import TICK_US

    assert DT * 1e6 == TICK_US


@given(components, components, components, components)
def test_split_error_is_thrust_turn_after_heading_turn(w, x, y, z):
    if w * w + x * x + y * y + z * z < 1e-4:
        return
    q = normalise(Quat(w, x, y, z))
    split = split_error(q)
    error, turn = split.error, split.thrust_turn
    assert math.hypot(error.x, error.y) == pytest.approx(split.thrust_angle, abs=1e-9)
    thrust, heading = Vec3(error.x, error.y, 0.0), Vec3(0.0, 0.0, error.z)
    again = multiply(quat_from_rotation_vector(thrust), quat_from_rotation_vector(heading))
    if q.w * q.w + q.z * q.z > 1e-12:
        assert abs(sum(a * b for a, b in zip(again, q, strict=True))) == pytest.approx(1.0, abs=1e-9)
        assert quat_norm_squared(turn) == pytest.approx(1.0)


@given(components, components, components, st.floats(-3.1, 3.1))
def test_thrust_quaternion_points_thrust(x, y, z, heading):
    n = math.sqrt(x * x + y * y + z * z)
    if n < 1e-3 or z / n > 0.99999:
        return
    thrust = rotate(thrust_quaternion(Vec3(x, y, z), heading), UP)
    assert thrust == pytest.approx((x / n, y / n, z / n), abs=1e-9)


@given(st.floats(-3, 3), st.floats(-1.5, 1.5), components, components, components)
def test_euler_rates_and_body_rates_are_inverse(roll, pitch, p, q, r):
    euler = Euler(roll, pitch, 0.0)
    assert body_rates(euler, euler_rates(euler, Vec3(p, q, r))) == pytest.approx((p, q, r), abs=1e-9)


GAINS = AttitudeGains(Vec3(4.5, 4.5, 4.5), Vec3(19.2, 19.2, 4.7), Vec3(2.0, 3.0, 1.0), 0.18)
rotations = st.tuples(components, components, components, components).filter(lambda q: sum(c * c for c in q) > 1e-2)


@given(rotations, rotations)
def test_correction_turns_the_body_towards_its_target_within_the_rate_limits(start, goal):
    q, target, rest = normalise(Quat(*start)), normalise(Quat(*goal)), Vec3(0.0, 0.0, 0.0)
    out = attitude_control(q, target, rest, rest, GAINS)
    rate, limit = out.rate_target, GAINS.rate_max
    assert math.hypot(rate.x / limit.x, rate.y / limit.y) <= 1.0 + 1e-9 and abs(rate.z) <= limit.z
    assert all(e * w >= 0.0 for e, w in zip(out.error, rate, strict=True))
    assert 0.0 <= out.thrust_error_angle <= math.pi + 1e-9
    if not out.yaw_limited:
        assert out.target == target
    up, wanted = rotate(out.target, UP), rotate(target, UP)
    assert up == pytest.approx(wanted, abs=1e-6)  # a limited heading leaves the thrust where it was asked to be


def test_on_target_the_correction_is_the_targets_own_rate():
    q = normalise(Quat(0.9, 0.1, -0.2, 0.3))
    out = attitude_control(q, q, Vec3(0.1, -0.2, 0.3), Vec3(9.0, 9.0, 9.0), GAINS)
    assert out.rate_target == pytest.approx((0.1, -0.2, 0.3))
    assert not out.yaw_limited


def test_a_thrust_far_off_is_turned_without_heading():
    q = Quat(1.0, 0.0, 0.0, 0.0)
    target = quat_from_rotation_vector(Vec3(math.radians(70.0), 0.0, 0.0))
    out = attitude_control(q, target, Vec3(0.0, 0.0, 0.5), Vec3(0.0, 0.0, 0.25), GAINS)
    assert out.rate_target.z == 0.25 and out.rate_target.x > 0.0


@given(components, components, components)
def test_rates_are_shortened_together_on_the_ellipse(p, q, r):
    got = limit_rates(Vec3(p, q, r) * 10.0, Vec3(2.0, 3.0, 1.0))
    assert math.hypot(got.x / 2.0, got.y / 3.0) <= 1.0 + 1e-9 and abs(got.z) <= 1.0
    assert got.x * q == pytest.approx(got.y * p, abs=1e-9)
    assert limit_rates(Vec3(p, q, r), Vec3(0.0, 0.0, 0.0)) == Vec3(p, q, r)


NEIGHBOURS = list(itertools.pairwise([*AWKWARD, AWKWARD[0]]))
OTHERS = [pair for pair in itertools.permutations(AWKWARD, 2) if pair not in NEIGHBOURS]


@pytest.mark.parametrize(("start", "goal"), NEIGHBOURS)
def test_one_attitude_to_the_next(start, goal):
    fly(start, goal)


@pytest.mark.slow
@pytest.mark.parametrize(("start", "goal"), OTHERS)
def test_any_attitude_to_any_other(start, goal):
    fly(start, goal)


def fly(start, goal):
    ap, actuators = make_autopilot(), make_actuators()
    set_attitude(ap, Quat(*start))
    attitude.relax(ap.control, ap.estimate)
    arm(ap, 0.5)
    goal = normalise(Quat(*goal))
    for _ in range(1000):
        attitude.input_quaternion(*parts(ap), goal, Vec3(0.0, 0.0, 0.0))
        output(ap, actuators)
        turn(ap, DT)
        assert all(math.isfinite(c) for c in actuators.controls[:4])
    dot = abs(sum(float(a) * b for a, b in zip(ap.estimate.q, goal, strict=True)))
    assert 2 * math.acos(min(dot, 1.0)) < math.radians(3.0)


def test_lean_keeps_heading(ap, actuators):
    arm(ap)
    for _ in range(600):
        attitude.input_thrust_vector_heading(*parts(ap), Vec3(3.0, 0.0, -9.8), attitude.Heading(0.5, 0.0, True))
        output(ap, actuators)
        turn(ap, DT)
    thrust = rotate(ap.estimate.q, UP)
    assert thrust.x / -thrust.z == pytest.approx(3.0 / 9.8, abs=0.01)
    assert ap.control.attitude.thrust_error_angle < 0.01


def test_heading_turn_is_limited_by_slew(ap, actuators):
    arm(ap)
    fastest = 0.0
    for _ in range(1200):
        attitude.input_thrust_vector_heading(*parts(ap), Vec3(0.0, 0.0, -9.8), attitude.Heading(2.0, 0.0, True))
        output(ap, actuators)
        turn(ap, DT)
        fastest = max(fastest, float(ap.control.attitude.target_rate[2]))
    assert fastest == pytest.approx(math.radians(60.0), rel=1e-6)
    assert ap.estimate.euler[2] == pytest.approx(2.0, abs=0.05)


def test_yaw_rate_input_turns_the_target(ap):
    arm(ap)
    for _ in range(400):
        attitude.input_euler_roll_pitch_yaw_rate(*parts(ap), attitude.Lean(0.2, 0.0), 0.5)
        set_attitude(ap, ap.control.attitude.target_q)
    assert ap.control.attitude.target_euler[0] == pytest.approx(0.2, abs=2e-3)
    assert ap.control.attitude.target_euler[2] == pytest.approx(0.473, abs=0.01)  # 4.7 rad/s^2


def test_without_feed_forward_the_target_jumps(ap):
    ap.params.ATC_RATE_FF_ENAB = 0.0
    attitude.input_euler_roll_pitch_yaw_rate(*parts(ap), attitude.Lean(0.3, -0.1), 0.0)
    assert tuple(ap.control.attitude.target_euler) == pytest.approx((0.3, -0.1, 0.0), abs=1e-12)


def test_a_jump_of_the_estimated_heading_does_not_turn_the_vehicle(ap):
    arm(ap)
    ap.control.tick = 10
    attitude.input_thrust_vector_heading_rate(*parts(ap), Vec3(0.0, 0.0, -9.8), 0.0)
    set_attitude(ap, quat_from_rotation_vector(Vec3(0.0, 0.0, 1.0)))
    ap.estimate.reset_yaw_count += 1
    attitude.input_thrust_vector_heading_rate(*parts(ap), Vec3(0.0, 0.0, -9.8), 0.0)
    assert ap.control.attitude.target_euler[2] == pytest.approx(1.0)
    assert abs(ap.control.attitude.rate_target[2]) < 1e-9


def test_reset_yaw_target_keeps_lean(ap):
    ap.params.ATC_RATE_FF_ENAB = 0.0
    attitude.input_euler_roll_pitch_yaw_rate(*parts(ap), attitude.Lean(0.3, 0.1), 0.0)
    ap.estimate.euler = ap.estimate.euler.replace(yaw=2.5)
    attitude.reset_yaw_target(ap.control.attitude, ap.estimate.euler.yaw)
    assert tuple(ap.control.attitude.target_euler) == pytest.approx((0.3, 0.1, 2.5))


REST = Vec3(0.0, 0.0, 0.0)
BAD_INPUTS = [
    lambda ap, bad: attitude.input_euler_roll_pitch_yaw_rate(*parts(ap), attitude.Lean(bad, 0.0), 0.0),
    lambda ap, bad: attitude.input_euler_roll_pitch_yaw_rate(*parts(ap), attitude.Lean(0.0, 0.0), bad),
    lambda ap, bad: attitude.input_thrust_vector_heading(
        *parts(ap), Vec3(0.0, bad, -9.8), attitude.Heading(0.0, 0.0, True)
    ),
    lambda ap, bad: attitude.input_thrust_vector_heading(
        *parts(ap), Vec3(0.0, 0.0, -9.8), attitude.Heading(bad, 0.0, True)
    ),
    lambda ap, bad: attitude.input_thrust_vector_heading_rate(*parts(ap), Vec3(0.0, 0.0, -9.8), bad),
    lambda ap, bad: attitude.input_quaternion(*parts(ap), Quat(bad, 0.0, 0.0, 0.0), REST),
    lambda ap, bad: attitude.input_quaternion(*parts(ap), Quat(1.0, 0.0, 0.0, 0.0), Vec3(bad, 0.0, 0.0)),
    lambda ap, bad: attitude.input_rates(*parts(ap), Vec3(0.0, bad, 0.0)),
    lambda ap, bad: set_throttle_out(ap.control, ap.params, bad, True, 2.0),
    lambda ap, bad: (
        setattr(ap.control.attitude, "target_q", (bad, 0.0, 0.0, 0.0)) or attitude.input_rates(*parts(ap), REST)
    ),
    lambda ap, bad: setattr(ap.estimate, "q", (1.0, bad, 0.0, 0.0)) or attitude.input_rates(*parts(ap), REST),
    lambda ap, bad: setattr(ap.estimate, "rates", (0.0, bad, 0.0)) or attitude.input_rates(*parts(ap), REST),
]


@pytest.mark.parametrize("bad", [math.nan, math.inf])
@pytest.mark.parametrize("give", BAD_INPUTS)
def test_bad_numbers_never_reach_the_motors(give, bad, ap, actuators):
    arm(ap)
    for _ in range(3):
        attitude.input_rates(*parts(ap), REST)
        output(ap, actuators)
    give(ap, bad)
    output(ap, actuators)
    assert all(1150 <= p <= 1950 for p in actuators.pwm[:4])
    assert all(math.isfinite(c) for c in actuators.controls[:4])


def test_who_relaxes_begins_with_its_present_rates_and_without_a_memory():
    ap = make_autopilot()
    arm(ap)
    loops = (ap.control.rate.roll, ap.control.rate.pitch, ap.control.rate.yaw)
    for loop in loops:
        loop.started, loop.integrator = True, 0.3
    ap.estimate.rates = Vec3(0.1, -0.2, 0.3)
    ap.control.attitude.thrust_error_angle = 0.5
    attitude.relax(ap.control, ap.estimate)
    assert [(bool(loop.started), float(loop.integrator)) for loop in loops] == [(False, 0.0)] * 3
    assert ap.control.attitude.rate_target == Vec3(0.1, -0.2, 0.3) and ap.control.attitude.thrust_error_angle == 0.0
