# SPDX-License-Identifier: BSD-3-Clause
"""An autopilot that is not ours, on our physics: commands and telemetry by its MAVLink, time held by the physics.

The physics goes exactly as far as a step says. At its end the autopilot waits for an answer that does not come before
the next step: it has done all that it does at that time. Scans and touches come from the physics, which has the lidar.
"""

from __future__ import annotations

import contextlib
import hashlib
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Protocol

from sitl.autopilot.params.parm_files import text_of
from sitl.bridge.hil.protocol import BASE_PORT
from sitl.client.byte_socket import ByteStream, open_stream
from sitl.client.commands import command_number
from sitl.client.connection import Connection
from sitl.client.endpoint import Endpoint, Inbox
from sitl.core.mavlink import ARM_FORCED, MavResult
from sitl.errors import LinkLostError, NotReadyError, OptionError
from sitl.foreign import ardupilot, px4
from sitl.foreign.betaflight import configuration
from sitl.foreign.betaflight.betaflight_session import starter
from sitl.foreign.betaflight.clients import InProcess
from sitl.foreign.betaflight.face import Face
from sitl.foreign.betaflight.host import BetaflightHost
from sitl.foreign.choice import ARDUPILOT, BETAFLIGHT, PX4, WIND, Choice
from sitl.foreign.hil_host import HilHost
from sitl.foreign.json_host import ANSWERS, JsonHost
from sitl.foreign.one_core import OneCore
from sitl.foreign.process import HOST, AutopilotEndedError, AutopilotProcess, free_tcp_run
from sitl.foreign.sim_parameters import SimParameterPort
from sitl.plants.json_link import PORT
from sitl.plants.local import LocalPlant
from sitl.plants.physics_server import SimulatedPlant
from sitl.run.runner import BASE_TCP_PORT

from .last_messages import StepTelemetry

_REBOOT = command_number("PREFLIGHT_REBOOT_SHUTDOWN")
_SLICE_US = 20_000
_ANSWER_US = 3_000_000
"""Simulated time within which a command is answered [us]."""
_PROMPT_US = 200_000
"""The same, after which simulated time does not outrun the wall clock any more: what answers for a PX4 is a thread that
lockstep does not wait for, and on a busy machine 9 s went by before it ran [us]."""
_START_S = 60.0
"""Wall time that a program which was started has until its MAVLink is there [s]."""
_HEARTBEAT_US = 30_000_000
_TELEMETRY_US = 5_000
"""Interval of telemetry [us], and so its greatest age at the end of a step, but for the autopilot's own delay: at
20 ms it was always 19 ms (ArduPilot) or 23 ms (PX4) old, and policies that had learnt with fresh one touched the ground
beside the pad."""


class Host(Protocol):
    """Serves a plant to an autopilot."""

    boots: int
    before_boot_us: int

    @property
    def time_us(self) -> int:
        """Simulated time since power-on [us]."""

    def listen(self) -> bool:
        """Wait a moment until the autopilot asks for a step; whether it does."""

    def step(self, until_us: int | None = None, answers: int = 1) -> None:
        """Give it the step, and up to so many in all, no further than ``until_us``."""

    def attach(self, plant: LocalPlant) -> None:
        """Serve this plant from now on."""

    def close(self) -> None:
        """Serve no more."""


class SimParameters(dict[str, float]):
    """Parameters as the autopilot reports them; those of the wind act on the physics, too, which is not the
    autopilot's.

    Args:
        plant: the physics.
    """

    def __init__(self, plant: LocalPlant) -> None:
        super().__init__()
        self._set = SimulatedPlant(plant).set_parameter

    def __setitem__(self, name: str, value: float) -> None:
        super().__setitem__(name, value)
        if name.startswith(WIND):
            self._set(name, value)


class Foreign(Connection):
    """See the module.

    Args:
        host: serves the plant.
        plant: physics and world.
        connection: form of ``open_stream``: where the autopilot's MAVLink is.
        process: the autopilot, when it was started for this.
        inbox: gets what it says; one of an environment's steps also gets the physics' scans and touches.
        patience: wall time without a sign of life after which it is lost [s].
        face: its MAVLink, when that is in this process: ``connection`` is a name then.
    """

    is_exact = False
    repeats = False
    """Whether the same words at the same times make the same flight, bit for bit: of an ArduPilot that was started
    here, without on-board log."""

    def __init__(
        self,
        host: Host,
        plant: LocalPlant,
        connection: str,
        process: AutopilotProcess | None,
        inbox: Inbox,
        patience: float,
        face: Face | None = None,
    ) -> None:
        super().__init__(Endpoint(), inbox)
        if isinstance(inbox, StepTelemetry):
            inbox.scans_by_mavlink, inbox.longest_interval_us = False, _TELEMETRY_US
        self.host, self.process = host, process
        self._one_core = OneCore(None if process is None else process.pid)
        self.patience, self._connection, self._face = patience, connection, face
        self._use(plant)
        self._port = SimParameterPort(plant) if isinstance(host, HilHost) else None
        self.tap: Callable[[bytes], None] = lambda data: None
        """Gets all that the autopilot says."""
        self.stream: ByteStream | None = None
        self.digests: list[str] = []
        """Of all true states and outputs from the start until each whole second of the physics' time, and until now."""
        self._hash = hashlib.blake2b(digest_size=8)
        try:
            self._connect()
            self.find()
        except BaseException:
            self.close()
            raise

    def _use(self, plant: LocalPlant) -> None:
        self.plant, self.kind = plant, plant.vehicle.kind
        self._sensors, self._obstacles = plant.vehicle.v.sensors, plant.vehicle.v.physics.obstacles
        self._scans = self._hits = 0
        self.inbox.parameters = SimParameters(plant)

    @property
    def name(self) -> str:
        return self._connection

    @property
    def boots(self) -> int:
        return self.host.boots

    @property
    def time_us(self) -> int:
        """Simulated time since the autopilot was started; reboots do not set it back [us]."""
        return self.host.before_boot_us + self.host.time_us

    # ------------------------------------------------------------------ beginning

    def _connect(self) -> None:
        """Open its MAVLink, which may not be there yet."""
        if self.stream is not None:
            self.stream.close()
        until = time.monotonic() + (self.patience if self.process is None else max(self.patience, _START_S))
        while True:
            try:
                stream = open_stream(self._connection) if self._face is None else InProcess(self._face)
                self.stream = stream if self._port is None else self._port.over(stream)
            except LinkLostError:
                self._check()
                if time.monotonic() >= until:
                    raise
                time.sleep(0.05)  # wall time; the vehicle has none yet
            else:
                self.endpoint = Endpoint(self.stream)
                return

    def find(self) -> None:
        """Go on until it is heard, no faster than the wall clock: programs start in wall time.

        Raises:
            LinkLostError: it is not.
        """
        self.inbox.system = 0
        began_us, began = self.time_us, time.monotonic()
        for _ in range(_HEARTBEAT_US // _SLICE_US):
            self.run(_SLICE_US)
            if self.inbox.system != 0:
                return
            ahead = 1e-6 * (self.time_us - began_us) - (time.monotonic() - began)
            if ahead > 0.0:
                time.sleep(ahead)
        said = "" if self.process is None else f"; it said: {self.process.last_output()}"
        raise LinkLostError(
            f"connection {self.name}: no HEARTBEAT in {_HEARTBEAT_US // 1_000_000} simulated seconds, "
            f"{time.monotonic() - began:.0f} of the wall clock{said}"
        )

    def restart(self, plant: LocalPlant) -> None:
        """Reboot an autopilot that runs elsewhere, on another plant.

        Raises:
            LinkLostError, NotReadyError: it does not boot.
        """
        self.command("COMPONENT_ARM_DISARM", arm=0, force=ARM_FORCED)
        boots = self.host.boots
        try:
            result = self.command("PREFLIGHT_REBOOT_SHUTDOWN", autopilot=1)
        except LinkLostError:  # its last word may be the answer
            answer = self.inbox.acks.get(_REBOOT)
            if answer is None:
                raise
            result = int(answer.result)
        if result != MavResult.ACCEPTED:
            raise NotReadyError(f"{self.name}: the autopilot refuses to reboot (MAV_RESULT {result})")
        self.plant.close()
        self._use(plant)
        self.host.attach(plant)
        until = time.monotonic() + self.patience
        self.inbox.forget()
        while True:  # it closes its port, and opens it again when it boots
            try:
                if self.host.boots != boots:
                    self.find()
                    return
                if self.host.listen():
                    self.host.step()
                self._hear()
            except LinkLostError:
                if time.monotonic() >= until:
                    raise
                self._connect()
            if time.monotonic() >= until:
                raise LinkLostError(f"connection {self.name}: the autopilot does not boot within {self.patience:g} s")

    # ------------------------------------------------------------------ going on

    def run(self, us: int) -> None:
        host, goal, boots = self.host, self.host.time_us + us, self.host.boots
        if self._port is not None:
            self._port.act()
        with self._one_core:
            if self.stream is not None:  # on the same core as our answers: the kernel delivers both in this order
                self.stream.flush()
            while host.time_us < goal and host.boots == boots:
                self._await()
                host.step(goal, ANSWERS)
                self._hear()
            if us > 0:
                self._await()
        self._hear()
        self._look()
        self._digest()

    def _digest(self) -> None:
        """Put the true state into the digests."""
        vehicle = self.plant.vehicle
        state = vehicle.fleet[vehicle.index : vehicle.index + 1]
        self._hash.update(state["physics"].tobytes() + state["actuators"].tobytes())
        second = self.time_us // 1_000_000
        del self.digests[second:]
        self.digests += (second + 1 - len(self.digests)) * [self._hash.hexdigest()]

    def _await(self) -> None:
        """Until the autopilot asks for a step."""
        if self.host.listen():
            return
        until = time.monotonic() + self.patience
        while not self.host.listen():
            self._check()
            self._hear()
            if time.monotonic() >= until:
                raise LinkLostError(
                    f"connection {self.name} is lost: the autopilot has not asked the physics for {self.patience:g} s"
                )

    def _check(self) -> None:
        if self.process is not None:
            try:
                self.process.check()
            except AutopilotEndedError as error:
                raise LinkLostError(str(error)) from None

    def _hear(self) -> None:
        if self.stream is None:
            return
        try:
            data = self.stream.receive()
        except LinkLostError:
            self._check()  # its exit code and last output say more
            if self.process is None:
                raise
            self._connect()  # it reboots, and opens its port anew
            return
        if data:
            self.inbox.feed(data)
            self.tap(data)

    def _look(self) -> None:
        """Take over the scan and the touches that are new."""
        if not isinstance(self.inbox, StepTelemetry):
            return
        scans, hits = int(self._sensors.lidar_count), int(self._obstacles.hit_count)
        if scans != self._scans:
            self.inbox.scan[: len(self.inbox.angles)] = self._sensors.lidar_ranges[: len(self.inbox.angles)]
            self.inbox.scans += 1
        self.inbox.hits += max(hits - self._hits, 0)
        self._scans, self._hits = scans, hits

    def listen(self, us: int) -> None:
        """Go on until so much time has gone by, its own and wall time [us]."""
        end, goal = time.monotonic() + 1e-6 * us, self.time_us + us
        while self.time_us < goal or time.monotonic() < end:
            self.run(_SLICE_US)

    def wait_answer(self, done: Callable[[], bool]) -> bool:
        began = time.monotonic()
        for number in range(1, _ANSWER_US // _SLICE_US + 1):
            self.run(_SLICE_US)
            if done():
                return True
            ahead = 1e-6 * (number * _SLICE_US - _PROMPT_US) - (time.monotonic() - began)
            if self._port is not None and ahead > 0.0:
                time.sleep(ahead)
        return False

    def close(self) -> None:
        if self.stream is not None:
            self.stream.close()
        if self.process is not None:
            self.process.stop()
        self.host.close()
        self.plant.close()


def physics_port(connection: str) -> int:
    """UDP port at which an ArduPilot that runs already looks for its physics: 9002, and 10 more for each instance, as
    the TCP port of its MAVLink is 5760 and 10 more."""
    kind, _, rest = connection.partition(":")
    port = rest.rpartition(":")[2]
    if kind != "tcp" or not port.isdigit() or int(port) < BASE_TCP_PORT:
        return PORT
    instance, other = divmod(int(port) - BASE_TCP_PORT, 10)
    return PORT if other else PORT + 10 * instance


def launch(
    choice: Choice, plant: LocalPlant, params: Mapping[str, float] | Sequence[str], inbox: Inbox, patience: float
) -> Foreign:
    """A foreign autopilot on a plant, which is its from now on: started, or found where it runs.

    Args:
        choice: the autopilot.
        plant: at power-on.
        params: of the autopilot, under its own names; or lines of Betaflight's command line. The on-board log of an
            ArduPilot is off, unless they say something of it (``ardupilot.unlogged``).
        inbox: see ``Foreign``.
        patience: wall time without a sign of life after which it is lost [s].

    Raises:
        OptionError, LinkLostError: it cannot be started; it does not answer.
    """
    with contextlib.ExitStack() as undo:
        undo.callback(plant.close)
        if choice.kind == BETAFLIGHT:
            assert choice.program is not None
            lines = configuration.given(params)[0] if isinstance(params, Mapping) else params
            pilot = BetaflightHost(plant, starter(choice.program, plant, lines))
            undo.pop_all()
            return Foreign(pilot, plant, choice.name, pilot.program.process, inbox, patience, pilot.face)
        assert isinstance(params, Mapping)
        if choice.kind == PX4:
            instance = px4.free_instance()
            host: Host = HilHost(plant, (HOST, BASE_PORT + instance))
            where = f"udp:{HOST}:{px4.programs_port(instance)}"
        elif choice.program is None:
            where = choice.connection or ""
            host = JsonHost(plant, (HOST, physics_port(where)))
        else:
            json_host, base = JsonHost(plant, (HOST, 0)), free_tcp_run(ardupilot.SERIAL_PORTS)
            host, where = json_host, f"tcp:{HOST}:{base}"
        undo.callback(host.close)
        airframe, process = plant.vehicle.airframe, None
        if choice.kind == PX4:
            if choice.program is None:
                raise OptionError(f"autopilot {choice.name}: a PX4 that runs already cannot be reset; name its program")
            params = choice.for_autopilot(params)
            process = px4.start(choice.program, airframe, plant.home, instance, params=params)
        elif choice.program is not None:
            process = ardupilot.start(
                choice.program, airframe, plant.home, json_host.address[1], base,
                overrides=text_of(ardupilot.unlogged(params)),
            )  # fmt: skip
        undo.pop_all()
    found = Foreign(host, plant, where, process, inbox, patience)
    if choice.kind == PX4 and process is not None and (unknown := px4.unknown_names(process, params)):
        found.close()
        raise OptionError(f"params: autopilot {choice.name} has no {', '.join(unknown)}")
    if choice.kind == ARDUPILOT and process is not None:
        found.repeats = ardupilot.unlogged(params)[ardupilot.LOG] == 0.0
    return found
