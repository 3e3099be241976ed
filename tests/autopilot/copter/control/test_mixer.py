# SPDX-License-Identifier: BSD-3-Clause
"""The mixer: total thrust kept, priorities, range; and the rate loops' integrators, whose trim ends with the flight."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.copter.control import rate
from sitl.autopilot.copter.control.frames import FRAMES, HEXA, OCTA, PLUS, QUAD, X, frame_of, load_frame, order
from sitl.autopilot.copter.control.mixer import Demands, follow_boost, mix_many
from sitl.autopilot.copter.control.spool import SpoolState
from sitl.autopilot.copter.control.state import MotorsState, RateState
from sitl.autopilot.copter.parameters import TABLE, Parameters
from sitl.autopilot.copter.parameters.control import Attitude
from sitl.core.vectors import Vec3

demand = st.floats(-1.0, 1.0)
unit = st.floats(0.0, 1.0)
frame = st.sampled_from([(QUAD, PLUS), (QUAD, X)])
any_frame = st.sampled_from(sorted(FRAMES))
FLAGS = ("limit_roll", "limit_pitch", "limit_yaw", "limit_throttle_lower", "limit_throttle_upper")


def made(frame) -> tuple[MotorsState, Parameters]:
    """Motors of a frame (FRAME_CLASS, FRAME_TYPE), and its parameters."""
    motors, params = MotorsState(), Parameters()
    TABLE.set_defaults(params)
    params.FRAME.CLASS, params.FRAME.TYPE = frame
    load_frame(motors, params)
    return motors, params


def run(frame, roll, pitch, yaw, throttle, avg_max=None, throttle_max=1.0, headroom=0.2):
    motors, _ = made(frame)
    avg = throttle if avg_max is None else avg_max
    out = mix_many(motors, Demands(roll, pitch, yaw, throttle, avg, throttle_max), headroom)
    return motors, out


def demands_met(motors):
    """(roll, pitch, yaw) that the thrusts of a frame without a tilt make."""
    met = []
    for factors in (motors.roll_factor, motors.pitch_factor, motors.yaw_factor):
        parts = factors[: motors.count]
        met.append(float(parts @ motors.thrust[: motors.count] / (parts @ parts)))
    return met


@given(any_frame, demand, demand, demand, unit, unit, unit, unit)
def test_thrusts_stay_within_range(frame, roll, pitch, yaw, throttle, avg_max, throttle_max, headroom):
    motors, out = run(frame, roll, pitch, yaw, throttle, avg_max, throttle_max, headroom)
    used = motors.thrust[: motors.count]
    assert all(-1e-9 <= t <= 1.0 + 1e-9 for t in used)
    if motors.count == 4:
        assert sum(used) == pytest.approx(4 * out, abs=1e-9)


@given(frame, demand, demand, demand, unit)
def test_unsaturated_demands_come_out_unchanged(frame, roll, pitch, yaw, throttle):
    motors, out = run(frame, roll, pitch, yaw, throttle)
    if any(getattr(motors, flag) for flag in FLAGS) or out != pytest.approx(throttle):
        return
    assert demands_met(motors) == pytest.approx([roll, pitch, yaw], abs=1e-9)


def test_small_demands_are_unsaturated():
    motors, out = run((QUAD, X), 0.1, -0.1, 0.1, 0.4)
    assert not any(getattr(motors, flag) for flag in FLAGS)
    assert out == pytest.approx(0.4)


@given(frame, demand, demand, demand, st.floats(0.3, 0.7))
def test_roll_and_pitch_are_served_before_yaw(frame, roll, pitch, yaw, throttle):
    motors, _ = run(frame, 0.28 * roll, 0.28 * pitch, yaw, throttle, headroom=0.0)
    got = demands_met(motors)
    assert got[0] == pytest.approx(0.28 * roll, abs=1e-9) and got[1] == pytest.approx(0.28 * pitch, abs=1e-9)
    assert abs(got[2]) <= abs(yaw) + 1e-9
    if not motors.limit_yaw:
        assert got[2] == pytest.approx(yaw, abs=1e-9)


def test_yaw_keeps_its_headroom_against_full_roll():
    with_room, _ = run((QUAD, X), 1.0, 0.0, 1.0, 0.5, headroom=0.2)
    without, _ = run((QUAD, X), 1.0, 0.0, 1.0, 0.5, headroom=0.0)
    assert demands_met(with_room)[2] > 0.1
    assert demands_met(without)[2] == pytest.approx(0.0, abs=1e-9)
    assert with_room.limit_yaw == 1 and without.limit_yaw == 1


@given(demand, demand, demand, unit)
def test_left_and_right_of_an_x_are_mirror_images(roll, pitch, yaw, throttle):
    a, out_a = run((QUAD, X), roll, pitch, yaw, throttle)
    b, out_b = run((QUAD, X), -roll, pitch, -yaw, throttle)
    assert [b.thrust[k] for k in (2, 3, 0, 1)] == pytest.approx(list(a.thrust[:4]), abs=1e-9)
    assert out_a == pytest.approx(out_b, abs=1e-9)


def test_throttle_may_rise_for_attitude_only_as_far_as_allowed():
    low, out_low = run((QUAD, X), 0.4, 0.4, 0.0, 0.05, avg_max=0.05)
    high, out_high = run((QUAD, X), 0.4, 0.4, 0.0, 0.05, avg_max=0.4)
    assert out_low == pytest.approx(0.05) and low.limit_roll == 1
    assert out_high == pytest.approx(0.4) and high.limit_roll == 0


def test_zero_and_full_throttle_raise_their_flags():
    assert run((QUAD, PLUS), 0.0, 0.0, 0.0, 0.0)[0].limit_throttle_lower == 1
    assert run((QUAD, PLUS), 0.0, 0.0, 0.0, 1.0)[0].limit_throttle_upper == 1


@pytest.mark.parametrize(
    ("frame_type", "roll", "pitch", "yaw", "strong"),
    [
        (PLUS, 0.2, 0.0, 0.0, {1}),  # to the right: the left motor pushes
        (PLUS, 0.0, 0.2, 0.0, {2}),  # nose up: the front motor
        (PLUS, 0.0, 0.0, 0.2, {0, 1}),  # clockwise: the counter-clockwise motors
        (X, 0.2, 0.0, 0.0, {1, 2}),
        (X, 0.0, 0.2, 0.0, {0, 2}),
        (X, 0.0, 0.0, 0.2, {0, 1}),
    ],
)
def test_motors_are_numbered_as_ardupilots(frame_type, roll, pitch, yaw, strong):
    motors, out = run((QUAD, frame_type), roll, pitch, yaw, 0.5)
    assert {k for k in range(4) if motors.thrust[k] > out + 1e-9} == strong


@pytest.mark.parametrize("frame", sorted(FRAMES))
def test_every_frame_is_in_balance(frame):
    motors, _ = made(frame)
    for factors in (motors.roll_factor, motors.pitch_factor, motors.yaw_factor):
        used = factors[: motors.count]
        assert max(abs(used)) == 0.5
        assert sum(used) == pytest.approx(0.0, abs=0.11)  # the V of an octa is not quite even
    assert list(motors.output[: motors.count]) == list(range(motors.count))


@pytest.mark.parametrize(
    ("frame", "expected"),
    [
        ((QUAD, PLUS), (3, 1, 4, 2)),
        ((QUAD, X), (1, 4, 2, 3)),
        ((HEXA, PLUS), (1, 4, 6, 2, 3, 5)),
        ((HEXA, X), (5, 1, 4, 6, 2, 3)),
        ((OCTA, PLUS), (1, 3, 8, 4, 2, 6, 7, 5)),
        ((OCTA, X), (1, 3, 8, 4, 2, 6, 7, 5)),
        ((4, X), (1, 6, 4, 7, 3, 8, 2, 5)),
        ((5, PLUS), (5, 1, 6, 4, 2, 3)),
        ((5, 10), (1, 2, 3, 4, 5, 6)),
    ],
)
def test_motors_are_tested_clockwise_from_the_front(frame, expected):
    _, params = made(frame)
    assert tuple(k + 1 for k in order(params)) == expected


def test_a_frame_that_there_is_not_has_no_motors():
    assert frame_of(QUAD, 5) is None and frame_of(6, PLUS) is None
    assert frame_of(5, 7) == frame_of(5, PLUS)  # a Y6 takes any type
    motors, _ = made((6, PLUS))
    assert motors.count == 0


def test_outputs_follow_their_functions():
    motors, params = made((HEXA, X))
    assert [int(output.FUNCTION) for output in params.SERVO][:8] == [33, 34, 35, 36, 37, 38, 0, 0]
    params.SERVO[0].FUNCTION, params.SERVO[8].FUNCTION, params.SERVO[1].FUNCTION = 1, 33, 0
    load_frame(motors, params)
    assert list(motors.output) == [8, 1, 2, 3, 4, 5, -1, -1]


def test_a_plain_quad_has_four_motors_on_the_first_four_outputs():
    assert made((QUAD, X))[0].is_plain_quad and not made((HEXA, X))[0].is_plain_quad
    motors, params = made((QUAD, X))
    params.SERVO[0].FUNCTION, params.SERVO[1].FUNCTION = 34, 33
    load_frame(motors, params)
    assert not motors.is_plain_quad


def fail_motor(motors: MotorsState, demands: Demands, ticks: int) -> float:
    """Let the mixer work for a while as it does in flight; returns what it gave."""
    out = 0.0
    for _ in range(ticks):
        out = mix_many(motors, demands, 0.2)
        follow_boost(motors, 0.005, 0.005)
    return out


def test_boosting_lifts_the_limit_that_the_failing_motor_sets():
    motors, _ = made((OCTA, PLUS))
    demands = Demands(0.0, 0.6, 0.0, 0.8, 0.8, 1.0)  # nose up: motor 1, in front, is at its limit
    before = fail_motor(motors, demands, 800)
    assert motors.strongest == 0 and motors.limit_throttle_upper and before == pytest.approx(0.7)
    motors.boosting = True
    assert mix_many(motors, demands, 0.2) == pytest.approx(0.7)
    motors.boost_ratio = 1.0
    assert mix_many(motors, demands, 0.2) == pytest.approx(1.0 - 0.3 * 0.5**0.5) and motors.thrust[0] > 1.0


def test_boosting_ends_when_the_motors_share_the_work_again():
    motors, _ = made((OCTA, PLUS))
    motors.boosting, motors.boost_ratio = True, 1.0
    fail_motor(motors, Demands(0.0, 0.0, 0.0, 0.4, 0.4, 1.0), 400)
    assert not motors.boosting and motors.boost_ratio == 0.0


class Loops:
    """Rate loops with the firmware's defaults and a trim, at rest."""

    def __init__(self, trim: float, spool_state: int) -> None:
        self.rate, self.motors, self.params = RateState(), MotorsState(), Attitude()
        self.params.RAT_RLL.I = self.params.RAT_PIT.I = self.params.RAT_YAW.I = 0.1
        for loop in self.loops:
            loop.integrator = trim
        for gains in (self.params.RAT_RLL, self.params.RAT_PIT, self.params.RAT_YAW):
            gains.P, gains.IMAX = 0.135, 0.5
        self.motors.spool_state = spool_state

    @property
    def loops(self):
        return (self.rate.roll, self.rate.pitch, self.rate.yaw)

    def run(self, ticks: int = 1, target: Vec3 = Vec3(0.0, 0.0, 0.0)) -> list[float]:  # noqa: B008
        for _ in range(ticks):
            rate.control_rates(self.rate, self.motors, target, Vec3(0.0, 0.0, 0.0), self.params)
        return [loop.integrator for loop in self.loops]


def test_motors_that_stand_have_no_trim():
    assert Loops(0.2, SpoolState.SHUT_DOWN).run() == [0.0] * 3


def test_trim_decays_while_motors_idle_on_the_ground():
    loops = Loops(0.2, SpoolState.GROUND_IDLE)
    assert all(0.0 < x < 0.2 * 0.5 for x in loops.run(round(rate.RELAX_TIME / 0.0025)))
    assert loops.run(400) == pytest.approx([0.0] * 3, abs=1e-3)


def test_trim_is_kept_in_flight():
    assert Loops(0.05, SpoolState.THROTTLE_UNLIMITED).run() == pytest.approx([0.05] * 3, abs=1e-3)


def test_each_axis_follows_its_own_target():
    loops = Loops(0.0, SpoolState.THROTTLE_UNLIMITED)
    loops.run(1, Vec3(1.0, -2.0, 0.0))
    m = loops.motors
    assert m.roll > 0.0 > m.pitch and m.pitch == pytest.approx(-2.0 * m.roll) and m.yaw == 0.0


def test_a_saturated_axis_does_not_integrate():
    loops = Loops(0.0, SpoolState.THROTTLE_UNLIMITED)
    loops.motors.limit_roll = True
    roll, pitch, _ = loops.run(10, Vec3(1.0, 1.0, 0.0))
    assert roll == 0.0 and pitch > 0.0
