# SPDX-License-Identifier: BSD-3-Clause
"""Rovers keep away from walls that their lidar sees, and from fences."""

from __future__ import annotations

import pytest

from sitl import Simulation
from sitl.client import Client
from sitl.worlds import Box, Start, World

WALL = World("wall", (Box((20.0, 0.0, 1.0), (0.2, 60.0, 2.0)),), (Start("here", (0.0, 0.0, 0.0), 0.0),))
NEAR_SIDE = 19.9


def ready(mode: str, world: World | None = None, **params: float) -> Client:
    driver = Client(
        Simulation(
            "erle_rover", world=world, seed=3, estimator="truth", params={"PRX1_TYPE": 10, "PRX_FILT": 0, **params}
        )
    )
    driver.wait_ready()
    driver.set_mode(mode)
    driver.arm()
    return driver


def north(driver: Client) -> float:
    return float(driver.simulation.v.physics.body.pos.x)


@pytest.mark.parametrize("mode", ["ACRO", "STEERING"])
def test_the_stick_does_not_drive_into_a_wall(mode: str) -> None:
    driver = ready(mode, WALL)
    driver.rc(throttle=1800)
    driver.delay(30.0)
    assert driver.simulation.v.physics.obstacles.hit_count == 0
    assert NEAR_SIDE - 3.0 < north(driver) < NEAR_SIDE - 2.0
    assert abs(driver.groundspeed) < 0.1


def test_manual_drives_into_it() -> None:
    driver = ready("MANUAL", WALL)
    driver.rc(throttle=1800)
    driver.delay(20.0)
    assert driver.simulation.v.physics.obstacles.hit_count > 0


def test_a_way_in_guided_ends_before_a_wall() -> None:
    driver = ready("GUIDED", WALL)
    driver.set_position(north=40.0, east=0.0)
    driver.delay(40.0)
    assert driver.simulation.v.physics.obstacles.hit_count == 0
    assert NEAR_SIDE - 6.0 < north(driver) < NEAR_SIDE - 1.2


def test_a_circle_around_home_is_not_left() -> None:
    driver = ready("ACRO", FENCE_TYPE=2, FENCE_RADIUS=20, FENCE_MARGIN=2, FENCE_ENABLE=1, PRX1_TYPE=0)
    driver.rc(throttle=1800)
    driver.delay(30.0)
    n, e, _ = driver.position
    assert 14.0 < (n * n + e * e) ** 0.5 < 18.6
    assert driver.mode == "ACRO" and abs(driver.groundspeed) < 0.3
