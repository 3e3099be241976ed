# SPDX-License-Identifier: BSD-3-Clause
"""The take-off check, and the loss of thrust in flight."""

from __future__ import annotations

import pytest

from sitl.autopilot.copter import takeoff_check, thrust_loss
from sitl.autopilot.copter.takeoff_check import TAKEOFF_BLOCKED
from sitl.autopilot.copter.thrust_loss import THRUST_LOST
from tests.autopilot.copter.steady_copter import codes, fly, make


def tell(v, rpm, motors=4):
    """The controllers of all motors tell a speed now."""
    v.sensors.esc_motors, v.sensors.esc_time_us = motors, v.time_us
    v.sensors.esc_count += 1
    v.sensors.esc_rpm[:motors] = rpm


def check(v, seconds, rpm=None):
    for _ in range(round(seconds * 10)):
        v.time_us += 100_000
        if rpm is not None:
            tell(v, rpm)
        takeoff_check.check(v)


@pytest.fixture
def v():
    found = make()
    found.autopilot.params.TKOFF.RPM_MIN = 1000.0
    check(found, 0.1)
    found.autopilot.arming.armed = True
    return found


def test_without_limits_nothing_is_checked(v):
    v.autopilot.params.TKOFF.RPM_MIN = 0.0
    check(v, 0.1)
    assert not v.autopilot.control.motors.blocked


@pytest.mark.parametrize(("rpm", "why"), [(None, takeoff_check.NO_TELEMETRY), (500.0, takeoff_check.OUT_OF_RANGE)])
def test_blocked_and_told_every_five_seconds(v, rpm, why):
    check(v, 11.0, rpm)
    assert v.autopilot.control.motors.blocked
    assert codes(v) == [TAKEOFF_BLOCKED] * 2 and v.autopilot.events.a[0] == why


@pytest.mark.parametrize(("rpm", "blocked"), [(999.0, True), (1000.0, False), (3000.0, False), (3001.0, True)])
def test_both_limits(v, rpm, blocked):
    v.autopilot.params.TKOFF.RPM_MAX = 3000.0
    check(v, 0.1, rpm)
    assert v.autopilot.control.motors.blocked == blocked


def test_motors_that_once_turned_well_are_not_blocked_again(v):
    check(v, 0.1, 1500.0)
    check(v, 10.0, 0.0)
    assert not v.autopilot.control.motors.blocked and codes(v) == []


def sink(v, ticks, throttle=0.95, vel_d=1.0):
    v.autopilot.control.attitude.throttle_in = throttle
    v.autopilot.estimate.vel = v.autopilot.estimate.vel.replace(z=vel_d)
    for _ in range(ticks):
        thrust_loss.check(v)


@pytest.fixture
def flying():
    found = fly(make())
    motors = found.autopilot.control.motors
    motors.thrust[:4] = (0.6, 0.6, 1.0, 0.6)
    return found


def test_sinking_at_full_throttle_boosts(flying):
    sink(flying, thrust_loss.TRIGGER_TICKS - 1)
    assert not flying.autopilot.control.motors.boosting
    sink(flying, 1)
    assert flying.autopilot.control.motors.boosting and codes(flying) == [THRUST_LOST]
    assert flying.autopilot.events.a[0] == 3.0


@pytest.mark.parametrize("change", ["climbs", "little throttle", "leans", "tumbles", "landed", "switched off"])
def test_what_is_no_loss_of_thrust(flying, change):
    ap = flying.autopilot
    throttle, vel_d = (0.2 if change == "little throttle" else 0.95), (-0.1 if change == "climbs" else 1.0)
    if change == "leans":
        ap.control.attitude.target_euler = (0.3, 0.0, 0.0)
    elif change == "tumbles":
        ap.control.attitude.thrust_error_angle = 0.6
    elif change == "landed":
        ap.arming.landed = True
    elif change == "switched off":
        ap.params.FLIGHT_OPTIONS = 1.0
    sink(flying, 500, throttle, vel_d)
    assert codes(flying) == [] and not ap.control.motors.boosting
