# SPDX-License-Identifier: BSD-3-Clause
"""Short runs with a DataFlash log, and what ArduPilot's own reader makes of it."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path
from typing import Any

import pytest
from pymavlink import DFReader

from sitl.client.endpoint import Endpoint
from sitl.run import runner
from sitl.simulation import Simulation


@pytest.fixture(scope="session", params=["copter", "rover"])
def driven(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Run:
    """A short flight and a short drive, logged and closed."""
    run = Run(tmp_path_factory.mktemp("dataflash"), request.param)
    run.drive()
    run.simulation.close()
    return run


GUIDED = {"copter": 4, "rover": 15}


class Run:
    """A vehicle with a logger and a client."""

    def __init__(self, folder: Path, kind: str = "copter", **params: float) -> None:
        frame = "erle_copter" if kind == "copter" else "erle_rover"
        self.kind = kind
        self.simulation = Simulation(frame, seed=3, estimator="truth", params=params)
        self.path = folder / "run.bin"
        self.logger = runner.open_dataflash(self.simulation, self.path)
        self.client = Endpoint()
        self.simulation.bridge.add_link(self.client.link)

    def arm(self) -> None:
        """Wait for readiness, GUIDED, arm."""
        while not self.simulation.v.autopilot.arming.prearm_ok:
            self.simulation.advance(1.0)
        self.client.command(176, 1, GUIDED[self.kind])
        self.client.command(400, 1)
        self.simulation.advance(0.5)
        assert self.simulation.v.autopilot.arming.armed

    def drive(self) -> None:
        """Arm, leave the ground, go 5 m north."""
        self.arm()
        if self.kind == "copter":
            self.client.command(22, 0, 0, 0, 0, 0, 0, 5)
            self.simulation.advance(8.0)
        z = -5.0 if self.kind == "copter" else 0.0
        self.client.send(
            "SET_POSITION_TARGET_LOCAL_NED", target_system=1, target_component=1, coordinate_frame=1, type_mask=0xDF8,
            x=5.0, z=z,
        )  # fmt: skip
        self.simulation.advance(8.0)

    def set(self, name: str, value: float) -> None:
        """PARAM_SET"""
        self.client.send("PARAM_SET", target_system=1, target_component=1, param_id=name.encode(), param_value=value)
        self.simulation.advance(0.1)

    def ask(self, name: str, seconds: float = 0.5, **fields: Any) -> list[Any]:
        """Send a LOG_ request; the LOG_ messages that come back."""
        self.client.receive()
        self.client.send(name, target_system=1, target_component=1, **fields)
        self.simulation.advance(seconds)
        return [m.fields for m in self.client.receive() if m.name.startswith("LOG_")]


def read_log(path: Path) -> dict[str, list[Any]]:
    """All messages by name, as pymavlink's DFReader reads them."""
    log = DFReader.DFReader_binary(str(path))
    found = defaultdict(list)
    while (message := log.recv_msg()) is not None:
        found[message.get_type()].append(message)
        found["*"].append(message)
    log.close()
    return found
