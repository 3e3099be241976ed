# SPDX-License-Identifier: BSD-3-Clause
"""In one compiled run lidar and range-finder measure, and solids are listed, as they do tick by tick."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.recorded.pilot import Pilot
from sitl import vehicles
from sitl.core.constants import NEVER, TICK_US
from sitl.simulation import Core, Simulation
from sitl.worlds import Box, Start, World

SECONDS = 10
POSITION_ONLY = 0xDF8
TOLD = ("DEBUG_FLOAT_ARRAY", "DISTANCE_SENSOR", "OBSTACLE_DISTANCE")


def alley() -> World:
    """Posts on both sides of a way to the north, more than a record can list."""
    posts = tuple(Box((0.7 * k, side, 1.0), (0.3, 0.3, 2.0)) for k in range(-5, 55) for side in (-3.0, 3.0))
    return World("alley", posts, (Start("here", (0.0, 0.0, 0.0), 0.0),))


def under_way(core: Core, frame: str) -> Pilot:
    """A vehicle with noisy sensors of awkward rates, on a long way through its world."""
    changes = {"lidar_rate": 7.0, "lidar_noise": 0.02}
    if frame == "erle_copter":
        changes |= {"rangefinder_rate": 33.0, "rangefinder_noise": 0.01}
    airframe = vehicles.load(frame).changed(**changes)
    pilot = Pilot(Simulation(airframe, world=alley(), core=core, estimator="truth", seed=5))
    pilot.boot()
    pilot.choose_mode("GUIDED")
    pilot.arm()
    if frame == "erle_copter":
        pilot.send_command("NAV_TAKEOFF", altitude=1.2)
        pilot.fly(4.0)
    for name in TOLD:
        pilot.set_rate(name, 20.0)
    pilot.setpoint(POSITION_ONLY, position=(40.0, 0.0, pilot.simulation.v.physics.body.pos.z))
    pilot.fly(0.1)
    return pilot


@pytest.mark.parametrize("frame", ["erle_copter", "erle_rover"])
def test_one_run_measures_as_tick_by_tick(cores: dict[str, Core], frame: str) -> None:
    pilot = under_way(cores[vehicles.load(frame).kind], frame)
    simulation = pilot.simulation
    v, snapshot = simulation.v, simulation.snapshot()
    scans, listed = v.sensors.lidar_count, (v.physics.obstacles.north, v.physics.obstacles.east)
    flown = []
    for step in (SECONDS * 1_000_000, TICK_US):
        pilot.connection.endpoint.receive()
        for _ in range(SECONDS * 1_000_000 // step):
            simulation.advance(step * 1e-6)
        said = [(name, repr(fields)) for name, fields in pilot.connection.endpoint.receive()]
        flown.append((simulation.fleet.tobytes(), said))
        assert v.sensors.lidar_count == scans + 7 * SECONDS
        assert (v.physics.obstacles.north, v.physics.obstacles.east) != listed, "the list was gathered anew"
        simulation.restore(snapshot)
    assert flown[0][0] == flown[1][0]
    assert flown[0][1] == flown[1][1]
    assert sum(name in TOLD for name, _ in flown[0][1]) > 20 * SECONDS


def test_the_core_does_not_return_to_measure(cores: dict[str, Core]) -> None:
    """One call of the unit for all of the time: nobody is connected and nothing happens."""
    simulation = Simulation("erle_copter", world="office_erlecopter", core=cores["copter"])
    simulation.advance(30.0)
    v, snapshot = simulation.v, simulation.snapshot()
    end = (30 + SECONDS) * 1_000_000
    simulation.bridge.run(simulation.plant.ranging, 0, end, NEVER)
    assert (v.time_us, v.sensors.lidar_count) == (end, end // 100_000 + 1)
    once = simulation.fleet.tobytes()
    simulation.restore(snapshot)
    while v.time_us < end:
        simulation.bridge.run(simulation.plant.ranging, 0, v.time_us + TICK_US, NEVER)
    assert simulation.fleet.tobytes() == once


def test_solids_are_listed_before_the_next_tick(cores: dict[str, Core]) -> None:
    simulation = Simulation("erle_rover", world="maze_erlerover", core=cores["rover"])
    simulation.advance(0.5)
    o = simulation.v.physics.obstacles
    o.north += 100.0  # the list is of another place
    o.rows[:] = 0.0
    o.clear = 0.0
    before = simulation.v.time_us
    simulation.bridge.run(simulation.plant.ranging, 0, before + TICK_US, NEVER)
    assert o.wanted and simulation.v.autopilot.events.attention
    simulation.bridge.run(simulation.plant.ranging, 0, before + 10 * TICK_US, NEVER)
    assert simulation.v.time_us == before + 10 * TICK_US
    assert not o.wanted and not simulation.v.autopilot.events.attention
    assert o.count > 0 and o.north == pytest.approx(simulation.v.physics.body.pos.x) and o.rows[0].any()


PLAIN = """
import sys
from sitl.simulation import Simulation
simulation = Simulation("erle_rover", world="maze_erlerover", seed=4)
simulation.advance(0.25)
sys.stdout.write(simulation.fleet.tobytes().hex())
"""


def test_plain_python_measures_the_same_bits() -> None:
    root = Path(__file__).parents[2]
    records = []
    for disabled in ("0", "1"):
        environment = {**os.environ, "NUMBA_DISABLE_JIT": disabled}
        run = subprocess.run(
            [sys.executable, "-c", PLAIN], capture_output=True, text=True, cwd=root, env=environment, check=True
        )
        records.append(run.stdout)
    assert records[0] == records[1] and len(records[0]) > 10_000
