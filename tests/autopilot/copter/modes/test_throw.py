# SPDX-License-Identifier: BSD-3-Clause
"""THROW from the hand to its hover: what each stage waits for and does with motors and controllers."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.copter.control.spool import DesiredSpoolState, SpoolState
from sitl.autopilot.copter.modes import throw
from sitl.autopilot.modes import ModeReason, ModeResult
from sitl.core.vectors import Vec2, Vec3
from tests.autopilot.copter.modes.obedient_copter import MODE, move, standing, ticks, turn_body
from tests.autopilot.copter.steady_copter import told, wait

CONDITIONS = (
    (throw.DISARMED, throw.WAITING),
    (throw.SPOOLING_UP, throw.UPRIGHTING),
    (throw.UPRIGHTING, throw.TO_HEIGHT),
    (throw.TO_HEIGHT, throw.STOPPING),
    (throw.STOPPING, throw.STOPPING),
)


def thrown(stage: int, spool: int = SpoolState.THROTTLE_UNLIMITED) -> Any:
    """A vehicle 10 m above home in a stage of THROW; it is level and at its height."""
    v = standing("THROW", spool)
    v.autopilot.arming.auto_armed = 0
    v.autopilot.modes.throw.stage = stage
    v.autopilot.estimate.pos = v.autopilot.estimate.pos.replace(z=-10.0)
    v.autopilot.modes.throw.target_d = -10.0
    return v


def stage_after(v: Any) -> int:
    ticks(v, throw.run)
    return int(v.autopilot.modes.throw.stage)


@pytest.mark.parametrize(("stage", "after"), CONDITIONS)
def test_a_stage_ends_when_its_condition_is_met(stage: int, after: int) -> None:
    v = thrown(stage)
    assert stage_after(v) == after
    assert told(v, throw.THROW_STAGE) == ([(float(after), 0.0)] if after != stage else [])


def test_it_waits_for_a_throw() -> None:
    v = thrown(throw.WAITING, SpoolState.SHUT_DOWN)
    assert stage_after(v) == throw.WAITING and v.autopilot.arming.landed
    v.autopilot.estimate.acc_ned = Vec3(0.0, 0.0, 9.8)  # falls freely
    move(v, 0.0, 0.0, -4.0)
    assert stage_after(v) == throw.WAITING, "not confirmed yet"
    wait(v, 0.3)
    move(v, 0.0, 0.0, -1.0)
    assert stage_after(v) == throw.SPOOLING_UP and not v.autopilot.arming.landed


@pytest.mark.parametrize("lost", ("attitude_ok", "position_ok"))
def test_without_an_estimate_it_is_not_thrown(lost: str) -> None:
    v = thrown(throw.WAITING, SpoolState.SHUT_DOWN)
    setattr(v.autopilot.estimate, lost, 0)
    v.autopilot.estimate.acc_ned = Vec3(0.0, 0.0, 9.8)
    move(v, 0.0, 0.0, -1.0)
    v.autopilot.modes.throw.released_us, v.autopilot.modes.throw.released_speed = v.time_us, -4.0
    assert stage_after(v) == throw.WAITING


def test_the_height_of_a_throw_counts_from_home() -> None:
    for home, after in ((-5.0, throw.SPOOLING_UP), (-9.0, throw.WAITING)):
        v = thrown(throw.WAITING, SpoolState.SHUT_DOWN)
        v.autopilot.home.pos = (0.0, 0.0, home)
        v.autopilot.params.THROW.ALT_MIN = 3.0
        v.autopilot.estimate.acc_ned = Vec3(0.0, 0.0, 9.8)
        move(v, 0.0, 0.0, -4.0)
        ticks(v, throw.run)
        move(v, 0.0, 0.0, -1.0)
        assert stage_after(v) == after


@pytest.mark.parametrize(("lean", "upright"), ((29.0, True), (31.0, False), (-31.0, False), (180.0, False)))
def test_upright_is_within_thirty_degrees(lean: float, upright: bool) -> None:
    v = thrown(throw.UPRIGHTING)
    turn_body(v, math.radians(lean), 0.0, 0.5)
    assert (stage_after(v) == throw.TO_HEIGHT) == upright
    assert bool(v.autopilot.arming.auto_armed) == upright


@pytest.mark.parametrize(("kind", "wanted"), ((0.0, -12.0), (1.0, -9.0)))
def test_it_stops_higher_after_a_throw_and_lower_after_a_drop(kind: float, wanted: float) -> None:
    v = thrown(throw.UPRIGHTING)
    p = v.autopilot.params.THROW
    p.TYPE, p.ALT_ACSND, p.ALT_DCSND = kind, 2.0, 1.0
    ticks(v, throw.run)
    assert v.autopilot.modes.throw.target_d == wanted
    assert v.autopilot.control.pos_d.pos_desired == pytest.approx(wanted)
    assert (v.autopilot.control.pos_d.speed_up, v.autopilot.control.pos_d.speed_down) == (2.5, 2.5)


@pytest.mark.parametrize(("off", "there"), ((0.49, True), (0.51, False), (-3.0, True)))
def test_its_height_is_reached_within_half_a_metre_from_below(off: float, there: bool) -> None:
    v = thrown(throw.TO_HEIGHT)
    v.autopilot.modes.throw.target_d = -10.0 - off
    assert (stage_after(v) == throw.STOPPING) == there


@pytest.mark.parametrize(("start", "spool"), ((0.0, DesiredSpoolState.SHUT_DOWN), (1.0, DesiredSpoolState.GROUND_IDLE)))
def test_in_the_hand_motors_stand_or_idle_as_throw_mot_start_says(start: float, spool: int) -> None:
    v = thrown(throw.WAITING, SpoolState.SHUT_DOWN)
    v.autopilot.params.THROW.MOT_START = start
    v.autopilot.control.attitude.throttle_in = 0.5
    turn_body(v, 1.0, 0.2, 0.3)
    ticks(v, throw.run)
    control = v.autopilot.control
    assert control.motors.desired_spool == spool and control.attitude.throttle_in == 0.0
    assert control.attitude.target_euler == pytest.approx((1.0, 0.2, 0.3)), "as it is held"


@pytest.mark.parametrize("stage", (throw.SPOOLING_UP, throw.UPRIGHTING, throw.TO_HEIGHT, throw.STOPPING))
def test_from_the_throw_on_the_motors_have_full_power(stage: int) -> None:
    v = thrown(stage, SpoolState.SPOOLING_UP)
    ticks(v, throw.run)
    assert v.autopilot.control.motors.desired_spool == DesiredSpoolState.THROTTLE_UNLIMITED


def test_it_turns_upright_at_half_throttle_whatever_its_lean() -> None:
    v = thrown(throw.UPRIGHTING)
    turn_body(v, math.radians(120.0), 0.0, 0.0)
    control = v.autopilot.control
    control.attitude.cos_lean = -0.5
    ticks(v, throw.run)
    assert control.attitude.throttle_in == control.motors.throttle_in == 0.5
    assert control.attitude.target_euler.roll == pytest.approx(0.0, abs=1e-6)


def test_it_stops_where_it_came_to_within_the_limits_of_waypoints() -> None:
    v = thrown(throw.TO_HEIGHT)
    p = v.autopilot.params.WPNAV
    p.SPEED, p.ACCEL = 700.0, 200.0
    move(v, 4.0, 0.0, 0.0)
    ticks(v, throw.run)
    path = v.autopilot.control.pos_ne
    assert (path.speed_max, path.accel_max) == (7.0, 2.0) and path.vel_desired.x == pytest.approx(4.0)
    speeds = [float(ticks(v, throw.run) or path.vel_desired.x) for _ in range(200)]
    assert speeds == sorted(speeds, reverse=True) and speeds[-1] < 3.9
    assert v.autopilot.control.pos_d.last_tick == v.autopilot.control.tick


@pytest.mark.parametrize(
    ("name", "asked"),
    (("AUTO", 1), ("GUIDED", 1), ("LOITER", 1), ("RTL", 1), ("LAND", 1), ("BRAKE", 1), ("THROW", 0), ("ALT_HOLD", 0)),
)
def test_stopped_it_goes_on_with_throw_nextmode_once(name: str, asked: int) -> None:
    v = thrown(throw.STOPPING)
    modes = v.autopilot.modes
    v.autopilot.params.THROW.NEXTMODE = float(MODE[name].number)
    ticks(v, throw.run)
    assert modes.wanted == (MODE[name].number + 1) * asked and modes.throw.passed_on
    if asked:
        assert modes.wanted_reason == ModeReason.THROW_COMPLETE
    modes.wanted = 0
    ticks(v, throw.run)
    assert modes.wanted == 0


@pytest.mark.parametrize(("error", "stopped"), ((Vec2(0.3, 0.3), True), (Vec2(0.4, 0.4), False)))
def test_it_has_stopped_within_half_a_metre_of_its_position(error: Vec2, stopped: bool) -> None:
    v = thrown(throw.STOPPING)
    v.autopilot.control.pos_ne.pos_error = error
    throw.pass_on(v)
    assert bool(v.autopilot.modes.throw.passed_on) == stopped


def test_it_is_entered_disarmed_only_and_begins_anew() -> None:
    v = thrown(throw.STOPPING)
    state = v.autopilot.modes.throw
    assert throw.start(v) == ModeResult.INIT_FAILED and state.stage == throw.STOPPING
    v.autopilot.arming.armed, state.released_us, state.passed_on = 0, 5, 1
    assert throw.start(v) == ModeResult.ACCEPTED
    assert (state.stage, state.released_us, state.passed_on) == (throw.DISARMED, 0, 0)


@pytest.mark.parametrize(
    ("height", "low", "high", "may"),
    ((5.0, 5.0, 0.0, False), (5.1, 5.0, 0.0, True), (5.0, 0.0, 5.0, False), (4.9, 0.0, 5.0, True), (-3.0, 0.0, 0.0, 1)),
)
def test_a_throw_is_within_its_heights_where_they_are_set(height: float, low: float, high: float, may: bool) -> None:
    v = thrown(throw.WAITING)
    p, est = v.autopilot.params.THROW, v.autopilot.estimate
    p.ALT_MIN, p.ALT_MAX, est.acc_ned = low, high, Vec3(0.0, 0.0, 9.80665)
    move(v, 0.0, 0.0, -0.51)
    assert throw.may_be_thrown(est, height, p) == bool(may)
    move(v, 0.0, 0.0, -0.5)
    assert not throw.may_be_thrown(est, height, p), "too slow"


@pytest.mark.parametrize(
    ("felt", "speed", "may"),
    (
        (Vec3(0.0, 0.0, -2.4), 0.0, True),  # less than a quarter of gravity
        (Vec3(0.0, 0.0, -2.5), 0.0, False),
        (Vec3(0.0, 0.0, -2.5), 4.98, True),  # or fast in any direction
        (Vec3(0.0, 0.0, -2.5), -4.98, True),
        (Vec3(0.0, 0.0, -2.5), 4.8, False),
        (Vec3(9.79, 0.0, 0.0), 0.0, True),
        (Vec3(9.81, 0.0, 0.0), 0.0, False),  # something holds it
        (Vec3(0.0, 9.81, 0.0), 0.0, False),
        (Vec3(7.0, 7.0, 0.0), 0.0, False),
        (Vec3(0.0, 0.0, 9.81), 0.0, False),
    ),
)
def test_a_throw_falls_freely_or_is_fast_and_nothing_holds_it(felt: Vec3, speed: float, may: bool) -> None:
    v = thrown(throw.WAITING)
    est = v.autopilot.estimate
    est.acc_ned = felt + Vec3(0.0, 0.0, 9.80665)
    for vel in ((speed, 0.0), (0.0, speed)):
        move(v, *vel, -0.6)
        assert throw.may_be_thrown(est, 10.0, v.autopilot.params.THROW) == may
