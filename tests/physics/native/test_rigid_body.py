# SPDX-License-Identifier: BSD-3-Clause
import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx

from sitl.core.rotations import quat_from_euler, quat_multiply, quat_rotate
from sitl.physics.native.body import GRAVITY, fly, small_rotation

angle = st.floats(-3.0, 3.0)
rate = st.floats(-15.0, 15.0)


def momentum_ned(p):
    b, inertia = p.body, p.airframe.inertia
    return np.array(quat_rotate(*b.q.tolist(), *(float(inertia[j]) * float(b.rates[j]) for j in range(3))))


def test_free_fall_without_air(rig):
    r = rig(drag_area=(0.0, 0.0, 0.0), momentum_drag=0.0, noise_scale=0.0)
    r.fly()
    r.step(80)
    assert r.p.body.vel[2] == approx(GRAVITY * 0.2)
    assert r.p.body.pos[2] == approx(-100.0 + 0.5 * GRAVITY * 0.04)
    assert r.p.body.specific_force.tolist() == approx([0.0, 0.0, 0.0], abs=1e-12)
    assert list(r.v.sensors.acc) == approx([0.0, 0.0, 0.0], abs=1e-6)


@given(st.tuples(angle, angle, angle), st.tuples(rate, rate, rate))
@settings(max_examples=25, deadline=None)
def test_free_body_keeps_momentum_and_norm(rig_factory, euler, rates):
    r = rig_factory("erle_copter")
    r.fly()
    r.p.body.q = quat_from_euler(*euler)
    r.p.body.rates = rates
    before = momentum_ned(r.p)
    for _ in range(40):
        fly(r.p, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    assert np.linalg.norm(r.p.body.q) == approx(1.0, abs=1e-14)
    assert momentum_ned(r.p) == approx(before, abs=1e-12 + 1e-11 * float(np.linalg.norm(before)))


def test_free_body_keeps_its_energy_and_is_second_order(rig):
    def tumble(substeps):
        r = rig("erle_copter", substeps=substeps)
        r.fly()
        r.p.body.rates = (6.0, 5.0, -7.0)
        for _ in range(100 * substeps):
            fly(r.p, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        inertia = r.p.airframe.inertia
        return np.array([*r.p.body.rates, *r.p.body.q]), float(np.sum(np.array(inertia) * r.p.body.rates**2))

    exact, energy = tumble(16)
    coarse, coarse_energy = tumble(1)
    fine, _ = tumble(2)
    assert coarse_energy == approx(energy, rel=1e-5)
    ratio = np.linalg.norm(coarse - exact) / np.linalg.norm(fine - exact)
    assert 3.5 < ratio < 4.5


def test_constant_torque_spins_up_exactly(rig):
    r = rig("erle_copter")
    r.fly()
    for _ in range(400):
        fly(r.p, 0.0, 0.0, 0.0, 0.0, 0.0, 0.01)
    assert r.p.body.rates[2] == approx(0.01 / 0.0977)
    yaw = 2.0 * math.atan2(float(r.p.body.q[3]), float(r.p.body.q[0]))
    assert yaw == approx(0.5 * 0.01 / 0.0977)


@given(st.tuples(*[st.floats(-0.28, 0.28)] * 3))
def test_small_rotation_is_the_exact_one(vector):
    x, y, z = vector
    n = math.sqrt(x * x + y * y + z * z)
    k = math.sin(0.5 * n) / n if n > 1e-9 else 0.5
    assert small_rotation(x, y, z) == approx((math.cos(0.5 * n), k * x, k * y, k * z), abs=1e-9)


def test_mean_rates_turn_the_attitude(rig):
    """Integrating what the gyro would show gives the attitude, so that a filter sees no error of its own."""
    r = rig("erle_copter", noise_scale=0.0)
    r.fly()
    r.command(0.62, 0.60, 0.58, 0.60)
    q = np.array(r.p.body.q)
    for _ in range(60):
        r.move()
        q = np.array(quat_multiply(*q.tolist(), *small_rotation(*(0.0025 * r.p.body.rates_mean).tolist())))
    assert q == approx(r.p.body.q, abs=1e-9)
    assert abs(float(r.p.body.rates[0])) > 0.05
