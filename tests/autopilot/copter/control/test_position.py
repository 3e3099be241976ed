# SPDX-License-Identifier: BSD-3-Clause
"""Position control on a point mass in plain Python: responses, anti-windup, jumps of the estimate, bad
numbers.
"""

from __future__ import annotations

import math

import pytest

from sitl.autopilot.copter.control import altitude, position, position_ned
from sitl.autopilot.copter.control.motors import hover_throttle
from sitl.autopilot.copter.control.state import DT, GRAVITY

LAG = 0.12  # of lean and of thrust [s]


def spooled(ap):
    ap.control.tick = 5
    ap.control.motors.thrust_max = 1.0
    ap.control.attitude.lean_max = 1.2
    position.set_max_speed_accel_ne(ap, 10.0, 2.5)
    altitude.set_max_speed_accel_d(ap, 1.5, 2.5, 1.0)
    ap.control.attitude.throttle_in = hover_throttle(ap)
    position.init_ne(ap)
    altitude.init_d(ap)
    return ap


def move_ne(ap, acc, wind=(0.0, 0.0)):
    """One tick of a mass whose acceleration follows the target with a lag."""
    for k in range(2):
        acc[k] += (float(ap.control.pos_ne.accel_target[k]) - acc[k]) * DT / LAG
        a = acc[k] + wind[k]
        pos, vel = list(ap.estimate.pos), list(ap.estimate.vel)
        pos[k] += vel[k] * DT + 0.5 * a * DT * DT
        vel[k] += a * DT
        ap.estimate.pos, ap.estimate.vel = tuple(pos), tuple(vel)
    ap.control.tick += 1


def move_d(ap, thrust):
    """One tick of a mass under a thrust that follows the throttle with a lag; returns the thrust over the
    weight.
    """
    wanted = float(ap.control.motors.throttle_in) / hover_throttle(ap)
    thrust += (min(max(wanted, 0.0), 2.5) - thrust) * DT / LAG
    a = GRAVITY * (1.0 - thrust)
    ap.estimate.acc_ned = ap.estimate.acc_ned.replace(z=a)
    ap.estimate.pos = ap.estimate.pos.replace(z=ap.estimate.pos.z + ap.estimate.vel[2] * DT + 0.5 * a * DT * DT)
    ap.estimate.vel = ap.estimate.vel.replace(z=ap.estimate.vel.z + a * DT)
    ap.control.tick += 1
    return thrust


def test_step_of_20_m(ap):
    spooled(ap)
    acc, half, most, far = [0.0, 0.0], 0.0, 0.0, 0.0
    for k in range(4000):
        position.input_pos_vel_accel_ne(ap, 20.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        position.update_ne(ap)
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
    acc = [0.0, 0.0]
    for _ in range(1600):
        position.input_vel_accel_ne(ap, 0.0, 3.0, 0.0, 0.0)
        position.update_ne(ap)
        move_ne(ap, acc)
    assert ap.estimate.vel[1] == pytest.approx(3.0, abs=0.1)
    for _ in range(1600):
        position.input_vel_accel_ne(ap, 0.0, 0.0, 0.0, 0.0)
        position.update_ne(ap)
        move_ne(ap, acc)
    assert abs(ap.estimate.vel[1]) < 0.1


def test_integrator_carries_steady_wind(ap):
    spooled(ap)
    acc = [0.0, 0.0]
    for _ in range(4800):
        position.input_pos_vel_accel_ne(ap, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        position.update_ne(ap)
        move_ne(ap, acc, wind=(1.0, 0.0))
    assert ap.estimate.pos[0] == pytest.approx(0.0, abs=0.15)
    assert ap.control.pos_ne.vel_integrator[0] == pytest.approx(-1.0, abs=0.2)


def test_storm_does_not_wind_up_the_integrator(ap):
    spooled(ap)
    ap.params.ANGLE_MAX = 1000.0
    acc = [0.0, 0.0]
    for _ in range(1600):
        position.input_pos_vel_accel_ne(ap, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        position.update_ne(ap)
        move_ne(ap, acc, wind=(4.0, 0.0))
    most = GRAVITY * math.tan(math.radians(10.0))
    assert math.hypot(*ap.control.pos_ne.accel_target) <= most * (1 + 1e-9)
    assert abs(ap.control.pos_ne.vel_integrator[0]) <= most
    assert ap.control.pos_ne.limit[0] != 0.0


def test_climb_of_10_m_keeps_the_speed_limit(ap):
    spooled(ap)
    thrust, fastest, highest = 1.0, 0.0, 0.0
    for _ in range(4000):
        altitude.input_pos_vel_accel_d(ap, -10.0, 0.0, 0.0)
        altitude.update_d(ap)
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
        altitude.land_at_rate_d(ap, 0.5, 1)
        altitude.update_d(ap)
        thrust = move_d(ap, thrust)
    assert ap.estimate.vel[2] == pytest.approx(0.5, abs=0.02)


def test_init_does_not_move_the_throttle(ap):
    spooled(ap)
    ap.control.attitude.throttle_in = 0.42
    altitude.init_d(ap)
    altitude.update_d(ap)
    assert ap.control.attitude.throttle_in == pytest.approx(0.42, abs=1e-3)


def test_relaxed_throttle_decays(ap):
    spooled(ap)
    for _ in range(400):
        altitude.relax_d(ap, 0.0)
        altitude.update_d(ap)
        ap.control.tick += 1
    assert ap.control.attitude.throttle_in == pytest.approx(0.0, abs=0.01)


def test_jump_of_the_estimate_moves_the_path_with_it(ap):
    spooled(ap)
    position.input_pos_vel_accel_ne(ap, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    position.update_ne(ap)
    before = tuple(ap.control.pos_ne.accel_target)
    ap.control.tick += 1
    ap.estimate.pos = ap.estimate.pos.replace(x=ap.estimate.pos.x + 7.0)
    ap.estimate.pos = ap.estimate.pos.replace(z=ap.estimate.pos.z - 3.0)
    ap.estimate.reset_ne_count += 1
    ap.estimate.reset_d_count += 1
    position.update_ne(ap)
    altitude.update_d(ap)
    assert tuple(ap.control.pos_ne.accel_target) == pytest.approx(before, abs=1e-9)
    assert ap.control.pos_ne.pos_desired[0] == pytest.approx(7.0)
    assert ap.control.pos_d.pos_desired == pytest.approx(-3.0)


def test_stopping_point_is_ahead_and_bounded(ap):
    spooled(ap)
    ap.estimate.vel = (3.0, 4.0, -5.0)
    n, e = position.stopping_point_ne(ap)
    assert n / e == pytest.approx(0.75)
    assert math.hypot(n, e) == pytest.approx(0.5 * 2.5 + 25.0 / 5.0)
    assert altitude.stopping_point_d(ap) == -3.0
    ap.estimate.vel = (0.0, 0.0, 0.0)
    assert position.stopping_point_ne(ap) == (0.0, 0.0)


def test_lean_targets_give_the_acceleration(ap):
    spooled(ap)
    ap.estimate.euler = ap.estimate.euler.replace(yaw=0.7)
    ap.control.pos_ne.accel_target[:] = (1.0, -2.0)
    roll, pitch = position.lean_targets(ap)
    assert position.lean_accel(roll, pitch, 0.7) == pytest.approx((1.0, -2.0))


def test_straight_line_to_a_point_keeps_all_limits(ap):
    spooled(ap)
    for _ in range(1200):
        position_ned.input_pos_ned(ap, 30.0, 0.0, -30.0)
        ap.estimate.pos = (*ap.control.pos_ne.pos_desired, ap.control.pos_d.pos_desired)
        assert -ap.control.pos_d.vel_desired <= 2.5 * 1.02
        assert ap.control.pos_ne.vel_desired[0] <= 2.5 * 1.02  # 45 degrees: as fast as it may climb
    assert ap.control.pos_ne.vel_desired[0] == pytest.approx(-ap.control.pos_d.vel_desired, abs=0.3)


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_bad_targets_brake(ap, bad):
    spooled(ap)
    for law, count in (
        (position.input_pos_vel_accel_ne, 6),
        (position.set_pos_vel_accel_ne, 6),
        (position.input_vel_accel_ne, 4),
        (position.input_accel_ne, 2),
        (altitude.input_pos_vel_accel_d, 3),
        (altitude.set_pos_vel_accel_d, 3),
        (altitude.input_vel_accel_d, 2),
        (position_ned.input_pos_ned, 3),
    ):
        for k in range(count):
            law(ap, *(bad if j == k else 0.0 for j in range(count)))
            position.update_ne(ap)
            altitude.update_d(ap)
            ap.control.tick += 1
            assert all(math.isfinite(x) for x in position.thrust_vector(ap))
            assert math.isfinite(ap.control.motors.throttle_in)
