# SPDX-License-Identifier: BSD-3-Clause
"""Tracks, slaloms and car parks from a seed: a rover has room to drive where their markings say."""

from __future__ import annotations

import math

import pytest

from sitl import worlds
from sitl.worlds import contact
from sitl.worlds.generated import generate

WIDE = 0.9
"""Half of the width of a rover [m]."""


def room(world, x, y):
    """Distance from a place on the floor to the nearest solid [m]."""
    return contact.clearance(world.geometry, x, -y, -1.0, 0.0, 0.0).distance


@pytest.mark.parametrize("kind", ["track", "slalom", "car_park"])
def test_a_text_is_one_world(kind):
    text = f"{kind}:seed=3,difficulty=0.7"
    assert generate(text) == generate(text) != generate(f"{kind}:seed=4,difficulty=0.7")
    assert worlds.load(worlds.load(text).name) == worlds.load(text)


@pytest.mark.parametrize("difficulty", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("kind", ["track", "slalom"])
def test_a_rover_fits_through_the_gates(kind, difficulty):
    for seed in range(4):
        world = worlds.load(f"{kind}:seed={seed},difficulty={difficulty}")
        gates = [m for m in world.markings if m.name.startswith("gate ")]
        assert [m.name for m in gates] == [f"gate {k}" for k in range(1, len(gates) + 1)] and len(gates) >= 4
        assert all(room(world, *m.centre) > WIDE + 0.3 for m in gates)
        assert room(world, *world.starts[0].position[:2]) > WIDE + 0.3


def test_gates_of_a_track_follow_its_heading():
    gates = [m for m in worlds.load("track:seed=2,difficulty=1").markings if m.name.startswith("gate ")]
    for here, there in zip(gates, gates[1:] + gates[:1]):
        x, y = there.centre[0] - here.centre[0], there.centre[1] - here.centre[1]
        assert x * math.cos(here.yaw) + y * math.sin(here.yaw) > 0.8 * math.hypot(x, y)
    assert len({m.size[1] for m in gates}) == 1 and gates[0].size[1] == pytest.approx(4.0)


def test_poles_stand_beside_their_gates_on_alternate_sides():
    world = worlds.load("slalom:seed=1")
    gates = [m for m in world.markings if m.name.startswith("gate ")]
    assert len(gates) == len(world.solids)
    sides = [math.copysign(1.0, gate.centre[1] - pole.centre[1]) for gate, pole in zip(gates, world.solids)]
    assert sides == [1.0 if k % 2 == 0 else -1.0 for k in range(len(sides))]


@pytest.mark.parametrize("difficulty", [0.0, 0.5, 1.0])
def test_free_bays_are_free(difficulty):
    for seed in range(4):
        world = worlds.load(f"car_park:seed={seed},difficulty={difficulty}")
        bays = [m for m in world.markings if m.name.startswith("bay ")]
        assert 3 <= len(bays) < len([solid for solid in world.solids if "car" in solid.name])
        for bay in bays:
            for along in (-1.3, 0.0, 1.3):  # a rover is 2.6 m long
                x, y = bay.centre[0] + along * math.cos(bay.yaw), bay.centre[1] + along * math.sin(bay.yaw)
                assert room(world, x, y) > 0.85
