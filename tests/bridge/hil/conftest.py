# SPDX-License-Identifier: BSD-3-Clause
"""The other end of a HIL link: physics in processes and threads, a pilot that is watched, a wire that is cut."""

from __future__ import annotations

import contextlib
import os
import select
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from benchmarks.recorded.pilot import Pilot
from sitl.bridge.dialect import message
from sitl.physics.native.power_on import DEFAULT_HOME
from sitl.plants.local import stand_alone
from sitl.plants.physics_server import PhysicsServer
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


OF_OTHER_SENSORS = {message(n).id for n in ("SCALED_IMU2", "SCALED_IMU3", "SCALED_PRESSURE2", "ESC_TELEMETRY_1_TO_4")}
"""Messages of sensors that physics at a connection does not have."""


class ReceivedFrames:
    """A tap: every frame with its simulated time, in and out, without sequence number and check sum; those of
    ``OF_OTHER_SENSORS`` are left out."""

    def __init__(self, simulation: Simulation) -> None:
        self.frames: list[tuple[int, bytes]] = []
        simulation.bridge.taps.append(self)

    def frame(self, time_us: int, raw: bytes) -> None:
        if raw[0] != 0xFD or int.from_bytes(raw[7:10], "little") not in OF_OTHER_SENSORS:
            self.frames.append((time_us, raw[:4] + b"\0" + raw[5:-2]))

    def names(self) -> set[int]:
        """Numbers of the messages."""
        return {int.from_bytes(raw[7:10], "little") for _, raw in self.frames if raw[0] == 0xFD}


class WatchedPilot(Pilot):
    """A pilot who asks for all streams and writes down every byte."""

    def __init__(self, simulation: Simulation, rate: int = 4) -> None:
        self.received = ReceivedFrames(simulation)
        super().__init__(simulation)
        for number in (1, 2, 3, 6, 10, 11, 12):  # stream groups of REQUEST_DATA_STREAM
            self.send("REQUEST_DATA_STREAM", req_stream_id=number, req_message_rate=rate, start_stop=1)
        for name in ("SIMSTATE", "HIGHRES_IMU", "BATTERY_STATUS", "WHEEL_DISTANCE"):
            self.set_rate(name, 10.0)


class CutWire:
    """Listens, connects each caller to ``target`` and cuts the connection after the next number of bytes.

    Args:
        target: (host, port).
        lengths: bytes that connections live for, both directions counted; then they live on.
    """

    def __init__(self, target: tuple[str, int], lengths: Iterator[int]) -> None:
        self._target, self._lengths = target, lengths
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = self._listener.getsockname()[1]
        self.cuts = 0
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        with contextlib.suppress(OSError):
            while True:
                caller = self._listener.accept()[0]
                with caller, socket.create_connection(self._target) as callee:
                    for end in (caller, callee):
                        end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                    self._pass_on(caller, callee, next(self._lengths, 1 << 62))

    def _pass_on(self, caller: socket.socket, callee: socket.socket, left: int) -> None:
        other = {caller: callee, callee: caller}
        while True:
            for end in select.select([caller, callee], [], [], 5.0)[0]:
                data = end.recv(1 << 16)
                if not data:
                    return
                other[end].sendall(data[:left])  # perhaps in the middle of a message
                left -= len(data)
                if left <= 0:
                    self.cuts += 1
                    return

    def close(self) -> None:
        """Take no more callers."""
        self._listener.close()


Start = Callable[..., PhysicsProcess]
Beside = Callable[..., PhysicsServer]


@pytest.fixture
def physics() -> Iterator[Start]:
    """Starts ``sitl physics VEHICLE OPTIONS...``; all are ended after the test."""
    started: list[PhysicsProcess] = []

    def start(*options: str) -> PhysicsProcess:
        started.append(PhysicsProcess(*options))
        return started[-1]

    yield start
    for process in started:
        process.kill()


@pytest.fixture
def beside() -> Iterator[Beside]:
    """Starts a server in a thread of this process; what it says is in ``server.said``."""
    stopped = threading.Event()
    threads: list[threading.Thread] = []
    servers: list[PhysicsServer] = []

    def start(frame: str = "erle_copter", port: int = 0, **options: object) -> PhysicsServer:
        plant = stand_alone(frame, home=DEFAULT_HOME, **options)  # type: ignore[arg-type]
        said: list[str] = []
        server = PhysicsServer(plant, "127.0.0.1", port, said.append)
        server.said = said  # type: ignore[attr-defined]
        thread = threading.Thread(target=server.serve, args=(lambda: not stopped.is_set(),), daemon=True)
        thread.start()
        threads.append(thread)
        servers.append(server)
        return server

    yield start
    stopped.set()
    for thread in threads:
        thread.join(10.0)
    for server in servers:
        server.close()
