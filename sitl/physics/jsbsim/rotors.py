# SPDX-License-Identifier: BSD-3-Clause
"""A multicopter's rotors and its contact with the ground, between record and JSBSim."""

from __future__ import annotations

import math
from typing import Any

from ..engine import EngineVehicle
from ..native.copter.ground import upright
from ..native.obstacles import HIT_PAUSE_US
from ..native.records import GROUND_AIRBORNE, GROUND_LYING, GROUND_STANDING
from . import copter_aircraft, model
from .copter_aircraft import GOES
from .engine import JsbsimEngine
from .formula import NAME
from .model import Properties, VehicleModel


class CopterModel(VehicleModel):
    """Commands in, rotor speeds and power out; touching the ground."""

    idle_parameters = ("SIM_ENGINE_LAG", "SIM_SHOVE_", "SIM_TWIST_")

    def __init__(self, vehicle: EngineVehicle) -> None:
        super().__init__(vehicle)
        p = vehicle.v.physics
        self._rotors, self._ground, self._battery, self._body = p.rotors, p.ground, p.battery, p.body
        self._commands = p.rotors.command
        self._write_power = model.writer(vehicle, "physics.rotors.power", 1)

    def frames(self, a: Any) -> int:
        return int(a.substeps)

    def document(self, a: Any, dt: float) -> str:
        return copter_aircraft.document(a, NAME, dt)

    def height(self, a: Any) -> float:
        return copter_aircraft.height(a)

    def bind(self, properties: Properties, a: Any, dt: float) -> None:
        count = int(a.rotor_count)
        numbers = range(1, count + 1)
        self._command_to = [properties.writer(f"rotor/command{k}") for k in numbers]
        self._speed_to = [properties.writer(f"rotor/speed{k}") for k in numbers]
        self._voltage_to = properties.writer("battery/voltage")
        self._goes_to = properties.writer(GOES)
        self._speeds = [properties.reader(f"rotor/speed{k}") for k in numbers]
        self._thrusts = [properties.reader(f"rotor/thrust{k}") for k in numbers]
        self._power = properties.reader("rotor/power")
        self._touches = properties.reader("forces/fbz-gear-lbs")
        self._write_speeds = model.writer(self.vehicle, "physics.rotors.speed", count)
        self._write_thrusts = model.writer(self.vehicle, "physics.rotors.thrust", count)
        self._upright = math.cos(float(a.tip_angle))
        self._hit_speed = float(a.hit_speed)

    def starting(self) -> None:
        self._goes_to(0.0)
        for write, speed in zip(self._speed_to, self._rotors.speed.tolist(), strict=False):
            write(speed)

    def started(self) -> None:
        self._goes_to(1.0)
        self._down = self._body.vel.z

    def inputs(self) -> None:
        commands = self._commands.tolist()
        if self._ground.state == GROUND_LYING:  # its rotors are broken
            commands = [0.0] * len(commands)
        for write, command in zip(self._command_to, commands, strict=False):
            write(command)
        self._voltage_to(self._battery.voltage)

    def outputs(self, down: float) -> None:
        self._write_speeds(*[read() for read in self._speeds])
        self._write_thrusts(*[read() for read in self._thrusts])
        self._write_power(self._power())
        state = self._ground.state
        if self._touches():
            if state != GROUND_LYING:
                self._touch(state)
        elif state == GROUND_STANDING:
            self._ground.state = GROUND_AIRBORNE
        self._down = down

    def _touch(self, state: int) -> None:
        """Something of the vehicle is on the ground."""
        g = self._ground
        if state == GROUND_AIRBORNE:
            g.state = GROUND_STANDING
            now = int(self.vehicle.v.time_us)
            if self._down > self._hit_speed and (g.hit_count == 0 or now - g.hit_time_us > HIT_PAUSE_US):
                g.hit_count += 1
                g.hit_speed = self._down
                g.hit_time_us = now
        if upright(self._body.q) < self._upright:
            g.state = GROUND_LYING


def make(vehicle: EngineVehicle) -> JsbsimEngine:
    """JSBSim for a copter.

    Raises:
        EngineError: its world is nothing for JSBSim.
        MissingExtra: JSBSim is not installed.
    """
    return JsbsimEngine(vehicle, CopterModel(vehicle))
