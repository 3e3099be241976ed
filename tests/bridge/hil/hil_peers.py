# SPDX-License-Identifier: BSD-3-Clause
"""The other end of a HIL link for tests, and what a flight says."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from sitl.missions.pilot import Pilot
from sitl.simulation import Simulation

ROOT = Path(__file__).parents[3]


class PhysicsProcess:
    """``sitl physics`` in a process of its own."""

    def __init__(self, *options: str, port: int = 0) -> None:
        command = [sys.executable, "-m", "sitl", "physics", *options, "--listen", f"tcp:{port}"]
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        self._process = subprocess.Popen(
            command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        assert self._process.stdout is not None and self._process.stderr is not None
        self.port = 0
        for line in self._process.stdout:
            if line.startswith("MAVLink HIL on "):
                self.port = int(line.rpartition(":")[2])
                return
        raise AssertionError(self._process.stderr.read())

    @property
    def address(self) -> str:
        """For ``Simulation(physics=...)``."""
        return f"hil:tcp:127.0.0.1:{self.port}"

    def kill(self) -> None:
        """As ``kill -9`` does."""
        self._process.kill()
        self._process.communicate()

    def signal(self, number: int) -> None:
        """Send it a signal."""
        self._process.send_signal(number)

    def end(self) -> tuple[int, str]:
        """Ctrl-C; gives the exit code and what it said."""
        self._process.terminate()
        out, _ = self._process.communicate(timeout=20)
        return self._process.returncode, out


class Heard:
    """A tap: every frame with its simulated time, in and out."""

    def __init__(self, simulation: Simulation) -> None:
        self.frames: list[tuple[int, bytes]] = []
        simulation.bridge.taps.append(self)

    def frame(self, time_us: int, raw: bytes) -> None:
        self.frames.append((time_us, raw))

    def names(self) -> set[int]:
        """Numbers of the messages."""
        return {int.from_bytes(raw[7:10], "little") for _, raw in self.frames if raw[0] == 0xFD}


class WatchedPilot(Pilot):
    """A pilot who asks for all streams and writes down every byte."""

    def __init__(self, simulation: Simulation, rate: int = 4) -> None:
        self.heard = Heard(simulation)
        super().__init__(simulation)
        for number in (1, 2, 3, 6, 10, 11, 12):  # stream groups of REQUEST_DATA_STREAM
            self.send("REQUEST_DATA_STREAM", req_stream_id=number, req_message_rate=rate, start_stop=1)
        for name in ("SIMSTATE", "HIGHRES_IMU", "BATTERY_STATUS", "WHEEL_DISTANCE"):
            self.set_rate(name, 10.0)
