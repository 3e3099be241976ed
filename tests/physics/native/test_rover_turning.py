# SPDX-License-Identifier: BSD-3-Clause
"""Rovers turn: circles, skid steering, grip, and what gyro and accelerometer say of it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pytest import approx

from sitl.core.algebra import multiply, rotate
from sitl.physics.native import truth
from sitl.physics.native.body import small_rotation


def test_full_steering_of_erle_rover_is_a_circle_of_2_m(rig):
    r = rig("erle_rover")
    r.command(0.8, 0.4)
    r.move(2000)
    rate = float(r.p.body.rates[2])
    assert r.p.wheels.forward / rate == approx(2.00, abs=0.01)  # [m] of the rear axle
    assert math.hypot(*r.p.body.vel[:2]) / rate == approx(math.hypot(2.002, 0.864), abs=0.01)  # of the IMU
    left, right = r.p.wheels.distance
    assert left > right > 0.0


def test_ardupilots_rover_turns_in_1_8_m(rig):
    r = rig("ardupilot_rover")
    r.command(-1.0, 0.1)
    r.move(4000)
    assert r.p.wheels.forward / r.p.body.rates[2] == approx(-0.9)
    r.command(0.5, 0.1)
    r.move(1)
    expected = 0.9 * math.sin(math.radians(35.0)) / math.sin(math.radians(17.5))
    assert r.p.wheels.forward / r.p.body.rates[2] == approx(expected)


def test_reverse_turns_the_other_way(rig):
    r = rig("erle_rover")
    r.command(0.4, -0.4)
    r.move(1000)
    assert r.p.body.rates[2] < -0.05


def test_front_wheels_turn_at_their_rate(rig):
    r = rig("erle_rover")
    r.command(0.8, 0.0)
    r.move(20)  # 50 ms
    assert r.p.wheels.angle == approx(7.5 * 0.05)
    r.move(100)
    assert r.p.wheels.angle == 0.7727


def test_skid_steering_turns_on_the_spot(rig):
    r = rig("skid_rover")
    r.command(0.2, -0.2)
    r.move(3000)
    side = 2.1 * 0.25 - 0.2 * 0.05 * 9.80665  # under the load of its tyres
    assert r.p.body.rates[2] == approx(2.0 * side / (0.376 * 1.5), rel=1e-6)
    assert list(r.p.body.pos) == approx([0.0, 0.0, 0.0], abs=1e-9)
    assert r.p.wheels.distance[0] == approx(-r.p.wheels.distance[1])


@pytest.mark.parametrize("grip", [0.05, 1.0])
def test_beyond_its_grip_it_runs_wide(rig, grip):
    r = rig("erle_rover", grip=grip)
    r.command(0.8, 0.8)
    r.move(4000)
    speed, rate = float(r.p.wheels.forward), float(r.p.body.rates[2])
    asked = speed * math.tan(0.7727) / 1.95222
    assert rate == approx(min(asked, grip * 9.80665 / speed), rel=1e-3)


@given(st.lists(st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0)), min_size=1, max_size=5), st.floats(0.02, 2.0))
def test_tyres_never_give_more_than_their_grip(rig_factory, commands, grip):
    """Along and across at the driven axle; the body's turn adds the swing of the origin ahead of it."""
    r = rig_factory("erle_rover", grip=grip, rear_axle=0.0)
    for command in commands:
        r.command(*command)
        for _ in range(60):
            before = float(r.p.body.rates[2])
            r.move()
            force = math.hypot(*r.p.body.specific_force[:2])
            assert force <= grip * 9.80665 * (1.0 + 1e-6) + abs(r.p.wheels.forward) * r.p.derived.yaw_step
            assert abs(r.p.body.rates[2] - before) <= r.p.derived.yaw_step * (1.0 + 1e-9)


def weave(r, ticks=2000):
    """Drive through changing curves; yields after each tick."""
    for k in range(ticks):
        r.command(0.6 * math.sin(0.01 * k), 0.5 + 0.3 * math.cos(0.004 * k))
        r.move()
        yield k


def test_a_full_circle_ends_where_it_began(rig):
    r = rig("ardupilot_rover", heading=40.0)
    r.command(0.5, 0.1)
    r.move(4000)  # at its speed
    start, before, turned = np.array(r.p.body.pos), truth.read(r.v).euler[2], 0.0
    while turned < 2.0 * math.pi:
        r.move()
        now = truth.read(r.v).euler[2]
        turned += (now - before) % (2.0 * math.pi)
        before = now
    left_over = (turned - 2.0 * math.pi) / float(r.p.body.rates[2]) * float(r.p.wheels.forward)
    assert np.linalg.norm(np.array(r.p.body.pos) - start) == approx(left_over, abs=1e-3)


def test_an_inertial_integration_of_gyro_and_accelerometer_gives_the_path(rig):
    for frame in ("erle_rover", "ardupilot_rover", "skid_rover"):
        r = rig(frame, heading=75.0)
        q, vel, pos = r.p.body.q, np.zeros(3), np.zeros(3)
        for _ in weave(r):
            turn = small_rotation(0.5 * 0.0025 * r.p.body.rates_mean)
            half = multiply(q, turn)
            q = multiply(half, turn)
            acc = np.array(rotate(half, r.p.body.specific_force)) + (0.0, 0.0, 9.80665)
            pos += 0.0025 * (vel + 0.00125 * acc)
            vel += 0.0025 * acc
        assert list(q) == approx(r.p.body.q, abs=1e-9)
        assert vel.tolist() == approx(r.p.body.vel, abs=1e-6)
        assert pos.tolist() == approx(r.p.body.pos, abs=1e-3)


def test_body_stays_level_and_the_driven_axle_does_not_slide(rig):
    r = rig("erle_rover", heading=75.0)
    for _ in weave(r):
        assert r.p.body.q[1] == r.p.body.q[2] == r.p.body.pos[2] == 0.0
        yaw = truth.read(r.v).euler[2]
        across = r.p.body.vel[1] * math.cos(yaw) - r.p.body.vel[0] * math.sin(yaw)
        assert across - 0.864 * r.p.body.rates[2] == approx(0.0, abs=1e-9)
    assert np.linalg.norm(r.p.body.q) == approx(1.0, abs=1e-14)
    assert truth.read(r.v).on_ground


def test_accelerometer_sees_the_curve(rig):
    r = rig("ardupilot_rover")
    r.command(0.3, 0.1)
    r.move(8000)
    speed, rate = float(r.p.wheels.forward), float(r.p.body.rates[2])
    assert list(r.p.body.specific_force) == approx([0.0, speed * rate, -9.80665], abs=1e-3)
    assert speed * rate > 1.0
