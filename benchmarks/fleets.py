# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.fleets``: vehicles in one process, alone and by the thousand.

Each copter and rover gets a velocity set-point by MAVLink and sends position and attitude ten times a simulated second;
each Turtlebot gets its speeds directly and scans 36 beams in circuit2 after 0.6 s. Wall time, because threads share the
work; the repeats of all sizes take turns, and each value is a median.
"""

from __future__ import annotations

import argparse
import os
import resource
import statistics
import time
from collections.abc import Callable

import gymnasium as gym

from benchmarks.recorded.pilot import VELOCITY_ONLY
from sitl.bridge.dialect import message
from sitl.bridge.frame import encode_v2
from sitl.client import Client
from sitl.fleet import Fleet
from sitl.simulation import Simulation, Snapshot, load_core
from sitl.turtlebots.native import Turtlebots
from sitl.vehicle.kinds import KINDS

FRAMES = {"copter": "erle_copter", "rover": "erle_rover"}
SIZES = (1, 16, 256, 1024, 4096)
STEP_S = 0.1
TURTLEBOT_STEP_S = 0.6


def under_way(kind: str) -> Snapshot:
    """In GUIDED and armed, a copter in the air, with two messages at 10 Hz."""
    simulation = Simulation(FRAMES[kind], core=load_core(KINDS[kind]))
    client = Client(simulation)
    client.wait_ready()
    if KINDS[kind].flies:
        client.take_off(10.0)
    else:
        client.set_mode("GUIDED")
        client.arm()
    client.send("REQUEST_DATA_STREAM", target_system=1, target_component=1)
    for name in ("LOCAL_POSITION_NED", "ATTITUDE"):
        client.set_rate(name, 10)
    simulation.advance(0.05)
    return simulation.snapshot()


def flying(kind: str, start: Snapshot, count: int, threads: int) -> Callable[[], float]:
    """A run of some steps of a fleet; gives steps a second of all vehicles."""
    fleet = Fleet(FRAMES[kind], count, threads=threads, core=load_core(KINDS[kind]))
    fleet.put(range(count), start)
    layout = message("SET_POSITION_TARGET_LOCAL_NED")
    steps = max(2048 // count, 2)

    def run() -> float:
        begun = time.perf_counter()
        for k in range(steps):
            speed = 0.5 if k % 2 else -0.5
            payload = layout.payload(target_system=1, coordinate_frame=1, type_mask=VELOCITY_ONLY, vx=speed)
            frame = encode_v2(layout, payload, k & 0xFF, 255, 190)
            for index in range(count):
                fleet.send(index, frame)
            fleet.advance(STEP_S)
            fleet.drop_telemetry()
        return steps * count / (time.perf_counter() - begun)

    run()
    return run


def driving(count: int) -> Callable[[], float]:
    """The same with Turtlebots."""
    robots = Turtlebots("circuit2", count)
    robots.commands[:] = 0.05, 0.3  # circles on the spot, free of walls
    steps = max(8192 // count, 2)

    def run() -> float:
        begun = time.perf_counter()
        for _ in range(steps):
            robots.advance(TURTLEBOT_STEP_S)
        return steps * count / (time.perf_counter() - begun)

    run()
    return run


def cartpole() -> float:
    """Steps a second of CartPole-v1, without wrappers."""
    env = gym.make("CartPole-v1").unwrapped
    env.reset(seed=0)
    begun = time.perf_counter()
    for k in range(5000):
        if env.step(k % 2)[2]:
            env.reset()
    return 5000 / (time.perf_counter() - begun)


def costs(kind: str, start: Snapshot, count: int) -> None:
    """Memory of a vehicle, time until they are ready, time of a reset."""
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    begun = time.perf_counter()
    fleet = Fleet(FRAMES[kind], count, core=load_core(KINDS[kind]))
    fleet.put(range(count), start)
    ready = time.perf_counter() - begun
    fleet.advance(STEP_S)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    begun = time.perf_counter()
    for index in range(200):
        fleet.put(index % count, start, seed=index)
    reset = (time.perf_counter() - begun) / 200
    arrays = (fleet.records.itemsize + fleet.ports.itemsize) / 1000
    print(
        f"{kind}: record and port of a vehicle {arrays:6.1f} kB, the process grew by {memory / count:6.1f} kB a vehicle"
    )
    print(f"{kind}: {count} vehicles ready after {ready * 1e3:6.0f} ms, a reset with a seed {reset * 1e6:6.0f} us")


def main() -> None:
    """Print every value."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.fleets")
    parser.add_argument("--repeats", type=int, default=5, metavar="N", help="runs of each, of which the median counts")
    parser.add_argument("--largest", type=int, default=4096, metavar="N", help="vehicles of the largest fleet")
    options = parser.parse_args()
    if options.repeats < 1 or options.largest < 1:
        parser.error("--repeats and --largest must be 1 or more")
    every = os.cpu_count() or 1
    starts = {kind: under_way(kind) for kind in FRAMES}
    for kind, start in starts.items():  # before other arrays are there
        costs(kind, start, min(1024, options.largest))
    rows: dict[str, tuple[Callable[[], float], float]] = {"CartPole-v1": (cartpole, 0.02)}
    for kind, start in starts.items():
        for size in (s for s in SIZES if s <= options.largest):
            for threads in sorted({1, every if size >= 256 else 1}):
                rows[f"{kind}, {size} vehicles, {threads} thread(s)"] = (flying(kind, start, size, threads), STEP_S)
    for size in (s for s in SIZES if s <= options.largest):
        rows[f"turtlebot, {size} vehicles, 1 thread(s)"] = (driving(size), TURTLEBOT_STEP_S)
    found: dict[str, list[float]] = {name: [] for name in rows}
    for _ in range(options.repeats):
        for name, (run, _) in rows.items():
            found[name].append(run())
    base = statistics.median(found["CartPole-v1"])
    title = f"wall time, median of {options.repeats}"
    print(f"{title:36s} {'steps/s':>10s} {'x real time':>12s} CartPole = 1   steps/s, all")
    for name, values in found.items():
        median = statistics.median(values)
        factor, ratio = median * rows[name][1], median / base
        print(f"{name:36s} {median:10,.0f} {factor:11,.0f}x {ratio:12.2f}   {min(values):,.0f} .. {max(values):,.0f}")


if __name__ == "__main__":
    main()
