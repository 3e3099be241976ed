# SPDX-License-Identifier: BSD-3-Clause
"""The rate loops' integrators: a flight's trim ends with the flight."""

from __future__ import annotations

import pytest

from sitl.autopilot.copter.control import motors, rate


def integrators(ap) -> list[float]:
    loops = ap.control.rate
    return [float(loop.integrator) for loop in (loops.roll, loops.pitch, loops.yaw)]


def set_integrators(ap, value: float) -> None:
    for loop in (ap.control.rate.roll, ap.control.rate.pitch, ap.control.rate.yaw):
        loop.integrator = value


def test_motors_that_stand_have_no_trim(ap):
    set_integrators(ap, 0.2)
    ap.control.motors.spool_state = motors.SHUT_DOWN
    rate.update(ap)
    assert integrators(ap) == pytest.approx([0.0] * 3, abs=1e-9)


def test_trim_decays_while_motors_idle_on_the_ground(ap):
    set_integrators(ap, 0.2)
    ap.control.motors.spool_state = motors.GROUND_IDLE
    for _ in range(round(rate.RELAX_TIME / 0.0025)):
        rate.update(ap)
    assert all(0.0 < abs(x) < 0.2 * 0.5 for x in integrators(ap))
    for _ in range(400):
        rate.update(ap)
    assert integrators(ap) == pytest.approx([0.0] * 3, abs=1e-3)


def test_trim_is_kept_in_flight(ap):
    set_integrators(ap, 0.05)
    ap.control.motors.spool_state = motors.THROTTLE_UNLIMITED
    rate.update(ap)
    assert integrators(ap) == pytest.approx([0.05] * 3, abs=1e-3)
