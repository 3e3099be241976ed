# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle under a scan: an executable in a folder of its own, or ours in this process; and its ways into states."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.manoeuvres import executable
from benchmarks.manoeuvres.__main__ import FRAMES, HOME
from sitl import vehicles
from sitl.client import Client
from sitl.client.connection import Connection
from sitl.client.errors import CommandRefusedError, WaitTimeoutError
from sitl.logs.dataflash.log import attach
from sitl.logs.dataflash.numbered import NumberedLogs
from sitl.simulation import Simulation, load_core
from sitl.vehicle.kinds import KINDS

RATES_HZ = {
    **dict.fromkeys(("HEARTBEAT", "GLOBAL_POSITION_INT", "ATTITUDE"), 10.0),
    **dict.fromkeys(("SYS_STATUS", "EKF_STATUS_REPORT"), 5.0),
    "SYSTEM_TIME": 40.0,
}
"""What a program tells; the client's clock goes on with each message."""
BOOT_SPEEDUP, SPEEDUP = 60, 10
HEIGHT_M = 10.0
ANSWER_S = 1.0
"""An answer comes within [simulated s]."""
UNASKED = ("EKF3 ", "AHRS: ", "Field Elevation", "ArduPilot Ready", "Barometer 1 calibration", "PreArm: ")
"""Beginnings of texts that come by the clock."""


class Program(Client):
    """A vehicle that is scanned.

    Args:
        vehicle: in this process, or a connection.
        kind: "copter" or "rover".
    """

    def __init__(self, vehicle: Simulation | Connection, kind: str) -> None:
        super().__init__(vehicle, rates=RATES_HZ, patience=60.0)
        self.of = kind
        self._said = 0

    @property
    def is_ours(self) -> bool:
        """In this process."""
        return self.connection.simulation is not None

    def version(self) -> str:
        """As "4.7.0-dev (8264a9b4)"."""
        m = self.message("AUTOPILOT_VERSION")
        number = ".".join(str(m.flight_sw_version >> shift & 0xFF) for shift in (24, 16, 8))
        kind = {0: "-dev", 255: ""}.get(m.flight_sw_version & 0xFF, "")
        return f"{number}{kind} ({bytes(m.flight_custom_version).decode('ascii', 'replace')})"

    # ------------------------------------------------------------------ what is asked

    def ask(self, name: str, answer: str, within: float = ANSWER_S, **fields: Any) -> Any:
        """Send a message and give the first of those that answer it; None: none came in time."""
        with self.messages(answer) as seen:
            self.send(name, **fields)
            self.passes(lambda: seen, within)
            return seen[0] if seen else None

    def new_texts(self) -> list[str]:
        """Status texts since the last call, without those that come by the clock."""
        new = [text.text for text in self.texts[self._said :]]
        self._said = len(self.texts)
        return [text for text in new if not text.startswith(UNASKED)]

    # ------------------------------------------------------------------ ways into states

    def be_ready(self) -> None:
        """On the ground, disarmed, with a position."""
        self.wait_ready()
        self.delay(5.0)

    def be_armed(self, mode: str = "GUIDED") -> None:
        """On the ground, armed in a mode."""
        self.be_ready()
        self.set_mode(mode)
        for patience in (5.0, 20.0, 60.0):  # its log is opened in wall time
            try:
                return self.arm()
            except (CommandRefusedError, WaitTimeoutError):
                if self.is_ours:
                    raise
                self.delay(patience)
        self.arm()

    def be_flying(self, altitude: float = HEIGHT_M) -> None:
        """At rest in GUIDED: a copter at a height, a rover armed."""
        self.be_armed()
        if self.of == "copter":
            self.delay(1.0)
            self.command("NAV_TAKEOFF", altitude=altitude)
            self.wait_altitude(altitude - 0.3, altitude + 0.5, hold=2.0)


@dataclass(frozen=True)
class Programs:
    """Starts programs of one kind: ours, or an executable."""

    kind: str
    binary: Path | None = None
    """None: ours, in this process."""
    speedup: int = SPEEDUP
    instance: int = 0
    rows: str = "*"
    """Which rows are wanted, as a pattern of the shell."""

    @contextmanager
    def started(
        self, params: Mapping[str, float] | None = None, seed: int = 0, folder: Path | None = None
    ) -> Iterator[Program]:
        """A program on the ground at the start of its time, with the parameters of our airframe and these; it ends with
        the block. ``folder``: where its folder ``logs`` is."""
        params = {**vehicles.load(FRAMES[self.kind]).parameters, **(params or {})}
        if self.binary is None:
            core = load_core(KINDS[self.kind])
            simulation = Simulation(FRAMES[self.kind], home=HOME, seed=seed, core=core, params=params)
            if folder is not None:
                attach(simulation, folder / "logs", NumberedLogs)
            yield Program(simulation, self.kind)
            simulation.close()
            return
        path = executable.find(self.binary, self.kind)
        start = (path, self.kind, HOME, BOOT_SPEEDUP, params, self.instance)
        with executable.started(*start, own=folder) as connection:
            program = Program(connection, self.kind)
            program.wait_ready()
            program.params["SIM_SPEEDUP"] = self.speedup
            yield program
