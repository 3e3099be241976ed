# SPDX-License-Identifier: BSD-3-Clause
"""Copters in Bullet for tests, with the common laws in plain Python: nothing is compiled."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from sitl import vehicles
from sitl.core.algebra import ZERO, quat_from_euler
from sitl.core.vectors import Euler
from sitl.physics.engine import EngineVehicle, Laws
from sitl.physics.native.copter import pieces
from sitl.physics.native.copter.init import init
from sitl.physics.pybullet.engine import BulletEngine
from sitl.vehicle.copter import Copter
from sitl.vehicles import Airframe
from sitl.worlds import World

HOME = (47.0, 8.0, 500.0, 0.0)


def copter(
    frame: str | Airframe = "erle_copter",
    world: World | None = None,
    position: Sequence[float] = (0.0, 0.0, 0.0),
    euler: Sequence[float] = (0.0, 0.0, 0.0),
    seed: int = 1,
) -> BulletEngine:
    """A copter with power on, put down at a place: NED [m]; roll, pitch, yaw [rad]."""
    airframe = vehicles.load(frame)
    fleet = Copter.fleet(1)
    v = Copter.of(fleet, 0)
    init(v, airframe, HOME, seed)
    floor = 0.0 if world is None else world.floor_z
    laws = Laws(lambda: pieces.begin([v], 0), lambda: pieces.load([v], 0), lambda: pieces.sense([v], 0))
    engine = BulletEngine(EngineVehicle(v, fleet, 0, airframe, laws, world, floor))
    v.physics.obstacles.present = int(world is not None)
    put(engine, position, euler)
    return engine


def put(engine: BulletEngine, position: Sequence[float], euler: Sequence[float] = (0.0, 0.0, 0.0)) -> None:
    """Put it down, at rest."""
    body = engine.vehicle.v.physics.body
    body.pos, body.vel, body.rates, body.q = position, ZERO, ZERO, quat_from_euler(Euler(*euler))
    engine.vehicle.v.physics.ground.state = int(position[2] > -0.001)
    engine.place()


def hover(engine: BulletEngine, share: float = 1.0) -> None:
    """Set all controls to what carries this share of the weight."""
    v = engine.vehicle.v
    a = v.physics.airframe
    speed = np.sqrt(share * a.mass * 9.80665 / a.rotor_count / a.thrust_coefficient)
    v.actuators.controls[: int(a.rotor_count)] = a.control_min + speed / a.speed_max * (a.control_max - a.control_min)


def run(engine: BulletEngine, seconds: float) -> None:
    """Let time pass."""
    for _ in range(round(seconds * 400)):
        engine.tick()


def record_of(engine: BulletEngine) -> bytes:
    """All bytes of the vehicle."""
    return engine.vehicle.fleet.tobytes()


def by_dice(engine: BulletEngine, ticks: int, seed: int) -> bytes:
    """Random controls; all bytes of the vehicle afterwards."""
    dice = np.random.default_rng(seed)
    controls: Any = engine.vehicle.v.actuators.controls
    for k in range(ticks):
        if k % 40 == 0:
            controls[:4] = dice.uniform(0.3, 0.75) + dice.uniform(-0.02, 0.02, 4)
        engine.tick()
    return record_of(engine)
