# SPDX-License-Identifier: BSD-3-Clause
"""The whole vehicle on Bullet: boots, aligns its filter, arms, flies a mission, lands and disarms as on native."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("pybullet")

from sitl.missions.pilot import Pilot
from sitl.physics.native import truth
from sitl.simulation import Simulation
from tests.pilots.witness import LAND_ITEM, TAKEOFF_ITEM, WAYPOINT, Item, Witness

pytestmark = pytest.mark.slow

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
    ways = [Item(WAYPOINT, corner, height) for corner in ((side, 0.0), (side, side), (0.0, side), (0.0, 0.0))]
    assert flyer.upload(Item(TAKEOFF_ITEM, None, height), *ways, Item(LAND_ITEM, (0.0, 0.0))) == 0
    flyer.arm()
    assert flyer.set_mode(AUTO)
    assert flyer.ask(300, 0, 0) == 0
    flyer.wait_disarmed(180.0)
    return flyer


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
