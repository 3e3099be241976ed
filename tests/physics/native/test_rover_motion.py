# SPDX-License-Identifier: BSD-3-Clause
import math

import numpy as np
from pytest import approx

from sitl.core.algebra import multiply, rotate
from sitl.physics.native import truth
from sitl.physics.native.body import small_rotation


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
