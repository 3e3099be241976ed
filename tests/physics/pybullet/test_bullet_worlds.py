# SPDX-License-Identifier: BSD-3-Clause
"""Worlds in Bullet: floor, solids, rays, the client; and the copter's URDF model, with pictures of it."""

from __future__ import annotations

import math
import sys
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("pybullet")

from sitl import vehicles, worlds
from sitl.errors import MissingExtra
from sitl.physics.pybullet import client as clients
from sitl.physics.pybullet.client import Client
from sitl.physics.pybullet.copter_model import footing, leg_length, model, sag, springs
from sitl.physics.pybullet.picture import Camera
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


SQUARE = [(0.1, 0.1), (-0.1, 0.1), (-0.1, -0.1), (0.1, -0.1)]


@pytest.mark.parametrize("frame", ["erle_copter", "ardupilot_quad"])
def test_says_what_the_airframe_says(frame: str) -> None:
    airframe = vehicles.load(frame)
    robot = ElementTree.fromstring(model(copter(frame).vehicle.v.physics.airframe).text)
    body, legs = robot.findall("link")
    assert float(body.find("inertial/mass").get("value")) == airframe.value("mass")  # type: ignore[union-attr]
    inertia = body.find("inertial/inertia").attrib  # type: ignore[union-attr]
    assert [float(inertia[k]) for k in ("ixx", "iyy", "izz")] == list(airframe.value("inertia"))
    outline = body.find("collision/geometry/cylinder").get("radius")  # type: ignore[union-attr]
    assert float(outline) == airframe.value("contact_radius")  # type: ignore[arg-type]
    feet = [[float(n) for n in c.find("origin").get("xyz").split()] for c in legs.findall("collision")]  # type: ignore[union-attr]
    assert sorted((x, -y) for x, y, _ in feet) == sorted((r.x, r.y) for r in airframe.rotors)  # type: ignore[attr-defined]


def test_it_tips_where_the_airframe_says() -> None:
    assert leg_length(SQUARE, math.radians(45.0)) == pytest.approx(0.1)
    assert leg_length(SQUARE, math.radians(60.0)) == pytest.approx(0.1 / math.sqrt(3.0))
    assert leg_length(SQUARE, math.radians(120.0)) == pytest.approx(0.03), "never without legs"


def test_every_copter_has_something_to_stand_on() -> None:
    ring = [(0.3 * math.cos(k * math.pi / 3.0), 0.3 * math.sin(k * math.pi / 3.0), 0.0) for k in range(6)]
    assert footing(ring, 0.4) == [(x, y) for x, y, _ in ring]
    assert leg_length(footing(ring, 0.4), math.radians(45.0)) == pytest.approx(0.3 * math.sqrt(0.75))
    for hubs in (ring[:1], ring[:2]):
        assert leg_length(footing(hubs, 0.4), math.radians(45.0)) == pytest.approx(0.2)


@given(st.floats(0.1, 20.0), st.floats(0.001, 0.1), st.integers(3, 8))
def test_springs_carry_the_weight(mass: float, time_constant: float, count: int) -> None:
    stiffness, damping = springs(mass, time_constant, count)
    assert count * stiffness * sag(time_constant) == pytest.approx(mass * 9.80665)
    assert (count * damping) ** 2 == pytest.approx(4.0 * mass * count * stiffness), "critically damped"


def test_a_picture_shows_it_and_changes_nothing() -> None:
    world = worlds.load("maze")
    engine, other = copter(world=world, position=(0.0, 0.0, -0.5)), copter(world=world, position=(0.0, 0.0, -0.5))
    picture = engine.render(96, 64)
    assert (picture.shape, picture.dtype) == ((64, 96, 3), np.uint8)
    red = (picture[..., 0] > 150) & (picture[..., 1] < 90)
    assert red.sum() > 20, "the front rotors"
    away = engine.render(96, 64, Camera((0.0, 0.0, 30.0), (0.0, 0.1, 100.0)))
    assert away.std() < 1.0, "nothing but sky"
    engine.tick()
    other.tick()
    assert engine.vehicle.fleet.tobytes() == other.vehicle.fleet.tobytes()
    engine.close()
