# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles of physics alone, without an autopilot: a copter's and a rover's."""

from __future__ import annotations

from typing import Any

import numpy as np

from sitl import vehicles
from sitl.autopilot.state import ACTUATORS_DTYPE, SENSORS_DTYPE
from sitl.core import compile as compiler
from sitl.core import records
from sitl.core.kernels import UNITS
from sitl.core.rng import RNG_DTYPE
from sitl.physics.native.copter import init as copter_init
from sitl.physics.native.copter import state as copter_state
from sitl.physics.native.copter import step as copter_step
from sitl.physics.native.rover import init as rover_init
from sitl.physics.native.rover import state as rover_state
from sitl.physics.native.rover import step as rover_step

HOME = (-35.363262, 149.165237, 584.0, 0.0)


def _vehicle(physics: Any) -> Any:
    return records.record(
        ("time_us", "i8"),
        ("tick", "i8"),
        ("rng", RNG_DTYPE),
        ("physics", physics),
        ("sensors", SENSORS_DTYPE),
        ("actuators", ACTUATORS_DTYPE),
    )


COPTER_DTYPE = _vehicle(copter_state.PHYSICS_DTYPE)
ROVER_DTYPE = _vehicle(rover_state.PHYSICS_DTYPE)


class Rig:
    """One vehicle, its fleet array, and shortcuts."""

    def __init__(self, frame: str = "ardupilot_quad", seed: int = 1, heading: float = 0.0, **figures: Any):
        self.airframe = vehicles.load(frame).changed(**figures)
        copter = self.airframe.kind == "copter"
        self._dtype = "COPTER_DTYPE" if copter else "ROVER_DTYPE"
        self._step = (copter_step if copter else rover_step).step
        self._init = (copter_init if copter else rover_init).init
        self.fleet = np.zeros(1, COPTER_DTYPE if copter else ROVER_DTYPE)
        self.v = records.view(self.fleet, 0)
        self.power_on(seed, heading)
        self.p = self.v.physics

    def power_on(self, seed: int, heading: float = 0.0) -> None:
        """Begin (again) at home."""
        self._init(self.v, self.airframe, (*HOME[:3], heading), seed)

    def step(self, ticks: int = 1) -> None:
        """Whole ticks, in plain Python."""
        for _ in range(ticks):
            self._step({0: self.v}, 0)

    def compiled(self) -> Any:
        """The compiled step, ``(address, count, index)``."""
        name = self._step.__module__.removeprefix("sitl.") + ".step"
        return compiler.load_unit(UNITS[name], f"{__name__}.{self._dtype}").ctypes

    def command(self, *controls: float) -> None:
        """Actuator controls: of each rotor or of all, of a rover steering and throttle (or left and right)."""
        if self.airframe.kind == "rover":
            self.v.actuators.controls[0], self.v.actuators.controls[2] = controls
        else:
            self.v.actuators.controls[:4] = controls if len(controls) == 4 else controls * 4

    def move(self, ticks: int = 1) -> None:
        """Motors, body and ground only."""
        for _ in range(ticks):
            if self.airframe.kind == "rover":
                rover_step.move(self.p, self.v.actuators.controls)
            else:
                copter_step.rotors.command(self.p, self.v.actuators.controls)
                copter_step.move(self.p, 0)

    def fly(self, height: float = 100.0) -> None:
        """Put a copter into the air, at rest."""
        self.p.ground.state = 0
        self.p.body.pos[2] = -height
