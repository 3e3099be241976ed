# SPDX-License-Identifier: BSD-3-Clause
"""Descents with and without a position, how fast they are, and who ends them; speeds of set-points, BRAKE."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.command_results import CommandResult
from sitl.autopilot.copter.control.spool import DesiredSpoolState, SpoolState
from sitl.autopilot.copter.control.state import AltitudeState
from sitl.autopilot.copter.modes import auto_yaw, descent, guided, land, mode_commands, precision_land
from sitl.autopilot.copter.parameters.flight_modes import Land
from sitl.autopilot.modes import ModeReason, ModeResult
from sitl.core.vectors import Quat, Vec2, Vec3
from tests.autopilot.copter.modes.obedient_copter import MODE, hovering, move, standing, ticks, turn_body
from tests.autopilot.copter.steady_copter import told, wait

FULL = DesiredSpoolState.THROTTLE_UNLIMITED
DT = 0.0025


def landing(height: float = 30.0, located: bool = True, **params: float) -> Any:
    """In LAND; ``params``: LAND_*."""
    v = hovering("LAND", height)
    for name, value in params.items():
        v.autopilot.params.LAND[name] = value
    v.autopilot.estimate.position_ok = located
    assert land.start(v) == ModeResult.ACCEPTED
    return v


@pytest.mark.parametrize("located", (True, False))
def test_it_lands_with_a_position_where_there_is_one(located: bool) -> None:
    v = landing(located=located)
    ticks(v, MODE["LAND"].run)
    control = v.autopilot.control
    assert bool(v.autopilot.modes.land.with_position) == located
    assert (control.pos_ne.last_tick == control.tick) == located
    assert control.pos_d.accel_desired > 0.0 and control.motors.desired_spool == FULL


@pytest.mark.parametrize(("reposition", "lean"), ((1.0, 30.0), (0.0, 0.0)))
def test_without_a_position_the_sticks_lean_it_where_they_may_move_it(reposition: float, lean: float) -> None:
    v = landing(located=False, REPOSITION=reposition)
    v.autopilot.modes.pilot.roll, v.autopilot.modes.pilot.yaw_rate = 1.0, 0.4
    ticks(v, MODE["LAND"].run)
    target = v.autopilot.control.attitude.target_euler
    assert math.degrees(target.roll) == pytest.approx(lean)
    assert target.yaw == pytest.approx(0.4 * DT, rel=0.3)


def test_with_a_position_the_sticks_move_it_and_it_softens_where_it_may_stand() -> None:
    v = landing()
    ap = v.autopilot
    ap.modes.pilot.pitch = -1.0
    descent.descend(ap.modes, 30.0, False, ap.control, ap.estimate, ap.params)
    assert ap.control.pos_ne.accel_desired.x > 0.0
    ap.control.pos_ne.last_tick, ap.control.pos_ne.pos_desired = ap.control.tick, Vec2(1.0, 0.0)
    descent.descend(ap.modes, 30.0, True, ap.control, ap.estimate, ap.params)
    assert ap.control.pos_ne.pos_desired.x == pytest.approx(1.0 - DT / (DT + 0.16), abs=1e-4)


def test_a_descent_begins_anew() -> None:
    v = landing()
    state = v.autopilot.modes.land
    state.pause, state.repositioned, state.stage, state.tries, state.with_position = 1, 1, 2, 3, 0
    v.autopilot.modes.auto_yaw.mode = auto_yaw.ROI
    wait(v, 1.0)
    descent.begin(v.autopilot.modes, v.time_us, v.autopilot.control, v.autopilot.estimate, v.autopilot.params)
    assert (state.pause, state.repositioned, state.stage, state.tries, state.with_position) == (0, 0, 0, 0, 1)
    assert state.start_us == v.time_us and v.autopilot.modes.auto_yaw.mode == auto_yaw.HOLD


@pytest.mark.parametrize(
    ("height", "slow", "fast", "low", "limit", "rate"),
    (
        (100.0, 50.0, 0.0, 1000.0, 1.5, 1.5),  # LAND_SPEED_HIGH 0: that of descents
        (100.0, 50.0, 80.0, 1000.0, 1.5, 0.8),
        (100.0, 90.0, 80.0, 1000.0, 1.5, 0.9),  # not slower than near the ground
        (9.0, 50.0, 0.0, 1000.0, 1.5, 0.5),
        (10.7, 50.0, 0.0, 1000.0, 1.5, 0.7),  # between
        (5.0, -50.0, 0.0, 1000.0, 1.5, 0.5),
        (1.7, 50.0, 0.0, 0.0, 1.5, 0.7),  # LAND_ALT_LOW is a metre at least
    ),
)
def test_how_fast_it_sinks(height: float, slow: float, fast: float, low: float, limit: float, rate: float) -> None:
    p, limits = Land(), AltitudeState()
    p.SPEED, p.SPEED_HIGH, p.ALT_LOW = slow, fast, low
    limits.speed_down, limits.accel_max = limit, 1.0
    assert descent.sink_rate(height, limits, p, 1.0) == pytest.approx(rate)


@pytest.mark.parametrize(
    ("pause", "height", "maybe", "at_limit", "sinks"),
    ((1, 30.0, False, 0.0, False), (0, 30.0, False, 1.0, True), (0, 9.9, False, 0.0, True), (0, 30.0, True, 0.0, True)),
)
def test_near_the_ground_it_goes_on_at_the_least_throttle(
    pause: int, height: float, maybe: bool, at_limit: float, sinks: bool
) -> None:
    v = landing()
    ap = v.autopilot
    ap.control.pos_d.limit, ap.modes.land.pause = 1.0 if not pause else 0.0, pause
    descent.sink(ap.control.pos_d, ap.modes.land, height, maybe, ap.params)
    assert ap.control.pos_d.limit == at_limit and (ap.control.pos_d.accel_desired > 0.0) == sinks


@pytest.mark.parametrize(
    ("roll", "pitch", "yaw", "wanted"),
    (
        (1.0, 0.0, 0.0, (0.0, 1.0)),
        (0.0, -1.0, 0.0, (1.0, 0.0)),
        (0.0, -1.0, math.pi / 2, (0.0, 1.0)),
        (1.0, -1.0, 0.0, (math.sqrt(0.5), math.sqrt(0.5))),  # a diagonal is no faster
        (0.0, 0.0, 1.0, (0.0, 0.0)),
    ),
)
def test_the_sticks_move_the_landing(roll: float, pitch: float, yaw: float, wanted: tuple[float, float]) -> None:
    """As fast as half a second of WPNAV_ACCEL gives."""
    v = landing()
    v.autopilot.params.WPNAV.ACCEL = 200.0
    v.autopilot.modes.pilot.roll, v.autopilot.modes.pilot.pitch = roll, pitch
    assert descent.stick_velocity(v.autopilot.modes.pilot, yaw, v.autopilot.params) == pytest.approx(wanted)


@pytest.mark.parametrize(("located", "name"), ((1, "LOITER"), (0, "ALT_HOLD")))
def test_a_landing_that_the_throttle_cancels_goes_on_in_a_mode_of_the_pilot(located: int, name: str) -> None:
    v = landing(located=bool(located))
    v.autopilot.params.PILOT.THR_BHV, v.autopilot.modes.pilot.throttle = 2.0, 0.71
    ticks(v, MODE["LAND"].run)
    modes = v.autopilot.modes
    assert (modes.wanted, modes.wanted_reason) == (MODE[name].number + 1, ModeReason.THROTTLE_LAND_ESCAPE)


@pytest.mark.parametrize(
    ("armed", "landed", "spool", "rests", "stays_armed"),
    (
        (1, 1, SpoolState.THROTTLE_UNLIMITED, 1, 1),
        (1, 1, SpoolState.GROUND_IDLE, 0, 0),
        (0, 1, SpoolState.SHUT_DOWN, 0, 0),
    ),
)
def test_on_the_ground_it_rests_and_disarms_once_it_idles(
    armed: int, landed: int, spool: int, rests: int, stays_armed: int
) -> None:
    v = landing(0.0)
    ap = v.autopilot
    ap.arming.armed, ap.arming.landed, ap.control.motors.spool_state = armed, landed, spool
    ticks(v, MODE["LAND"].run)
    assert (ap.control.motors.desired_spool, ap.arming.armed) == (rests, stays_armed)


@pytest.mark.parametrize(("stage", "height"), ((precision_land.CLIMBING, -13.0), (precision_land.RETURNING, -10.0)))
def test_it_flies_back_to_where_it_saw_its_target(stage: int, height: float) -> None:
    v = landing()
    ap = v.autopilot
    ap.modes.land.stage, ap.params.PLND.STRICT = stage, 1.0
    ap.landing_target.seen_from = ap.landing_target.last_pos = Vec3(3.0, 4.0, -10.0)
    goal = precision_land.position_to_try(ap.modes.land, ap.landing_target, ap.params.PLND)
    assert goal.z <= -10.0 and (goal.z < -10.0) == (stage == precision_land.CLIMBING)
    precision_land.fly_back(v)
    path = ap.control.pos_ne
    assert path.accel_desired.x > 0.0 and path.accel_desired.y > 0.0 and ap.control.pos_d.accel_desired > 0.0
    assert path.last_tick == ap.control.pos_d.last_tick == ap.control.tick
    assert height <= goal.z


@pytest.mark.parametrize(
    ("off", "near"), ((0.0, True), (precision_land.NEAR - 1e-6, True), (precision_land.NEAR, False))
)
def test_it_is_there_within_a_distance_in_space(off: float, near: bool) -> None:
    for way in (Vec3(off, 0.0, 0.0), Vec3(0.0, -off, 0.0), Vec3(0.0, 0.0, off)):
        assert precision_land.is_near(Vec3(0.0, 0.0, 0.0), way) == near


@pytest.mark.parametrize(
    ("kind", "index"), ((mode_commands.HORIZONTAL, 0), (mode_commands.CLIMB, 1), (mode_commands.DESCENT, 2))
)
def test_each_speed_is_changed_alone(kind: int, index: int) -> None:
    v = hovering("GUIDED")
    ap = v.autopilot
    guided.start(v)

    def speeds() -> list[float]:
        c, d = ap.control.pos_ne, ap.control.pos_d
        return [float(c.speed_max), float(d.speed_up), float(d.speed_down), float(c.accel_max), float(d.accel_max)]

    wanted = speeds()
    wanted[index] = 3.25
    assert mode_commands.change_speed(ap.control, ap.params, kind, 3.25) == CommandResult.OK
    assert speeds() == wanted
    assert mode_commands.change_speed(ap.control, ap.params, 7, 3.25) == CommandResult.OUT_OF_RANGE


def test_without_a_position_attitudes_begin_level_at_the_heading_of_now() -> None:
    v = hovering("GUIDED_NOGPS")
    turn_body(v, 0.2, 0.1, 0.7)
    state = v.autopilot.modes.guided
    state.use_thrust, state.climb_rate, state.rates = 1, 2.0, Vec3(1.0, 0.0, 0.0)
    state.use_attitude, state.q = 1, Quat(0.0, 0.0, 0.0, 1.0)  # of the last time
    assert MODE["GUIDED_NOGPS"].start(v) == ModeResult.ACCEPTED
    ticks(v, MODE["GUIDED_NOGPS"].run)
    assert (state.submode, state.use_thrust, state.climb_rate) == (guided.ANGLE, 0, 0.0)
    assert v.autopilot.control.attitude.target_euler == pytest.approx((0.0, 0.0, 0.7), abs=1e-6)
    wait(v, 3.1)
    ticks(v, MODE["GUIDED_NOGPS"].run, 2)
    assert len(told(v, guided.GUIDED_TIMEOUT)) == 1


def test_on_the_ground_brake_rests_and_in_the_air_it_stops() -> None:
    v = standing("BRAKE")
    ticks(v, MODE["BRAKE"].run)
    assert v.autopilot.control.motors.desired_spool == DesiredSpoolState.GROUND_IDLE
    v = hovering("BRAKE")
    v.autopilot.control.motors.desired_spool = DesiredSpoolState.GROUND_IDLE
    move(v, 3.0, 0.0, 0.0)
    assert MODE["BRAKE"].start(v) == ModeResult.ACCEPTED
    ticks(v, MODE["BRAKE"].run, 40)
    assert 0.0 < v.autopilot.control.pos_ne.vel_desired.x < 3.0 and v.autopilot.control.motors.desired_spool == FULL


def test_where_it_saw_its_target_it_stays() -> None:
    v = landing(10.0)
    ap = v.autopilot
    ap.modes.land.stage = precision_land.RETURNING
    ap.landing_target.seen_from = ap.landing_target.last_pos = Vec3(0.0, 0.0, -10.0)
    assert precision_land.position_to_try(ap.modes.land, ap.landing_target, ap.params.PLND) == (0.0, 0.0, -10.0)
    ticks(v, precision_land.fly_back, 3)
    assert ap.control.pos_d.accel_desired == ap.control.pos_d.vel_desired == 0.0
    assert ap.control.pos_ne.accel_desired == (0.0, 0.0)


@pytest.mark.parametrize(
    ("vel", "limits"),
    (
        ((0.0, 0.0, 0.0), (0.1, 2.5, 2.5)),
        ((3.0, 4.0, 0.0), (5.0, 2.5, 2.5)),
        ((0.0, 0.0, 6.0), (0.1, 6.0, 2.5)),  # down
        ((0.0, 0.0, -6.0), (0.1, 2.5, 6.0)),
    ),
)
def test_brake_begins_with_the_speed_that_it_has_as_its_limits(
    vel: tuple[float, float, float], limits: tuple[float, float, float]
) -> None:
    v = hovering("BRAKE")
    move(v, *vel)
    assert MODE["BRAKE"].start(v) == ModeResult.ACCEPTED
    ne, d = v.autopilot.control.pos_ne, v.autopilot.control.pos_d
    assert (ne.speed_max, d.speed_down, d.speed_up) == pytest.approx(limits)
    assert ne.accel_max == d.accel_max == 7.5, "ArduPilot's deceleration"
    assert (*ne.vel_desired, d.vel_desired) == vel
