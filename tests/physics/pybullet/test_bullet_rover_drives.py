# SPDX-License-Identifier: BSD-3-Clause
"""The whole rover on Bullet: boots, aligns its filter, arms, drives a square, returns; in a world, into a wall."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("pybullet")

from sitl import vehicles
from sitl.core.records import first_difference
from sitl.missions.pilot import Pilot
from sitl.simulation import Simulation
from tests.pilots.witness import KEEP, MIDDLE, WAYPOINT, Item, Witness

MANUAL, AUTO, RTL = 0, 10, 11
SIDES = {"erle_rover": 10.0, "erle_rover_small": 3.0, "ardupilot_rover": 60.0, "skid_rover": 5.0}
"""Of the square [m]."""


class Rover(Witness):
    """Drives a rover on Bullet."""

    def __init__(self, frame: str, world: str | None = None, physics: str = "pybullet") -> None:
        self.track, self._pulses = [], None
        Pilot.__init__(self, Simulation(frame, physics=physics, world=world, seed=3))

    def ready(self) -> Rover:
        """Boot and arm."""
        self.boot()
        self.fly(0.1)
        self.arm(0.2)
        return self

    def error(self) -> float:
        """Of the estimated position [m]."""
        return float(np.hypot(*(np.array(self.ap.estimate.pos)[:2] - self.pos[:2])))


@pytest.mark.slow
@pytest.mark.parametrize("frame", vehicles.names("rover"))
def test_square_and_return(frame: str) -> None:
    r, side = Rover(frame).ready(), SIDES[frame]
    limit = 60.0 + 6.0 * side / float(r.ap.params.WP_SPEED)
    corners = [(side, 0.0), (side, side), (0.0, side)]
    assert r.upload(*(Item(WAYPOINT, corner) for corner in corners)) == 0
    start = r.now
    assert r.set_mode(AUTO)
    assert r.fly(limit, lambda: r.said("Mission Complete")), r.texts
    places = np.array(r.track)[:, 1:3][np.array(r.track)[:, 0] > start]
    for corner in corners:
        assert np.hypot(*(places - corner).T).min() < float(r.ap.params.WP_RADIUS) + 1.0
    assert r.set_mode(RTL)
    assert r.fly(limit, lambda: r.said("Reached destination")), r.texts
    assert r.error() < 1.0
    assert np.hypot(*r.pos[:2]) < float(r.ap.params.WP_RADIUS) + 1.0
    assert r.armed, "no failsafe, no crash check"


def test_boots_and_stands_armed() -> None:
    r = Rover("erle_rover").ready()
    r.fly(10.0)
    assert r.armed and np.abs(r.pos).max() < 1e-3
    assert r.error() < 1.0


@pytest.mark.slow
def test_into_a_wall_of_the_maze_and_again_from_a_snapshot() -> None:
    r = Rover("erle_rover", "maze_erlerover").ready()
    assert r.set_mode(MANUAL)
    r._pulses = (MIDDLE, KEEP, 1900)
    r.fly(6.5)
    kept, hits, ends = r.simulation.snapshot(), r.simulation.v.physics.obstacles, []
    assert hits.hit_count == 0 and r.vel[0] > 1.5
    for _ in range(2):
        r.simulation.restore(kept)
        r.simulation.advance(2.0)
        ends.append(r.simulation.fleet.copy())
    assert first_difference(ends[0][0], ends[1][0]) is None
    assert hits.hit_count == 1 and hits.hit_speed == pytest.approx(1.59, abs=0.02)
    assert abs(r.vel[0]) < 0.01 and r.error() < 1.5
