# SPDX-License-Identifier: BSD-3-Clause
"""The outline of what is solid at a height."""

import math

import numpy as np
import pytest

from sitl import worlds
from sitl.worlds import outline


@pytest.mark.parametrize("text", ["forest:size=14,difficulty=1", "rooms:seed=2,size=12", "car_park:size=14"])
def test_solids_that_stand_apart_need_not_be_compared(text, monkeypatch):
    world = worlds.load(text)
    found = outline.outline(world, world.plan_height)
    monkeypatch.setattr(outline, "_NEAR", math.inf)
    assert len(found) > 8 and np.array_equal(found, outline.outline(world, world.plan_height))


def test_no_more_solids_are_compared_than_stand_near(monkeypatch):
    world, calls, real = worlds.load("forest:size=20"), [], outline._inside
    monkeypatch.setattr(outline, "_inside", lambda *args: calls.append(1) or real(*args))
    outline.outline(world, world.plan_height)
    assert len(calls) < 0.2 * 32 * len(world.solids) ** 2  # all of them: 32 edges each with each other
