# SPDX-License-Identifier: BSD-3-Clause
"""Rovers for tests: the engine without an autopilot, beside native physics under the same controls."""

from __future__ import annotations

from typing import Any

from sitl import vehicles, worlds
from sitl.physics.engine import EngineVehicle, Laws
from sitl.physics.native.rover.init import init
from sitl.physics.pybullet.rover import BulletRover
from sitl.vehicle.core_entry import bind_unit
from sitl.vehicle.rover import ROVER
from sitl.vehicle.rover import Rover as RoverRecord
from sitl.worlds import World

HOME = (-35.36, 149.16, 584.0, 0.0)
AIRFRAMES = vehicles.names("rover")


class Rover:
    """A rover with steering or left side on the first control, throttle or right side on the second: -1 .. 1."""

    def __init__(self, frame: str, world: str | World | None = None, physics: str = "pybullet", **figures: Any) -> None:
        airframe = vehicles.load(frame).changed(noise_scale=0.0, **figures)
        self.fleet = fleet = RoverRecord.fleet(1)
        self.v = RoverRecord.of(fleet, 0)
        init(self.v, airframe, HOME, 1)
        self.full = float(airframe.value("control_full"))
        self.engine: BulletRover | None = None
        if physics == "native":
            self.tick = bind_unit(ROVER.step, ROVER, fleet, 0)
            return
        units = (ROVER.pieces.begin, ROVER.pieces.load, ROVER.pieces.sense)
        laws = Laws(*(bind_unit(unit, ROVER, fleet, 0) for unit in units))
        found = worlds.load(world) if world is not None else None
        self.engine = BulletRover(EngineVehicle(self.v, fleet, 0, airframe, laws, found))
        self.engine.place()
        self.tick = self.engine.tick

    def drive(self, seconds: float, first: float = 0.0, second: float = 0.0) -> None:
        controls = self.v.actuators.controls
        controls[0], controls[2] = first * self.full, second * self.full
        for _ in range(round(400 * seconds)):
            self.tick()

    @property
    def body(self) -> Any:
        return self.v.physics.body

    @property
    def wheels(self) -> Any:
        return self.v.physics.wheels

    @property
    def hits(self) -> Any:
        return self.v.physics.obstacles
