# SPDX-License-Identifier: BSD-3-Clause
"""The bench that turns a vehicle as its outputs 5 to 8 say."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl.core.algebra import IDENTITY, euler_of, rotate_inverse
from sitl.core.constants import GRAVITY
from sitl.core.vectors import Vec3
from sitl.physics.native import bench
from sitl.physics.native.records import Body


def turned(pulses: tuple[int, int, int, int], seconds: float, body: Body | None = None) -> Body:
    """A body after some time on the bench."""
    body = body or Body()
    if body.q.w == 0.0:
        body.q = IDENTITY
    outputs = np.array((0, 0, 0, 0, *pulses))
    for tick in range(round(seconds / 0.0025)):
        bench.turn(body, outputs, 2500 * tick)
    return body


@pytest.mark.parametrize(("roll", "pitch", "yaw"), [(90.0, 0.0, 0.0), (0.0, 60.0, -30.0), (180.0, 0.0, 0.0)])
def test_it_takes_an_attitude(roll: float, pitch: float, yaw: float) -> None:
    body = turned((1150, *(round(1500 + angle / 0.36) for angle in (roll, pitch, yaw))), 4.0)
    euler = np.degrees(tuple(euler_of(body.q)))
    assert (euler - (roll, pitch, yaw) + 180.0) % 360.0 - 180.0 == pytest.approx([0.0] * 3, abs=0.4)
    assert tuple(body.rates) == pytest.approx((0.0, 0.0, 0.0), abs=1e-3)
    assert tuple(body.specific_force) == pytest.approx(tuple(rotate_inverse(body.q, Vec3(0.0, 0.0, -GRAVITY))))
    assert tuple(body.pos) == tuple(body.vel) == (0.0, 0.0, 0.0)


def test_it_turns_about_an_axis_and_comes_to_rest() -> None:
    body = turned((1300 + 175, 1500, 1900, 1500), 1.0)
    assert tuple(body.rates) == pytest.approx((0.0, math.pi / 2.0, 0.0), abs=1e-6)
    turned((1000, 1500, 1900, 1500), 1.0, body)
    assert tuple(body.rates) == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)
    assert tuple(turned((1475, 1500, 1500, 1500), 0.1).rates) == (0.0, 0.0, 0.0)  # no axis


def test_it_shows_all_sides() -> None:
    body, up = turned((1000, 0, 0, 0), 0.0), []
    outputs = np.array((0, 0, 0, 0, 1250, 0, 0, 0))
    for tick in range(400 * 60):
        bench.turn(body, outputs, 2500 * tick)
        up.append(tuple(rotate_inverse(body.q, Vec3(0.0, 0.0, -1.0))))
    assert np.linalg.norm(tuple(body.rates)) == pytest.approx(math.radians(60.0), rel=0.05)
    for axis in np.vstack((np.eye(3), -np.eye(3))):
        assert (np.array(up) @ axis).max() > 0.9
