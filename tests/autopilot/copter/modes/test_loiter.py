# SPDX-License-Identifier: BSD-3-Clause
"""LOITER and POSHOLD: how far and how fast sticks take them, how they brake and hold, also over a landing target."""

from __future__ import annotations

import itertools
import math
from typing import Any

import pytest

from sitl.autopilot.avoidance import limit
from sitl.autopilot.control.shaping import Motion2
from sitl.autopilot.copter import avoidance
from sitl.autopilot.copter.control.attitude import Lean
from sitl.autopilot.copter.modes import loiter, poshold
from sitl.autopilot.copter.modes.state import LoiterState
from sitl.autopilot.modes import ModeResult
from sitl.core.vectors import Vec2
from tests.autopilot.copter.modes.obedient_copter import MODE, hovering, move, ticks, turn_body

GRAVITY = 9.80665
REST = Vec2(0.0, 0.0)
LIMITS = loiter.Limits(10.0, 5.0, 1.0, 2.5, 5.0)
DT = 0.0025


@pytest.mark.parametrize(
    ("lean", "of_position", "of_loiter", "wanted"),
    (
        (30.0, 0.0, 0.0, 20.0),  # two thirds of ANGLE_MAX
        (30.0, 0.0, 25.0, 25.0),  # LOIT_ANG_MAX
        (30.0, 0.0, 45.0, 30.0),  # no more than ANGLE_MAX
        (30.0, 15.0, 0.0, 10.0),  # PSC_ANGLE_MAX replaces ANGLE_MAX where that is less
        (30.0, 45.0, 0.0, 20.0),
        (30.0, 15.0, 20.0, 15.0),
    ),
)
def test_the_lean_of_a_full_stick(lean: float, of_position: float, of_loiter: float, wanted: float) -> None:
    p = hovering("LOITER").autopilot.params
    p.ANGLE_MAX, p.PSC.ANGLE_MAX, p.LOIT.ANG_MAX = lean * 100.0, of_position, of_loiter
    assert math.degrees(loiter.angle_max(p)) == pytest.approx(wanted)


def test_limits_are_those_of_the_parameters() -> None:
    p = hovering("LOITER").autopilot.params
    p.LOIT.SPEED, p.LOIT.BRK_ACCEL, p.LOIT.BRK_JERK, p.LOIT.ANG_MAX = 800.0, 150.0, 400.0, 20.0
    p.PSC.VELXY.P = 3.0
    wanted = (8.0, GRAVITY * math.tan(math.radians(20.0)), 1.5, 1.5, 4.0)
    assert tuple(loiter.limits(p)) == pytest.approx(wanted, rel=1e-6)
    p.LOIT.SPEED = 0.0
    assert loiter.limits(p).speed_max == 0.2


@pytest.mark.parametrize(
    ("roll", "pitch", "yaw", "way"),
    ((1.0, 0.0, 0.0, (0, 1)), (0.0, -1.0, 0.0, (1, 0)), (0.0, -1.0, math.pi / 2, (0, 1)), (-1.0, 0.0, 0.0, (0, -1))),
)
def test_sticks_fly_it_in_the_direction_of_the_nose(
    roll: float, pitch: float, yaw: float, way: tuple[int, int]
) -> None:
    v = hovering("LOITER")
    turn_body(v, 0.0, 0.0, yaw)
    assert loiter.start(v) == ModeResult.ACCEPTED
    v.autopilot.modes.pilot.roll, v.autopilot.modes.pilot.pitch = roll, pitch
    ticks(v, MODE["LOITER"].run, 120)
    vel = v.autopilot.control.pos_ne.vel_desired
    assert vel.x * way[0] + vel.y * way[1] > 0.1
    assert abs(vel.x * way[1]) + abs(vel.y * way[0]) == pytest.approx(0.0, abs=1e-6)


def test_a_full_stick_flies_at_loit_speed_in_the_end() -> None:
    """Drag balances it there."""
    state, path = LoiterState(), Motion2(REST, Vec2(9.9, 0.0), REST)
    state.acc = state.predicted_acc = Vec2(LIMITS.accel_full, 0.0)
    for _ in range(1200):
        path = loiter.advance_path(state, path, LIMITS, False)
    assert path.vel == pytest.approx((10.0, 0.0), abs=0.05)
    fast = loiter.advance_path(state, Motion2(REST, Vec2(0.0, -14.0), REST), LIMITS, False)
    assert math.hypot(*fast.vel) == 10.0, "never faster"


def test_the_path_moves_with_its_velocity_and_drag_slows_it_down() -> None:
    state = LoiterState()
    path = loiter.advance_path(state, Motion2(Vec2(3.0, 4.0), Vec2(4.0, 0.0), REST), LIMITS, False)
    assert path.vel == pytest.approx((4.0 - 5.0 * 0.4 * DT, 0.0))
    assert path.pos == pytest.approx((3.0 + path.vel.x * DT, 4.0))
    assert state.brake_acc == 0.0 and path.acc == REST


def test_the_brake_grows_with_its_jerk_up_to_its_limit_and_fades_with_the_speed() -> None:
    state, path = LoiterState(), Motion2(REST, Vec2(8.0, 0.0), REST)
    brakes = []
    for _ in range(1600):
        path = loiter.advance_path(state, path, LIMITS, True)
        brakes.append(float(state.brake_acc))
        assert path.acc.x == pytest.approx(-brakes[-1] if path.vel.x > 1e-6 else path.acc.x)
    assert brakes[0] == pytest.approx(LIMITS.brake_jerk * DT)
    assert max(brakes) == pytest.approx(LIMITS.brake_accel)
    steps = [abs(b - a) for a, b in itertools.pairwise(brakes)]
    assert max(steps) == pytest.approx(LIMITS.brake_jerk * DT)
    assert brakes[-1] < 0.2 and path.vel.x < 0.1


def test_a_brake_is_let_go_with_the_same_jerk() -> None:
    state = LoiterState()
    state.brake_acc = 2.0
    loiter.advance_path(state, Motion2(REST, Vec2(4.0, 0.0), REST), LIMITS, False)
    assert state.brake_acc == pytest.approx(2.0 - LIMITS.brake_jerk * DT)


@pytest.mark.parametrize(
    ("lean", "wanted"), ((Lean(0.0, 0.0), (0.0, 0.0)), (Lean(0.2, 0.0), (0.0, 1.0)), (Lean(0.0, 0.2), (-1.0, 0.0)))
)
def test_a_lean_asks_for_its_acceleration_and_is_followed_as_the_attitude_controller_would(
    lean: Lean, wanted: tuple[float, float]
) -> None:
    state, p = LoiterState(), hovering("LOITER").autopilot.params.ATC
    for _ in range(400):
        loiter.predict_accel(state, lean, 0.0, p)
    size = GRAVITY * math.tan(0.2)
    assert state.acc == pytest.approx((wanted[0] * size, wanted[1] * size))
    assert state.predicted_acc == pytest.approx(tuple(state.acc), rel=1e-2, abs=1e-6)
    assert state.predicted_euler == pytest.approx((lean.roll, lean.pitch), abs=1e-3)


def test_what_is_predicted_lags_behind_the_stick() -> None:
    state, p = LoiterState(), hovering("LOITER").autopilot.params.ATC
    p.ACCEL_R_MAX = p.ACCEL_P_MAX = 18000.0
    loiter.predict_accel(state, Lean(0.3, -0.2), 0.0, p)
    rate = math.radians(180.0) * DT
    assert state.predicted_rate == pytest.approx((rate, -rate))
    assert state.predicted_euler == pytest.approx((rate * DT, -rate * DT))


def test_it_begins_with_the_lean_that_there_is_and_does_not_brake() -> None:
    v = hovering("LOITER")
    state = v.autopilot.modes.loiter
    turn_body(v, 0.2, -0.1, 0.5)
    state.brake_acc, state.predicted_rate = 1.0, Vec2(1.0, 1.0)
    loiter.start(v)
    assert state.predicted_euler == pytest.approx((0.2, -0.1))
    assert (state.predicted_rate, state.brake_acc) == ((0.0, 0.0), 0.0)
    forward = state.predicted_acc.x * math.cos(0.5) + state.predicted_acc.y * math.sin(0.5)
    assert forward == pytest.approx(GRAVITY * math.tan(0.1), rel=0.02)


def test_it_takes_the_present_motion_over() -> None:
    v = hovering("LOITER")
    move(v, 2.0, -1.0, 0.3)
    loiter.start(v)
    control = v.autopilot.control
    assert (control.pos_ne.vel_desired, control.pos_d.vel_desired) == ((2.0, -1.0), 0.3)
    assert (control.pos_ne.speed_max, control.pos_ne.accel_max) == (12.5, 5.0), "LOIT_SPEED, LOIT_ACC_MAX"


def test_a_controller_that_runs_goes_on() -> None:
    v = hovering("LOITER")
    control = v.autopilot.control
    control.pos_ne.last_tick = control.pos_d.last_tick = control.tick
    control.pos_ne.vel_desired, control.pos_d.vel_desired = Vec2(1.5, 0.0), -0.4
    loiter.start(v)
    assert (control.pos_ne.vel_desired, control.pos_d.vel_desired) == ((1.5, 0.0), -0.4)


@pytest.mark.parametrize(("options", "turns"), ((0.0, False), (1.0, True), (2.0, False)))
def test_a_turn_is_coordinated_with_the_option(options: float, turns: bool) -> None:
    v = hovering("LOITER")
    v.autopilot.params.LOIT.OPTIONS = options
    move(v, 5.0, 0.0, 0.0)
    loiter.start(v)
    v.autopilot.control.attitude.target_rate = v.autopilot.control.attitude.target_rate.replace(z=0.5)
    ticks(v, MODE["LOITER"].run)
    assert v.autopilot.modes.loiter.acc == pytest.approx((0.0, 2.5 if turns else 0.0))


def test_the_path_softens_where_it_may_stand_on_the_ground() -> None:
    for maybe in (0, 1):
        v = hovering("LOITER")
        loiter.start(v)
        path = v.autopilot.control.pos_ne
        path.pos_desired, v.autopilot.arming.landed_maybe = Vec2(1.0, 0.0), maybe
        ticks(v, MODE["LOITER"].run)
        assert (path.pos_desired.x < 1.0) == bool(maybe)
        if maybe:
            assert path.pos_desired.x == pytest.approx(1.0 - DT / (DT + 0.16))


def test_what_is_in_the_way_limits_the_velocity(monkeypatch: Any) -> None:
    v = hovering("LOITER")
    move(v, 4.0, 0.0, 0.0)
    loiter.start(v)
    monkeypatch.setattr(loiter, "is_active", lambda avoid: True)
    monkeypatch.setattr(avoidance, "limit_velocity", lambda v, vel: Vec2(1.0, 0.0))
    loiter.fly_by_sticks(v)
    path = v.autopilot.control.pos_ne
    assert (path.vel_desired, path.pos_desired) == ((1.0, 0.0), (DT, 0.0))
    assert limit.is_active(v.autopilot.avoid) == 0


@pytest.mark.parametrize(
    ("seeks", "acc", "seen", "maybe_landed", "holds"),
    (
        (1, 0.0, 1, 0, True),
        (0, 0.0, 1, 0, False),
        (1, 0.49, 1, 0, True),
        (1, 0.5, 1, 0, False),
        (1, -0.6, 1, 0, False),
        (1, 0.0, 0, 0, False),
        (1, 0.0, 1, 1, False),
    ),
)
@pytest.mark.parametrize("was_there", (0, 1))
def test_it_holds_over_a_target_that_it_seeks_and_sees_while_the_sticks_rest(
    was_there: int, seeks: int, acc: float, seen: int, maybe_landed: int, holds: bool
) -> None:
    ap = hovering("LOITER").autopilot
    state = ap.modes.loiter
    state.seeks_target, state.on_target, state.acc = seeks, was_there, Vec2(0.0, acc)
    state.brake_acc, state.predicted_acc = 1.0, Vec2(1.0, 0.0)
    ap.landing_target.acquired, ap.arming.landed_maybe = seen, maybe_landed
    assert bool(loiter.hover_over_target(ap)) == holds == bool(state.on_target)
    leaves = was_there and not holds
    assert (state.brake_acc, state.predicted_acc) == ((0.0, REST) if leaves else (1.0, (1.0, 0.0)))


@pytest.mark.parametrize("yaw", (0.0, 0.8, -2.0))
@pytest.mark.parametrize("wind", ((1.0, 0.0), (0.0, -1.0), (0.7, 0.4)))
def test_the_lean_against_the_wind_accelerates_as_it_must(wind: tuple[float, float], yaw: float) -> None:
    lean = poshold.wind_lean(Vec2(*wind), yaw)
    forward, right = -GRAVITY * math.tan(lean.pitch), GRAVITY * math.tan(lean.roll) / math.cos(lean.pitch)
    north = forward * math.cos(yaw) - right * math.sin(yaw)
    east = forward * math.sin(yaw) + right * math.cos(yaw)
    assert (north, east) == pytest.approx(wind)


@pytest.mark.parametrize(("speed", "holds"), ((0.49, True), (0.51, False)))
def test_poshold_holds_at_once_when_it_is_slow(speed: float, holds: bool) -> None:
    v = hovering("POSHOLD")
    state = v.autopilot.modes.poshold
    state.wind = Vec2(1.0, 1.0)
    state.roll.lean = state.pitch.held = 0.3
    move(v, 0.0, speed, 0.0)
    assert poshold.start(v) == ModeResult.ACCEPTED
    assert bool(state.holding) == holds and state.wind == REST
    for axis in (state.roll, state.pitch):
        assert (axis.phase, axis.lean, axis.held) == (poshold.STOPPED if holds else poshold.BRAKING, 0.0, 0.0)
        assert axis.since_us == v.time_us


@pytest.mark.parametrize("yaw", (0.0, math.pi / 2))
def test_poshold_brakes_against_its_motion_in_its_own_axes(yaw: float) -> None:
    v = hovering("POSHOLD")
    turn_body(v, 0.0, 0.0, yaw)
    move(v, 3.0 * math.cos(yaw) - 2.0 * math.sin(yaw), 3.0 * math.sin(yaw) + 2.0 * math.cos(yaw), 0.0)
    poshold.start(v)
    ticks(v, MODE["POSHOLD"].run, 20)
    state = v.autopilot.modes.poshold
    step = math.radians(v.autopilot.params.PHLD.BRAKE_RATE) * DT * 20
    assert (state.pitch.lean, state.roll.lean) == pytest.approx((step, -step)), "back, and to the left"
    lean = v.autopilot.control.attitude.target_euler
    assert (lean.pitch, lean.roll) == pytest.approx((step, -step))


def test_poshold_holds_once_both_axes_have_stopped_and_starts_from_what_it_knows_of_the_wind() -> None:
    v = hovering("POSHOLD")
    poshold.start(v)
    state = v.autopilot.modes.poshold
    state.holding, state.wind = 0, Vec2(0.5, -0.3)
    state.roll.phase, state.pitch.phase = poshold.STOPPED, poshold.FLOWN
    state.pitch.lean = 0.2
    ticks(v, MODE["POSHOLD"].run)
    assert not state.holding
    state.pitch.phase = poshold.STOPPED
    ticks(v, MODE["POSHOLD"].run)
    assert state.holding
    assert v.autopilot.control.pos_ne.vel_integrator == pytest.approx((0.5, -0.3), abs=1e-2)


@pytest.mark.parametrize(("speed", "learns"), ((0.0, True), (0.2, False)))
def test_poshold_learns_the_wind_while_it_stands(speed: float, learns: bool) -> None:
    v = hovering("POSHOLD")
    ap = v.autopilot
    poshold.start(v)
    move(v, speed, 0.0, 0.0)
    ap.control.pos_ne.last_tick = ap.control.tick + 1
    ap.control.pos_ne.vel_integrator = Vec2(0.4, 0.0)
    ap.control.tick += 1
    poshold.hold(ap.modes.poshold, 0.0, False, ap.control, ap.estimate, ap.params)
    learnt = ap.control.pos_ne.accel_target.x * DT / (DT + 2.5)
    assert ap.modes.poshold.wind.x == pytest.approx(learnt if learns else 0.0)
    assert ap.control.pos_ne.accel_target.x != 0.0


def test_the_lean_of_poshold_stays_within_angle_max_with_the_wind() -> None:
    for sign in (1.0, -1.0):
        v = hovering("POSHOLD")
        ap = v.autopilot
        state = ap.modes.poshold
        state.roll.lean, state.pitch.lean, state.wind = 0.5 * sign, 0.5 * sign, Vec2(-5.0 * sign, 5.0 * sign)
        poshold.lean_back(state, 0.0, ap.control, ap.estimate, ap.params)
        lean = ap.control.attitude.target_euler
        assert (math.degrees(lean.roll), math.degrees(lean.pitch)) == pytest.approx((30.0 * sign, 30.0 * sign))


def test_poshold_softens_where_it_may_stand_on_the_ground() -> None:
    v = hovering("POSHOLD")
    ap = v.autopilot
    poshold.start(v)
    ap.control.pos_ne.pos_desired = Vec2(1.0, 0.0)
    ap.control.pos_ne.last_tick = ap.control.tick
    poshold.hold(ap.modes.poshold, 0.0, True, ap.control, ap.estimate, ap.params)
    assert ap.control.pos_ne.pos_desired.x == pytest.approx(1.0 - DT / (DT + 0.16))
