# SPDX-License-Identifier: BSD-3-Clause
"""Where the nose points."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.copter.control.state import AttitudeState, PositionState
from sitl.autopilot.copter.modes import auto_yaw, mode_commands
from sitl.autopilot.copter.modes.auto_yaw import Turn
from sitl.autopilot.copter.modes.state import AutoYaw, Modes
from sitl.autopilot.copter.parameters.flight_modes import Waypoints
from sitl.autopilot.state import Estimate
from sitl.core.scalars import wrap_pi
from sitl.core.vectors import Vec2, Vec3
from tests.autopilot.copter.steady_copter import fly, make, turn_to

DEG = math.pi / 180.0


def turned(v, start, seconds=20.0):
    """(angle turned [deg], when it was done [s])."""
    ap = v.autopilot
    total, before, done = 0.0, start, 0.0
    for k in range(round(seconds / 0.0025)):
        now, _rate, _ = auto_yaw.advance(ap.modes.auto_yaw, ap.control.pos_ne, ap.control.attitude, ap.estimate, 0.0025)
        step = wrap_pi(now - before)
        total, before = total + step, now
        if abs(step) > 1e-9:
            done = k * 0.0025
    return total / DEG, done


@pytest.mark.parametrize(
    ("start", "angle", "direction", "relative", "total"),
    (
        (0.0, 90.0, 1, 0, 90.0),
        (0.0, 90.0, -1, 0, -270.0),
        (0.0, 90.0, 0, 0, 90.0),
        (170.0, -170.0, 0, 0, 20.0),
        (-0.1, 0.0, 1, 0, 0.1),
        (0.1, 0.0, 1, 0, 359.9),
        (0.1, 0.0, -1, 0, -0.1),
        (-0.1, 0.0, -1, 0, -359.9),
        (30.0, 45.0, 1, 1, 45.0),
        (30.0, 45.0, -1, 1, -45.0),
        (30.0, 400.0, 1, 1, 400.0),
    ),
)
def test_fixed_angle_goes_the_way_asked_for(flying, start, angle, direction, relative, total):
    turn_to(flying, start * DEG)
    assert mode_commands.condition_yaw(flying.autopilot, Turn(angle * DEG, 0.0, direction, relative)) == 0
    assert turned(flying, start * DEG)[0] == pytest.approx(total, abs=1e-6)


@pytest.mark.parametrize(("rate", "seconds"), ((30.0, 3.0), (0.0, 1.5), (500.0, 1.5)))
def test_turn_rate_is_the_one_asked_for_up_to_the_slew_limit(flying, rate, seconds):
    mode_commands.condition_yaw(flying.autopilot, Turn(90.0 * DEG, rate * DEG, 1, 0))
    assert turned(flying, 0.0)[1] == pytest.approx(seconds, abs=0.01)


def test_without_a_slew_limit_it_turns_at_once(flying):
    flying.autopilot.params.ATC_SLEW_YAW = 0.0
    mode_commands.condition_yaw(flying.autopilot, Turn(90.0 * DEG, 0.0, 1, 0))
    assert turned(flying, 0.0, 1.0)[0] == pytest.approx(90.0)


@given(st.floats(-50.0, 50.0), st.floats(-3.1, 3.1), st.sampled_from((-1, 0, 1)))
def test_absolute_turns_end_at_the_angle_within_one_circle(angle, start, direction):
    v = fly(make())
    turn_to(v, start)
    mode_commands.condition_yaw(v.autopilot, Turn(angle, 0.0, direction, 0))
    offset = float(v.autopilot.modes.auto_yaw.offset)
    assert abs(offset) <= 2.0 * math.pi
    assert abs(wrap_pi(start + offset - angle)) < 1e-6
    assert offset * direction >= 0.0


def test_condition_yaw_refuses_what_it_cannot_do(flying):
    assert mode_commands.condition_yaw(flying.autopilot, Turn(math.nan, 0.0, 1, 0)) == 1
    assert mode_commands.condition_yaw(flying.autopilot, Turn(1.0, -1.0, 1, 0)) == 3
    flying.autopilot.modes.number = 5
    assert mode_commands.condition_yaw(flying.autopilot, Turn(1.0, 0.0, 1, 0)) == 0, "taken in any mode"


@pytest.mark.parametrize(
    ("behaviour", "rtl", "mode"),
    (
        (0, 0, auto_yaw.HOLD),
        (1, 0, auto_yaw.LOOK_AT_NEXT_WP),
        (1, 1, auto_yaw.LOOK_AT_NEXT_WP),
        (2, 0, auto_yaw.LOOK_AT_NEXT_WP),
        (2, 1, auto_yaw.HOLD),
        (3, 0, auto_yaw.LOOK_AHEAD),
    ),
)
def test_default_is_a_parameter(behaviour, rtl, mode):
    yaw, params = AutoYaw(), Waypoints()
    yaw.mode, params.YAW_BEHAVIOR = auto_yaw.ROI, float(behaviour)
    auto_yaw.set_default(yaw, params, rtl, AttitudeState(), Estimate())
    assert yaw.mode == mode


def heading(yaw: AutoYaw, path: PositionState, estimate: Estimate, target: AttitudeState | None = None) -> float:
    """Where the nose points after a tick."""
    return auto_yaw.advance(yaw, path, target or AttitudeState(), estimate, 0.0025).angle


def test_nose_follows_the_desired_velocity_but_not_a_slow_one():
    yaw, path, estimate = AutoYaw(), PositionState(), Estimate()
    auto_yaw.set_mode(yaw, auto_yaw.LOOK_AT_NEXT_WP, AttitudeState(), estimate)
    path.speed_max, path.vel_desired = 10.0, Vec2(0.0, 0.4)
    assert heading(yaw, path, estimate) == 0.0
    path.vel_desired = Vec2(0.0, 3.0)
    assert heading(yaw, path, estimate) == pytest.approx(math.pi / 2)
    path.vel_desired = Vec2(0.0, 0.0)
    target = AttitudeState()
    target.target_euler = (0.0, 0.0, 0.7)  # on the way to it
    assert heading(yaw, path, estimate, target) == pytest.approx(0.7)
    assert heading(yaw, path, estimate, target) == pytest.approx(0.7)


def test_the_nose_stays_where_it_is_until_the_vehicle_moves():
    yaw, path, estimate = AutoYaw(), PositionState(), Estimate()
    estimate.euler = (0.0, 0.0, 0.8)
    auto_yaw.set_mode(yaw, auto_yaw.LOOK_AHEAD, AttitudeState(), estimate)
    assert heading(yaw, path, estimate) == pytest.approx(0.8)


def test_roi_is_looked_at_from_anywhere(flying):
    ap = flying.autopilot
    mode_commands.set_roi(ap, Vec3(10.0, 10.0, 0.0))
    assert heading(ap.modes.auto_yaw, ap.control.pos_ne, ap.estimate) == pytest.approx(math.pi / 4)
    ap.estimate.pos = ap.estimate.pos.replace(x=20.0)
    assert heading(ap.modes.auto_yaw, ap.control.pos_ne, ap.estimate) == pytest.approx(3 * math.pi / 4)
    mode_commands.clear_roi(ap)
    assert ap.modes.auto_yaw.mode == auto_yaw.LOOK_AT_NEXT_WP


def test_the_pilot_may_turn_and_the_heading_stays_where_he_left_it():
    modes, target, estimate = Modes(), AttitudeState(), Estimate()
    modes.pilot.yaw_rate = 0.5
    auto_yaw.follow_pilot(modes, target, estimate)
    assert auto_yaw.advance(modes.auto_yaw, PositionState(), target, estimate, 0.0025) == (0.0, 0.5, False)
    modes.pilot.yaw_rate = 0.0
    auto_yaw.follow_pilot(modes, target, estimate)
    assert modes.auto_yaw.mode == auto_yaw.HOLD
