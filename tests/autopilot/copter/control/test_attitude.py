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
from sitl.autopilot.copter.control.state import DT
from sitl.core.rotations import quat_from_rotation_vector, quat_multiply, quat_normalise, quat_rotate
from tests.autopilot.copter.control.level_autopilot import (
    arm,
    make_actuators,
    make_autopilot,
    output,
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


def test_period_agrees_with_the_vehicles():
    from sitl.vehicle.record import TICK_US

    assert DT * 1e6 == TICK_US


@given(components, components, components, components)
def test_split_error_is_thrust_turn_after_heading_turn(w, x, y, z):
    if w * w + x * x + y * y + z * z < 1e-4:
        return
    w, x, y, z = quat_normalise(w, x, y, z)
    rx, ry, rz, angle, tw, tx, ty = split_error(w, x, y, z)
    assert math.hypot(rx, ry) == pytest.approx(angle, abs=1e-9)
    again = quat_multiply(*quat_from_rotation_vector(rx, ry, 0.0), *quat_from_rotation_vector(0.0, 0.0, rz))
    if w * w + z * z > 1e-12:
        assert abs(sum(a * b for a, b in zip(again, (w, x, y, z), strict=True))) == pytest.approx(1.0, abs=1e-9)
        assert tw * tw + tx * tx + ty * ty == pytest.approx(1.0)


@given(components, components, components, st.floats(-3.1, 3.1))
def test_thrust_quaternion_points_thrust(x, y, z, heading):
    n = math.sqrt(x * x + y * y + z * z)
    if n < 1e-3 or z / n > 0.99999:
        return
    thrust = quat_rotate(*thrust_quaternion(x, y, z, heading), 0.0, 0.0, -1.0)
    assert thrust == pytest.approx((x / n, y / n, z / n), abs=1e-9)


@given(st.floats(-3, 3), st.floats(-1.5, 1.5), components, components, components)
def test_euler_rates_and_body_rates_are_inverse(roll, pitch, p, q, r):
    assert body_rates(roll, pitch, *euler_rates(roll, pitch, p, q, r)) == pytest.approx((p, q, r), abs=1e-9)


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
    set_attitude(ap, *start)
    attitude.relax(ap)
    arm(ap, 0.5)
    goal = quat_normalise(*goal)
    for _ in range(1000):
        attitude.input_quaternion(ap, *goal, 0.0, 0.0, 0.0)
        output(ap, actuators)
        turn(ap, DT)
        assert all(math.isfinite(c) for c in actuators.controls[:4])
    dot = abs(sum(float(a) * b for a, b in zip(ap.estimate.q, goal, strict=True)))
    assert 2 * math.acos(min(dot, 1.0)) < math.radians(3.0)


def test_lean_keeps_heading(ap, actuators):
    arm(ap)
    for _ in range(600):
        attitude.input_thrust_vector_heading(ap, 3.0, 0.0, -9.8, 0.5, 0.0)
        output(ap, actuators)
        turn(ap, DT)
    thrust = quat_rotate(*ap.estimate.q, 0.0, 0.0, -1.0)
    assert thrust[0] / -thrust[2] == pytest.approx(3.0 / 9.8, abs=0.01)
    assert ap.control.attitude.thrust_error_angle < 0.01


def test_heading_turn_is_limited_by_slew(ap, actuators):
    arm(ap)
    fastest = 0.0
    for _ in range(1200):
        attitude.input_thrust_vector_heading(ap, 0.0, 0.0, -9.8, 2.0, 0.0)
        output(ap, actuators)
        turn(ap, DT)
        fastest = max(fastest, float(ap.control.attitude.target_rate[2]))
    assert fastest == pytest.approx(math.radians(60.0), rel=1e-6)
    assert ap.estimate.euler[2] == pytest.approx(2.0, abs=0.05)


def test_yaw_rate_input_turns_the_target(ap):
    arm(ap)
    for _ in range(400):
        attitude.input_euler_roll_pitch_yaw_rate(ap, 0.2, 0.0, 0.5)
        set_attitude(ap, *ap.control.attitude.target_q)
    assert ap.control.attitude.target_euler[0] == pytest.approx(0.2, abs=2e-3)
    assert ap.control.attitude.target_euler[2] == pytest.approx(0.473, abs=0.01)  # 4.7 rad/s^2


def test_without_feed_forward_the_target_jumps(ap):
    ap.params.ATC_RATE_FF_ENAB = 0.0
    attitude.input_euler_roll_pitch_yaw(ap, 0.3, -0.1, 0.0, 0)
    assert tuple(ap.control.attitude.target_euler) == pytest.approx((0.3, -0.1, 0.0), abs=1e-12)


def test_a_jump_of_the_estimated_heading_does_not_turn_the_vehicle(ap):
    arm(ap)
    ap.control.tick = 10
    attitude.input_thrust_vector_heading_rate(ap, 0.0, 0.0, -9.8, 0.0)
    set_attitude(ap, *quat_from_rotation_vector(0.0, 0.0, 1.0))
    ap.estimate.reset_yaw_count += 1
    attitude.input_thrust_vector_heading_rate(ap, 0.0, 0.0, -9.8, 0.0)
    assert ap.control.attitude.target_euler[2] == pytest.approx(1.0)
    assert abs(ap.control.attitude.rate_target[2]) < 1e-9


def test_reset_yaw_target_keeps_lean(ap):
    ap.params.ATC_RATE_FF_ENAB = 0.0
    attitude.input_euler_roll_pitch_yaw(ap, 0.3, 0.1, 0.0, 0)
    ap.estimate.euler = ap.estimate.euler.replace(yaw=2.5)
    attitude.reset_yaw_target(ap)
    assert tuple(ap.control.attitude.target_euler) == pytest.approx((0.3, 0.1, 2.5))


BAD_INPUTS = [
    lambda ap, bad: attitude.input_euler_roll_pitch_yaw_rate(ap, bad, 0.0, 0.0),
    lambda ap, bad: attitude.input_euler_roll_pitch_yaw(ap, 0.0, 0.0, bad, 1),
    lambda ap, bad: attitude.input_thrust_vector_heading(ap, 0.0, bad, -9.8, 0.0, 0.0),
    lambda ap, bad: attitude.input_thrust_vector_heading(ap, 0.0, 0.0, -9.8, bad, 0.0),
    lambda ap, bad: attitude.input_thrust_vector_heading_rate(ap, 0.0, 0.0, -9.8, bad),
    lambda ap, bad: attitude.input_quaternion(ap, bad, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    lambda ap, bad: attitude.input_quaternion(ap, 1.0, 0.0, 0.0, 0.0, bad, 0.0, 0.0),
    lambda ap, bad: attitude.input_rates(ap, 0.0, bad, 0.0),
    lambda ap, bad: attitude.set_throttle_out(ap, bad, 1, 2.0),
    lambda ap, bad: ap.control.attitude.target_q.__setitem__(0, bad) or attitude.input_rates(ap, 0.0, 0.0, 0.0),
    lambda ap, bad: setattr(ap.estimate, "q", (1.0, bad, 0.0, 0.0)) or attitude.input_rates(ap, 0.0, 0.0, 0.0),
    lambda ap, bad: setattr(ap.estimate, "rates", (0.0, bad, 0.0)) or attitude.input_rates(ap, 0.0, 0.0, 0.0),
]


@pytest.mark.parametrize("bad", [math.nan, math.inf])
@pytest.mark.parametrize("give", BAD_INPUTS)
def test_bad_numbers_never_reach_the_motors(give, bad, ap, actuators):
    arm(ap)
    for _ in range(3):
        attitude.input_rates(ap, 0.0, 0.0, 0.0)
        output(ap, actuators)
    give(ap, bad)
    output(ap, actuators)
    assert all(1150 <= p <= 1950 for p in actuators.pwm[:4])
    assert all(math.isfinite(c) for c in actuators.controls[:4])
