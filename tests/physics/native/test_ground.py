# SPDX-License-Identifier: BSD-3-Clause
import math

import pytest
from pytest import approx

from sitl.core.algebra import euler_of, quat_from_euler
from sitl.core.vectors import Euler
from sitl.physics.native.records import GROUND_AIRBORNE, GROUND_LYING, GROUND_STANDING


@pytest.mark.parametrize("frame", ["ardupilot_quad", "erle_copter"])
@pytest.mark.parametrize("control", [0.0, 0.5])
def test_stands_still_below_lift_off_thrust(rig, frame, control):
    r = rig(frame, heading=30.0)
    r.p.wind.vel = (3.0, -4.0, 0.5)
    q = list(r.p.body.q)
    r.command(control, 0.9 * control, control, control)
    r.move(100)
    assert list(r.p.body.pos) == [0.0, 0.0, 0.0]
    assert list(r.p.body.vel) == [0.0, 0.0, 0.0]
    assert list(r.p.body.q) == q
    assert list(r.p.body.specific_force) == approx([0.0, 0.0, -9.80665])


def test_lifts_off_above_it(rig):
    r = rig()
    r.command(0.62)
    r.move(80)
    assert r.p.ground.state == GROUND_AIRBORNE
    assert r.p.body.pos[2] < -0.01


def test_landing_is_reported_once_with_its_speed(rig):
    r = rig()
    r.fly(0.02)
    r.p.body.vel = r.p.body.vel.replace(z=0.5)
    felt = 0.0
    for _ in range(200):
        r.move()
        felt += 0.0025 * (float(r.p.body.specific_force[2]) + 9.80665)
        assert r.p.body.pos[2] <= 0.0
    assert r.p.ground.hit_count == 1
    assert r.p.ground.hit_speed == approx(math.sqrt(0.25 + 2 * 9.8 * 0.02), rel=0.05)
    assert list(r.p.body.vel) == [0.0, 0.0, 0.0]
    assert felt == approx(-0.5, abs=1e-4)  # what the accelerometer feels takes the whole speed away


def test_gentle_touch_is_not_reported(rig):
    r = rig()
    r.fly(1e-5)
    r.p.body.vel = r.p.body.vel.replace(z=0.05)
    r.command(0.59)
    r.move(5)
    assert r.p.ground.state == GROUND_STANDING
    assert r.p.ground.hit_count == 0


def test_slides_to_a_stop(rig):
    r = rig("erle_copter")
    r.fly(0.0)
    r.p.body.vel = (1.0, 0.0, 0.1)
    r.move(200)
    assert list(r.p.body.vel) == [0.0, 0.0, 0.0]
    assert r.p.body.pos[0] == approx(1.0 / (2.0 * 0.8 * 9.80665), abs=0.003)


def test_legs_level_a_leaning_touch(rig):
    r = rig()
    r.fly(0.001)
    r.p.body.q = quat_from_euler(Euler(0.3, -0.2, 1.0))
    r.p.body.vel = r.p.body.vel.replace(z=0.5)
    r.move(120)
    roll, pitch, yaw = euler_of(r.p.body.q)
    assert (roll, pitch) == approx((0.0, 0.0), abs=2e-5)
    assert yaw == approx(1.0, abs=0.05)
    assert list(r.p.body.rates) == [0.0, 0.0, 0.0]


def test_tipped_over_it_lies_whatever_the_rotors_do(rig):
    r = rig()
    r.fly(0.001)
    r.p.body.q = quat_from_euler(Euler(2.0, 0.0, 0.0))
    r.p.body.vel = (0.5, 0.0, 1.0)
    r.command(0.8)
    r.move(100)
    assert r.p.ground.state == GROUND_LYING
    assert euler_of(r.p.body.q)[0] == approx(2.0, abs=0.05)
    assert list(r.p.body.vel) == [0.0, 0.0, 0.0]
    assert r.p.body.pos[2] == 0.0
