# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.physics``: real-time factors of every engine with the full autopilot, and of the HIL link.

All on one core. The engines: CPU time of a vehicle that flies or drives. The link: two processes on the same core and
the wall clock, beside the bare round trip of as many bytes over loopback.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import socket
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator

from benchmarks.engines import FLIGHTS
from benchmarks.recorded.pilot import VELOCITY_ONLY, Pilot
from sitl.errors import MissingExtra
from sitl.physics.engine import EngineError
from sitl.physics.engines import BACKENDS
from sitl.simulation import Simulation

from .__main__ import repeat, show

SECONDS = 10.0
"""Simulated, of each repeat."""
TICK_S = 0.0025


def under_way(frame: str, physics: str) -> Pilot:
    """A vehicle that has taken off, or drives."""
    simulation = Simulation(frame, physics=physics)
    pilot = Pilot(simulation)
    pilot.boot()
    pilot.arm()
    if simulation.kind.name == "copter":
        pilot.send_command(22, 0, 0, 0, 0, 0, 0, 10.0)
        pilot.fly(10.0)
    pilot.send("REQUEST_DATA_STREAM", target_system=1, target_component=1)  # stops all streams
    for name in ("LOCAL_POSITION_NED", "ATTITUDE"):
        pilot.set_rate(name, 10.0)
    return pilot


def driven(pilot: Pilot, seconds: float = SECONDS) -> Callable[[], float]:
    """Go forth and back by a velocity set-point ten times a second, as a client would."""

    def run() -> float:
        for k in range(round(seconds * 10)):
            pilot.setpoint(VELOCITY_ONLY, velocity=(1.0 if k % 100 < 50 else -1.0, 0.0, 0.0))
            pilot.simulation.advance(0.1)
            pilot.connection.endpoint.receive()
        return seconds

    return run


def engine_alone(pilot: Pilot) -> Callable[[], float]:
    """The physics of the same vehicle without its autopilot: the actuators stay."""
    tick = pilot.simulation.plant.tick  # type: ignore[attr-defined]
    count = round(SECONDS / TICK_S)

    def run() -> float:
        for _ in range(count):
            tick()
        return SECONDS

    return run


def measure_engine(frame: str, physics: str, repeats: int) -> None:
    """Print the rows of one vehicle on one engine."""
    try:
        pilot = under_way(frame, physics)
    except (EngineError, MissingExtra) as error:
        print(f"{frame}, {physics}: {error}")
        return
    show(f"{frame}, {physics}: autopilot and MAVLink at 10 Hz", repeat(driven(pilot), repeats))
    show(f"{frame}, {physics}: physics and sensors alone, tick by tick", repeat(engine_alone(pilot), repeats))
    pilot.simulation.close()


def round_trips(size: int, back: int, seconds: float = 1.0) -> float:
    """Round trips a second over loopback TCP: ``size`` bytes there, ``back`` bytes back, the peer another process."""
    server = socket.create_server(("127.0.0.1", 0))
    code = (
        "import socket,sys\n"
        f"s=socket.create_connection(('127.0.0.1',{server.getsockname()[1]}))\n"
        "s.setsockopt(socket.IPPROTO_TCP,socket.TCP_NODELAY,1)\n"
        f"while True:\n    got=0\n    while got<{size}:\n        d=s.recv(65536)\n        if not d: sys.exit()\n"
        f"        got+=len(d)\n    s.sendall(bytes({back}))\n"
    )
    with subprocess.Popen([sys.executable, "-c", code]) as peer:
        there, _ = server.accept()
        there.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        count, start = 0, time.monotonic()
        while time.monotonic() - start < seconds:
            there.sendall(bytes(size))
            got = 0
            while got < back:
                got += len(there.recv(65536))
            count += 1
        rate = count / (time.monotonic() - start)
        there.close()
        peer.wait()
    server.close()
    return rate


@contextlib.contextmanager
def served(frame: str) -> Iterator[str]:
    """``sitl physics`` in a process of its own; its address."""
    kind = "rover" if "rover" in frame else "copter"
    command = [sys.executable, "-m", "sitl", "physics", kind, "--frame", frame, "--listen", "tcp:127.0.0.1:0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        address = next(word for line in server.stdout for word in line.split() if word.startswith("tcp:"))
        threading.Thread(target=server.stdout.read, daemon=True).start()
        try:
            yield address
        finally:
            server.terminate()


def measure_link(frame: str, repeats: int) -> None:
    """Print the rows of the HIL link: exchanges a second, the bare round trip, real-time factor."""
    with served(frame) as address:
        pilot = under_way(frame, f"hil:{address}")
        run, rates = driven(pilot), []
        for _ in range(repeats):
            start = time.monotonic()
            rates.append(run() / TICK_S / (time.monotonic() - start))
        pilot.simulation.close()
    bare = statistics.median(round_trips(140, 100) for _ in range(repeats))
    rate = statistics.median(rates)
    print(f"{frame}: HIL exchanges a second over loopback {rate:21.0f}    ({min(rates):.0f} .. {max(rates):.0f})")
    print(f"{'   bare round trips of as many bytes':58s} {bare:9.0f}    exchanges are {rate / bare:.2f} of them")
    print(f"{'   real-time factor with the full autopilot':58s} {rate * TICK_S:9.0f}x")


def main() -> None:
    """Print every value."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.physics")
    parser.add_argument("--frame", choices=sorted(FLIGHTS), help="else all of these")
    parser.add_argument("--physics", choices=(*BACKENDS, "hil"), help="else all of these")
    parser.add_argument("--repeats", type=int, default=5, metavar="N", help="of which the median counts")
    options = parser.parse_args()
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})  # children too
    print(f"one core, median of {options.repeats} (lowest .. highest)")
    for frame in [options.frame] if options.frame else sorted(FLIGHTS):
        for physics in [options.physics] if options.physics else [*BACKENDS, "hil"]:
            if physics == "hil":
                measure_link(frame, options.repeats)
            else:
                measure_engine(frame, physics, options.repeats)


if __name__ == "__main__":
    main()
