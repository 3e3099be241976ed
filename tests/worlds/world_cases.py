# SPDX-License-Identifier: BSD-3-Clause
"""Shared by the tests of worlds: what is known of gym-gazebo's, and random worlds and rays."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
from hypothesis import strategies as st

from sitl.worlds.geometry import Floats, compile_geometry
from sitl.worlds.shapes import Box, Cylinder, Solid

KNOWN: dict[str, dict[str, Any]] = json.loads(
    (Path(__file__).parent / "data" / "gym_gazebo_worlds.json").read_text(encoding="utf-8")
)
"""World -> bounds, clearance at the start, scan at the start, outlines at heights, all of independent making."""

LIDARS = {
    "turtlebot": (40, 20, 20.0, (0.0, 0.0, 0.5102)),
    "erle_rover": (542, 271, 20.0, (0.5, 0.0, 0.8)),
    "erle_copter": (140, 70, 10.0, (0.15, 0.0, 1.15)),
}
"""Robot -> rays cast, readings published, range [m], lidar: forward, left, above the floor [m]. All see 270 degrees."""

PLAIN = (0.0, 0.5, 1.0, -1.0, 2.0)  # values at which faces, corners and cells meet
lengths = st.one_of(st.sampled_from(PLAIN), st.floats(-6.0, 6.0))
sizes = st.one_of(st.sampled_from((0.15, 0.5, 1.0, 4.0)), st.floats(0.01, 5.0))
yaws = st.one_of(st.sampled_from((0.0, 0.5 * math.pi, math.pi, 0.25 * math.pi)), st.floats(-3.2, 3.2))
boxes = st.builds(Box, st.tuples(lengths, lengths, lengths), st.tuples(sizes, sizes, sizes), yaws)
cylinders = st.builds(Cylinder, st.tuples(lengths, lengths, lengths), sizes, sizes)
solids = st.one_of(boxes, cylinders)
worlds = st.builds(
    lambda some, floor, each: compile_geometry(some, floor, each),
    st.lists(solids, max_size=12),
    st.sampled_from((-8.0, 0.0)),
    st.sampled_from((0, 1, 6, 40)),
)
points = st.tuples(lengths, lengths, lengths)


@st.composite
def fans(draw: st.DrawFn) -> Floats:
    """Directions, shape (3, n): round about, along the axes, straight up and down, almost along an axis."""
    turn, tilt = draw(yaws), draw(st.sampled_from((0.0, 0.1, -0.7)))
    angles = turn + np.arange(16) * (math.pi / 8)
    level = math.cos(tilt)
    fan = [(math.cos(a) * level, math.sin(a) * level, math.sin(tilt)) for a in angles]
    almost = draw(st.sampled_from((1e-16, -1e-12, 1e-320)))
    fan += [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1), (1, almost, 0), (almost, -1, almost)]
    return np.ascontiguousarray(np.array(fan, dtype=np.float64).T)


def random_solids(count: int, seed: int, half: float = 10.0) -> list[Solid]:
    """Walls and pillars strewn over a square."""
    rng = np.random.default_rng(seed)
    result: list[Solid] = []
    for k in range(count):
        x, y = rng.uniform(-half, half, 2)
        if k % 5 == 4:
            result.append(Cylinder((x, y, 0.5), rng.uniform(0.1, 0.6), 1.0))
        else:
            result.append(
                Box((x, y, 0.5), (rng.uniform(0.3, 4.0), 0.15, rng.uniform(0.4, 2.0)), rng.uniform(-3.0, 3.0))
            )
    return result
