# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles for the tests of physics: laws and the step run as plain Python."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from sitl import vehicles
from sitl.core import records
from sitl.physics.native import step as step_module
from sitl.physics.native.init import init
from sitl.vehicle import VEHICLE_DTYPE

HOME = (-35.363262, 149.165237, 584.0, 0.0)


class Rig:
    """One vehicle, its fleet array, and shortcuts."""

    def __init__(self, frame: str = "ardupilot_quad", seed: int = 1, heading: float = 0.0, **figures: Any):
        self.fleet = np.zeros(1, VEHICLE_DTYPE)
        self.v = records.view(self.fleet, 0)
        self.airframe = vehicles.load(frame).changed(**figures)
        init(self.v, self.airframe, (*HOME[:3], heading), seed)
        self.p = self.v.physics

    def step(self, ticks: int = 1) -> None:
        fleet = self.fleet.view(np.recarray)
        for _ in range(ticks):
            step_module.step(fleet, 0)

    def move(self, ticks: int = 1) -> None:
        """Rotors, body and ground only."""
        for _ in range(ticks):
            step_module.rotors.command(self.p, self.v.actuators.controls)
            step_module.move(self.p, 0)

    def command(self, *controls: float) -> None:
        self.v.actuators.controls[:4] = controls if len(controls) == 4 else controls * 4

    def fly(self, height: float = 100.0) -> None:
        """Put the vehicle into the air, at rest."""
        self.p.ground.state = 0
        self.p.body.pos[2] = -height


@pytest.fixture
def rig() -> Callable[..., Rig]:
    return Rig


@pytest.fixture(scope="session")
def rig_factory() -> Callable[..., Rig]:
    """As ``rig``, for property tests, which must not use fixtures of one test."""
    return Rig
