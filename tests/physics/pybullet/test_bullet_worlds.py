# SPDX-License-Identifier: BSD-3-Clause
"""Worlds in Bullet: floor, solids, rays; the client."""

from __future__ import annotations

import sys

import numpy as np
import pytest

pytest.importorskip("pybullet")

from sitl import worlds
from sitl.errors import MissingExtra
from sitl.physics.pybullet import client as clients
from sitl.physics.pybullet.client import Client
from sitl.physics.pybullet.worlds import SHAPES_EACH, build
from sitl.worlds.contact import clearance
from sitl.worlds.raycast import scan
from tests.physics.pybullet.bullet_copters import copter


def test_every_solid_is_there_in_few_bodies() -> None:
    world = worlds.load("office_erlecopter")
    client = Client(0.0025)
    surfaces = build(client, world, world.floor_z)
    assert len(surfaces.solids) == -(-len(world.solids) // SHAPES_EACH)
    p, id_ = client.p, client.id
    for solid in world.solids:
        x, y, z = solid.centre
        (met,) = p.rayTestBatch([(x, y, z + 50.0)], [(x, y, z)], physicsClientId=id_)
        assert met[0] in surfaces.solids
        assert met[3][2] >= solid.high - 1e-6, solid
    friction = p.getDynamicsInfo(surfaces.floor, -1, id_)[1]
    assert friction == world.friction
    client.close()
    client.close()


@pytest.mark.parametrize("name", ["office_erlecopter", "maze", "round"])
def test_rays_meet_what_ray_casting_meets(name: str) -> None:
    world = worlds.load(name)
    engine = copter(world=world)
    start, dice = world.start("erle_copter").north_east_down, np.random.default_rng(5)
    errors: list[float] = []
    while len(errors) < 700:
        origin = np.array([start[0], start[1], -world.floor_z]) + dice.uniform((-1, -1, -1.5), (1, 1, -0.1))
        if clearance(world.geometry, *origin, origin[2], 0.0).distance < 0.0:
            continue
        directions = dice.normal(size=(3, 70)) * [[1.0], [1.0], [0.2]]
        directions /= np.linalg.norm(directions, axis=0)
        ranges = np.empty(70)
        assert engine.cast(origin, directions, ranges, 10.0)
        expected = scan(world.geometry, origin, directions, np.empty(70))
        expected[expected > 10.0] = np.inf
        errors += [0.0 if a == b else abs(a - b) for a, b in zip(ranges, expected, strict=True)]
    assert np.quantile(errors, 0.98) < 2e-3
    assert np.count_nonzero(np.isinf(errors)) <= 2, "rays that graze an edge"


def test_without_pybullet(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pybullet", None)
    clients.bullet.cache_clear()
    with pytest.raises(MissingExtra, match=r"gym-sitl\[pybullet\]"):
        copter()
    monkeypatch.undo()
    clients.bullet.cache_clear()


def test_prints_nothing(capfd: pytest.CaptureFixture[str]) -> None:
    engine = copter("erle_copter", worlds.load("maze"))
    engine.restore(engine.snapshot())
    engine.tick()
    engine.close()
    out, err = capfd.readouterr()
    assert (out, err) == ("", "")
