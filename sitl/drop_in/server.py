# SPDX-License-Identifier: BSD-3-Clause
"""Runs a vehicle as ArduPilot's simulator does: waits for the first client, keeps parameters, ends with its parent."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from .. import vehicles
from ..autopilot.params import parm_files
from ..autopilot.params.table import Table
from ..autopilot.shell_parameters import clears_mission
from ..bridge.links import Link
from ..bridge.services.failure_injection import FaultService
from ..bridge.services.mission_protocol import MissionService
from ..bridge.services.signing import SigningService
from ..bridge.signing import WINDOW, Signing
from ..core.compile import Progress
from ..errors import OptionError
from ..logs.dataflash.log import DataFlash, attach
from ..logs.dataflash.numbered import NumberedLogs
from ..run import runner
from ..run.pacing import Pacing
from ..run.stop_signals import StopSignals
from ..scenario import Scenario
from ..simulation import Simulation
from ..vehicle.kinds import KINDS
from . import serial_ports
from .command_line import HELP, SERIAL_PORTS, CommandLine, parse
from .statistics import Statistics
from .stick_port import AT_REST, LEAST_THROTTLE, StickPort
from .storage import Storage

PROGRAMS = {"arducopter": "copter", "ardurover": "rover"}
"""ArduPilot's executables -> the kinds that they run."""
JSON = "JSON"
HIGH_LATENCY = 43.0
MAVLINK_PROTOCOLS = (1.0, 2.0, HIGH_LATENCY)
"""Values of SERIALn_PROTOCOL."""
LOGS = Path("logs")
LOOK_S = 0.2
"""Wall time between two looks for the parent while the first client is awaited [s]."""

LOG_US = 500_000
"""The log on disk is at most so far behind: suites read it while it grows [simulated us]."""
Say = Callable[[str], None]


class Session:
    """A vehicle with all that belongs to its executable.

    Args:
        program: "arducopter" or "ardurover".
        line: its command line.
        say: prints a line.
        progress: called for each unit that is compiled.
        on_built: called when all is compiled, before ports and logs are opened.

    Raises:
        SitlError: an option, a file or a port that cannot be taken, named.
    """

    def __init__(
        self,
        program: str,
        line: CommandLine,
        say: Say = print,
        progress: Progress | None = None,
        on_built: Callable[[], None] = lambda: None,
    ) -> None:
        self._line, self._say = line, say
        path = Path(f"{program}-storage.json")
        self.storage = Storage.wiped(path) if line.wipe else Storage(path)
        kind = PROGRAMS[program]
        airframe, physics = _model(kind, line)
        table = KINDS[kind].firmware.table
        params = self._parameters(table)
        in_range = {name: table[name].used(value) for name, value in params.items()}
        scenario = Scenario(airframe, home=line.home, params=in_range, physics=physics)
        self.simulation = simulation = Simulation(scenario, progress=progress)
        on_built()
        self._values = simulation.parameters
        self._values.update(params)  # values out of range are kept as they are, and told so
        self._values.defaults = {**simulation.airframe.parameters, **self._of_files}
        self.pacing = Pacing(None)
        self._follow_speedup()
        if not clears_mission(self._values):
            result = simulation.bridge.autopilot.replace_mission(self.storage.mission)
            if result:
                say(f"not taken: the mission of {str(path)!r} (MAV_MISSION_RESULT {result})")
        simulation.bridge.autopilot.take_notes()
        self._mission = simulation.mission
        self._lists = (self.storage.fence, self.storage.rally)
        simulation.bridge.get(MissionService).keep(*self._lists, counted=True)
        if (kept := self.storage.signing).key:  # as after any reboot: what was sent before is not taken again
            kept = kept._replace(timestamp=kept.timestamp + WINDOW)
            simulation.bridge.get(SigningService).signing = Signing(kept)
        simulation.bridge.listeners.append(self)
        self._logs: DataFlash | None = None
        self._statistics = Statistics(simulation, self._keep)
        self._awaited: Link | None = None
        self._serial: dict[str, Link] = {}
        """Links of serial ports, by the parameters of their protocols."""
        simulation.set_link_faults(line.link_faults)
        self._open_ports()
        self._logs, self._written_us = attach(simulation, LOGS, NumberedLogs), 0
        self.storage.write()

    def _parameters(self, table: Table) -> dict[str, float]:
        """Of default files, storage and command line; what the firmware does not take is told and left out."""
        self._of_files = of_files = parm_files.load_all(self._line.defaults)
        for note in parm_files.notes(table, of_files):
            self._say(note)
        values = {"SIM_WIND_T": 0.0, **of_files}  # ArduPilot's, with less wind near the ground
        values.update(self.storage.parameters)
        if self._line.sysid is not None:
            values["MAV_SYSID"] = self._line.sysid
        if self._line.speedup is not None:
            values["SIM_SPEEDUP"] = self._line.speedup
        strange = [name for name in values if name not in table and name not in of_files]
        self._report("parameters that this firmware does not have", strange)
        known = {name: value for name, value in values.items() if name in table}
        refusals = {name: text for name, value in known.items() if (text := table[name].no_number(value))}
        for text in refusals.values():
            self._say(f"not taken: {text}")
        return {name: value for name, value in known.items() if name not in refusals}

    def _report(self, what: str, names: Sequence[str]) -> None:
        if names:
            self._say(f"{len(names)} {what}: {', '.join(names)}")

    def _open_ports(self) -> None:
        line, bridge = self._line, self.simulation.bridge
        for number in range(SERIAL_PORTS):
            if not self._speaks_mavlink(number):
                continue
            link = serial_ports.open_port(line, number)
            if link is not None:
                if number == 0:
                    link.take_unsigned()
                self._serial[f"SERIAL{number}_PROTOCOL"] = link
                link.is_high_latency = self._values[f"SERIAL{number}_PROTOCOL"] == HIGH_LATENCY
                bridge.add_link(link)
                self._say(f"MAVLink on SERIAL{number}: {link.name}")
                if serial_ports.waits(line.devices[number]) and self._awaited is None:
                    self._awaited = link
        throttle = LEAST_THROTTLE if self.simulation.kind.flies else AT_REST[2]
        sticks = StickPort(self.simulation.v, line.address, line.sticks_port, throttle)
        bridge.add_link(sticks)
        self._say(f"sticks on {sticks.name}")

    def _speaks_mavlink(self, number: int) -> bool:
        name = f"SERIAL{number}_PROTOCOL"
        return name in self.simulation.firmware.table and self._values[name] in MAVLINK_PROTOCOLS

    # ------------------------------------------------------------------ listening

    def said(self, severity: int, text: str) -> None:
        """Texts are for clients."""

    def reached(self, seq: int) -> None:
        """Progress is for clients."""

    def commanded(self, fields: Any, frame: int, is_location: bool, sender: tuple[int, int], result: int) -> None:
        """Commands are for the vehicle."""

    def parameter_set(self, name: str) -> None:
        """Keep what a client has set; what a fault sets would outlive it."""
        if not self.simulation.bridge.get(FaultService).is_setting:
            self.storage.keep(name, self._values[name])
        if name in self._serial:
            self._serial[name].is_high_latency = self._values[name] == HIGH_LATENCY
        if name == "SIM_SPEEDUP":
            self._follow_speedup()

    def _follow_speedup(self) -> None:
        speedup = self._values["SIM_SPEEDUP"]
        self.pacing.set_speedup(speedup if speedup > 0.0 else None)

    # ------------------------------------------------------------------ running

    def wait_for_client(self, running: Callable[[], bool]) -> None:
        """Time stands until somebody is connected to the port that waits for it."""
        link, bridge = self._awaited, self.simulation.bridge
        if link is None:
            return
        self._say("Waiting for connection ....")
        while running() and not link.peers:
            bridge.wait(LOOK_S)
            bridge.receive()

    def serve(self, running: Callable[[], bool]) -> None:
        """Go on until ``running()`` is false."""
        self.wait_for_client(running)
        self._follow_speedup()  # time begins now
        runner.serve(self.simulation, self.pacing, running=running, on_slice=self._after_slice)

    def _keep(self, name: str, value: float) -> None:
        """Keep a parameter that counts, and have it logged."""
        self.storage.keep(name, value)
        if self._logs is not None:
            self._logs.parameter_set(name)

    def _after_slice(self) -> None:
        self._statistics.follow()
        if self._logs is not None and self.simulation.time_us - self._written_us >= LOG_US:
            self._written_us = self.simulation.time_us
            self._logs.write_out()
        mission = self.simulation.mission
        if mission is not self._mission:
            self._mission = mission
            self.storage.keep_mission(mission.items)
        lists = self.simulation.bridge.get(MissionService).lists
        if lists != self._lists:
            self._lists = lists
            self.storage.keep_lists(*lists)
        self._keep_key()
        self.storage.write()
        dropped = self.simulation.bridge.dropped
        while dropped:
            self._say(dropped.popleft())

    def _keep_key(self, with_time: bool = False) -> None:
        state = self.simulation.bridge.get(SigningService).signing.state()
        if state.key != self.storage.signing.key or (with_time and state.key):
            self.storage.keep_signing(state)

    def close(self) -> None:
        """Keep everything and close all."""
        self._keep_key(with_time=True)
        self.storage.write()
        self.simulation.close()


def _model(kind: str, line: CommandLine) -> tuple[str, str]:
    """Airframe and physics."""
    models = KINDS[kind].ardupilot_models
    first = next(iter(models.values()))
    name, _, address = line.model.partition(":")
    if name == JSON:
        host, port = line.physics
        return first, f"json:{address or host}:{port}"
    if line.model in ("", *models):
        return models.get(line.model, first), "native"
    own = line.model.replace("-", "_")
    if own in vehicles.names(kind):
        return own, "native"
    if vehicles.is_file(line.model):
        if (found := vehicles.load(line.model).kind) != kind:
            raise OptionError(f"--model {line.model!r} is a {found}; this program runs a {kind}")
        return line.model, "native"
    known = ", ".join((*models, f"{JSON}:HOST", *vehicles.names(kind), "a .toml file of an airframe"))
    raise OptionError(f"--model {line.model!r} is none of {known}")


def run(program: str, words: Sequence[str], progress: Progress | None = None) -> int:
    """The executable: returns its exit code.

    Raises:
        SitlError: an option, a file or a port that cannot be taken, named.
    """
    parent = os.getppid()  # before the core is compiled: it may end meanwhile
    line = parse(words)
    if line.help:
        print(f"usage: {program} [option ...]\n\n{HELP}", end="")
        return 0
    say: Say = lambda text: print(text, flush=True)  # noqa: E731 - tools read along
    if line.without_effect:
        say(f"no effect in this simulator: {', '.join(line.without_effect)}")
    with StopSignals("SIGINT", "SIGTERM", "SIGHUP") as signals:
        session = Session(program, line, say, progress, signals.catch)
        try:
            session.serve(lambda: signals.go_on() and os.getppid() == parent)
        finally:
            session.close()
    return 0
