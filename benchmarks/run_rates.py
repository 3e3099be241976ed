# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.run_rates``: ``sitl run --speedup max`` with a client over TCP, beside the core alone.

The client asks for all streams at 4 Hz and then only reads; a copter hovers at 10 m, a rover stands armed. A rate is
simulated time by CPU time of the process that serves, where one process can see that of another (Linux), else by wall
time; that of the core alone is measured in this process.
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
from sitl.vehicle.core_entry import load_core
from sitl.vehicle.kinds import KINDS

from .__main__ import begin, kernel, repeat

GUIDED = {"copter": 4, "rover": 15}
HEIGHT = 10.0
"""Of the copter [m]."""


def clock_of(process: subprocess.Popen[str]) -> Callable[[], float]:
    """CPU time of a process [s]; wall time where that cannot be had."""
    number = ~process.pid << 3 | 2  # what clock_getcpuclockid gives on Linux
    if sys.platform != "linux":
        return time.monotonic
    return lambda: time.clock_gettime(number)


class Client:
    """Reads telemetry; knows the vehicle's time by SYSTEM_TIME."""

    def __init__(self, port: int) -> None:
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=120.0)
        self.writer = mavlink.MAVLink(None, 255, 190)
        self.splitter = Splitter()
        self.telemetry: dict[str, object] = {}

    def send(self, *messages: mavlink.MAVLink_message) -> None:
        """In one piece: at full speed seconds go by between two."""
        self.socket.sendall(b"".join(message.pack(self.writer) for message in messages))

    def command(self, number: int, *values: float) -> mavlink.MAVLink_message:
        """COMMAND_LONG"""
        return mavlink.MAVLink_command_long_message(1, 1, number, 0, *values, *(7 - len(values)) * [0])

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


def rates(vehicle: str, backend: str, seconds: float, repeats: int) -> list[float]:
    """Rates of ``sitl run``; ``backend``: "1" when a ``.bin`` is written, too, else "0" (LOG_BACKEND_TYPE)."""
    with tempfile.TemporaryDirectory() as folder:
        parameters = Path(folder) / "vehicle.parm"
        stays_armed = "DISARM_DELAY 0\n" if vehicle == "copter" else ""
        parameters.write_text(f"LOG_BACKEND_TYPE {backend}\n{stays_armed}")
        command = [sys.executable, "-m", "sitl", "run", vehicle, "--speedup", "max", "--tcp", "0", "--out", "none"]
        command += ["--quiet", "--log-dir", folder, "--params", str(parameters)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
            assert process.stdout is not None
            try:
                port = next(int(line.rsplit(":", 1)[1]) for line in process.stdout if "tcp" in line)
                client = Client(port)
                client.send(mavlink.MAVLink_request_data_stream_message(1, 1, 0, 4, 1))
                client.wait_for("SYSTEM_TIME", lambda m: m.time_boot_ms > 45_000)  # type: ignore[attr-defined]
                client.send(
                    client.command(176, 1, GUIDED[vehicle]),
                    client.command(400, 1),
                    client.command(22, *6 * [0], HEIGHT),
                )
                client.wait_for("HEARTBEAT", lambda m: m.base_mode & 128)  # type: ignore[attr-defined]
                return sorted(client.read_for(seconds, clock_of(process)) for _ in range(repeats))
            finally:
                process.send_signal(signal.SIGINT)


def main() -> None:
    """Print the rates of each vehicle."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.run_rates")
    parser.add_argument("--vehicle", choices=tuple(GUIDED), help="default: both")
    parser.add_argument("--seconds", type=float, default=200.0, help="simulated time of each repeat (default 200)")
    parser.add_argument("--repeats", type=int, default=3, metavar="N", help="of which the median counts (default 3)")
    options = parser.parse_args()
    for vehicle in (options.vehicle,) if options.vehicle else tuple(GUIDED):
        core = load_core(KINDS[vehicle])
        alone = statistics.median(repeat(kernel(begin(KINDS[vehicle].default_frame, core), core), options.repeats))
        print(f"{vehicle}: core alone {alone:.0f}x", flush=True)
        for name, bits in (("with .tlog", "0"), ("with .tlog and .bin", "1")):
            found = rates(vehicle, bits, options.seconds, options.repeats)
            median = statistics.median(found)
            spread = f"({found[0]:.0f} .. {found[-1]:.0f})"
            print(
                f"  sitl run, {name:20s} {median:6.0f}x   {median / alone:.2f} of the core alone   {spread}", flush=True
            )


if __name__ == "__main__":
    main()
