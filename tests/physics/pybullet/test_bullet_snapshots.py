# SPDX-License-Identifier: BSD-3-Clause
"""Snapshots of a copter in Bullet: bit for bit, in the air, on its feet and fallen over."""

from __future__ import annotations

import dataclasses
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pybullet")

from sitl import worlds
from sitl.envs.options import EnvOptionError
from sitl.envs.robots.autopilot import AutopilotRobot, EpisodeState
from sitl.physics.engine import EngineError
from sitl.physics.pybullet.engine import BulletEngine
from sitl.simulation import Simulation
from tests.physics.pybullet.bullet_copters import by_dice, copter, put, record_of, run


def again(engine: BulletEngine, record: bytes, state: bytes) -> bytes:
    """Put back, flown on."""
    engine.vehicle.fleet.view("u1")[:] = bytearray(record)
    engine.restore(state)
    return by_dice(engine, 200, 9)


POSES = {
    "standing": ((0.0, 0.0, 0.0), (0.0, 0.0, 0.3)),
    "in the air": ((1.0, 0.0, -5.0), (0.1, 0.2, 2.0)),
    "upside down": ((0.0, 0.0, -0.4), (2.5, 0.0, 0.0)),
}


@pytest.mark.parametrize(("position", "euler"), POSES.values(), ids=POSES)
def test_goes_on_bit_for_bit(position: tuple[float, ...], euler: tuple[float, ...]) -> None:
    engine = copter(position=position, euler=euler)
    run(engine, 1.0)
    state, record = engine.snapshot(), record_of(engine)
    flown = by_dice(engine, 200, 9)
    assert again(engine, record, state) == flown
    assert again(copter(), record, state) == flown, "in another engine"
    elsewhere = copter(position=(3.0, 0.0, -1.0), euler=(3.0, 0.0, 0.0))
    run(elsewhere, 1.0)
    assert again(elsewhere, record, state) == flown, "in one that touches the ground itself"


def test_a_look_changes_nothing_in_the_air() -> None:
    looked_at, other = copter(position=(0.0, 0.0, -30.0)), copter(position=(0.0, 0.0, -30.0))
    by_dice(looked_at, 100, 1)
    by_dice(other, 100, 1)
    looked_at.snapshot()
    assert by_dice(looked_at, 300, 2) == by_dice(other, 300, 2)


def test_a_snapshot_of_another_world_is_refused() -> None:
    state = copter(world=worlds.load("maze")).snapshot()
    with pytest.raises(EngineError, match="vehicle and world"):
        copter().restore(state)
    engine, other = copter(), copter()
    with pytest.raises(EngineError, match="vehicle and world"):
        engine.restore(b"-nonsense")
    assert by_dice(engine, 200, 1) == by_dice(other, 200, 1), "it is where it was"


def test_power_on_forgets_what_it_ran_into() -> None:
    world = worlds.load("round")
    engine, dice = copter(world=world), np.random.default_rng(5)
    start, record, touched = world.start("erle_copter").north_east_down, record_of(engine), 0
    for k in range(10):
        put(engine, (start[0] + dice.uniform(-1, 1), start[1] + dice.uniform(-1, 1), -dice.uniform(0.0, 1.0)))
        body = engine.body
        velocity, spin = dice.uniform(-3, 3, 3).tolist(), dice.uniform(-6, 6, 3).tolist()
        body.client.p.resetBaseVelocity(body.number, velocity, spin, body.client.id)
        by_dice(engine, 200, k)
        touched += engine.body.keeps_contacts()
        n, e, d = list(engine.vehicle.v.physics.body.pos)
        ends = []
        for again in (engine, copter(world=world)):
            again.vehicle.fleet.view("u1")[:] = bytearray(record)
            put(again, (n, e, min(d, 0.0)))
            ends.append(by_dice(again, 300, k))
        assert ends[0] == ends[1], k
    assert touched > 3


@pytest.mark.parametrize("name", ["maze", "round"])
def test_goes_on_bit_for_bit_among_walls(name: str) -> None:
    world = worlds.load(name)
    engine, used = copter(world=world), copter(world=world)
    start, dice, near = world.start("erle_copter").north_east_down, np.random.default_rng(4), 0
    for k in range(8):
        put(engine, (start[0] + dice.uniform(-1, 1), start[1] + dice.uniform(-1, 1), -dice.uniform(0.1, 1.0)))
        body = engine.body
        velocity, spin = dice.uniform(-3, 3, 3).tolist(), dice.uniform(-6, 6, 3).tolist()
        body.client.p.resetBaseVelocity(body.number, velocity, spin, body.client.id)
        by_dice(engine, int(dice.integers(20, 120)), k)
        near += engine._is_near()
        state, record = engine.snapshot(), record_of(engine)
        flown = by_dice(engine, 200, 9)
        assert again(used, record, state) == flown
        assert again(copter(world=world), record, state) == flown
    assert near > 2


def test_goes_on_bit_for_bit_in_another_process(tmp_path: Path) -> None:
    engine = copter(position=(0.0, 0.0, -0.2), euler=(0.2, 0.0, 0.0))
    run(engine, 0.3)
    assert engine.body.keeps_contacts()
    (tmp_path / "state").write_bytes(engine.snapshot())
    (tmp_path / "record").write_bytes(record_of(engine))
    script = (
        "import sys; from pathlib import Path; from tests.physics.pybullet.bullet_copters import by_dice, copter;"
        "e = copter();"
        "e.vehicle.fleet.view('u1')[:] = bytearray(Path('record').read_bytes());"
        "e.restore(Path('state').read_bytes()); sys.stdout.buffer.write(by_dice(e, 200, 9))"
    )
    there = subprocess.run(
        [sys.executable, "-c", script], cwd=tmp_path, env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True, check=True,
    )  # fmt: skip
    assert there.stdout == by_dice(engine, 200, 9)


def test_bullet_keeps_no_state_that_it_read(tmp_path: Path) -> None:
    """Its cache of files would grow with every one, and take the second for the first."""
    engine, heights = copter(position=(0.0, 0.0, -30.0)), []
    p, client, file = engine.body.client.p, engine.body.client.id, str(tmp_path / "state.bullet")
    for _ in range(2):
        p.saveBullet(file, client)
        by_dice(engine, 50, 1)
        p.restoreState(fileName=file, physicsClientId=client)
        heights.append(p.getBasePositionAndOrientation(engine.body.number, client)[0][2])
        by_dice(engine, 50, 1)
    assert heights[1] < heights[0]


def test_a_simulation_takes_all_of_a_snapshot_or_nothing() -> None:
    simulation, other = (Simulation("erle_copter", physics="pybullet") for _ in range(2))
    taken = simulation.snapshot()
    for one in (simulation, other):
        one.advance(1.0)
    with pytest.raises(EngineError, match="snapshot"):
        simulation.restore(dataclasses.replace(taken, plant=b"-nonsense"))
    for one in (simulation, other):
        one.advance(1.0)
    assert simulation.time_us == 2_000_000
    assert simulation.fleet.tobytes() == other.fleet.tobytes()


def test_a_robot_refuses_it_by_name() -> None:
    robot = AutopilotRobot("office_erlecopter", frame="erle_copter", physics="pybullet")
    taken = EpisodeState(robot.simulation(0).snapshot(), None, (0.0, 0.0, 0.0), 0, "", 20_000)
    broken = dataclasses.replace(taken, simulation=dataclasses.replace(taken.simulation, plant=b""))
    with pytest.raises(EnvOptionError, match="cannot be restored"):
        robot.restore(0, broken)
    robot.close()
