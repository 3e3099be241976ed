# SPDX-License-Identifier: BSD-3-Clause
"""Rovers on JSBSim: at rest, straight on, on a circle, braking."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sitl.core.algebra import euler_of
from sitl.core.vectors import Quat
from sitl.physics.native.rover.steering import curvature
from tests.physics.jsbsim.jsbsim_bench import Bench

ALL = pytest.mark.parametrize("frame", ("erle_rover", "erle_rover_small", "ardupilot_rover", "skid_rover"))
CARS = pytest.mark.parametrize("frame", ("erle_rover", "erle_rover_small", "ardupilot_rover"))


def straight(frame: str, share: float) -> tuple[float, float, float]:
    """Controls for this share of full speed, straight on."""
    return (share, 0.0, share) if frame == "skid_rover" else (0.0, 0.0, share)


def speed(b: Any) -> float:
    return float(np.hypot(b.body.vel[0], b.body.vel[1]))


@ALL
def test_rests_quietly(frame: str) -> None:
    b = Bench(frame)
    noise = []
    for _ in range(4000):
        b.engine.tick()
        noise.append([*b.body.specific_force, *b.body.rates_mean])
    away = np.abs(np.array(noise) - (0.0, 0.0, -9.80665, 0.0, 0.0, 0.0)).max(0)
    assert away[:3].max() < 1e-4
    assert away[3:].max() < 1e-5
    assert np.abs(b.body.pos).max() < 1e-5


@ALL
def test_drives_straight_at_its_wheels_speed(frame: str) -> None:
    b = Bench(frame, home=(-35.0, 149.0, 584.0, 0.0))
    b.run(12.0, *straight(frame, 0.3))
    assert speed(b) == pytest.approx(b.p.wheels.speed[0], rel=0.01)
    assert b.p.wheels.forward == pytest.approx(speed(b), rel=1e-4)
    assert abs(b.body.pos[1]) < 1e-3
    assert b.p.wheels.distance == pytest.approx([b.body.pos[0]] * 2, rel=0.01)


@CARS
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_turns_on_its_steering_circle(frame: str, side: float) -> None:
    """Yaw rate by speed at half steering, slowly, is the curvature that native physics has: 2 %."""
    b = Bench(frame)
    b.run(8.0, side * 0.4, 0.0, 0.15 if frame == "ardupilot_rover" else 0.5)
    assert b.body.rates[2] / b.p.wheels.forward == pytest.approx(
        curvature(b.p.wheels.angle, b.p.airframe, b.p.derived), rel=0.02
    )
    assert math.copysign(1.0, b.body.rates[2]) == side


def test_skid_steering_turns_on_the_spot() -> None:
    b = Bench("skid_rover")
    b.run(3.0, 0.2, 0.0, -0.2)
    left, right = b.p.wheels.speed
    wanted = (left - right) * b.p.derived.inverse_track
    assert b.body.rates[2] == pytest.approx(wanted, rel=0.15)
    assert np.linalg.norm(b.body.pos[:2]) < 0.05


def test_grip_bounds_the_acceleration() -> None:
    b = Bench(Bench("erle_rover").simulation.airframe.changed(grip=0.1, drive_accel=0.0))
    fastest = 0.0
    for _ in range(400):
        b.tick(0.0, 0.0, 0.8)
        fastest = max(fastest, math.hypot(b.body.acc_ned[0], b.body.acc_ned[1]))
    assert fastest == pytest.approx(0.1 * 9.80665 * 0.56, rel=0.05)


def test_nose_dives_when_it_brakes() -> None:
    """It stands on springs: the only engine-made motion that native physics has not."""
    b = Bench("erle_rover")
    b.run(5.0, 0.0, 0.0, 0.8)
    lowest = 0.0
    for _ in range(200):
        b.tick(0.0, 0.0, 0.0)
        lowest = min(lowest, euler_of(Quat(*b.body.q))[1])
    assert -math.radians(2.0) < lowest < -math.radians(0.02)
    b.run(5.0)
    assert speed(b) < 0.01
