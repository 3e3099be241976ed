# SPDX-License-Identifier: BSD-3-Clause
"""Short flights that are recorded, and what their clients were sent."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest

from benchmarks.recorded.pilot import VELOCITY_ONLY, Pilot
from sitl.client.endpoint import Endpoint
from sitl.recording.recorder import Recorder
from sitl.simulation import Core, Simulation


@pytest.fixture(scope="session")
def hopped(core: Core, tmp_path_factory: pytest.TempPathFactory) -> Recorded:
    """A recorded flight of 62 s."""
    return hop(tmp_path_factory.mktemp("hop") / "hop.rec", core)


SECONDS = 62.0


@dataclass
class Recorded:
    """A flight and its file."""

    path: Path
    simulation: Simulation
    frames: list[tuple[int, bytes]]
    """All frames, with their times, sent and received, in order."""


class Frames:
    """A tap."""

    def __init__(self) -> None:
        self.frames: list[tuple[int, bytes]] = []

    def frame(self, time_us: int, raw: bytes) -> None:
        self.frames.append((time_us, raw))


def hop(path: Path, core: Core | None, gain: float | None = None, late_s: float = 0.0, **options: object) -> Recorded:
    """Take off, fly a moment, disarm: 62 s; a second client comes and goes; the vehicle is told to reboot at last."""
    params = {"SIM_WIND_SPD": 4.0, **({"PSC_VELXY_P": gain} if gain is not None else {})}
    simulation = Simulation(core=core, seed=7, params=params, **options)  # type: ignore[arg-type]
    recorder = Recorder(simulation, path)
    tap = Frames()
    simulation.bridge.taps.append(tap)
    pilot = Pilot(simulation)
    pilot.boot()
    pilot.arm()
    pilot.send_command("NAV_TAKEOFF", altitude=4.0)
    pilot.fly(4.0 + late_s)
    other = Endpoint(system=250)
    simulation.bridge.add_link(other.link)
    other.set_interval("ATTITUDE", 20.0)
    other.send("PARAM_REQUEST_LIST", target_system=1, target_component=1)
    pilot.stream_setpoint(1.0, VELOCITY_ONLY, (1.0, 0.5, 0.0))
    simulation.bridge.remove_link(other.link)
    pilot.send_command("COMPONENT_ARM_DISARM", 0, 21196)
    simulation.advance(0.2)
    pilot.send_command("PREFLIGHT_REBOOT_SHUTDOWN", 1)
    while simulation.time_us < SECONDS * 1e6:
        simulation.advance_to(min(simulation.time_us + 700_000, round(SECONDS * 1e6)))
    recorder.stopped = "the script ended"
    simulation.close()
    return Recorded(path, simulation, tap.frames)
