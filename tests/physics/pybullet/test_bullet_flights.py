# SPDX-License-Identifier: BSD-3-Clause
"""Whole vehicles on Bullet: boot, mission, return and landing as on native physics; snapshots; walls."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.core.mavlink import MavCmd

pytest.importorskip("pybullet")

from benchmarks.recorded.pilot import Pilot
from sitl import vehicles
from sitl.core.records import first_difference
from sitl.physics.native import truth
from sitl.simulation import Simulation
from tests.pilots.witness import KEEP, MIDDLE, Item, Witness

AUTO = 3
MISSIONS = {
    "erle_copter": ("erle_copter", None, 20.0, 10.0),
    "ardupilot_quad": ("ardupilot_quad", None, 20.0, 10.0),
    "office": ("erle_copter", "office_erlecopter", 1.0, 1.0),
}
"""Airframe, world, side of the square [m], height [m]."""


class Flyer(Witness):
    """Flies a copter on any physics."""

    def __init__(self, physics: str, frame: str, world: str | None = None) -> None:
        self.track, self._pulses = [], None
        Pilot.__init__(self, Simulation(frame, physics=physics, world=world, seed=2))


def square(physics: str, frame: str, world: str | None, side: float, height: float) -> Flyer:
    """Flies round a square by a mission, from power-on to disarmed."""
    flyer = Flyer(physics, frame, world)
    flyer.boot()
    flyer.fly(0.1)
    ways = [
        Item(MavCmd.NAV_WAYPOINT, corner, height) for corner in ((side, 0.0), (side, side), (0.0, side), (0.0, 0.0))
    ]
    assert flyer.upload(Item(MavCmd.NAV_TAKEOFF, None, height), *ways, Item(MavCmd.NAV_LAND, (0.0, 0.0))) == 0
    flyer.arm()
    assert flyer.set_mode(AUTO)
    assert flyer.ask(300, 0, 0) == 0
    flyer.wait_disarmed(180.0)
    return flyer


@pytest.mark.slow
@pytest.mark.parametrize(("frame", "world", "side", "height"), MISSIONS.values(), ids=MISSIONS)
def test_a_mission_as_on_native_physics(frame: str, world: str | None, side: float, height: float) -> None:
    bullet, native = (square(physics, frame, world, side, height) for physics in ("pybullet", "native"))
    assert bullet.reached == [1, 2, 3, 4, 5]
    assert [t for t, _ in bullet.telemetry.reached] == pytest.approx([t for t, _ in native.telemetry.reached], abs=0.5)
    assert bullet.now == pytest.approx(native.now, abs=1.0)
    ours, theirs = np.array(bullet.track), np.array(native.track)
    count = min(len(ours), len(theirs))
    assert np.abs(ours[:count, 1:4] - theirs[:count, 1:4]).max() < 0.5
    assert truth.read(bullet.simulation.v).on_ground
    assert bullet.pos[2] == pytest.approx(0.0, abs=1e-3)
    assert bullet.simulation.v.physics.battery.charge == pytest.approx(
        native.simulation.v.physics.battery.charge, abs=2e-3
    )


@pytest.mark.slow
def test_a_snapshot_in_flight_goes_on_bit_for_bit() -> None:
    flyer = Flyer("pybullet", "erle_copter", "office_erlecopter")
    flyer.boot()
    flyer.fly(0.1)
    flyer.arm()
    flyer.ask(22, 0, 0, 0, 0, 0, 0, 1.0)
    flyer.fly(2.0)
    simulation = flyer.simulation
    snapshot = simulation.snapshot()
    simulation.advance(3.0)
    flown = simulation.fleet.tobytes()
    simulation.restore(snapshot)
    simulation.advance(3.0)
    assert simulation.fleet.tobytes() == flown
    other = Simulation("erle_copter", physics="pybullet", world="office_erlecopter", seed=2)
    other.restore(snapshot)
    other.advance(3.0)
    assert other.fleet.tobytes() == flown


MANUAL, ROVER_AUTO, RTL = 0, 10, 11
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
@pytest.mark.parametrize("frame", vehicles.names("rover", on_bench=False))
def test_square_and_return(frame: str) -> None:
    r, side = Rover(frame).ready(), SIDES[frame]
    limit = 60.0 + 6.0 * side / float(r.ap.params.WP_SPEED)
    corners = [(side, 0.0), (side, side), (0.0, side)]
    assert r.upload(*(Item(MavCmd.NAV_WAYPOINT, corner) for corner in corners)) == 0
    start = r.now
    assert r.set_mode(ROVER_AUTO)
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
