# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles of physics alone, without an autopilot: laws and the step run as plain Python."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from sitl import vehicles
from sitl.core import compile as compiler
from sitl.core.border import Actuators, Sensors
from sitl.core.kernels import UNITS
from sitl.core.records import Record
from sitl.core.rng import Rng
from sitl.physics.native.copter import init as copter_init
from sitl.physics.native.copter import state as copter_state
from sitl.physics.native.copter import step as copter_step
from sitl.physics.native.rover import init as rover_init
from sitl.physics.native.rover import state as rover_state
from sitl.physics.native.rover import step as rover_step
from sitl.vehicle.kinds import KINDS


@pytest.fixture
def rig() -> Callable[..., Rig]:
    return Rig


@pytest.fixture(scope="session")
def rig_factory() -> Callable[..., Rig]:
    """As ``rig``, for property tests, which must not use fixtures of one test."""
    return Rig


HOME = (-35.363262, 149.165237, 584.0, 0.0)


class Copter(Record):
    """A copter without autopilot."""

    time_us: int
    tick: int
    rng: Rng
    physics: copter_state.Physics
    sensors: Sensors
    actuators: Actuators


class Rover(Record):
    """A rover without autopilot."""

    time_us: int
    tick: int
    rng: Rng
    physics: rover_state.Physics
    sensors: Sensors
    actuators: Actuators


class Rig:
    """One vehicle, its fleet array, and shortcuts."""

    def __init__(self, frame: str = "ardupilot_quad", seed: int = 1, heading: float = 0.0, **properties: Any):
        self.airframe = vehicles.load(frame).changed(**properties)
        copter = self.airframe.kind == "copter"
        self._record = Copter if copter else Rover
        self._step = (copter_step if copter else rover_step).step
        self._init = (copter_init if copter else rover_init).init
        self.fleet = self._record.fleet(1)
        self.v: Any = self._record.of(self.fleet, 0)
        self.power_on(seed, heading)
        self.p = self.v.physics

    def power_on(self, seed: int, heading: float = 0.0) -> None:
        """Begin (again) at home."""
        self._init(self.v, self.airframe, (*HOME[:3], heading), seed)

    def step(self, ticks: int = 1) -> None:
        """Whole ticks, in plain Python."""
        for _ in range(ticks):
            self._step({0: self.v}, 0)

    def step_compiled(self) -> None:
        """One tick by the unit of whole vehicles, which need not be compiled for the rig: what they have in common goes
        there and back."""
        kind = KINDS[self.airframe.kind]
        path = f"{kind.record.__module__}.{kind.record.__qualname__}"
        unit = compiler.load_unit(UNITS[self._step.__module__.removeprefix("sitl.") + ".step"], path)
        whole = kind.record.fleet(1)
        for name in self._record.fields:
            whole[name] = self.fleet[name]
        unit(whole.ctypes.data, 1, 0)
        for name in self._record.fields:
            self.fleet[name] = whole[name]

    def command(self, *controls: float) -> None:
        """Actuator controls: of each rotor or of all, of a rover steering and throttle (or left and right)."""
        if self.airframe.kind == "rover":
            self.v.actuators.controls[0], self.v.actuators.controls[2] = controls
        else:
            self.v.actuators.controls[:4] = controls if len(controls) == 4 else controls * 4

    def move(self, ticks: int = 1) -> None:
        """Motors, body and ground only."""
        for _ in range(ticks):
            p = self.p
            if self.airframe.kind == "rover":
                rover_step.move(p.wheels, p.body, p.airframe, p.derived, self.v.actuators.controls)
            else:
                copter_step.rotors.command(p.rotors, self.v.actuators.controls, p.airframe, p.derived)
                copter_step.move(p, 0)

    def fly(self, height: float = 100.0) -> None:
        """Put a copter into the air, at rest."""
        self.p.ground.state = 0
        self.p.body.pos = self.p.body.pos.replace(z=-height)
