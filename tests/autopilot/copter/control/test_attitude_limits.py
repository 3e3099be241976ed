# SPDX-License-Identifier: BSD-3-Clause
"""Attitude control at its limits: without shaping, with limits that are off, far from the target, near vertical."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.copter.control import attitude
from sitl.autopilot.copter.control.attitude_error import (
    angle_per_half_sine,
    body_rates,
    euler_accel_limits,
    euler_rates,
    split_error,
    thrust_quaternion,
)
from sitl.autopilot.copter.control.attitude_target import (
    AttitudeGains,
    accel_max,
    attitude_control,
    attitude_gains,
    correction_rate,
    cos_lean,
    limit_rates,
    rate_max,
    set_target,
    turned_by_rate,
)
from sitl.autopilot.copter.control.state import DT, AttitudeState
from sitl.core.algebra import euler_of, multiply, quat_from_euler, quat_from_rotation_vector
from sitl.core.vectors import Euler, Quat, Vec3
from tests.autopilot.copter.control.level_autopilot import parts, set_attitude

REST = Vec3(0.0, 0.0, 0.0)
LEVEL = Quat(1.0, 0.0, 0.0, 0.0)
GAINS = AttitudeGains(Vec3(4.0, 5.0, 3.0), REST, REST, 0.0)
"""No limits."""


@pytest.mark.parametrize(
    ("limit", "wanted"),
    (
        (Vec3(0.0, 0.0, 0.0), (3.0, -4.0, 5.0)),
        (Vec3(1.0, 0.0, 0.0), (1.0, -4.0, 5.0)),
        (Vec3(0.0, 1.0, 0.0), (3.0, -1.0, 5.0)),
        (Vec3(0.0, 0.0, 1.0), (3.0, -4.0, 1.0)),
        (Vec3(2.5, 2.5, 0.0), (1.5, -2.0, 5.0)),  # on an ellipse
        (Vec3(5.0, 5.0, 5.0), (3.0, -4.0, 5.0)),  # on its edge
    ),
)
def test_each_limit_of_the_rates_counts_where_it_is_set(limit: Vec3, wanted: tuple[float, float, float]) -> None:
    assert limit_rates(Vec3(3.0, -4.0, 5.0), limit) == pytest.approx(wanted)
    assert limit_rates(Vec3(-3.0, 4.0, -5.0), limit) == pytest.approx(tuple(-x for x in wanted))


def test_limits_are_those_of_the_parameters(ap: Any) -> None:
    p = ap.params.ATC
    p.ACCEL_R_MAX, p.ACCEL_P_MAX, p.ACCEL_Y_MAX = 9000.0, 18000.0, 3600.0
    p.RATE_R_MAX, p.RATE_P_MAX, p.RATE_Y_MAX = 90.0, 180.0, 45.0
    p.ANG_RLL_P, p.ANG_PIT_P, p.ANG_YAW_P, p.RAT_YAW.P = 4.0, 5.0, 3.0, 0.2
    assert [math.degrees(a) for a in accel_max(p)] == pytest.approx([90.0, 180.0, 36.0])
    assert [math.degrees(a) for a in rate_max(p)] == pytest.approx([90.0, 180.0, 45.0])
    gains = attitude_gains(p)
    assert (gains.angle_p, gains.rate_yaw_p) == (pytest.approx((4.0, 5.0, 3.0)), pytest.approx(0.2))
    p.SLEW_YAW, p.RATE_Y_MAX = 6000.0, 0.0
    assert math.degrees(attitude.slew_yaw_max(p)) == pytest.approx(60.0)
    p.RATE_Y_MAX = 45.0
    assert math.degrees(attitude.slew_yaw_max(p)) == pytest.approx(45.0), "the lesser"
    p.SLEW_YAW = 0.0
    assert attitude.slew_yaw_max(p) == 0.0


@pytest.mark.parametrize(("limit", "wanted"), ((0.0, 9.0), (2.0, 2.0)))
def test_a_turn_without_a_limit_is_as_fast_as_asked_for(limit: float, wanted: float) -> None:
    assert attitude.limit_turn(9.0, limit) == wanted and attitude.limit_turn(-9.0, limit) == -wanted


@pytest.mark.parametrize("q", (Quat(math.nan, 0.0, 0.0, 0.0), Quat(0.0, 0.0, 0.0, 0.0), Quat(1e-7, 0.0, 0.0, 0.0)))
def test_a_target_without_a_direction_is_level(q: Quat) -> None:
    state = AttitudeState()
    set_target(state, q)
    assert state.target_q == LEVEL


def test_a_target_is_normalised() -> None:
    state = AttitudeState()
    set_target(state, Quat(0.0, 3.0, 0.0, -4.0))
    assert state.target_q == pytest.approx((0.0, 0.6, 0.0, -0.8))
    set_target(state, Quat(0.0, 3e-6, 0.0, 0.0))
    assert state.target_q == pytest.approx((0.0, 1.0, 0.0, 0.0))


@pytest.mark.parametrize("rate", (Vec3(2.0, 0.0, 0.0), Vec3(-1.0, 3.0, 0.5), Vec3(0.0, 0.0, -20.0)))
def test_a_target_turns_as_a_rotation_vector_says(rate: Vec3) -> None:
    q = quat_from_euler(Euler(0.3, -0.2, 1.0))
    wanted = quat_from_euler(Euler(0.3, -0.2, 1.0))
    for _ in range(40):
        q = turned_by_rate(q, rate, DT)
    turn = quat_from_rotation_vector(rate * (40 * DT))
    assert q == pytest.approx(multiply(wanted, turn), abs=1e-6)


@pytest.mark.parametrize(
    ("accel", "used"),
    (
        (math.radians(40.0), math.radians(40.0)),
        (math.radians(2000.0), math.radians(720.0)),
        (math.radians(400.0), math.radians(200.0)),
    ),
)
def test_a_correction_uses_half_of_the_acceleration_within_bounds(accel: float, used: float) -> None:
    """Far away it is that which the acceleration can stop: sqrt(2 a (e - a / (2 p^2)))."""
    p, error = 20.0, 3.0
    assert correction_rate(error, p, accel) == pytest.approx(math.sqrt(2.0 * used * (error - 0.5 * used / (p * p))))
    assert correction_rate(-error, p, accel) == -correction_rate(error, p, accel)
    assert correction_rate(error, p, 0.0) == p * error


def turned(roll: float = 0.0, pitch: float = 0.0, yaw: float = 0.0) -> Quat:
    return quat_from_euler(Euler(math.radians(roll), math.radians(pitch), math.radians(yaw)))


def test_without_limits_the_correction_is_the_gains() -> None:
    for axis, gain in ((0, 4.0), (1, 5.0), (2, 3.0)):
        vector = [0.0, 0.0, 0.0]
        vector[axis] = 0.1
        out = attitude_control(LEVEL, quat_from_rotation_vector(Vec3(*vector)), REST, REST, GAINS)
        wanted = [0.0, 0.0, 0.0]
        wanted[axis] = 0.1 * gain
        assert out.rate_target == pytest.approx(tuple(wanted), abs=1e-9) and not out.yaw_limited
        assert out.error == pytest.approx(tuple(vector), abs=1e-9)


@pytest.mark.parametrize(
    ("lean", "ahead", "yaw_rate"),
    ((29.0, 1.0, 0.5), (45.0, 0.5, 0.5 * 0.5 + 0.5 * 0.2), (59.9, 0.003, 0.2), (61.0, 0.0, 0.2), (120.0, 0.0, 0.2)),
)
def test_far_off_thrust_fades_the_turn_of_the_target_out(lean: float, ahead: float, yaw_rate: float) -> None:
    """Between 30 and 60 degrees; then the heading turns as it does. ``ahead``: how much of a roll rate of 1 counts."""
    target = turned(lean)
    still = attitude_control(LEVEL, target, REST, Vec3(0.0, 0.0, 0.2), GAINS)
    out = attitude_control(LEVEL, target, Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.2), GAINS)
    assert out.rate_target.x - still.rate_target.x == pytest.approx(ahead, abs=0.002)
    up = Vec3(0.0, 0.5 * math.sin(math.radians(lean)), 0.5 * math.cos(math.radians(lean)))  # about the body's z axis
    out = attitude_control(LEVEL, target, up, Vec3(0.0, 0.0, 0.2), GAINS)
    assert out.rate_target.z == pytest.approx(yaw_rate, abs=0.002)
    assert out.thrust_error_angle == pytest.approx(math.radians(lean))


@pytest.mark.parametrize(
    ("rate_p", "angle_p", "yaw", "kept"),
    (
        (0.2, 3.0, 170.0, 45.0),  # no more than 45 degrees
        (5.0, 3.0, 40.0, math.degrees(0.2 / 3.0)),  # what a full yaw demand works off
        (0.0, 3.0, 170.0, 170.0),
        (0.2, 0.0, 170.0, 170.0),
        (0.2, 3.0, -170.0, -45.0),
    ),
)
def test_an_error_of_heading_is_kept_to_what_the_motors_can_work_off(
    rate_p: float, angle_p: float, yaw: float, kept: float
) -> None:
    gains = GAINS._replace(angle_p=Vec3(4.0, 4.0, angle_p), accel_max=Vec3(0.0, 0.0, 4.0), rate_yaw_p=rate_p)
    out = attitude_control(LEVEL, turned(yaw=yaw), REST, REST, gains)
    assert math.degrees(out.error.z) == pytest.approx(kept)
    assert out.yaw_limited == (abs(kept - yaw) > 1e-6)
    assert math.degrees(euler_of(out.target).yaw) == pytest.approx(kept), "the target is held back"


@pytest.mark.parametrize(("accel", "used"), ((4.0, 2.0), (1e-3, math.radians(10.0)), (99.0, math.radians(120.0))))
def test_a_heading_is_corrected_with_half_of_its_acceleration_within_bounds(accel: float, used: float) -> None:
    gains = GAINS._replace(angle_p=Vec3(4.0, 4.0, 20.0), accel_max=Vec3(0.0, 0.0, accel))
    out = attitude_control(LEVEL, turned(yaw=90.0), REST, REST, gains)
    error = math.pi / 2
    assert out.rate_target.z == pytest.approx(math.sqrt(2.0 * used * (error - 0.5 * used / 400.0)))
    free = attitude_control(LEVEL, turned(yaw=90.0), REST, REST, gains._replace(accel_max=REST))
    assert free.rate_target.z == pytest.approx(20.0 * error)


@pytest.mark.parametrize(("lean", "cosine"), ((0.0, 1.0), (60.0, 0.5), (-90.0, 0.0), (180.0, -1.0)))
def test_the_cosine_of_a_lean(lean: float, cosine: float) -> None:
    assert cos_lean(turned(roll=lean, yaw=40.0)) == pytest.approx(cosine, abs=1e-12)


@pytest.mark.parametrize("half", (1e-9, 0.05, 0.0999, 0.1001, 0.7, math.pi / 2))
def test_angles_of_half_sines_meet_their_series(half: float) -> None:
    assert angle_per_half_sine(math.sin(half), math.cos(half)) == pytest.approx(2.0 * half / math.sin(half), rel=1e-9)


@pytest.mark.parametrize(
    ("q", "error", "angle"),
    (
        (Quat(0.0, 1.0, 0.0, 0.0), (math.pi, 0.0, 0.0), math.pi),
        (Quat(0.0, 0.6, -0.8, 0.0), (0.6 * math.pi, -0.8 * math.pi, 0.0), math.pi),
        (Quat(0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0), math.pi),
        (Quat(0.0, 0.0, 0.0, 1.0), (0.0, 0.0, math.pi), 0.0),
        (Quat(-1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0),
        (Quat(-math.cos(0.1), 0.0, 0.0, -math.sin(0.1)), (0.0, 0.0, 0.2), 0.0),  # the same turn
    ),
)
def test_awkward_errors(q: Quat, error: tuple[float, float, float], angle: float) -> None:
    split = split_error(q)
    assert split.error == pytest.approx(error, abs=1e-9) and split.thrust_angle == pytest.approx(angle, abs=1e-9)


@pytest.mark.parametrize("heading", (0.0, 1.0))
@pytest.mark.parametrize(("thrust", "upright"), ((Vec3(0.0, 0.0, 0.0), 1.0), (Vec3(0.0, 0.0, 5.0), -1.0)))
def test_no_thrust_is_upright_and_thrust_down_is_upside_down(thrust: Vec3, upright: float, heading: float) -> None:
    q = thrust_quaternion(thrust, heading)
    assert cos_lean(q) == pytest.approx(upright)
    if upright > 0.0:
        assert euler_of(q).yaw == pytest.approx(heading)


@pytest.mark.parametrize("pitch", (89.5, -89.5, 90.0))
def test_euler_rates_near_the_vertical_are_those_one_degree_off(pitch: float) -> None:
    rates = euler_rates(Euler(0.0, math.radians(pitch), 0.0), Vec3(0.0, 0.0, 1.0))
    assert rates.yaw == pytest.approx(1.0 / 0.0175)
    outside = euler_rates(Euler(0.0, math.radians(88.0), 0.0), Vec3(0.0, 0.0, 1.0))
    assert outside.yaw == pytest.approx(1.0 / math.cos(math.radians(88.0)))


@pytest.mark.parametrize("off", (0, 1, 2))
def test_an_acceleration_limit_that_is_off_leaves_the_others_as_they_are(off: int) -> None:
    limit = [4.0, 5.0, 3.0]
    limit[off] = 0.0
    assert euler_accel_limits(Euler(0.5, 0.5, 0.0), Vec3(*limit)) == tuple(limit)


@pytest.mark.parametrize(
    ("roll", "pitch", "wanted"),
    (
        (0.0, 0.0, (4.0, 5.0, 3.0)),
        (90.0, 0.0, (4.0, 3.0, 5.0)),  # pitching is a turn of the body
        (0.0, 90.0, (4.0, 5.0, 4.0)),  # turning is a roll
        (30.0, 0.0, (4.0, 5.0 / math.cos(math.radians(30.0)), 3.0 / math.cos(math.radians(30.0)))),
        (60.0, 60.0, (4.0, 3.0 / math.sin(math.radians(60.0)), 4.0 / math.sin(math.radians(60.0)))),
    ),
)
def test_accelerations_of_the_angles_keep_the_bodys(
    roll: float, pitch: float, wanted: tuple[float, float, float]
) -> None:
    got = euler_accel_limits(Euler(math.radians(roll), math.radians(pitch), 0.0), Vec3(4.0, 5.0, 3.0))
    assert got == pytest.approx(wanted, rel=1e-6)
    assert euler_accel_limits(Euler(-math.radians(roll), -math.radians(pitch), 0.0), Vec3(4.0, 5.0, 3.0)) == got


def test_limits_of_angles_count_ten_percent_of_an_axis_at_least() -> None:
    got = euler_accel_limits(Euler(0.0, 0.0, 0.0), Vec3(0.1, 50.0, 99.0))
    assert got == pytest.approx((0.1, 50.0, 1.0)), "0.1 / 0.1"
    assert euler_accel_limits(Euler(0.0, 0.0, 0.0), Vec3(9.0, 50.0, 1.0)).pitch == pytest.approx(10.0)


def direct(ap: Any) -> Any:
    """Without shaping."""
    ap.params.ATC.RATE_FF_ENAB = 0.0
    return ap.control.attitude


def test_without_shaping_every_input_gives_its_target_at_once(ap: Any) -> None:
    target = direct(ap)
    heading = attitude.Heading(0.7, 0.0, True)
    attitude.input_thrust_vector_heading(*parts(ap), Vec3(0.0, 0.0, -9.8), heading)
    assert target.target_euler == pytest.approx((0.0, 0.0, 0.7)) and target.target_rate == REST
    set_attitude(ap, target.target_q)
    attitude.input_thrust_vector_heading_rate(*parts(ap), Vec3(0.0, 0.0, -9.8), 0.4)
    assert target.target_euler.yaw == pytest.approx(0.7 + 0.4 * DT)
    attitude.input_thrust_vector_heading_rate(*parts(ap), Vec3(0.0, 9.8, -9.8), 0.0)
    assert cos_lean(target.target_q) == pytest.approx(math.sqrt(0.5))
    attitude.input_quaternion(*parts(ap), turned(20.0, -10.0, 30.0), Vec3(0.1, 0.2, 0.3))
    assert target.target_q == pytest.approx(tuple(turned(20.0, -10.0, 30.0))) and target.target_rate == (0.1, 0.2, 0.3)
    attitude.input_rates(*parts(ap), Vec3(0.3, -0.2, 0.1))
    assert target.target_rate == (0.3, -0.2, 0.1)
    attitude.input_euler_roll_pitch_yaw_rate(*parts(ap), attitude.Lean(0.1, 0.2), 0.0)
    assert target.target_rate == REST


@pytest.mark.parametrize("size", (0.5, 1.0, 3.0))
def test_an_attitude_counts_whatever_the_length_of_its_quaternion(ap: Any, size: float) -> None:
    ap.params.ATC.ACCEL_R_MAX = ap.params.ATC.RATE_R_MAX = 0.0
    attitude.input_quaternion(*parts(ap), turned(20.0) * size, REST)
    assert ap.control.attitude.target_rate.x == pytest.approx(math.radians(20.0) / ap.params.ATC.INPUT_TC)


def test_no_attitude_brings_the_target_to_rest(ap: Any) -> None:
    target = ap.control.attitude
    for q in (Quat(0.0, 0.0, 0.0, 0.0), Quat(9e-4, 0.0, 0.0, 0.0), Quat(math.inf, 0.0, 0.0, 0.0)):
        target.target_rate = Vec3(1.0, 0.0, 0.0)
        attitude.input_quaternion(*parts(ap), q, REST)
        assert 0.0 < target.target_rate.x < 1.0
    direct(ap)
    attitude.input_quaternion(*parts(ap), Quat(0.0, 0.0, 0.0, 0.0), REST)
    assert target.target_rate == REST


@pytest.mark.parametrize(("slew", "fastest"), ((0.0, 99.0), (2000.0, math.radians(20.0))))
def test_a_heading_that_turns_is_followed_within_the_slew_rate(ap: Any, slew: float, fastest: float) -> None:
    ap.params.ATC.SLEW_YAW, ap.params.ATC.ACCEL_Y_MAX, ap.params.ATC.RATE_Y_MAX = slew, 0.0, 0.0
    attitude.input_thrust_vector_heading(*parts(ap), Vec3(0.0, 0.0, -9.8), attitude.Heading(0.0, 0.9, True))
    assert ap.control.attitude.target_rate.z == pytest.approx(min(0.9, fastest))


def test_a_limited_heading_moves_the_target(ap: Any) -> None:
    ap.params.ATC.ANG_YAW_P = 4.5
    target = ap.control.attitude
    target.target_q = turned(yaw=170.0)
    attitude.correct(target, ap.estimate, ap.params.ATC)
    assert abs(math.degrees(target.target_euler.yaw)) <= 45.0 + 1e-6
    assert target.cos_lean == 1.0 and target.thrust_error_angle == pytest.approx(0.0)


def test_body_rates_of_a_turn_in_a_lean() -> None:
    """Banked by 90 degrees a turn is a pitch; nose up by 90 degrees it is a roll backwards."""
    assert body_rates(Euler(math.pi / 2, 0.0, 0.0), Euler(0.0, 0.0, 1.0)) == pytest.approx((0.0, 1.0, 0.0), abs=1e-12)
    assert body_rates(Euler(0.0, math.pi / 2, 0.0), Euler(0.0, 0.0, 1.0)) == pytest.approx((-1.0, 0.0, 0.0), abs=1e-12)
    assert body_rates(Euler(math.pi / 2, 0.0, 0.0), Euler(0.0, 1.0, 0.0)) == pytest.approx((0.0, 0.0, -1.0), abs=1e-12)


@pytest.mark.parametrize(("tick", "turns"), ((0, False), (1, True)))
def test_a_jump_of_the_heading_counts_once_the_controller_runs(ap: Any, tick: int, turns: bool) -> None:
    target = ap.control.attitude
    target.error_q, ap.control.tick, ap.estimate.reset_yaw_count = LEVEL, tick, 1
    set_attitude(ap, turned(yaw=40.0))
    attitude.follow_yaw_reset(ap.control, ap.estimate)
    assert (math.degrees(target.target_euler.yaw) == pytest.approx(40.0)) == turns
    assert target.yaw_reset_count == 1
    set_attitude(ap, turned(yaw=80.0))
    attitude.follow_yaw_reset(ap.control, ap.estimate)
    assert math.degrees(target.target_euler.yaw) < 41.0, "once"


@pytest.mark.parametrize(
    ("most", "own", "wanted"), ((0.5, 3.0, 0.5), (0.0, 0.7, 0.7), (2.0, 0.7, 2.0), (0.0, 0.0, 3.0))
)
def test_a_slew_rate_replaces_the_limit_of_yaw(most: float, own: float, wanted: float) -> None:
    shaping = attitude.Shaping(True, 0.1, 0.0, REST, Vec3(0.0, 0.0, own))
    turn = attitude.shape_rotation(Vec3(0.2, -0.1, 0.3), REST, Vec3(0.4, 0.5, 0.0), shaping, most)
    assert turn == pytest.approx((2.4, -0.5, wanted)), "with what the goal turns itself"


def test_a_thrust_is_turned_to_while_the_heading_turns_with_its_own_time_constant() -> None:
    shaping = attitude.Shaping(True, 0.1, 0.25, REST, REST)
    turn = attitude.shape_thrust_turn(Vec3(0.2, -0.1, 0.7), Vec3(0.0, 0.0, 0.1), 0.9, shaping)
    assert turn == pytest.approx((2.0, -1.0, 0.1 + 0.8 * DT / 0.25))


def test_rates_are_shaped_each_with_its_acceleration() -> None:
    shaping = attitude.Shaping(True, 0.1, 0.0, Vec3(1.0, 2.0, 3.0), REST)
    assert attitude.shape_rates(Vec3(0.5, 0.5, 0.5), Vec3(9.0, -9.0, 9.0), shaping) == pytest.approx(
        (0.5 + DT, 0.5 - 2.0 * DT, 0.5 + 3.0 * DT)
    )


def test_the_series_of_a_fast_turn_is_exact_to_its_last_term() -> None:
    q = turned_by_rate(LEVEL, Vec3(0.0, 0.0, 240.0), DT)
    assert (q.w, q.z) == pytest.approx((math.cos(0.3), math.sin(0.3)), abs=2e-6)


def test_a_heading_that_is_reset_does_not_turn_but_leans_on(ap: Any) -> None:
    target = ap.control.attitude
    target.target_q, target.target_rate = (
        turned(10.0),
        body_rates(Euler(math.radians(10.0), 0.0, 0.0), Euler(0.3, 0.2, 0.5)),
    )
    attitude.reset_yaw_target(target, 1.0)
    rates = euler_rates(Euler(math.radians(10.0), 0.0, 1.0), target.target_rate)
    assert rates == pytest.approx((0.3, 0.2, 0.0), abs=1e-9)
    assert target.target_euler == pytest.approx((math.radians(10.0), 0.0, 1.0))


@pytest.mark.parametrize("bad", ((math.nan, 0.0, 0.0), (0.0, math.inf, 0.0), (0.0, 0.0, math.nan)))
def test_a_lean_that_is_no_number_keeps_the_lean_and_ends_the_turn(ap: Any, bad: tuple[float, float, float]) -> None:
    target = direct(ap)
    target.target_q = turned(10.0, -5.0, 30.0)
    set_attitude(ap, target.target_q)
    attitude.input_euler_roll_pitch_yaw_rate(*parts(ap), attitude.Lean(bad[0], bad[1]), bad[2])
    assert [math.degrees(x) for x in target.target_euler] == pytest.approx([10.0, -5.0, 30.0])


def test_a_lean_is_turned_to_with_its_time_constant_on_each_axis() -> None:
    shaping = attitude.Shaping(True, 0.1, 0.25, REST, REST)
    wanted = attitude.Lean(0.3, -0.4)
    turn = attitude.shape_euler(Euler(0.0, 0.0, 0.0), REST, wanted, 0.5, shaping)
    assert turn == pytest.approx((3.0, -4.0, 0.5 * DT / 0.25))
    assert attitude.shape_euler(Euler(0.3, 0.0, 0.0), REST, attitude.Lean(0.3, 0.0), 0.0, shaping) == REST
