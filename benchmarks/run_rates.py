# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.run_rates``: ``sitl run --speedup max`` with a client over TCP, beside the core alone.

The client asks for all streams at 4 Hz and then only reads; a copter hovers at 10 m, a rover stands armed. A rate is
simulated time by CPU time of the process that serves, where one process can see that of another (Linux), else by wall
time; that of the core alone is measured in this process.

With ``--ardupilot`` the same client reads an ArduPilot that the user has built (SITL: ``arducopter``, ``ardurover``),
as fast as it goes, with its ``.bin``. It simulates its own physics and sensors, so these are two simulators.
"""

from __future__ import annotations

import argparse
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.bridge.frame import Splitter
from sitl.core.mavlink import ARM_FORCED
from sitl.vehicle.core_entry import load_core
from sitl.vehicle.kinds import KINDS

from .__main__ import begin, kernel, repeat

GUIDED = {"copter": 4, "rover": 15}
STAYS_ARMED = {"copter": "DISARM_DELAY 0\n", "rover": ""}
MODEL = {"copter": "quad", "rover": "rover"}
"""Of ArduPilot's physics."""
HEIGHT = 10.0
"""Of the copter [m]."""


def clock_of(process: subprocess.Popen[str]) -> Callable[[], float]:
    """CPU time of a process [s]; wall time where that cannot be had."""
    number = ~process.pid << 3 | 2  # what clock_getcpuclockid gives on Linux
    if sys.platform != "linux":
        return time.monotonic
    return lambda: time.clock_gettime(number)


def connect(port: int) -> socket.socket:
    """A connection to a server that may still be starting.

    Raises:
        ConnectionError: it does not start.
    """
    for _ in range(200):
        try:
            return socket.create_connection(("127.0.0.1", port), timeout=120.0)
        except ConnectionRefusedError:
            time.sleep(0.1)
    raise ConnectionError(f"nothing listens at TCP port {port}")


class Client:
    """Reads telemetry; knows the vehicle's time by SYSTEM_TIME."""

    def __init__(self, port: int) -> None:
        self.socket = connect(port)
        self.writer = mavlink.MAVLink(None, 255, 190)
        self.splitter = Splitter()
        self.telemetry: dict[str, object] = {}

    def send(self, *messages: mavlink.MAVLink_message) -> None:
        """In one piece: at full speed seconds go by between two."""
        self.socket.sendall(b"".join(message.pack(self.writer) for message in messages))

    def command(self, number: int, *values: float) -> mavlink.MAVLink_message:
        """COMMAND_LONG"""
        return mavlink.MAVLink_command_long_message(1, 1, number, 0, *values, *(7 - len(values)) * [0])

    def fly(self, vehicle: str) -> None:
        """Arm in GUIDED, and a copter takes off: asked for anew with every HEARTBEAT until it is so."""
        asks = (
            self.command(176, 1, GUIDED[vehicle]),
            self.command(400, 1, ARM_FORCED),
            self.command(22, *6 * [0], HEIGHT),
        )

        def is_armed(m: object) -> bool:
            if m.base_mode & 128:  # type: ignore[attr-defined]
                return True
            self.send(*asks)
            return False

        self.wait_for("HEARTBEAT", is_armed)

    def wait_for(self, name: str, is_so: Callable[[object], bool]) -> None:
        """Read until a message says so.

        Raises:
            ConnectionError: the vehicle has gone.
        """
        while True:
            data = self.socket.recv(1 << 16)
            if not data:
                raise ConnectionError("the vehicle has closed the connection")
            for frame in self.splitter.feed(data):
                if frame.kind.name == name and is_so(frame.kind.decode(frame.payload)):
                    return

    def read_for(self, seconds: float, clock: Callable[[], float]) -> float:
        """Read for so much simulated time; simulated time by the clock."""
        passed = [0.0, 0.0]

        def note(place: int) -> Callable[[object], bool]:
            def at(m: object) -> bool:
                passed[place] = m.time_boot_ms * 1e-3  # type: ignore[attr-defined]
                return place == 0 or passed[1] >= passed[0] + seconds

            return at

        self.wait_for("SYSTEM_TIME", note(0))
        start = clock()
        self.wait_for("SYSTEM_TIME", note(1))
        return (passed[1] - passed[0]) / (clock() - start)


def rates(process: subprocess.Popen[str], port: int, vehicle: str, seconds: float, repeats: int) -> list[float]:
    """Rates of a process that serves a vehicle at a TCP port, which is ended then."""
    try:
        client = Client(port)
        client.send(mavlink.MAVLink_request_data_stream_message(1, 1, 0, 4, 1))
        client.wait_for("SYSTEM_TIME", lambda m: m.time_boot_ms > 45_000)  # type: ignore[attr-defined]
        client.fly(vehicle)
        return sorted(client.read_for(seconds, clock_of(process)) for _ in range(repeats))
    finally:
        process.send_signal(signal.SIGINT)


def ours(vehicle: str, backend: str, seconds: float, repeats: int) -> list[float]:
    """Rates of ``sitl run``; ``backend``: "1" when a ``.bin`` is written, too, else "0" (LOG_BACKEND_TYPE)."""
    with tempfile.TemporaryDirectory() as folder:
        parameters = Path(folder) / "vehicle.parm"
        parameters.write_text(f"LOG_BACKEND_TYPE {backend}\n{STAYS_ARMED[vehicle]}")
        command = [sys.executable, "-m", "sitl", "run", vehicle, "--speedup", "max", "--tcp", "0", "--out", "none"]
        command += ["--quiet", "--log-dir", folder, "--params", str(parameters)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
            assert process.stdout is not None
            port = next(int(line.rsplit(":", 1)[1]) for line in process.stdout if "tcp" in line)
            return rates(process, port, vehicle, seconds, repeats)


def ardupilots(program: Path, vehicle: str, seconds: float, repeats: int) -> list[float]:
    """Rates of an ArduPilot's executable, as fast as it goes."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with tempfile.TemporaryDirectory() as folder:
        parameters = Path(folder) / "vehicle.parm"
        parameters.write_text(f"FRAME_CLASS 1\n{STAYS_ARMED[vehicle]}")
        command = [str(program), "--model", MODEL[vehicle], "--speedup", "1000", "--wipe", "--base-port", str(port)]
        command += ["--defaults", str(parameters)]
        nothing = subprocess.DEVNULL
        with subprocess.Popen(command, cwd=folder, stdin=nothing, stdout=nothing, stderr=nothing, text=True) as process:
            return rates(process, port, vehicle, seconds, repeats)


def find(given: Path | None, vehicle: str) -> Path | None:
    """ArduPilot's executable of a vehicle in what the user gave; None: there is none."""
    if given is None:
        return None
    program = given / f"ardu{vehicle}" if given.is_dir() else given
    return program.resolve() if program.is_file() and program.name == f"ardu{vehicle}" else None


def show(name: str, found: list[float], alone: float) -> None:
    """Print a line."""
    median, spread = statistics.median(found), f"({found[0]:.0f} .. {found[-1]:.0f})"
    print(f"  {name:31s} {median:6.0f}x   {median / alone:.2f} of the core alone   {spread}", flush=True)


def main() -> None:
    """Print the rates of each vehicle."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.run_rates")
    parser.add_argument("--vehicle", choices=tuple(GUIDED), help="default: both")
    parser.add_argument("--seconds", type=float, default=200.0, help="simulated time of each repeat (default 200)")
    parser.add_argument("--repeats", type=int, default=3, metavar="N", help="of which the median counts (default 3)")
    help_text = "executable arducopter or ardurover, or a folder with them: measured in the same run"
    parser.add_argument("--ardupilot", type=Path, metavar="PATH", help=help_text)
    options = parser.parse_args()
    vehicles = (options.vehicle,) if options.vehicle else tuple(GUIDED)
    programs = {vehicle: find(options.ardupilot, vehicle) for vehicle in vehicles}
    if options.ardupilot is not None and not any(programs.values()):
        names = " nor ".join(f"ardu{vehicle}" for vehicle in vehicles)
        parser.error(f"--ardupilot {options.ardupilot}: it is neither {names} nor a folder with them")
    for vehicle, program in programs.items():
        core = load_core(KINDS[vehicle])
        alone = statistics.median(repeat(kernel(begin(KINDS[vehicle].default_frame, core), core), options.repeats))
        print(f"{vehicle}: core alone {alone:.0f}x", flush=True)
        for name, bits in (("with .tlog", "0"), ("with .tlog and .bin", "1")):
            show(f"sitl run, {name}", ours(vehicle, bits, options.seconds, options.repeats), alone)
        if program is not None:
            show("ArduPilot, with .bin", ardupilots(program, vehicle, options.seconds, options.repeats), alone)


if __name__ == "__main__":
    main()
