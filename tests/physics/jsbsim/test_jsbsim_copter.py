# SPDX-License-Identifier: BSD-3-Clause
"""Multicopters on JSBSim: at rest, in the hover, falling, tipping over."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sitl.core.algebra import euler_of, quat_from_euler
from sitl.core.vectors import Euler, Quat
from sitl.physics.native.records import GROUND_AIRBORNE, GROUND_LYING, GROUND_STANDING
from tests.physics.jsbsim.jsbsim_bench import Bench

FRAMES = pytest.mark.parametrize("frame", ("erle_copter", "ardupilot_quad"))


@FRAMES
def test_rests_quietly(frame: str) -> None:
    """Nothing that an IMU would show, for 20 s, and where it was put."""
    b = Bench(frame)
    noise = []
    for _ in range(8000):
        b.engine.tick()
        noise.append([*b.body.specific_force, *b.body.rates_mean])
    away = np.abs(np.array(noise) - (0.0, 0.0, -9.80665, 0.0, 0.0, 0.0)).max(0)
    assert away[:3].max() < 1e-4  # [m/s^2]
    assert away[3:].max() < 1e-5  # [rad/s]
    assert np.abs(b.body.pos).max() < 1e-6
    assert b.p.ground.state == GROUND_STANDING


def hover_control(b: Any) -> float:
    """Control that carries the weight, by the airframe's own properties."""
    a = b.p.airframe
    share = a.mass * 9.80665 / int(a.rotor_count)
    if a.thrust_model == 0:
        command = math.sqrt(share / a.thrust_coefficient) / a.speed_max
    else:
        part = share / (0.5 * b.p.air.density * a.outflow_area * a.outflow_speed_max**2)
        e = a.thrust_expo
        command = (e - 1.0 + math.sqrt((1.0 - e) ** 2 + 4.0 * e * part)) / (2.0 * e)
    return float(a.control_min + command * (a.control_max - a.control_min))


@FRAMES
def test_hovers_open_loop(frame: str) -> None:
    """The control that carries the weight keeps it at its height, level."""
    b = Bench(frame)
    b.run(0.5, *(hover_control(b),) * 4)  # rotors are at speed; it stands
    b.put(pos=(0.0, 0.0, -3.0), vel=(0.0, 0.0, 0.0), rates=(0.0, 0.0, 0.0))
    b.run(1.0)
    assert b.body.vel == pytest.approx([0.0, 0.0, 0.0], abs=1e-2)
    assert b.body.pos[2] == pytest.approx(-3.0, abs=1e-2)
    assert b.p.ground.state == GROUND_AIRBORNE


@FRAMES
def test_takes_off_when_it_can_carry_itself(frame: str) -> None:
    b = Bench(frame)
    control = hover_control(b)
    b.run(2.0, *(control - 0.02,) * 4)
    assert b.p.ground.state == GROUND_STANDING
    assert np.linalg.norm(b.body.pos) < 0.01
    b.run(2.0, *(control + 0.02,) * 4)
    assert b.p.ground.state == GROUND_AIRBORNE
    assert b.body.pos[2] < -0.5


def test_a_fall_is_reported() -> None:
    """From 0.5 m: 3.1 m/s, once; then it stands still, level."""
    b = Bench("erle_copter")
    b.put(pos=(0.0, 0.0, -0.5), q=quat_from_euler(Euler(0.1, 0.0, 1.0)))
    b.run(3.0, *(0.0,) * 4)
    g = b.p.ground
    assert (g.state, g.hit_count) == (GROUND_STANDING, 1)
    assert g.hit_speed == pytest.approx(math.sqrt(2.0 * 9.80665 * 0.5), rel=0.05)
    assert np.abs(b.body.vel).max() < 1e-4
    roll, pitch, yaw = euler_of(Quat(*b.body.q))
    assert (roll, pitch) == pytest.approx((0.0, 0.0), abs=1e-4)
    assert yaw == pytest.approx(1.0, abs=0.2)


def test_falls_over_and_stays_there() -> None:
    """Beyond its tip angle it does not come upright, and its rotors carry it no more."""
    b = Bench("erle_copter")
    b.put(pos=(0.0, 0.0, -0.3), q=quat_from_euler(Euler(math.radians(100.0), 0.0, 0.0)))
    b.run(4.0, *(0.0,) * 4)
    assert b.p.ground.state == GROUND_LYING
    assert abs(euler_of(Quat(*b.body.q))[0]) > math.radians(60.0)
    assert abs(b.body.pos[2]) < 0.3
    place = np.array(b.body.pos)
    b.run(2.0, *(0.8,) * 4)
    assert b.body.pos == pytest.approx(place, abs=0.05)
    assert b.p.ground.state == GROUND_LYING


def test_slides_to_a_stop() -> None:
    """Coulomb friction: v^2 / (2 mu g)."""
    b = Bench("erle_copter")
    b.put(vel=(1.0, 0.0, 0.0))
    b.run(1.0, *(0.0,) * 4)
    assert b.body.pos[0] == pytest.approx(1.0 / (2.0 * b.p.airframe.ground_friction * 9.80665), rel=0.15)
    assert np.abs(b.body.vel).max() < 1e-4


def test_wind_carries_it_along() -> None:
    """A hovering copter drifts towards the wind's speed."""
    b = Bench("erle_copter", params={"SIM_WIND_SPD": 5.0, "SIM_WIND_DIR": 180.0})
    b.run(0.5, *(hover_control(b),) * 4)
    b.put(pos=(0.0, 0.0, -3.0), vel=(0.0, 0.0, 0.0), q=(1.0, 0.0, 0.0, 0.0), rates=(0.0, 0.0, 0.0))
    b.run(0.5)
    assert 0.1 < b.body.vel[0] < 1.0
    assert abs(b.body.vel[1]) < 0.2
