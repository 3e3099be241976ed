# SPDX-License-Identifier: BSD-3-Clause
"""Position control on a point mass in plain Python: responses, anti-windup, jumps of the estimate, bad
numbers.
"""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.control.pid import Blocked, Gains
from sitl.autopilot.control.shaping import Motion, Motion2
from sitl.autopilot.copter.control import altitude, altitude_start, position, position_ned, position_start
from sitl.autopilot.copter.control.motors import hover_throttle
from sitl.autopilot.copter.control.state import DT, AltitudeState, PositionState
from sitl.core.algebra import dot2, norm2, quat_from_euler, rotate, with_down
from sitl.core.constants import GRAVITY
from sitl.core.vectors import Euler, Vec2, Vec3
from tests.autopilot.copter.control.level_autopilot import parts

REST = Vec2(0.0, 0.0)
LAG = 0.12  # of lean and of thrust [s]


def standing(north, east):
    return Motion2(Vec2(north, east), REST, REST)


def spooled(ap):
    ap.control.tick = 5
    ap.control.motors.thrust_max = 1.0
    ap.control.attitude.lean_max = 1.2
    position_start.set_max_speed_accel_ne(ap.control.pos_ne, ap.params, 10.0, 2.5)
    altitude_start.set_max_speed_accel_d(ap.control.pos_d, ap.params.PSC, 1.5, 2.5, 1.0)
    ap.control.attitude.throttle_in = hover_throttle(ap.params.MOT)
    position_start.init_ne(*parts(ap))
    altitude_start.init_d(*parts(ap))
    return ap


def move_ne(ap, acc, wind=(0.0, 0.0)):
    """One tick of a mass whose acceleration follows the target with a lag."""
    est = ap.estimate
    acc[0] += (ap.control.pos_ne.accel_target - acc[0]) * (DT / LAG)
    a = with_down(acc[0] + Vec2(*wind), 0.0)
    est.pos += est.vel.replace(z=0.0) * DT + 0.5 * a * DT * DT
    est.vel += a * DT
    ap.control.tick += 1


def move_d(ap, thrust):
    """One tick of a mass under a thrust that follows the throttle with a lag; returns the thrust over the
    weight.
    """
    wanted = float(ap.control.motors.throttle_in) / hover_throttle(ap.params.MOT)
    thrust += (min(max(wanted, 0.0), 2.5) - thrust) * DT / LAG
    a = GRAVITY * (1.0 - thrust)
    ap.estimate.acc_ned = ap.estimate.acc_ned.replace(z=a)
    ap.estimate.pos = ap.estimate.pos.replace(z=ap.estimate.pos.z + ap.estimate.vel[2] * DT + 0.5 * a * DT * DT)
    ap.estimate.vel = ap.estimate.vel.replace(z=ap.estimate.vel.z + a * DT)
    ap.control.tick += 1
    return thrust


def test_step_of_20_m(ap):
    spooled(ap)
    acc, half, most, far = [Vec2(0.0, 0.0)], 0.0, 0.0, 0.0
    for k in range(4000):
        position.input_pos_vel_accel_ne(ap.control.pos_ne, standing(20.0, 0.0))
        position.update_ne(*parts(ap))
        move_ne(ap, acc)
        if half == 0.0 and ap.estimate.pos[0] >= 10.0:
            half = k * DT
        most = max(most, float(ap.estimate.vel[0]))
        far = max(far, float(ap.estimate.pos[0]))
    assert half == pytest.approx(3.3, abs=0.15)
    assert most == pytest.approx(5.4, abs=0.3)
    assert far < 21.0
    assert ap.estimate.pos[0] == pytest.approx(20.0, abs=0.1)
    assert abs(ap.estimate.pos[1]) < 1e-6


def test_velocity_step_and_stop(ap):
    spooled(ap)
    acc = [Vec2(0.0, 0.0)]
    for _ in range(1600):
        position.input_vel_accel_ne(ap.control.pos_ne, Vec2(0.0, 3.0), REST)
        position.update_ne(*parts(ap))
        move_ne(ap, acc)
    assert ap.estimate.vel[1] == pytest.approx(3.0, abs=0.1)
    for _ in range(1600):
        position.brake_ne(ap.control.pos_ne)
        position.update_ne(*parts(ap))
        move_ne(ap, acc)
    assert abs(ap.estimate.vel[1]) < 0.1


def test_integrator_carries_steady_wind(ap):
    spooled(ap)
    acc = [Vec2(0.0, 0.0)]
    for _ in range(4800):
        position.input_pos_vel_accel_ne(ap.control.pos_ne, standing(0.0, 0.0))
        position.update_ne(*parts(ap))
        move_ne(ap, acc, wind=(1.0, 0.0))
    assert ap.estimate.pos[0] == pytest.approx(0.0, abs=0.15)
    assert ap.control.pos_ne.vel_integrator[0] == pytest.approx(-1.0, abs=0.2)


def test_storm_does_not_wind_up_the_integrator(ap):
    spooled(ap)
    ap.params.ANGLE_MAX = 1000.0
    acc = [Vec2(0.0, 0.0)]
    for _ in range(1600):
        position.input_pos_vel_accel_ne(ap.control.pos_ne, standing(0.0, 0.0))
        position.update_ne(*parts(ap))
        move_ne(ap, acc, wind=(4.0, 0.0))
    most = GRAVITY * math.tan(math.radians(10.0))
    assert math.hypot(*ap.control.pos_ne.accel_target) <= most * (1 + 1e-9)
    assert abs(ap.control.pos_ne.vel_integrator[0]) <= most
    assert ap.control.pos_ne.limit[0] != 0.0


def test_climb_of_10_m_keeps_the_speed_limit(ap):
    spooled(ap)
    thrust, fastest, highest = 1.0, 0.0, 0.0
    for _ in range(4000):
        altitude.input_pos_vel_accel_d(ap.control.pos_d, Motion(-10.0, 0.0, 0.0))
        altitude.update_d(*parts(ap))
        thrust = move_d(ap, thrust)
        fastest = max(fastest, -float(ap.estimate.vel[2]))
        highest = max(highest, -float(ap.estimate.pos[2]))
    assert fastest == pytest.approx(2.5, abs=0.1)
    assert highest < 10.15
    assert ap.estimate.pos[2] == pytest.approx(-10.0, abs=0.03)


def test_landing_descends_at_the_rate(ap):
    spooled(ap)
    thrust = 1.0
    for _ in range(1600):
        altitude.land_at_rate_d(ap.control.pos_d, 0.5, True)
        altitude.update_d(*parts(ap))
        thrust = move_d(ap, thrust)
    assert ap.estimate.vel[2] == pytest.approx(0.5, abs=0.02)


def test_init_does_not_move_the_throttle(ap):
    spooled(ap)
    ap.control.attitude.throttle_in = 0.42
    altitude_start.init_d(*parts(ap))
    altitude.update_d(*parts(ap))
    assert ap.control.attitude.throttle_in == pytest.approx(0.42, abs=1e-3)


def test_relaxed_throttle_decays(ap):
    spooled(ap)
    for _ in range(400):
        altitude_start.relax_d(*parts(ap), 0.0)
        altitude.update_d(*parts(ap))
        ap.control.tick += 1
    assert ap.control.attitude.throttle_in == pytest.approx(0.0, abs=0.01)


def test_jump_of_the_estimate_moves_the_path_with_it(ap):
    spooled(ap)
    position.input_pos_vel_accel_ne(ap.control.pos_ne, standing(0.0, 0.0))
    position.update_ne(*parts(ap))
    before = tuple(ap.control.pos_ne.accel_target)
    ap.control.tick += 1
    ap.estimate.pos = ap.estimate.pos.replace(x=ap.estimate.pos.x + 7.0)
    ap.estimate.pos = ap.estimate.pos.replace(z=ap.estimate.pos.z - 3.0)
    ap.estimate.reset_ne_count += 1
    ap.estimate.reset_d_count += 1
    position.update_ne(*parts(ap))
    altitude.update_d(*parts(ap))
    assert tuple(ap.control.pos_ne.accel_target) == pytest.approx(before, abs=1e-9)
    assert ap.control.pos_ne.pos_desired[0] == pytest.approx(7.0)
    assert ap.control.pos_d.pos_desired == pytest.approx(-3.0)


def test_stopping_point_is_ahead_and_bounded(ap):
    spooled(ap)
    ap.estimate.vel = (3.0, 4.0, -5.0)
    n, e = position_start.stopping_point_ne(ap.control.pos_ne, ap.estimate, ap.params.PSC)
    assert n / e == pytest.approx(0.75)
    assert math.hypot(n, e) == pytest.approx(0.5 * 2.5 + 25.0 / 5.0)
    assert altitude_start.stopping_point_d(ap.control.pos_d, ap.estimate, ap.params.PSC) == -3.0
    ap.estimate.vel = (0.0, 0.0, 0.0)
    assert position_start.stopping_point_ne(ap.control.pos_ne, ap.estimate, ap.params.PSC) == Vec2(0.0, 0.0)


@given(st.floats(-1.2, 1.2), st.floats(-1.2, 1.2), st.floats(-3.0, 3.0))
def test_acceleration_of_a_lean_is_that_of_its_thrust(roll, pitch, yaw):
    thrust = rotate(quat_from_euler(Euler(roll, pitch, yaw)), Vec3(0.0, 0.0, -1.0))
    level = thrust * (GRAVITY / -thrust.z)
    assert position_start.lean_accel(roll, pitch, yaw) == pytest.approx((level.x, level.y), rel=1e-9, abs=1e-9)


def test_straight_line_to_a_point_keeps_all_limits(ap):
    spooled(ap)
    for _ in range(1200):
        position_ned.input_pos_ned(ap.control.pos_ne, ap.control.pos_d, Vec3(30.0, 0.0, -30.0))
        ap.estimate.pos = (*ap.control.pos_ne.pos_desired, ap.control.pos_d.pos_desired)
        assert -ap.control.pos_d.vel_desired <= 2.5 * 1.02
        assert ap.control.pos_ne.vel_desired[0] <= 2.5 * 1.02  # 45 degrees: as fast as it may climb
    assert ap.control.pos_ne.vel_desired[0] == pytest.approx(-ap.control.pos_d.vel_desired, abs=0.3)


TARGETS = [
    (lambda ne, d, x: position.input_pos_vel_accel_ne(ne, Motion2(Vec2(*x[:2]), Vec2(*x[2:4]), Vec2(*x[4:]))), 6),
    (lambda ne, d, x: position.set_pos_vel_accel_ne(ne, Motion2(Vec2(*x[:2]), Vec2(*x[2:4]), Vec2(*x[4:]))), 6),
    (lambda ne, d, x: position.input_vel_accel_ne(ne, Vec2(*x[:2]), Vec2(*x[2:])), 4),
    (lambda ne, d, x: position.input_accel_ne(ne, Vec2(*x)), 2),
    (lambda ne, d, x: altitude.input_pos_vel_accel_d(d, Motion(*x)), 3),
    (lambda ne, d, x: altitude.set_pos_vel_accel_d(d, Motion(*x)), 3),
    (lambda ne, d, x: altitude.input_vel_accel_d(d, *x), 2),
    (lambda ne, d, x: position_ned.input_pos_ned(ne, d, Vec3(*x)), 3),
]


@pytest.mark.parametrize("bad", [math.nan, math.inf])
@pytest.mark.parametrize(("give", "count"), TARGETS)
def test_bad_targets_brake(ap, bad, give, count):
    spooled(ap)
    for k in range(count):
        give(ap.control.pos_ne, ap.control.pos_d, [bad if j == k else 0.0 for j in range(count)])
        position.update_ne(*parts(ap))
        altitude.update_d(*parts(ap))
        ap.control.tick += 1
        assert all(math.isfinite(x) for x in position.thrust_vector(ap.control.pos_ne))
        assert math.isfinite(ap.control.motors.throttle_in)


def test_the_path_waits_for_a_vehicle_that_cannot_keep_up():
    c = PositionState()
    c.pos_desired, c.correction_speed, c.correction_accel = Vec2(100.0, 0.0), 5.0, 2.5
    vel = position.control_position(c, Vec2(0.0, 0.0), 1.0)
    assert vel == pytest.approx((5.0, 0.0))
    assert c.pos_desired == c.pos_error and 0.0 < c.pos_desired.x < 100.0


@given(st.floats(-20.0, 20.0), st.floats(-20.0, 20.0))
def test_acceleration_stays_within_the_lean_and_says_where_it_is_used_up(north, east):
    c = PositionState()
    gains = position.PositionGains(1.0, Gains(2.0, 0.0, 0.25, 0.0, 0.0, 10.0, 0.0, 0.0, 5.0, 5.0))
    position.control_horizontal(c, Vec2(0.0, 0.0), Vec2(north, east), 3.0, gains)
    assert norm2(c.accel_target) <= 3.0 * (1 + 1e-9)
    assert (norm2(c.limit) > 0.0) == (2.0 * math.hypot(north, east) > 3.0)
    assert dot2(c.accel_target, Vec2(north, east)) <= 0.0


ALTITUDE = altitude.AltitudeGains(
    1.0,
    Gains(5.0, 0.0, 0.0, 0.0, 0.0, 10.0, 0.0, 0.0, 5.0, 5.0),
    Gains(0.05, 0.0, 0.0, 0.0, 0.0, 0.8, 0.0, 0.0, 20.0, 0.0),
)


@given(st.floats(-20.0, 20.0), st.floats(-3.0, 3.0))
def test_throttle_is_taken_off_above_the_path_and_added_below(pos, vel):
    c = AltitudeState()
    off = altitude.control_vertical(c, Motion(pos, vel, 0.0), Blocked(False, False), ALTITUDE)
    assert off == pytest.approx(-0.05 * 5.0 * (pos + vel), abs=1e-9)
    assert c.pos_error == -pos and c.vel_target == -pos and c.limit == 0.0


@pytest.mark.parametrize(("blocked", "limit"), [(Blocked(True, False), 1.0), (Blocked(False, True), -1.0)])
def test_the_path_learns_in_which_direction_thrust_is_used_up(blocked, limit):
    c = AltitudeState()
    altitude.control_vertical(c, Motion(0.0, 0.0, 0.0), blocked, ALTITUDE)
    assert c.limit == limit


@pytest.mark.parametrize(("error", "ratio"), [(5.0, 2.0), (-5.0, 0.0), (-1.25, 1.0)])
def test_how_well_a_descent_is_held_is_a_ratio_between_0_and_2(error, ratio):
    c = AltitudeState()
    c.control_ratio, c.speed_down, c.vel.error = 1.0, 2.5, error
    for _ in range(8000):
        altitude.note_limits(c, Blocked(False, False))
    assert c.control_ratio == pytest.approx(ratio)


@given(st.floats(-10.0, 10.0), st.floats(-10.0, 10.0))
def test_a_vehicle_stops_ahead_of_where_it_is(north, east):
    stop = position_start.stopping_point(Vec2(1.0, 2.0), Vec2(north, east), 1.0, 5.0, 2.5) - Vec2(1.0, 2.0)
    assert north * stop.y == pytest.approx(east * stop.x, abs=1e-9) and dot2(stop, Vec2(north, east)) >= 0.0
    assert norm2(stop) <= 0.5 * 2.5 + 25.0 / 5.0 + 1e-9


VELOCITY = Gains(2.0, 0.5, 0.25, 0.1, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0)
"""P, I, D, feed-forward; the integrator is at most 1 m/s^2."""


@pytest.mark.parametrize(("north", "east"), [(1.0, 0.0), (0.0, -1.0), (-0.6, 0.8)])
def test_the_acceleration_holds_all_terms_of_the_velocity_loop(north, east):
    c, wanted = PositionState(), Vec2(north, east)
    c.vel_target = wanted
    outs = [position.control_velocity(c, REST, VELOCITY) for _ in range(400)]
    assert outs[0] == pytest.approx((2.1 + 0.5 * DT) * wanted)
    assert outs[-1] == pytest.approx((2.1 + 0.5 * 400 * DT) * wanted)
    assert c.vel_integrator == pytest.approx(0.5 * 400 * DT * wanted)
    for _ in range(1000):
        position.control_velocity(c, REST, VELOCITY)
    assert c.vel_integrator == pytest.approx(wanted)  # at its limit
    out = position.control_velocity(c, 0.1 * wanted, VELOCITY)
    assert out == pytest.approx((2.0 * 0.9 + 0.1 + 1.0 - 0.25 * 0.1 / DT) * wanted)


def test_the_integrator_of_the_velocity_loop_does_not_grow_into_the_limit():
    c = PositionState()
    c.vel_target, c.vel_integrator, c.limit = Vec2(1.0, 0.0), Vec2(0.5, 0.0), Vec2(1.0, 0.0)
    position.control_velocity(c, REST, VELOCITY)
    assert c.vel_integrator == pytest.approx((0.5, 0.0))
    c.vel_target = Vec2(-1.0, 0.0)
    position.control_velocity(c, REST, VELOCITY)
    assert c.vel_integrator.x < 0.5
    position.control_velocity(c, REST, VELOCITY._replace(i=0.0))
    assert c.vel_integrator == (0.0, 0.0)


def test_gains_of_the_parameters(ap):
    psc = ap.params.PSC
    psc.VELXY.I, psc.VELXY.IMAX, psc.VELZ.I, psc.VELZ.IMAX = 0.7, 800.0, 0.3, 600.0
    psc.ACCZ.P, psc.ACCZ.I, psc.ACCZ.IMAX = 0.4, 0.9, 700.0
    horizontal = position.position_gains(psc)
    assert (horizontal.vel.i, horizontal.vel.i_max) == pytest.approx((0.7, 8.0))
    vertical = altitude.altitude_gains(psc, 0.3)
    assert (vertical.vel.i, vertical.vel.i_max) == pytest.approx((0.3, 6.0))
    assert (vertical.acc.p, vertical.acc.i, vertical.acc.i_max) == pytest.approx((0.04, 0.09, 0.7))
    assert altitude.altitude_gains(psc, 0.9).acc.i_max == 0.9  # all of the throttle that hovers


WITH_I = altitude.AltitudeGains(
    1.0,
    Gains(0.0, 2.0, 0.0, 0.0, 0.0, 10.0, 0.0, 0.0, 0.0, 0.0),
    Gains(0.0, 0.5, 0.0, 0.0, 0.0, 0.8, 0.0, 0.0, 0.0, 0.0),
)


@pytest.mark.parametrize("too_low", [1.0, -1.0])
def test_integrators_of_the_altitude_loops_push_back(too_low):
    """Below the path (z is down) the velocity loop asks for acceleration upward, and less throttle is taken off."""
    c, free = AltitudeState(), Blocked(False, False)
    for _ in range(400):
        off = altitude.control_vertical(c, Motion(0.1 * too_low, 0.0, 0.0), free, WITH_I)
    assert c.accel_target == pytest.approx(-2.0 * 0.1 * too_low * 400 * DT)
    assert c.vel.integrator == pytest.approx(c.accel_target)
    assert off == pytest.approx(-0.5 * 0.2 * too_low * sum((k + 1) * DT * DT for k in range(400)))
    assert c.accel.integrator == pytest.approx(off)


@pytest.mark.parametrize(("blocked", "error", "grows"), [
    (Blocked(True, False), 0.1, True), (Blocked(True, False), -0.1, False),
    (Blocked(False, True), 0.1, False), (Blocked(False, True), -0.1, True),
])  # fmt: skip
def test_the_velocity_integrator_of_altitude_does_not_wind_up(blocked, error, grows):
    """At the least throttle (down) it must not ask for more descent, at the greatest (up) not for more climb."""
    c = AltitudeState()
    altitude.control_vertical(c, Motion(error, 0.0, 0.0), blocked, WITH_I)
    assert (c.vel.integrator != 0.0) is grows


def test_a_position_that_is_no_number_asks_for_no_velocity(ap):
    control = spooled(ap).control.pos_ne
    control.pos_desired = Vec2(3.0, -4.0)
    assert norm2(position.control_position(control, Vec2(0.0, 0.0), 1.0)) > 1.0
    assert position.control_position(control, Vec2(math.nan, 0.0), 1.0) == REST
    assert control.pos_error == REST


def test_a_path_that_is_no_number_lets_the_copter_stop(ap):
    control = spooled(ap).control.pos_d
    altitude.set_pos_vel_accel_d(control, Motion(-5.0, 1.0, 0.5))
    assert (control.pos_desired, control.vel_desired, control.accel_desired) == (-5.0, 1.0, 0.5)
    speed = [1.0]
    for _ in range(1200):
        altitude.set_pos_vel_accel_d(control, Motion(-5.0, math.nan, 0.0))
        speed.append(float(control.vel_desired))
    assert min(speed) > -0.05 and max(speed) < 1.5 and abs(speed[-1]) < 1e-3


@pytest.mark.parametrize("speed", (0.5, 5.0))
def test_the_path_waits_for_a_copter_that_may_correct_only_slowly(ap, speed):
    control = spooled(ap).control.pos_ne
    control.correction_speed, control.correction_accel = speed, 2.5
    control.pos_desired = Vec2(30.0, 40.0)
    velocity = position.control_position(control, REST, 1.0)
    assert norm2(velocity) == pytest.approx(speed) and velocity.x == pytest.approx(0.6 * speed)
    assert norm2(control.pos_desired) == norm2(control.pos_error) < 50.0
