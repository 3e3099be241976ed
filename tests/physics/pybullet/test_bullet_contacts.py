# SPDX-License-Identifier: BSD-3-Clause
"""What contacts mean: reports of hits with solids and floor, by rows as pybullet gives them; and real ones."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

pytest.importorskip("pybullet")

from sitl.physics.native.records import GROUND_AIRBORNE, GROUND_STANDING
from sitl.physics.pybullet.contacts import contacts_report as report
from sitl.physics.pybullet.worlds import Surfaces
from sitl.worlds import Box, Start, World
from tests.physics.pybullet.bullet_copters import copter, put, run

FLOOR, SOLID, BODY, LEGS = 0, 3, -1, 0
ROOM = World(
    "room",
    (Box((6.0, 0.0, 1.5), (0.2, 20.0, 3.0)), Box((2.0, 0.0, 0.35), (1.5, 1.5, 0.7))),
    (Start("a", (0.0, 0.0, 0.0), 0.0),),
)


def row(other: int, link: int, normal: tuple[float, float, float], force: float = 1.0) -> tuple[Any, ...]:
    """A contact as pybullet gives it; the normal in its frame."""
    return (0, 7, other, link, -1, (0.0,) * 3, (0.0,) * 3, normal, 0.0, force, 0.0, (0.0,) * 3, 0.0, (0.0,) * 3)


def flying() -> tuple[Any, Surfaces]:
    v = copter(position=(0.0, 0.0, -2.0)).vehicle.v
    v.time_us = 1_000_000
    return v, Surfaces(FLOOR, frozenset({SOLID}), 0.0)


def test_a_run_into_a_solid_counts_once() -> None:
    v, surfaces = flying()
    o, west = v.physics.obstacles, (0.0, 1.0, 0.0)
    assert report(v, surfaces, [row(SOLID, BODY, west)], (0.0, 1.5, 0.0))
    assert (o.hit_count, o.hit_speed, o.hit_time_us, o.touching) == (1, 1.5, 1_000_000, 1)
    v.time_us += 250_000
    report(v, surfaces, [row(SOLID, BODY, west)], (0.0, 2.0, 0.0))
    assert (o.hit_count, o.hit_speed) == (1, 1.5), "the same contact still"
    v.time_us += 2500
    report(v, surfaces, [row(SOLID, BODY, west)], (0.0, 0.1, 0.0))
    assert o.hit_count == 1, "not faster than what is reported"
    report(v, surfaces, [row(SOLID, LEGS, west)], (0.0, 0.2, 0.0))
    assert (o.hit_count, o.hit_time_us) == (2, 1_252_500)
    assert not report(v, surfaces, [], (0.0, 0.0, 0.0))
    assert o.touching == 0


def test_points_without_force_are_no_contact() -> None:
    v, surfaces = flying()
    rows = [row(SOLID, BODY, (-1.0, 0.0, 0.0), 0.0), row(FLOOR, LEGS, (0.0, 0.0, 1.0), 0.0)]
    assert not report(v, surfaces, rows, (3.0, 0.0, 3.0))
    assert (v.physics.obstacles.hit_count, v.physics.ground.hit_count) == (0, 0)
    assert v.physics.ground.state == GROUND_AIRBORNE


def test_the_floor_out_of_the_air() -> None:
    v, surfaces = flying()
    v.physics.body.pos = v.physics.body.pos.replace(z=0.0)
    g, down = v.physics.ground, row(FLOOR, LEGS, (0.0, 0.0, 1.0))
    report(v, surfaces, [down], (0.0, 0.0, 0.75))
    assert (g.state, g.hit_count, g.hit_speed, g.hit_time_us) == (GROUND_STANDING, 1, 0.75, 1_000_000)
    report(v, surfaces, [down], (0.0, 0.0, 0.75))
    assert g.hit_count == 1, "it stands already"
    report(v, surfaces, [], (0.0, 0.0, 0.0))
    assert g.state == GROUND_STANDING, "not clear of the floor yet"
    v.physics.body.pos = v.physics.body.pos.replace(z=-0.02)
    report(v, surfaces, [], (0.0, 0.0, 0.0))
    assert g.state == GROUND_AIRBORNE
    assert v.physics.obstacles.touching == 0


def test_a_wall_stops_it_and_the_accelerometer_can_show_it() -> None:
    engine = copter(world=ROOM, position=(5.0, 0.0, -1.5))
    v = engine.vehicle.v
    client = engine.body.client
    client.p.resetBaseVelocity(engine.body.number, (3.0, 0.0, 2.0), physicsClientId=client.id)
    v.physics.body.vel = (3.0, 0.0, -2.0)
    felt, gained = [], 0.0
    for _ in range(160):
        engine.tick()
        felt.append(v.physics.body.specific_force)
        gained += 0.0025 * v.physics.body.acc_ned[0]
    o = v.physics.obstacles
    assert (o.hit_count, o.hit_speed) == (1, pytest.approx(3.0, abs=0.05))
    assert v.physics.body.pos[0] <= 5.9 - v.physics.airframe.contact_radius + 0.005
    assert np.abs(felt).max() < 160.0
    assert gained == pytest.approx(v.physics.body.vel[0] - 3.0, abs=0.01), "all of the impact is felt in the end"


def test_stands_on_a_solid() -> None:
    engine = copter(world=ROOM, position=(2.0, 0.0, -0.8))
    run(engine, 1.5)
    p = engine.vehicle.v.physics
    assert p.body.pos == pytest.approx([2.0, 0.0, -0.7], abs=1e-4)
    assert (p.obstacles.touching, p.obstacles.hit_count, p.ground.state) == (1, 1, GROUND_AIRBORNE)
    assert p.obstacles.hit_speed == pytest.approx(math.sqrt(2.0 * 9.80665 * 0.1), abs=0.05)


def test_the_floor_of_the_world_may_be_anywhere() -> None:
    world = World("cellar", (), (Start("a", (0.0, 0.0, -3.0), 0.0),), floor_z=-3.0)
    engine = copter(world=world)
    run(engine, 0.5)
    assert engine.vehicle.v.physics.body.pos == pytest.approx([0.0, 0.0, 0.0], abs=1e-6)
    put(engine, (0.0, 0.0, -0.2))
    run(engine, 1.5)
    assert engine.vehicle.v.physics.body.pos[2] == pytest.approx(0.0, abs=1e-5)
