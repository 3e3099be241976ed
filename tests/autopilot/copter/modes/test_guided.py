# SPDX-License-Identifier: BSD-3-Clause
"""GUIDED's set-points: what is taken, what is refused, when they grow too old."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.autopilot.command_results import CommandResult
from sitl.autopilot.copter.modes import auto_yaw, guided, guided_setpoints, mode_commands
from sitl.autopilot.copter.modes.guided import ACCEL, GUIDED_TIMEOUT, POS_VEL_ACCEL, POSITION, TAKEOFF, VELOCITY_ACCEL
from sitl.autopilot.copter.modes.guided_setpoints import NO_YAW, YawSetpoint
from sitl.autopilot.copter.modes.mode_commands import LARGEST
from sitl.core.algebra import euler_of
from sitl.core.vectors import Quat, Vec3
from tests.autopilot.copter.steady_copter import codes, fly, make, snapshot, turn_to, wait

GOOD = Vec3(1.0, 2.0, -3.0)
UPRIGHT = Quat(1.0, 0.0, 0.0, 0.0)
STILL = Vec3(0.0, 0.0, 0.0)
SETTERS = (
    (guided_setpoints.set_position, 1, POSITION),
    (guided_setpoints.set_velocity, 2, VELOCITY_ACCEL),
    (guided_setpoints.set_accel, 1, ACCEL),
    (guided_setpoints.set_pos_vel_accel, 3, POS_VEL_ACCEL),
)


@pytest.mark.parametrize(("setter", "count", "submode"), SETTERS)
def test_a_set_point_selects_its_kind(flying, setter, count, submode):
    assert setter(flying, *[GOOD] * count, NO_YAW) == CommandResult.OK
    assert flying.autopilot.modes.guided.submode == submode


@pytest.mark.parametrize(("setter", "count", "_"), SETTERS)
def test_only_in_guided(flying, setter, count, _):
    flying.autopilot.modes.number = 5
    before = snapshot(flying)
    assert setter(flying, *[GOOD] * count, NO_YAW) == CommandResult.WRONG_MODE
    assert snapshot(flying) == before


@settings(max_examples=150, deadline=None)
@given(
    st.sampled_from(SETTERS),
    st.lists(st.floats(), min_size=11, max_size=11),
    st.integers(0, 10),
    st.sampled_from((math.nan, math.inf, -math.inf)),
)
def test_a_number_that_is_none_leaves_everything_as_it_was(case, numbers, place, bad):
    setter, count, _ = case
    v = fly(make())
    yaw = YawSetpoint(True, numbers[9], True, numbers[10], False)
    if place < 3 * count:
        numbers[place] = bad
    else:
        yaw = yaw._replace(angle=bad)
    args = [Vec3(*numbers[3 * k : 3 * k + 3]) for k in range(count)]
    before = snapshot(v)
    assert setter(v, *args, yaw) == CommandResult.NOT_FINITE
    assert snapshot(v) == before


@settings(max_examples=100, deadline=None)
@given(st.lists(st.floats(), min_size=8, max_size=8))
def test_attitude_takes_unit_quaternions_and_finite_numbers_only(numbers):
    v = fly(make())
    before = snapshot(v)
    code = guided_setpoints.set_attitude(v, True, Quat(*numbers[:4]), Vec3(*numbers[4:7]), numbers[7])
    norm = math.sqrt(sum(x * x for x in numbers[:4])) if not any(map(math.isnan, numbers)) else math.nan
    if math.isnan(norm) or not all(abs(x) <= LARGEST for x in numbers[4:]):
        assert code == CommandResult.NOT_FINITE
    elif not 0.5 <= norm <= 2.0:
        assert code == CommandResult.OUT_OF_RANGE
    else:
        assert code == CommandResult.OK
    if code == CommandResult.OK:
        q = [float(x) for x in v.autopilot.modes.guided.q]
        assert sum(x * x for x in q) == pytest.approx(1.0)
    else:
        assert snapshot(v) == before


@pytest.mark.parametrize(
    ("thrust", "climb"), ((0.5, 0.0), (1.0, 2.5), (0.75, 1.25), (0.0, -1.5), (0.25, -0.75), (7.0, 2.5))
)
def test_thrust_is_a_climb_rate(flying, thrust, climb):
    guided_setpoints.set_attitude(flying, True, UPRIGHT, STILL, thrust)
    assert flying.autopilot.modes.guided.climb_rate == pytest.approx(climb)
    assert flying.autopilot.modes.guided.use_thrust == 0


def test_thrust_is_thrust_with_the_option(flying):
    flying.autopilot.params.GUID_OPTIONS = 8.0
    guided_setpoints.set_attitude(flying, True, UPRIGHT, STILL, 0.4)
    assert (flying.autopilot.modes.guided.use_thrust, flying.autopilot.modes.guided.thrust) == (1, 0.4)


@pytest.mark.parametrize(("seconds", "old"), ((2.9, False), (3.1, True)))
def test_velocity_becomes_zero_after_the_time_out(flying, seconds, old):
    guided_setpoints.set_velocity(flying, Vec3(3.0, 0.0, 0.0), STILL, YawSetpoint(False, 0.0, True, 0.5, False))
    wait(flying, seconds)
    guided.run(flying)
    ap = flying.autopilot
    assert (ap.modes.guided.vel[0] == 0.0) == old
    assert (ap.modes.auto_yaw.mode == auto_yaw.HOLD) == old
    assert codes(flying).count(GUIDED_TIMEOUT) == int(old)
    guided.run(flying)
    assert codes(flying).count(GUIDED_TIMEOUT) == int(old)


def test_a_position_does_not_time_out(flying):
    guided_setpoints.set_position(flying, Vec3(20.0, 0.0, -10.0), NO_YAW)
    wait(flying, 60.0)
    guided.run(flying)
    assert flying.autopilot.modes.guided.pos[0] == 20.0
    assert GUIDED_TIMEOUT not in codes(flying)


def test_attitude_levels_off_after_the_time_out_and_keeps_its_heading(flying):
    q = Quat(math.cos(0.1), math.sin(0.1), 0.0, 0.0)
    guided_setpoints.set_attitude(flying, True, q, Vec3(0.0, 0.0, 0.2), 0.9)
    wait(flying, 3.1)
    guided.run(flying)
    target = flying.autopilot.modes.guided
    assert [float(x) for x in target.q] == pytest.approx([1.0, 0.0, 0.0, 0.0])
    assert target.climb_rate == 0.0 and target.rates[2] == 0.0


def test_the_time_out_is_a_parameter(flying):
    flying.autopilot.params.GUID_TIMEOUT = 0.5
    guided_setpoints.set_velocity(flying, Vec3(3.0, 0.0, 0.0), STILL, NO_YAW)
    wait(flying, 0.6)
    assert guided.is_stale(flying.autopilot.modes.guided, flying.time_us, 0.5)


def test_the_set_point_moves_on_between_messages(flying):
    motion = (Vec3(0.0, 0.0, -10.0), Vec3(4.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0))
    guided_setpoints.set_pos_vel_accel(flying, *motion, NO_YAW)
    for _ in range(40):
        flying.time_us += 2500
        guided.run(flying)
    target = flying.autopilot.modes.guided
    assert target.pos[0] == pytest.approx(0.4)
    assert target.vel[1] == pytest.approx(0.1)
    assert target.pos[1] == pytest.approx(0.5 * 1.0 * 0.1**2)


SET_POINTS = {
    "position": lambda v: guided_setpoints.set_position(v, Vec3(20.0, 0.0, -10.0), NO_YAW),
    "velocity": lambda v: guided_setpoints.set_velocity(v, Vec3(5.0, 0.0, 0.0), STILL, NO_YAW),
    "acceleration": lambda v: guided_setpoints.set_accel(v, Vec3(2.0, 0.0, 0.0), NO_YAW),
    "moving position": lambda v: guided_setpoints.set_pos_vel_accel(v, GOOD, Vec3(5.0, 0.0, 0.0), STILL, NO_YAW),
}


def ticks(v, count):
    """The greatest speed that is asked for [m/s]."""
    fastest = 0.0
    for _ in range(count):
        v.time_us += 2500
        guided.run(v)
        fastest = max(fastest, abs(v.autopilot.control.pos_ne.vel_desired[0]))
    return fastest


@pytest.mark.parametrize("name", SET_POINTS)
def test_a_pause_holds_against_new_set_points_and_flies_on_when_it_ends(flying, name):
    modes = flying.autopilot.modes
    assert mode_commands.set_paused(modes, True) == CommandResult.OK
    assert SET_POINTS[name](flying) == CommandResult.OK
    assert ticks(flying, 40) == 0.0 and modes.guided.paused
    mode_commands.set_paused(modes, False)
    assert ticks(flying, 40) > 0.01


def test_a_pause_holds_against_an_attitude_and_a_lean_ends(flying):
    q = Quat(math.cos(0.1), 0.0, math.sin(0.1), 0.0)
    mode_commands.set_paused(flying.autopilot.modes, True)
    assert guided_setpoints.set_attitude(flying, True, q, STILL, 0.5) == CommandResult.OK
    ticks(flying, 200)
    assert abs(flying.autopilot.control.attitude.target_euler[1]) < 0.02
    mode_commands.set_paused(flying.autopilot.modes, False)
    ticks(flying, 200)
    assert flying.autopilot.control.attitude.target_euler[1] == pytest.approx(0.2, abs=0.02)


def test_what_stops_the_vehicle_ends_a_pause_too(flying):
    mode_commands.set_paused(flying.autopilot.modes, True)
    assert guided_setpoints.stop(flying) == CommandResult.OK
    assert not flying.autopilot.modes.guided.paused


@pytest.mark.parametrize(("yaw", "lean"), [(0.0, (0.1, 0.0)), (math.pi / 2, (0.0, 0.1))])
def test_an_attitude_turns_on_with_its_rates(flying, yaw, lean):
    """Rates count in the frame that ArduCopter takes them in: a roll rate at heading east pitches."""
    q = Quat(math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2))
    guided_setpoints.set_attitude(flying, True, q, Vec3(0.1, 0.0, 0.0), 0.5)
    ticks(flying, 400)
    reached = euler_of(flying.autopilot.modes.guided.q)
    assert (reached.roll, reached.pitch) == pytest.approx(lean, abs=1e-3)


def test_take_off_sets_a_height_above_home_and_needs_the_ground(vehicle):
    ap = vehicle.autopilot
    ap.modes.number, ap.home.pos = 4, (0.0, 0.0, 1.5)
    ap.estimate.pos = ap.estimate.pos.replace(z=1.5)
    assert mode_commands.take_off(vehicle.autopilot, 10.0) == CommandResult.NOT_ARMED
    ap.arming.armed = 1
    assert mode_commands.take_off(vehicle.autopilot, math.nan) == CommandResult.NOT_FINITE
    assert mode_commands.take_off(vehicle.autopilot, -1.0) == CommandResult.TOO_LOW
    assert mode_commands.take_off(vehicle.autopilot, 10.0) == CommandResult.OK
    assert (ap.modes.guided.submode, ap.modes.takeoff.target_d, ap.arming.auto_armed) == (TAKEOFF, -8.5, 1)
    ap.arming.landed = 0
    assert mode_commands.take_off(vehicle.autopilot, 12.0) == CommandResult.OK, "repeated in the climb"
    assert ap.modes.takeoff.target_d == -10.5
    ap.modes.takeoff.complete = 1
    assert mode_commands.take_off(vehicle.autopilot, 10.0) == CommandResult.ALREADY_FLYING


@pytest.mark.parametrize(
    ("mode", "answer"),
    ((3, CommandResult.WRONG_MODE), (6, CommandResult.WRONG_MODE), (2, CommandResult.OK), (5, CommandResult.OK)),
)
def test_take_off_in_other_modes(vehicle, mode, answer):
    vehicle.autopilot.modes.number, vehicle.autopilot.arming.armed = mode, 1
    assert mode_commands.take_off(vehicle.autopilot, 10.0) == answer


def test_on_the_ground_a_position_does_not_start_the_motors(vehicle):
    ap = vehicle.autopilot
    ap.modes.number, ap.arming.armed = 4, 1
    assert guided_setpoints.set_position(vehicle, Vec3(20.0, 0.0, -10.0), NO_YAW) == CommandResult.OK
    guided.run(vehicle)
    assert ap.control.motors.desired_spool == 1
    assert ap.arming.auto_armed == 0


@pytest.mark.parametrize(
    ("speed", "answer"),
    (
        (3.0, CommandResult.OK),
        (-5.0, CommandResult.OUT_OF_RANGE),
        (0.0, CommandResult.OUT_OF_RANGE),
        (math.nan, CommandResult.NOT_FINITE),
    ),
)
def test_change_speed(flying, speed, answer):
    ap = flying.autopilot
    before = float(ap.control.pos_ne.speed_max)
    assert mode_commands.change_speed(ap.control, ap.params, mode_commands.HORIZONTAL, speed) == answer
    assert ap.control.pos_ne.speed_max == (speed if answer == CommandResult.OK else before)


@pytest.mark.parametrize(
    ("yaw", "mode"),
    (
        ((0, 0.0, 0, 0.0, 0), auto_yaw.LOOK_AT_NEXT_WP),
        ((1, 1.0, 0, 0.0, 0), auto_yaw.ANGLE_RATE),
        ((1, 1.0, 1, 0.2, 0), auto_yaw.ANGLE_RATE),
        ((0, 0.0, 1, 0.2, 0), auto_yaw.RATE),
        ((1, 1.0, 0, 0.0, 1), auto_yaw.FIXED),
    ),
)
def test_yaw_of_a_set_point(flying, yaw, mode):
    turn_to(flying, 0.3)
    guided_setpoints.set_velocity(flying, Vec3(1.0, 0.0, 0.0), STILL, YawSetpoint(*yaw))
    assert flying.autopilot.modes.auto_yaw.mode == mode
