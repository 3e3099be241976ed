# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles in JSBSim, without their autopilots: the engine alone, driven by actuator controls."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.physics.jsbsim.engine import JsbsimEngine
from sitl.simulation import Simulation
from sitl.vehicles import Airframe

pytest.importorskip("jsbsim")


class Bench:
    """One vehicle on JSBSim, standing at its home."""

    def __init__(self, frame: str | Airframe, **options: Any) -> None:
        self.simulation = Simulation(frame, physics="jsbsim", **options)
        engine = self.simulation.plant.engine  # type: ignore[attr-defined]
        assert isinstance(engine, JsbsimEngine)
        self.engine = engine
        self.v = self.simulation.v
        self.p = self.v.physics
        self.body = self.p.body
        self.controls = self.v.actuators.controls

    def run(self, seconds: float, *controls: float) -> None:
        """Hold the controls for a time."""
        for _ in range(round(seconds * 400)):
            self.tick(*controls)

    def tick(self, *controls: float) -> None:
        """One tick under these controls."""
        self.controls[: len(controls)] = controls
        self.engine.tick()

    def put(self, **body: Any) -> None:
        """Change the body's motion and have JSBSim go on from there."""
        for name, value in body.items():
            setattr(self.body, name, value)
        self.engine.restore(b"")

    def digest(self) -> bytes:
        """All of the physics, to the last bit."""
        return bytes(self.p._bytes)
