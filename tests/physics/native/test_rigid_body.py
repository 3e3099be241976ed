# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from pytest import approx

from sitl.core.algebra import (
    IDENTITY,
    ZERO,
    by_component,
    dot,
    euler_of,
    multiply,
    quat_from_euler,
    quat_from_rotation_vector,
    rotate,
)
from sitl.core.constants import GRAVITY, TICK_S
from sitl.core.vectors import Euler, Quat, Vec3
from sitl.physics.native.body import Inertia, Wrench, fly, small_rotation
from sitl.physics.native.records import Body

MOMENTS = Vec3(0.0347, 0.0459, 0.0977)
INERTIA = Inertia(MOMENTS, Vec3(1.0 / 0.0347, 1.0 / 0.0459, 1.0 / 0.0977), 1.0 / 1.14)
NOTHING = Wrench(ZERO, ZERO)
angle = st.floats(-3.0, 3.0)
rate = st.floats(-15.0, 15.0)


def momentum_ned(body):
    return np.array(rotate(body.q, by_component(MOMENTS, body.rates)))


def test_free_fall_without_air(rig):
    r = rig(drag_area=(0.0, 0.0, 0.0), momentum_drag=0.0, noise_scale=0.0)
    r.fly()
    r.step(80)
    assert r.p.body.vel[2] == approx(GRAVITY * 0.2)
    assert r.p.body.pos[2] == approx(-100.0 + 0.5 * GRAVITY * 0.04)
    assert list(r.p.body.specific_force) == approx([0.0, 0.0, 0.0], abs=1e-12)
    assert list(r.v.sensors.acc) == approx([0.0, 0.0, 0.0], abs=1e-6)


@given(st.builds(Euler, angle, angle, angle), st.builds(Vec3, rate, rate, rate))
def test_free_body_keeps_momentum_and_norm(euler, rates):
    body = Body()
    body.q, body.rates = quat_from_euler(euler), rates
    before = momentum_ned(body)
    for _ in range(40):
        fly(body, NOTHING, INERTIA, TICK_S)
    assert np.linalg.norm(body.q) == approx(1.0, abs=1e-14)
    assert momentum_ned(body) == approx(before, abs=1e-12 + 1e-11 * float(np.linalg.norm(before)))


def test_free_body_keeps_its_energy_and_is_second_order():
    def tumble(substeps):
        body = Body()
        body.q, body.rates = IDENTITY, (6.0, 5.0, -7.0)
        for _ in range(100 * substeps):
            fly(body, NOTHING, INERTIA, TICK_S / substeps)
        return np.array([*body.rates, *body.q]), dot(by_component(MOMENTS, body.rates), body.rates)

    exact, energy = tumble(16)
    coarse, coarse_energy = tumble(1)
    fine, _ = tumble(2)
    assert coarse_energy == approx(energy, rel=1e-5)
    ratio = np.linalg.norm(coarse - exact) / np.linalg.norm(fine - exact)
    assert 3.5 < ratio < 4.5


def test_constant_torque_spins_up_exactly():
    body = Body()
    body.q = IDENTITY
    for _ in range(400):
        fly(body, Wrench(ZERO, Vec3(0.0, 0.0, 0.01)), INERTIA, TICK_S)
    assert body.rates.z == approx(0.01 / 0.0977)
    assert euler_of(body.q).yaw == approx(0.5 * 0.01 / 0.0977)


@given(st.builds(Vec3, *[st.floats(-50.0, 50.0)] * 3), st.builds(Vec3, rate, rate, rate))
def test_force_and_gravity_give_their_acceleration(force, vel):
    body = Body()
    body.q, body.vel = IDENTITY, vel
    fly(body, Wrench(force, ZERO), INERTIA, TICK_S)
    acc = np.array(force) * INERTIA.inverse_mass + (0.0, 0.0, GRAVITY)
    assert list(body.vel) == approx(np.array(vel) + TICK_S * acc)
    assert list(body.pos) == approx(TICK_S * np.array(vel) + 0.5 * TICK_S**2 * acc)


@given(st.builds(Vec3, *[st.floats(-0.28, 0.28)] * 3))
def test_small_rotation_is_the_exact_one(vector):
    assert small_rotation(vector) == approx(quat_from_rotation_vector(vector), abs=1e-9)


def test_mean_rates_turn_the_attitude(rig):
    """Integrating what the gyro would show gives the attitude, so that a filter sees no error of its own."""
    r = rig("erle_copter", noise_scale=0.0)
    r.fly()
    r.command(0.62, 0.60, 0.58, 0.60)
    q = np.array(r.p.body.q)
    for _ in range(60):
        r.move()
        q = np.array(multiply(Quat(*q), small_rotation(0.0025 * r.p.body.rates_mean)))
    assert q == approx(r.p.body.q, abs=1e-9)
    assert abs(float(r.p.body.rates[0])) > 0.05


def spin_about_the_third_axis(rig, **properties):
    r = rig("ardupilot_quad", angular_damping=0.0, momentum_drag=0.0, noise_scale=0.0, **properties)
    r.fly()
    r.p.body.rates = Vec3(4.0, 0.0, 2.0)
    r.move(20)
    return r.p.body.rates.y


def test_ardupilots_bodies_turn_about_each_axis_for_itself(rig):
    """Its model divides torques by moments of inertia; a real quad, twice as heavy to yaw as to roll, would pitch."""
    assert spin_about_the_third_axis(rig) == approx(0.0, abs=2e-3)
    assert spin_about_the_third_axis(rig, gyroscopic=1) == approx(4.0 * 2.0 * 20 * TICK_S, rel=0.05)
