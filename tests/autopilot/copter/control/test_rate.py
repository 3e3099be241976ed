# SPDX-License-Identifier: BSD-3-Clause
"""The rate loops' integrators: a flight's trim ends with the flight."""

from __future__ import annotations

import pytest

from sitl.autopilot.copter.control import motors, rate
from sitl.autopilot.copter.control.state import MotorsState, RateState
from sitl.autopilot.copter.parameters.control import Attitude
from sitl.core.vectors import Vec3


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
