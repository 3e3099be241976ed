# SPDX-License-Identifier: BSD-3-Clause
"""How GUIDED flies what it was told: attitudes, positions over the ground, its limits within a mission, its yaw."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.arming_checks import ArmingMethod
from sitl.autopilot.command_results import CommandResult
from sitl.autopilot.copter.control.spool import DesiredSpoolState, SpoolState
from sitl.autopilot.copter.modes import auto_yaw, guided, guided_setpoints
from sitl.autopilot.copter.modes.guided_setpoints import NO_YAW, YawSetpoint
from sitl.autopilot.copter.modes.state import GuidedState
from sitl.autopilot.copter.navigation.state import CopterNav
from sitl.autopilot.copter.terrain_following import begin as begin_over_ground
from sitl.autopilot.modes import ModeResult
from sitl.autopilot.terrain.ground import Ground, is_long_missing
from sitl.core.vectors import Quat, Vec2, Vec3
from tests.autopilot.copter.modes.obedient_copter import MODE, hovering, move, standing, ticks, turn_body
from tests.autopilot.copter.steady_copter import wait

STILL = Vec3(0.0, 0.0, 0.0)
LEVEL = Quat(1.0, 0.0, 0.0, 0.0)
RIGHT = Quat(math.cos(0.1), math.sin(0.1), 0.0, 0.0)
"""0.2 rad of roll."""
THRUST_IS_THRUST = 8.0
"""GUID_OPTIONS"""


def leaning(
    q: Quat = RIGHT, thrust: float = 0.5, options: float = 0.0, rates: Vec3 = STILL, attitude: bool = True
) -> Any:
    """A vehicle that flies in GUIDED and was sent a SET_ATTITUDE_TARGET."""
    v = hovering("GUIDED")
    guided.start(v)
    v.autopilot.params.GUID.OPTIONS = options
    assert guided_setpoints.set_attitude(v, attitude, q, rates, thrust) == CommandResult.OK
    return v


def tick(v: Any, count: int = 1) -> Any:
    ticks(v, MODE["GUIDED"].run, count)
    return v.autopilot.control


def test_an_attitude_is_flown_at_constant_height() -> None:
    control = tick(leaning())
    assert control.attitude.target_euler.roll == pytest.approx(0.2)
    assert control.pos_d.vel_desired == 0.0 and control.pos_d.accel_desired == 0.0


@pytest.mark.parametrize(("thrust", "way"), ((1.0, -1), (0.0, 1)))
def test_its_thrust_climbs_and_sinks(thrust: float, way: int) -> None:
    v = leaning(thrust=thrust)
    assert tick(v, 40).pos_d.vel_desired * way > 0.0


@pytest.mark.parametrize(("limits", "climb"), (((1.0, 0.5), 1.0), ((1.0, 0.5), -0.5)))
def test_a_climb_of_an_attitude_keeps_the_limits_of_now(limits: tuple[float, float], climb: float) -> None:
    v = leaning(thrust=1.0 if climb > 0.0 else 0.0)
    path = v.autopilot.control.pos_d
    path.speed_up, path.speed_down = limits
    path.accel_max, path.jerk_max = 5.0, 50.0
    assert -tick(v, 250).pos_d.vel_desired == pytest.approx(climb, abs=0.01)


def test_with_the_option_its_thrust_is_that_of_the_motors() -> None:
    v = leaning(thrust=0.6, options=THRUST_IS_THRUST)
    control = tick(v)
    assert control.attitude.throttle_in == pytest.approx(0.6) and control.motors.throttle_filter_hz == 0.0
    assert control.pos_d.last_tick != control.tick
    control.attitude.cos_lean = 0.5
    turn_body(v, math.radians(60.0), 0.0, 0.0)
    assert tick(v).motors.throttle_in > 0.9, "more in a lean"


def test_rates_alone_turn_the_body() -> None:
    v = leaning(rates=Vec3(0.5, -0.2, 0.1), attitude=False)
    assert tick(v).attitude.target_rate == pytest.approx((0.5, -0.2, 0.1))


def test_rates_of_an_attitude_keep_their_limits() -> None:
    v = leaning(LEVEL, rates=Vec3(0.0, 0.0, 9.0))
    v.autopilot.params.ATC.RATE_Y_MAX = 45.0
    assert tick(v).attitude.target_rate.z == pytest.approx(math.radians(45.0), rel=1e-3)


def late(v: Any) -> Any:
    wait(v, 3.1)  # GUID_TIMEOUT is 3 s
    return tick(v)


@pytest.mark.parametrize("yaw", (0.0, 1.2))
def test_an_attitude_that_is_too_old_becomes_level_at_its_heading(yaw: float) -> None:
    v = leaning(Quat(math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)), thrust=1.0)
    turn_body(v, 0.0, 0.0, yaw)
    control = late(v)
    assert control.attitude.target_euler == pytest.approx((0.0, 0.0, yaw), abs=1e-6)
    assert control.pos_d.accel_desired == 0.0


def test_rates_that_are_too_old_become_level_at_the_heading_of_now() -> None:
    v = leaning(rates=Vec3(0.5, 0.0, 0.0), attitude=False)
    turn_body(v, 0.1, 0.0, 0.7)
    late(v)
    state = v.autopilot.modes.guided
    assert state.use_attitude and state.rates == STILL
    assert v.autopilot.control.attitude.target_euler == pytest.approx((0.0, 0.0, 0.7), abs=1e-3)


def test_a_thrust_that_is_too_old_holds_the_height_without_a_jump() -> None:
    v = leaning(thrust=0.6, options=THRUST_IS_THRUST)
    tick(v)
    move(v, 0.0, 0.0, -0.5)
    control = late(v)
    assert not v.autopilot.modes.guided.use_thrust
    assert control.pos_d.last_tick == control.tick
    assert control.attitude.throttle_in == pytest.approx(0.6, abs=0.02)


def landed(thrust: float, options: float = 0.0, spool: int = SpoolState.THROTTLE_UNLIMITED) -> Any:
    """On the ground in GUIDED, sent an attitude."""
    v = standing("GUIDED", spool)
    guided.start(v)
    v.autopilot.arming.auto_armed = 0
    v.autopilot.params.GUID.OPTIONS = options
    guided_setpoints.set_attitude(v, True, LEVEL, STILL, thrust)
    return v


@pytest.mark.parametrize("options", (0.0, THRUST_IS_THRUST))
def test_a_thrust_upwards_takes_off_once_the_motors_have_spooled_up(options: float) -> None:
    v = landed(0.8, options, SpoolState.GROUND_IDLE)
    control = tick(v)
    assert v.autopilot.arming.auto_armed and v.autopilot.arming.landed
    assert control.motors.desired_spool == DesiredSpoolState.THROTTLE_UNLIMITED
    assert control.attitude.throttle_in == 0.0
    control.motors.spool_state = SpoolState.THROTTLE_UNLIMITED
    tick(v)
    assert not v.autopilot.arming.landed


@pytest.mark.parametrize(("thrust", "options"), ((0.5, 0.0), (0.2, 0.0), (0.0, THRUST_IS_THRUST)))
def test_no_thrust_upwards_rests_on_the_ground(thrust: float, options: float) -> None:
    v = landed(thrust, options)
    assert tick(v).motors.desired_spool == DesiredSpoolState.GROUND_IDLE
    assert v.autopilot.arming.landed and not v.autopilot.arming.auto_armed


def test_disarmed_a_thrust_upwards_does_nothing() -> None:
    v = landed(0.8)
    v.autopilot.arming.armed = 0
    assert tick(v).motors.desired_spool == DesiredSpoolState.SHUT_DOWN and not v.autopilot.arming.auto_armed


def test_on_the_ground_the_target_is_the_body_until_it_flies() -> None:
    v = landed(0.8, spool=SpoolState.SPOOLING_UP)
    turn_body(v, 0.05, 0.0, 0.4)
    v.autopilot.control.attitude.target_q = LEVEL
    assert tick(v).attitude.target_euler == pytest.approx((0.05, 0.0, 0.4))


def over_ground(ground_d: float = -30.0, known: bool = True) -> Any:
    """Flies in GUIDED at 10 m above ground that is 30 m above the origin, to a point 10 m north at the same height."""
    v = hovering("GUIDED", 40.0)
    guided.start(v)
    ap = v.autopilot
    ap.terrain.asked, ap.params.TERRAIN.ENABLE = 0, 1.0
    ap.home.pos = (0.0, 0.0, ground_d)  # without a grid the ground is as high as home
    ap.modes.guided.submode, ap.modes.guided.pos = guided.POSITION, Vec3(10.0, 0.0, -10.0)
    begin_over_ground(ap.modes.nav, Ground(known, ground_d))
    return v


def test_a_position_over_the_ground_keeps_its_height_over_it() -> None:
    v = over_ground()
    control = tick(v, 100)
    assert control.pos_ne.vel_desired.x > 0.0 and control.pos_d.vel_desired == pytest.approx(0.0, abs=1e-9)
    assert control.pos_d.pos_desired == pytest.approx(-40.0)


def test_where_the_ground_rises_it_climbs_with_it() -> None:
    v = over_ground()
    v.autopilot.home.pos = (0.0, 0.0, -32.0)
    control = tick(v, 200)
    nav = v.autopilot.modes.nav
    assert nav.ground_d < -30.05 and control.pos_d.pos_desired == pytest.approx(nav.ground_d - 10.0, abs=0.02)
    assert control.pos_d.vel_desired == pytest.approx(nav.ground_vel, abs=0.02)


def test_where_nothing_is_known_of_the_ground_it_stops_and_says_so_at_once() -> None:
    v = over_ground(known=False)
    v.autopilot.params.TERRAIN.ENABLE = 0.0
    move(v, 1.0, 0.0, 0.0)
    v.autopilot.control.pos_ne.last_tick = 0
    assert tick(v, 40).pos_ne.vel_desired.x < 1.0
    assert is_long_missing(v.autopilot.terrain, v.time_us)


@pytest.mark.parametrize(
    ("seconds", "north", "height", "ends"),
    (
        (9.9, 0.0, 10.0, False),
        (10.0, 0.0, 10.0, True),
        (0.0, 20.0, 10.0, False),
        (0.0, 20.1, 10.0, True),
        (0.0, 0.0, 5.0, False),
        (0.0, 0.0, 4.9, True),
        (0.0, 0.0, 15.0, False),
        (0.0, 0.0, 15.1, True),
    ),
)
def test_limits_of_a_mission_end_guided(seconds: float, north: float, height: float, ends: bool) -> None:
    state = GuidedState()
    state.limit_us, state.limit_low, state.limit_high, state.limit_distance = 10_000_000, 5.0, 15.0, 20.0
    guided.begin_limits(state, 3_000_000, Vec2(1.0, 0.0))
    assert guided.is_at_limit(state, 3_000_000 + round(seconds * 1e6), Vec3(1.0 + north, 0.0, -height)) == ends


@pytest.mark.parametrize("name", ("limit_us", "limit_low", "limit_high", "limit_distance"))
def test_a_limit_of_zero_is_none(name: str) -> None:
    state = GuidedState()
    state.limit_us, state.limit_low, state.limit_high, state.limit_distance = 10_000_000, -50.0, 15.0, 20.0
    setattr(state, name, 0)
    broken = {"limit_us": (10**9, 0.0, 0.0), "limit_low": (0, 0.0, -60.0), "limit_high": (0, 0.0, 99.0)}
    time_us, north, height = broken.get(name, (0, 99.0, 0.0))
    assert not guided.is_at_limit(state, int(time_us), Vec3(north, 0.0, -height))


@pytest.mark.parametrize(("options", "mode"), ((0.0, auto_yaw.PILOT_RATE), (4.0, auto_yaw.LOOK_AT_NEXT_WP)))
def test_the_yaw_stick_turns_it_unless_guid_options_says_no(options: float, mode: int) -> None:
    v = hovering("GUIDED")
    guided.start(v)
    v.autopilot.params.GUID.OPTIONS, v.autopilot.modes.pilot.yaw_rate = options, 0.5
    tick(v)
    assert v.autopilot.modes.auto_yaw.mode == mode


def test_entering_it_stops_the_vehicle_and_forgets_what_was_flown() -> None:
    v = hovering("GUIDED")
    state = v.autopilot.modes.guided
    state.paused, state.timed_out, state.vel, state.acc, state.update_us = (
        1,
        1,
        Vec3(5.0, 0.0, 0.0),
        Vec3(1.0, 0.0, 0.0),
        0,
    )
    move(v, 2.0, 0.0, 0.0)
    assert guided.start(v) == ModeResult.ACCEPTED
    assert (state.submode, state.paused, state.timed_out, state.update_us) == (guided.VELOCITY_ACCEL, 0, 0, v.time_us)
    assert state.vel == state.acc == STILL
    assert v.autopilot.control.pos_ne.vel_desired == (2.0, 0.0), "without a jump"
    assert tick(v, 40).pos_ne.vel_desired.x < 2.0


@pytest.mark.parametrize(
    ("since", "timeout", "stale"), ((3_000_000, 3.0, False), (3_000_001, 3.0, True), (500_001, 0.5, True))
)
def test_a_set_point_is_stale_after_guid_timeout(since: int, timeout: float, stale: bool) -> None:
    state = GuidedState()
    state.update_us = 7
    assert guided.is_stale(state, 7 + since, timeout) == stale


@pytest.mark.parametrize(
    ("method", "options", "may"),
    ((ArmingMethod.RUDDER, 0.0, False), (ArmingMethod.RUDDER, 1.0, True), (ArmingMethod.MAVLINK, 0.0, True)),
)
def test_guid_options_lets_the_yaw_stick_arm(method: int, options: float, may: bool) -> None:
    v = hovering("GUIDED")
    v.autopilot.params.GUID.OPTIONS = options
    assert MODE["GUIDED"].may_arm(v.autopilot.params, method) == may


def test_an_acceleration_is_flown_and_ends_when_it_is_too_old() -> None:
    v = hovering("GUIDED")
    guided.start(v)
    guided_setpoints.set_accel(v, Vec3(1.0, 0.0, -0.5), NO_YAW)
    control = tick(v, 100)
    speed, climb = float(control.pos_ne.vel_desired.x), float(control.pos_d.vel_desired)
    assert speed > 0.1 and climb < -0.01
    late(v)
    fastest = float(tick(v, 400).pos_ne.vel_desired.x)
    assert fastest < speed + 0.3 and abs(tick(v, 400).pos_d.vel_desired) < 0.05


def test_a_velocity_that_is_too_old_ends_its_turn_and_its_acceleration() -> None:
    v = hovering("GUIDED")
    guided.start(v)
    guided_setpoints.set_velocity(v, Vec3(1.0, 0.0, 0.0), Vec3(0.5, 0.0, 0.0), YawSetpoint(True, 0.3, True, 0.2, False))
    assert v.autopilot.modes.auto_yaw.mode == auto_yaw.ANGLE_RATE
    late(v)
    state = v.autopilot.modes.guided
    assert (state.vel, state.acc, v.autopilot.modes.auto_yaw.mode) == (STILL, STILL, auto_yaw.HOLD)


def test_a_moving_position_is_followed_up_and_down_as_well() -> None:
    v = hovering("GUIDED")
    guided.start(v)
    guided_setpoints.set_pos_vel_accel(v, Vec3(0.0, 0.0, -10.0), Vec3(0.0, 1.0, -1.0), STILL, NO_YAW)
    control = tick(v, 200)
    assert control.pos_ne.vel_desired.y > 0.3 and control.pos_d.vel_desired < -0.3


@pytest.mark.parametrize(
    ("submode", "complete", "taking_off"),
    ((guided.TAKEOFF, 0, True), (guided.TAKEOFF, 1, False), (guided.POSITION, 0, False)),
)
def test_it_takes_off_until_the_take_off_is_complete(submode: int, complete: int, taking_off: bool) -> None:
    v = hovering("GUIDED")
    v.autopilot.modes.guided.submode, v.autopilot.modes.takeoff.complete = submode, complete
    assert MODE["GUIDED"].is_taking_off(v.autopilot.modes) == taking_off


def test_a_take_off_is_flown_by_guided() -> None:
    v = standing("GUIDED", SpoolState.THROTTLE_UNLIMITED)
    v.autopilot.modes.guided.submode = guided.TAKEOFF
    assert tick(v, 3).attitude.throttle_in > 0.0


@pytest.mark.parametrize(("known", "code"), ((True, CommandResult.OK), (False, CommandResult.NO_GROUND)))
def test_a_position_over_the_ground_needs_the_ground(known: bool, code: int) -> None:
    v = hovering("GUIDED")
    ap = v.autopilot
    ap.params.TERRAIN.ENABLE, ap.home.pos = float(known), (0.0, 0.0, -3.0)
    assert guided_setpoints.set_position_over_ground(v, Vec3(1.0, 2.0, -7.0), NO_YAW) == code
    nav: CopterNav = ap.modes.nav
    if known:
        assert (ap.modes.guided.pos, nav.over_ground, nav.ground_d) == ((1.0, 2.0, -7.0), 1, -3.0)
        nav.ground_d = -2.5  # it follows the ground already
        guided_setpoints.set_position_over_ground(v, Vec3(1.0, 2.0, -8.0), NO_YAW)
        assert (nav.over_ground, nav.ground_d) == (1, -2.5)
        guided_setpoints.set_position(v, Vec3(1.0, 2.0, -8.0), NO_YAW)
        assert not nav.over_ground


@pytest.mark.parametrize(("on", "north", "code"), ((1, 60.0, CommandResult.BEYOND_FENCE), (1, 40.0, 0), (0, 60.0, 0)))
@pytest.mark.parametrize("kind", ("position", "over ground", "moving"))
def test_positions_beyond_a_fence_that_is_on_are_refused(kind: str, on: int, north: float, code: int) -> None:
    v = hovering("GUIDED")
    ap = v.autopilot
    ap.params.FENCE.TYPE, ap.params.FENCE.RADIUS, ap.fence.on = 2.0, 50.0, 2 * on
    ap.params.TERRAIN.ENABLE = 1.0
    pos = Vec3(north, 0.0, -10.0)
    if kind == "position":
        result = guided_setpoints.set_position(v, pos, NO_YAW)
    elif kind == "over ground":
        result = guided_setpoints.set_position_over_ground(v, pos, NO_YAW)
    else:
        result = guided_setpoints.set_pos_vel_accel(v, pos, STILL, STILL, NO_YAW)
    assert result == (code or CommandResult.OK)


@pytest.mark.parametrize(("angle", "rate", "taken"), ((math.nan, 0.0, 0), (0.0, math.inf, 0), (0.5, 0.1, 1)))
def test_a_yaw_that_is_no_number_refuses_the_set_point(angle: float, rate: float, taken: int) -> None:
    v = hovering("GUIDED")
    code = guided_setpoints.set_accel(v, STILL, YawSetpoint(True, angle, True, rate, False))
    assert (code == CommandResult.OK) == bool(taken)


@pytest.mark.parametrize(("use_rate", "rate"), ((True, 0.2), (False, 0.0)))
def test_a_rate_that_is_not_used_is_not_flown(use_rate: bool, rate: float) -> None:
    v = hovering("GUIDED")
    guided_setpoints.set_accel(v, STILL, YawSetpoint(True, 1.0, use_rate, 0.2, False))
    yaw = v.autopilot.modes.auto_yaw
    assert (yaw.yaw, yaw.rate) == (1.0, rate)


def test_a_relative_yaw_turns_from_the_target_of_now_at_the_slew_rate() -> None:
    v = hovering("GUIDED")
    turn_body(v, 0.0, 0.0, 0.4)
    guided_setpoints.set_accel(v, STILL, YawSetpoint(True, -0.9, False, 0.0, True))
    yaw = v.autopilot.modes.auto_yaw
    assert (yaw.mode, yaw.yaw, yaw.offset) == (auto_yaw.FIXED, pytest.approx(0.4), -0.9)
    assert yaw.slew == pytest.approx(math.radians(v.autopilot.params.ATC.SLEW_YAW * 0.01))


@pytest.mark.parametrize("name", ("GUIDED_NOGPS", "GUIDED", "AVOID_ADSB", "LOITER"))
def test_attitudes_are_taken_in_guided_modes(name: str) -> None:
    v = hovering(name)
    code = guided_setpoints.set_attitude(v, True, LEVEL, STILL, 0.5)
    assert (code == CommandResult.OK) == (name in ("GUIDED", "GUIDED_NOGPS"))
