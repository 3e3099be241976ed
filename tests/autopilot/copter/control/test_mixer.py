# SPDX-License-Identifier: BSD-3-Clause
"""The mixer: total thrust kept, priorities, range; and the rate loops' integrators, whose trim ends with the flight."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.copter.control import motors, rate
from sitl.autopilot.copter.control.mixer import PLUS, Demands, X, factors, mix
from sitl.autopilot.copter.control.state import MotorsState, RateState
from sitl.autopilot.copter.parameters.control import Attitude
from sitl.core.vectors import Vec3

demand = st.floats(-1.0, 1.0)
unit = st.floats(0.0, 1.0)
frame = st.sampled_from([PLUS, X])
FLAGS = ("limit_roll", "limit_pitch", "limit_yaw", "limit_throttle_lower", "limit_throttle_upper")


def run(frame_type, roll, pitch, yaw, throttle, avg_max=None, throttle_max=1.0, headroom=0.2):
    motors = MotorsState()
    avg = throttle if avg_max is None else avg_max
    out = mix(motors, frame_type, Demands(roll, pitch, yaw, throttle, avg, throttle_max), headroom)
    return motors, out


def demands_met(frame_type, motors):
    """(roll, pitch, yaw) that the four thrusts make."""
    sums = [0.0, 0.0, 0.0]
    weight = [0.0, 0.0, 0.0]
    for k in range(4):
        for j, f in enumerate(factors(frame_type, k)):
            sums[j] += f * motors.thrust[k]
            weight[j] += f * f
    return [s / w for s, w in zip(sums, weight, strict=True)]


@given(frame, demand, demand, demand, unit, unit, unit, unit)
def test_thrusts_stay_within_range(frame_type, roll, pitch, yaw, throttle, avg_max, throttle_max, headroom):
    motors, out = run(frame_type, roll, pitch, yaw, throttle, avg_max, throttle_max, headroom)
    assert all(-1e-9 <= t <= 1.0 + 1e-9 for t in motors.thrust)
    assert sum(motors.thrust) == pytest.approx(4 * out, abs=1e-9)


@given(frame, demand, demand, demand, unit)
def test_unsaturated_demands_come_out_unchanged(frame_type, roll, pitch, yaw, throttle):
    motors, out = run(frame_type, roll, pitch, yaw, throttle)
    if any(getattr(motors, flag) for flag in FLAGS) or out != pytest.approx(throttle):
        return
    assert demands_met(frame_type, motors) == pytest.approx([roll, pitch, yaw], abs=1e-9)


def test_small_demands_are_unsaturated():
    motors, out = run(X, 0.1, -0.1, 0.1, 0.4)
    assert not any(getattr(motors, flag) for flag in FLAGS)
    assert out == pytest.approx(0.4)


@given(frame, demand, demand, demand, st.floats(0.3, 0.7))
def test_roll_and_pitch_are_served_before_yaw(frame_type, roll, pitch, yaw, throttle):
    motors, _ = run(frame_type, 0.28 * roll, 0.28 * pitch, yaw, throttle, headroom=0.0)
    got = demands_met(frame_type, motors)
    assert got[0] == pytest.approx(0.28 * roll, abs=1e-9) and got[1] == pytest.approx(0.28 * pitch, abs=1e-9)
    assert abs(got[2]) <= abs(yaw) + 1e-9
    if not motors.limit_yaw:
        assert got[2] == pytest.approx(yaw, abs=1e-9)


def test_yaw_keeps_its_headroom_against_full_roll():
    with_room, _ = run(X, 1.0, 0.0, 1.0, 0.5, headroom=0.2)
    without, _ = run(X, 1.0, 0.0, 1.0, 0.5, headroom=0.0)
    assert demands_met(X, with_room)[2] > 0.1
    assert demands_met(X, without)[2] == pytest.approx(0.0, abs=1e-9)
    assert with_room.limit_yaw == 1 and without.limit_yaw == 1


@given(demand, demand, demand, unit)
def test_left_and_right_of_an_x_are_mirror_images(roll, pitch, yaw, throttle):
    a, out_a = run(X, roll, pitch, yaw, throttle)
    b, out_b = run(X, -roll, pitch, -yaw, throttle)
    assert [b.thrust[k] for k in (2, 3, 0, 1)] == pytest.approx(list(a.thrust), abs=1e-9)
    assert out_a == pytest.approx(out_b, abs=1e-9)


def test_throttle_may_rise_for_attitude_only_as_far_as_allowed():
    low, out_low = run(X, 0.4, 0.4, 0.0, 0.05, avg_max=0.05)
    high, out_high = run(X, 0.4, 0.4, 0.0, 0.05, avg_max=0.4)
    assert out_low == pytest.approx(0.05) and low.limit_roll == 1
    assert out_high == pytest.approx(0.4) and high.limit_roll == 0


def test_zero_and_full_throttle_raise_their_flags():
    assert run(PLUS, 0.0, 0.0, 0.0, 0.0)[0].limit_throttle_lower == 1
    assert run(PLUS, 0.0, 0.0, 0.0, 1.0)[0].limit_throttle_upper == 1


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
    motors, out = run(frame_type, roll, pitch, yaw, 0.5)
    assert {k for k in range(4) if motors.thrust[k] > out + 1e-9} == strong


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
    assert Loops(0.2, motors.SHUT_DOWN).run() == [0.0] * 3


def test_trim_decays_while_motors_idle_on_the_ground():
    loops = Loops(0.2, motors.GROUND_IDLE)
    assert all(0.0 < x < 0.2 * 0.5 for x in loops.run(round(rate.RELAX_TIME / 0.0025)))
    assert loops.run(400) == pytest.approx([0.0] * 3, abs=1e-3)


def test_trim_is_kept_in_flight():
    assert Loops(0.05, motors.THROTTLE_UNLIMITED).run() == pytest.approx([0.05] * 3, abs=1e-3)


def test_each_axis_follows_its_own_target():
    loops = Loops(0.0, motors.THROTTLE_UNLIMITED)
    loops.run(1, Vec3(1.0, -2.0, 0.0))
    m = loops.motors
    assert m.roll > 0.0 > m.pitch and m.pitch == pytest.approx(-2.0 * m.roll) and m.yaw == 0.0


def test_a_saturated_axis_does_not_integrate():
    loops = Loops(0.0, motors.THROTTLE_UNLIMITED)
    loops.motors.limit_roll = True
    roll, pitch, _ = loops.run(10, Vec3(1.0, 1.0, 0.0))
    assert roll == 0.0 and pitch > 0.0
