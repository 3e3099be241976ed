# SPDX-License-Identifier: BSD-3-Clause
"""A copter in Bullet: at rest, in the air as native physics has it, touching down, tipping over, repeatable."""

from __future__ import annotations

import math

import numpy as np
import pytest

pytest.importorskip("pybullet")

from sitl import vehicles
from sitl.physics.engine import EngineError
from sitl.physics.native.copter.step import move
from sitl.physics.native.records import GROUND_AIRBORNE, GROUND_LYING, GROUND_STANDING
from sitl.physics.pybullet.engine import BulletEngine
from tests.physics.pybullet.bullet_copters import by_dice, copter, hover, put, record_of, run


@pytest.mark.parametrize("frame", ["erle_copter", "ardupilot_quad"])
def test_stands_still(frame: str) -> None:
    engine = copter(frame, euler=(0.0, 0.0, 0.7))
    b, start = engine.vehicle.v.physics.body, engine.vehicle.v.physics.body.q
    shown = []
    for _ in range(2000):
        engine.tick()
        shown.append(b.specific_force)
    assert b.pos == pytest.approx([0.0, 0.0, 0.0], abs=1e-6)
    assert b.q == pytest.approx(start, abs=1e-6)
    assert np.array(shown) == pytest.approx(np.tile([0.0, 0.0, -9.80665], (2000, 1)), abs=2e-3)
    assert engine.vehicle.v.physics.ground.state == GROUND_STANDING
    assert engine.vehicle.v.physics.ground.hit_count == 0


def test_flies_as_native_physics() -> None:
    bullet, native = copter(position=(0.0, 0.0, -50.0)), copter(position=(0.0, 0.0, -50.0))
    for engine in (bullet, native):
        hover(engine, 1.1)
        engine.vehicle.v.actuators.controls[:4] += (0.001, -0.001, 0.0008, -0.0008)
        engine.vehicle.v.physics.wind.vel = (3.0, -2.0, 0.5)
    p = native.vehicle.v.physics
    for _ in range(400):
        bullet.vehicle.laws.begin()
        bullet.move()
        native.vehicle.laws.begin()
        move(p, int(native.vehicle.v.time_us))
    ours = bullet.vehicle.v.physics.body
    assert np.abs(p.body.rates).max() > 0.05, "it has turned"
    assert ours.rates == pytest.approx(p.body.rates, abs=2e-3)
    assert ours.q == pytest.approx(p.body.q, abs=1e-3)
    assert ours.vel == pytest.approx(p.body.vel, abs=0.02)
    assert ours.pos == pytest.approx(p.body.pos, abs=0.02)


def test_lifts_off_and_touches_down() -> None:
    engine = copter()
    v = engine.vehicle.v
    hover(engine, 0.9)
    run(engine, 1.0)
    assert v.physics.ground.state == GROUND_STANDING
    assert v.physics.body.pos[2] == pytest.approx(0.0, abs=5e-3)
    hover(engine, 1.3)
    run(engine, 0.6)
    assert v.physics.ground.state == GROUND_AIRBORNE
    assert v.physics.body.pos[2] < -0.1
    hover(engine, 0.6)
    run(engine, 4.0)
    g = v.physics.ground
    assert (g.state, g.hit_count) == (GROUND_STANDING, 1), "the legs take it up: no bounce"
    assert 0.5 < g.hit_speed < 3.0
    assert v.physics.body.pos[2] == pytest.approx(0.0, abs=5e-3)
    assert np.abs(v.physics.body.vel).max() < 1e-3


def test_a_soft_touch_is_no_hit() -> None:
    engine = copter(position=(0.0, 0.0, -0.005))
    v = engine.vehicle.v
    v.physics.rotors.speed[:4] = math.sqrt(0.95 * 1.14 * 9.80665 / 4.0 / 8.54858e-6)
    hover(engine, 0.95)
    run(engine, 2.0)
    assert v.physics.ground.state == GROUND_STANDING
    assert v.physics.ground.hit_count == 0


def test_legs_spread_an_impact() -> None:
    engine = copter(position=(0.0, 0.0, -0.05))  # falls at 1 m/s
    run(engine, 0.08)
    felt = []
    for _ in range(60):
        engine.tick()
        felt.append(-engine.vehicle.v.physics.body.specific_force[2])
    assert engine.vehicle.v.physics.ground.hit_speed == pytest.approx(1.0, abs=0.1)
    assert 40.0 < max(felt) < 160.0, "below the range of the accelerometer"


def test_falls_back_on_its_feet_unless_it_came_down_on_its_back() -> None:
    """Its outline reaches beyond them: 75 degrees are more than its tip angle."""
    for lean, state in ((15.0, GROUND_STANDING), (75.0, GROUND_STANDING), (120.0, GROUND_LYING)):
        engine = copter(position=(0.0, 0.0, -0.3), euler=(math.radians(lean), 0.0, 0.0))
        run(engine, 3.0)
        assert engine.vehicle.v.physics.ground.state == state, lean
        assert np.abs(engine.vehicle.v.physics.body.rates).max() < 0.05


def test_same_bits_on_every_repeat() -> None:
    one, other = copter(), copter()
    flown = by_dice(one, 800, 3)
    assert by_dice(other, 800, 3) == flown
    put(other, (1.0, 2.0, -3.0))
    run(other, 0.5)
    again = copter()
    other.vehicle.fleet[:] = again.vehicle.fleet
    other.place()
    assert record_of(other) == record_of(again)
    assert by_dice(other, 800, 3) == flown, "a second power-on leaves nothing of the first"


def test_properties_may_change_until_power_on() -> None:
    engine = copter()
    a = engine.vehicle.v.physics.airframe
    a.mass, a.leg_time_constant = 2.0 * a.mass, 0.01
    engine.vehicle.v.physics.derived.inverse_mass = 1.0 / float(a.mass)
    engine.place()
    hover(engine, 0.6)  # of the new weight: more than the old one
    run(engine, 0.5)
    assert engine.vehicle.v.physics.ground.state == GROUND_STANDING
    assert engine.body.model.mass == pytest.approx(2.28)


def test_substeps_and_hard_feet() -> None:
    airframe = vehicles.load("erle_copter").changed(substeps=4, leg_time_constant=0.0)
    engine = copter(airframe)
    shown = []
    for _ in range(400):
        engine.tick()
        shown.append(engine.vehicle.v.physics.body.specific_force[2])
    assert engine.vehicle.v.physics.body.pos == pytest.approx([0.0, 0.0, 0.0], abs=1e-5)
    assert np.array(shown) == pytest.approx(-9.80665, abs=0.02)
    put(engine, (0.0, 0.0, -1.0))
    run(engine, 0.4)
    assert -engine.vehicle.v.physics.body.pos[2] == pytest.approx(1.0 - 0.5 * 9.80665 * 0.4**2, abs=5e-3)


def test_does_not_move_without_power() -> None:
    vehicle = copter().vehicle
    with pytest.raises(EngineError, match="place"):
        BulletEngine(vehicle).move()
