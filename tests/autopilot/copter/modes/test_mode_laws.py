# SPDX-License-Identifier: BSD-3-Clause
"""Laws of the modes on values and on records of their own, without a vehicle."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.control.shaping import Motion2
from sitl.autopilot.copter import pilot
from sitl.autopilot.copter.control.spool import DesiredSpoolState, SpoolState
from sitl.autopilot.copter.control.state import AltitudeState, Control, MotorsState
from sitl.autopilot.copter.mission import COMMANDS
from sitl.autopilot.copter.modes import (
    acro,
    alt_hold,
    auto,
    auto_yaw,
    decisions,
    descent,
    drift,
    flip,
    ground,
    guided,
    guided_setpoints,
    land,
    loiter,
    poshold,
    rtl,
    takeoff,
    throw,
    zigzag,
)
from sitl.autopilot.copter.modes import circle as circle_mode
from sitl.autopilot.copter.modes.mode_list import MODES, NAMES
from sitl.autopilot.copter.modes.state import (
    AutoYaw,
    CircleState,
    DriftState,
    FlipState,
    GuidedState,
    LandState,
    LoiterState,
    Modes,
    PilotState,
    PosHoldAxis,
    RtlState,
    TakeoffState,
    ThrowState,
    ZigZagState,
)
from sitl.autopilot.copter.navigation import circle, waypoint
from sitl.autopilot.copter.navigation.state import CopterNav
from sitl.autopilot.copter.parameters.flight_modes import Acro, Land, Legs, Pilot, PosHold, Rtl, Throw
from sitl.autopilot.events import Events
from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.modes import ModeResult
from sitl.autopilot.state import Arming, Estimate
from sitl.core.algebra import dot2, quat_from_euler
from sitl.core.mavlink import MavCmd
from sitl.core.scalars import wrap_pi
from sitl.core.vectors import Euler, Vec2, Vec3
from tests.autopilot.copter.steady_copter import codes, fly, make

ANGLES = st.floats(-3.1, 3.1)


def test_modes_have_numbers_names_and_a_description_of_their_own() -> None:
    assert len(NAMES) == len({mode.name for mode in MODES}) == len({mode.description for mode in MODES}) == len(MODES)
    assert all(mode.description and mode.name not in mode.description.split() for mode in MODES)


@given(ANGLES, ANGLES, st.sampled_from((-1, 0, 1)))
def test_a_turn_ends_at_the_angle_in_the_direction_asked_for(start: float, angle: float, direction: int) -> None:
    turn = auto_yaw.turn_from(start, auto_yaw.Turn(angle, 0.0, direction, False))
    assert wrap_pi(start + turn - angle) == pytest.approx(0.0, abs=1e-9)
    assert turn * direction >= 0.0
    assert abs(turn) <= (2.0 * math.pi if direction else math.pi)


@given(st.floats(-7.0, 7.0), st.floats(0.01, 2.0))
def test_a_turn_takes_as_long_as_its_rate_needs(offset: float, slew: float) -> None:
    yaw = AutoYaw()
    yaw.mode, yaw.offset, yaw.slew = auto_yaw.FIXED, offset, slew
    for _ in range(math.ceil(abs(offset) / slew / 0.1) + 1):
        auto_yaw.advance_turn(yaw, 0.1)
    assert yaw.offset == 0.0
    assert auto_yaw.has_turned(yaw, offset)


@given(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(0.1, 1.0), st.floats(0.1, 1.0))
def test_the_lean_of_sticks_stays_within_the_limit(roll: float, pitch: float, angle_max: float, limit: float) -> None:
    sticks = PilotState()
    sticks.roll, sticks.pitch = roll, pitch
    lean = pilot.lean_angles(sticks, angle_max, limit)
    assert math.cos(lean.roll) * math.cos(lean.pitch) >= math.cos(min(limit, angle_max)) - 1e-9
    assert lean.roll * roll >= 0.0 and lean.pitch * pitch >= 0.0


@given(st.floats(0.0, 1.0))
def test_the_climb_of_the_stick_is_continuous_and_within_its_speeds(throttle: float) -> None:
    climb = pilot.climb_of_stick(throttle, 0.48, 0.1, 2.5, 1.5)
    assert -1.5 - 1e-12 <= climb <= 2.5 + 1e-12
    assert pilot.climb_of_stick(throttle + 1e-6, 0.48, 0.1, 2.5, 1.5) == pytest.approx(climb, abs=1e-4)


@pytest.mark.parametrize(("thrust", "climb"), ((0.0, -1.5), (0.5, 0.0), (1.0, 2.5)))
def test_thrust_stands_for_a_climb_rate(thrust: float, climb: float) -> None:
    limits = AltitudeState()
    limits.speed_up, limits.speed_down = 2.5, 1.5
    assert guided_setpoints.climb_of_thrust(thrust, limits) == climb


def test_a_moving_set_point_moves_as_it_says() -> None:
    target = GuidedState()
    target.vel, target.acc = Vec3(4.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0)
    for _ in range(400):
        guided.advance(target, 0.0025)
    assert target.pos == pytest.approx((4.0, 0.5, 0.0))
    assert target.vel == pytest.approx((4.0, 1.0, 0.0))


@given(st.floats(-10.0, 10.0), st.floats(-10.0, 10.0))
def test_loiter_comes_to_rest_with_the_sticks_centred(north: float, east: float) -> None:
    state, path = LoiterState(), Motion2(Vec2(0.0, 0.0), Vec2(north, east), Vec2(0.0, 0.0))
    limits = loiter.Limits(12.5, 4.0, 0.5, 2.5, 5.0)
    speed, at_rest = math.hypot(north, east), 0
    for _ in range(400 * 30):
        path = loiter.advance_path(state, path, limits, True)
        assert math.hypot(*path.vel) <= speed + 1e-12
        speed = math.hypot(*path.vel)
        at_rest = at_rest + 1 if speed < 0.05 else 0
        if at_rest == 400:  # for a second
            break
    assert at_rest == 400


@given(st.floats(-10.0, 500.0), st.floats(10.0, 300.0), st.floats(0.0, 300.0))
def test_a_landing_sinks_within_its_speeds_and_slowly_near_the_ground(height: float, slow: float, fast: float) -> None:
    p, limits = Land(), AltitudeState()
    p.SPEED, p.SPEED_HIGH, p.ALT_LOW = slow, fast, 1000.0
    limits.speed_down, limits.accel_max = 1.5, 1.0
    rate = descent.sink_rate(height, limits, p, 1.0)
    top = 1.5 if fast * 0.01 <= 0.0 else fast * 0.01
    assert slow * 0.01 <= rate <= max(top, slow * 0.01)
    if height <= 10.0:
        assert rate == slow * 0.01


@given(st.floats(-50.0, 50.0).filter(lambda r: abs(r) > 0.5), st.floats(-3.0, 3.0))
def test_a_circle_stays_on_its_radius_and_turns_its_way(radius: float, angle: float) -> None:
    nav = CopterNav()
    nav.circle_radius, nav.circle_centre = radius, Vec3(5.0, -7.0, -20.0)
    circle.start(nav, Vec3(5.0 + math.cos(angle), -7.0 + math.sin(angle), 0.0), 0.0)
    circle.set_limits(nav, math.radians(20.0), 5.0, 2.5)
    turns = [circle.advance(nav) for _ in range(400)]
    away = nav.pos - nav.circle_centre
    assert math.hypot(away.x, away.y) == pytest.approx(abs(radius))
    assert turns == sorted(turns) and math.copysign(1.0, nav.circle_total) == math.copysign(1.0, radius)
    assert math.hypot(nav.vel.x, nav.vel.y) <= 5.0 + 1e-9


def test_a_pause_stops_path_time_and_lets_it_run_again() -> None:
    nav, p = CopterNav(), Legs()
    p.SPEED, p.ACCEL = 500.0, 250.0
    nav.pause_scale, nav.paused = 1.0, True
    for wanted in (0.0, 1.0):
        nav.paused = wanted == 0.0
        for _ in range(400 * 10):
            waypoint.advance_pause(nav, p, 5.0)
            assert -0.01 <= nav.pause_scale <= 1.01
        assert (nav.pause_scale, nav.pause_rate) == (wanted, 0.0)


@pytest.mark.parametrize(
    ("armed", "flies", "spool", "climb", "doing", "wanted"),
    (
        (False, False, 0, 0.0, alt_hold.STOPPED, DesiredSpoolState.SHUT_DOWN),
        (True, False, SpoolState.GROUND_IDLE, -0.5, alt_hold.LANDED_IDLE, DesiredSpoolState.GROUND_IDLE),
        (True, False, SpoolState.THROTTLE_UNLIMITED, 0.0, alt_hold.LANDED_READY, DesiredSpoolState.THROTTLE_UNLIMITED),
        (True, False, SpoolState.GROUND_IDLE, 0.5, alt_hold.LANDED_IDLE, DesiredSpoolState.THROTTLE_UNLIMITED),
        (True, False, SpoolState.THROTTLE_UNLIMITED, 0.5, alt_hold.TAKING_OFF, DesiredSpoolState.THROTTLE_UNLIMITED),
        (True, True, SpoolState.THROTTLE_UNLIMITED, -0.5, alt_hold.FLYING, DesiredSpoolState.THROTTLE_UNLIMITED),
    ),
)
def test_what_the_throttle_stick_does(
    armed: bool, flies: bool, spool: int, climb: float, doing: int, wanted: int
) -> None:
    arming, motors = Arming(), MotorsState()
    arming.armed, arming.auto_armed, arming.landed, motors.spool_state = armed, flies, not flies, spool
    assert alt_hold.decide(arming, TakeoffState(), motors, climb) == doing
    assert motors.desired_spool == wanted


@pytest.mark.parametrize(
    ("throttle", "accel_d", "lifts"), ((0.5, 0.0, False), (0.8, 0.0, True), (0.1, -1.3, True), (0.1, 1.3, False))
)
def test_a_take_off_ends_at_full_throttle_or_with_acceleration(throttle: float, accel_d: float, lifts: bool) -> None:
    assert takeoff.has_thrust(throttle, accel_d, 2.5, 0.8) == lifts


def test_a_take_off_raises_the_throttle_on_the_ground_and_climbs_in_the_air() -> None:
    v = fly(make())
    ap = v.autopilot
    ap.params.WP.NAVALT_MIN = 2.0
    ap.arming.landed = True
    takeoff.begin(ap.modes.takeoff, -20.0, True, ap.control, ap.estimate, ap.params)
    before = ap.control.attitude.throttle_in
    for _ in range(10):
        takeoff.run(v)
    assert ap.arming.landed and ap.control.pos_d.vel_desired == 0.0
    assert ap.control.attitude.throttle_in > before and ap.modes.takeoff.no_nav_active
    ap.arming.landed = False
    for _ in range(10):
        takeoff.run(v)
    assert ap.control.pos_d.vel_desired < 0.0 and ap.modes.takeoff.no_nav_active
    ap.estimate.pos = Vec3(0.0, 0.0, -12.5)
    takeoff.run(v)
    assert not ap.modes.takeoff.no_nav_active


def test_the_stages_of_a_throw_are_told_once() -> None:
    v = make()
    throw.run(v)
    assert codes(v) == [], "disarmed"
    v.autopilot.arming.armed = True
    throw.run(v)
    assert codes(v) == [throw.THROW_STAGE]
    throw.run(v)
    assert codes(v) == [throw.THROW_STAGE] and v.autopilot.modes.throw.stage == throw.WAITING
    v.autopilot.arming.armed = False
    throw.run(v)
    assert codes(v) == [throw.THROW_STAGE] and v.autopilot.modes.throw.stage == throw.DISARMED


def test_sticks_end_a_hold_and_both_axes_brake_from_then_on() -> None:
    v = fly(make())
    state = v.autopilot.modes.poshold
    state.holding, v.autopilot.modes.pilot.roll = True, 0.5
    poshold.fly(v)
    assert not state.holding
    assert (state.roll.since_us, state.pitch.since_us) == (v.time_us, v.time_us)


def test_position_control_begins_where_the_vehicle_is_and_as_it_moves() -> None:
    v = make()
    control, est = v.autopilot.control, v.autopilot.estimate
    est.pos, est.vel = Vec3(10.0, -20.0, -5.0), Vec3(1.0, 2.0, -0.5)
    ground.start_position_control(control, est, v.autopilot.params)
    assert (control.pos_ne.pos_desired, control.pos_ne.vel_desired) == (Vec2(10.0, -20.0), Vec2(1.0, 2.0))
    assert (control.pos_d.pos_desired, control.pos_d.vel_desired) == (-5.0, -0.5)


def test_loiter_turns_its_velocity_with_the_heading() -> None:
    state = LoiterState()
    vel = Vec2(3.0, 4.0)
    for _ in range(400):
        state.acc = state.predicted_acc = Vec2(0.0, 0.0)
        loiter.turn_with_heading(state, vel, math.radians(90.0))
        assert state.acc == state.predicted_acc
        vel += state.predicted_acc * 0.0025
    assert (vel.x, vel.y) == pytest.approx((-4.0, 3.0), abs=0.05)


def test_loiter_brakes_some_time_after_the_sticks_are_centred() -> None:
    state = LoiterState()
    state.acc = Vec2(0.0, 1.0)
    assert not loiter.is_braking(state, 5_000_000, 1.0)
    state.acc = Vec2(0.0, 0.0)
    assert not loiter.is_braking(state, 6_000_000, 1.0)
    assert loiter.is_braking(state, 6_000_001, 1.0)


def test_a_landing_waits_and_goes_on_without_a_position() -> None:
    state = LandState()
    state.pause, state.with_position, state.start_us = True, True, 1_000_000
    land.follow_state(state, 4_999_999, True)
    assert (state.pause, state.with_position) == (True, True)
    land.follow_state(state, 5_000_000, False)
    assert (state.pause, state.with_position) == (False, False)


@pytest.mark.parametrize(("option", "throttle", "cancelled"), ((2, 0.8, True), (2, 0.6, False), (0, 0.8, False)))
def test_a_high_throttle_cancels_a_landing(option: int, throttle: float, cancelled: bool) -> None:
    sticks, p = PilotState(), Pilot()
    sticks.throttle, p.THR_BHV = throttle, float(option)
    assert land.is_cancelled(sticks, p) == cancelled


@given(st.floats(0.0, 200.0), st.floats(-500.0, 500.0), st.floats(200.0, 10000.0), st.floats(0.0, 3.0))
def test_the_way_home_is_not_below_the_vehicle(height: float, away: float, alt: float, slope: float) -> None:
    state, p = RtlState(), Rtl()
    p.ALT, p.CONE_SLOPE, p.ALT_FINAL = alt, slope, 300.0
    home = Vec3(3.0, 4.0, -2.0)
    rtl.plan_heights(state, home, home, Vec3(3.0 + away, 4.0, -2.0 - height), p)
    assert state.return_d <= -2.0 - height + 1e-9
    assert (state.home, state.descent_d) == (Vec2(3.0, 4.0), -5.0)


@pytest.mark.parametrize(
    ("armed", "landed", "count", "takes_off", "cause"),
    (
        (False, True, 0, False, ModeResult.ACCEPTED),
        (True, True, 1, False, ModeResult.INIT_FAILED),
        (True, True, 3, False, ModeResult.MISSING_TAKEOFF),
        (True, True, 3, True, ModeResult.ACCEPTED),
        (True, False, 3, False, ModeResult.ACCEPTED),
    ),
)
def test_auto_needs_a_mission(armed: bool, landed: bool, count: int, takes_off: bool, cause: int) -> None:
    modes, arming = Modes(), Arming()
    modes.mission_count, modes.mission_takes_off, arming.armed, arming.landed = count, takes_off, armed, landed
    assert auto.refusal(modes, arming) == cause


def test_a_time_out_is_told_once_each_time() -> None:
    target, events = GuidedState(), Events()
    for stale, told in ((False, 0), (True, 1), (True, 1), (False, 1), (True, 2)):
        guided.note_timeout(target, stale, events, 0)
        assert (events.count, target.timed_out) == (told, stale)


@pytest.mark.parametrize(
    ("climb", "vel_d", "cos_lean", "throttle", "hovers"),
    (
        (0.0, 0.1, 1.0, 0.4, True),
        (0.5, 0.1, 1.0, 0.4, False),
        (0.0, 0.7, 1.0, 0.4, False),
        (0.0, 0.1, 0.9, 0.4, False),
        (0.0, 0.1, 1.0, 0.0, False),
    ),
)
def test_hovering_is_level_and_at_rest(
    climb: float, vel_d: float, cos_lean: float, throttle: float, hovers: bool
) -> None:
    control = Control()
    control.pos_d.vel_desired, control.attitude.cos_lean, control.motors.throttle = climb, cos_lean, throttle
    assert decisions.hovers(control, vel_d) == hovers


@given(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_body_rates_of_the_sticks_stay_within_theirs(roll: float, pitch: float, yaw: float) -> None:
    sticks, p = PilotState(), Acro()
    sticks.roll, sticks.pitch, sticks.yaw = roll, pitch, yaw
    p.RP_RATE, p.Y_RATE, p.RP_EXPO = 360.0, 200.0, 0.3
    rates = acro.stick_rates(sticks, p)
    assert abs(rates.x) <= math.radians(360.0) + 1e-9 and abs(rates.z) <= math.radians(200.0) + 1e-9
    assert rates.x * roll >= 0.0 and rates.y * pitch >= 0.0 and rates.z * yaw >= 0.0


@pytest.mark.parametrize(
    ("trainer", "stick", "wanted"), ((0, 0.0, 0.0), (1, 0.0, -20.0), (1, 0.25, -15.0), (2, 1.0, -20.0))
)
def test_the_trainer_turns_back_to_level(trainer: int, stick: float, wanted: float) -> None:
    sticks, lean = PilotState(), Euler(math.radians(20.0), 0.0, 0.0)
    p = make().autopilot.params
    sticks.yaw, p.ACRO.TRAINER = stick, float(trainer)
    rates = acro.trained_rates(Vec3(0.0, 0.0, 0.0), sticks, lean, p)
    assert math.degrees(rates.x) == pytest.approx(wanted)


@given(st.floats(-3.0, 3.0))
def test_the_trainer_pushes_back_to_the_limit(angle: float) -> None:
    rate = acro.limiting_rate(angle, math.radians(30.0), 6.0, 20.0)
    assert rate * angle <= 0.0 and (rate == 0.0) == (abs(angle) <= math.radians(30.0))
    assert 0.5 * rate * rate <= 20.0 * max(abs(angle) - math.radians(30.0), 0.0) + 1e-9, "it can still be stopped there"


@given(st.lists(st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0)), max_size=30), st.floats(-1.5, 1.5))
def test_the_rate_of_a_circle_turns_back_only_after_the_stick_was_centred(
    sticks: list[tuple[float, float]], rate: float
) -> None:
    state, pilot_sticks = CircleState(), PilotState()
    state.radius, state.rate = 10.0, rate
    for pilot_sticks.roll, pilot_sticks.pitch in sticks:
        before = state.rate
        for _ in range(100):
            circle_mode.steer(state, pilot_sticks, state.rate, 10.0)
        assert state.radius >= 0.0 and abs(state.rate) <= math.radians(90.0)
        if pilot_sticks.roll == 0.0:
            assert state.rate == before
        else:
            assert abs(state.rate - before) <= math.radians(0.25) + 1e-9
            assert before * state.rate >= 0.0


def brakes() -> PosHold:
    p = PosHold()
    p.BRAKE_RATE, p.BRAKE_ANGLE = 8.0, 3000.0
    return p


@given(st.floats(-20.0, 20.0))
def test_the_lean_that_brakes_grows_with_the_speed(speed: float) -> None:
    lean = math.degrees(poshold.brake_lean(speed, 8.0, 30.0))
    assert lean * speed >= 0.0 and abs(lean) <= 30.0
    assert abs(math.degrees(poshold.brake_lean(1.1 * speed, 8.0, 30.0))) >= abs(lean)


def test_a_stick_that_is_let_go_of_brakes_at_its_rate_until_the_axis_is_slow() -> None:
    axis, p, speed, time_us = PosHoldAxis(), brakes(), 5.0, 0
    poshold.advance_axis(axis, -0.4, speed, time_us, p)
    assert (axis.phase, axis.lean) == (poshold.FLOWN, -0.4), "the stick's lean at once"
    poshold.advance_axis(axis, -0.1, speed, time_us, p)
    assert -0.4 < axis.lean < -0.39, "back with a time constant"
    while axis.phase != poshold.STOPPED:
        before, time_us = axis.lean, time_us + 2500
        poshold.advance_axis(axis, 0.0, speed, time_us, p)
        speed -= 9.8 * math.tan(axis.lean) * 0.0025
        if axis.phase == poshold.BRAKING and before > -math.radians(2.0):
            assert abs(axis.lean - before) <= math.radians(8.0) * 0.0025 + 1e-9
    assert abs(speed) < 0.1 and 2.0 < time_us * 1e-6 < 5.0
    held = axis.lean
    for since, share in ((0.0, 1.0), (0.25, 0.5), (0.4, 0.2)):
        poshold.advance_axis(axis, 0.2, 0.0, time_us + round(since * 1e6), p)
        assert axis.phase == poshold.TAKEN_OVER
        assert axis.lean == pytest.approx(0.2 * share + held * (1.0 - share)), (
            "as recorded: the stick fades, then jumps"
        )
    poshold.advance_axis(axis, 0.2, 0.0, time_us + 500_000, p)
    assert (axis.phase, axis.lean) == (poshold.FLOWN, 0.2)


def test_a_brake_that_never_stops_ends() -> None:
    axis, p = PosHoldAxis(), brakes()
    axis.phase = poshold.BRAKING
    poshold.advance_axis(axis, 0.0, 3.0, 8_500_000, p)
    assert axis.phase == poshold.BRAKING
    poshold.advance_axis(axis, 0.0, 3.0, 8_500_001, p)
    assert axis.phase == poshold.STOPPED


@pytest.mark.parametrize(
    ("roll", "pitch", "way"),
    ((0.0, 0.0, (1.0, 0.0)), (-0.5, 0.0, (-1.0, 0.0)), (0.5, 0.5, (0.0, 1.0)), (0.0, -0.5, (0.0, -1.0))),
)
def test_a_flip_goes_round_once(roll: float, pitch: float, way: tuple[float, float]) -> None:
    state, sticks = FlipState(), PilotState()
    sticks.roll, sticks.pitch = roll, pitch
    flip.choose(state, sticks)
    assert (state.roll, state.pitch) == way
    state.level = quat_from_euler(Euler(0.0, 0.0, 0.7))
    phases = []
    for k in range(361):
        angle = math.radians(float(k))
        done = flip.advance(state, quat_from_euler(Euler(way[0] * angle, way[1] * angle, 0.7)))
        phases.append(int(state.phase))
        if done:
            break
    assert done and 354 <= k <= 356
    assert phases.index(flip.TURNING) == 45
    assert phases.index(flip.RECOVERING) in ((270, 271) if way[0] else (315, 316))


@pytest.mark.parametrize(("phase", "wanted"), ((flip.BEGINNING, 0.6), (flip.TURNING, 0.16), (flip.RECOVERING, 0.6)))
def test_the_throttle_of_a_flip(phase: int, wanted: float) -> None:
    state = FlipState()
    state.phase = phase
    assert flip.throttle(state, 0.4) == pytest.approx(wanted)


@pytest.mark.parametrize("point", (zigzag.A, zigzag.B))
def test_zigzag_flies_parallel_to_its_points_onto_the_line(point: int) -> None:
    state = ZigZagState()
    state.a, state.b = Vec2(0.0, 0.0), Vec2(3.0, 4.0)
    here = Vec2(-2.0, 7.0)
    place = zigzag.position_on_line(state, point, here)
    along, across = Vec2(0.6, 0.8), Vec2(-0.8, 0.6)
    assert dot2(place - here, across) == pytest.approx(0.0)
    assert dot2(place - (state.a if point == zigzag.A else state.b), along) == pytest.approx(0.0)


@given(ANGLES)
def test_zigzag_steps_aside_at_right_angles_towards_the_heading(heading: float) -> None:
    state = ZigZagState()
    state.a, state.b = Vec2(1.0, 2.0), Vec2(4.0, 6.0)
    step = zigzag.position_beside(state, Vec2(5.0, 5.0), heading, 3.0) - Vec2(5.0, 5.0)
    assert math.hypot(*step) == pytest.approx(3.0) and dot2(step, state.b - state.a) == pytest.approx(0.0)
    assert step.x * math.cos(heading) + step.y * math.sin(heading) >= -1e-12


def falling(vel: float, felt: float) -> Estimate:
    """An estimate with a velocity down [m/s] and a specific force down [m/s^2]."""
    est = Estimate()
    est.vel, est.acc_ned = Vec3(0.0, 0.0, vel), Vec3(0.0, 0.0, 9.80665 + felt)
    return est


@pytest.mark.parametrize(
    ("vel", "felt", "kind", "height", "thrown"),
    (
        (-3.0, 0.0, 0.0, 5.0, True),
        (-3.0, -9.9, 0.0, 5.0, False),  # still held
        (-3.0, -9.0, 0.0, 5.0, False),  # does not fall freely
        (-6.0, -9.0, 0.0, 5.0, True),  # but is fast
        (-0.4, 0.0, 0.0, 5.0, False),
        (3.0, 0.0, 0.0, 5.0, False),
        (3.0, 0.0, 1.0, 5.0, True),
        (-3.0, 0.0, 1.0, 5.0, False),
        (-3.0, 0.0, 0.0, 1.0, False),
        (-3.0, 0.0, 0.0, 40.0, False),
    ),
)
def test_what_looks_like_a_throw(vel: float, felt: float, kind: float, height: float, thrown: bool) -> None:
    p = Throw()
    p.TYPE, p.ALT_MIN, p.ALT_MAX = kind, 2.0, 30.0
    assert throw.may_be_thrown(falling(vel, felt), height, p) == thrown


def test_a_throw_is_confirmed_by_the_speed_that_it_loses_in_half_a_second() -> None:
    p = Throw()
    for after_us, lost, thrown in ((300_000, 2.6, True), (300_000, 2.4, False), (600_000, 2.6, False)):
        state = ThrowState()
        assert not throw.is_thrown(state, falling(-6.0, 0.0), 1_000_000, 5.0, p)
        assert throw.is_thrown(state, falling(-6.0 + lost, 0.0), 1_000_000 + after_us, 5.0, p) == thrown


def test_drift_turns_slower_when_it_is_fast_and_brakes_more_and_more() -> None:
    assert drift.turn_rate(math.radians(45.0), 0.0, 3.5) == pytest.approx(3.5)
    assert drift.turn_rate(math.radians(45.0), 90.0, 3.5) == pytest.approx(2.1)
    state = DriftState()
    leans = [drift.braking_lean(state, 0.0, 3.0) for _ in range(300)]
    assert leans == sorted(leans) and leans[-1] == pytest.approx(math.radians(24.0)) == leans[-30]
    assert drift.braking_lean(state, -0.2, 3.0) == -0.2 and state.brake == 0.0


@given(st.floats(0.0, 1.0), st.floats(-10.0, 10.0))
def test_drift_assists_the_throttle_around_its_middle_only(throttle: float, climb: float) -> None:
    change = drift.assisted(throttle, climb) - throttle
    assert -0.3 - 1e-12 <= change <= 0.3 + 1e-12 and change * climb <= 0.0
    if abs(throttle - 0.5) > 0.29:
        assert change == 0.0


def test_loiter_waits_before_it_brakes_also_when_it_begins() -> None:
    v = fly(make())
    v.autopilot.modes.loiter.brake_us = 0
    assert loiter.start(v) == ModeResult.ACCEPTED
    assert v.autopilot.modes.loiter.brake_us == v.time_us


def test_a_mission_looks_at_a_place_until_it_says_no_more() -> None:
    v = fly(make())
    yaw = v.autopilot.modes.auto_yaw
    COMMANDS.run(v, MissionItem(MavCmd.DO_SET_ROI_LOCATION, x=-353632621, y=1491652371, z=584.0))
    assert yaw.mode == auto_yaw.ROI
    COMMANDS.run(v, MissionItem(MavCmd.DO_SET_SERVO, p1=9.0, p2=1500.0))
    assert yaw.mode == auto_yaw.ROI
    COMMANDS.run(v, MissionItem(MavCmd.DO_SET_ROI_NONE))
    assert yaw.mode == auto_yaw.LOOK_AT_NEXT_WP
