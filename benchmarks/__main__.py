# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks``: real-time factors on one core, medians of several repeats, with the spread."""

from __future__ import annotations

import argparse
import math
import os
import statistics
import subprocess
import sys
import tempfile
import time
import timeit
from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks.recorded.pilot import VELOCITY_ONLY, Pilot
from sitl import vehicles
from sitl.bridge.dialect import message
from sitl.core.mavlink import MavFrame
from sitl.envs.mavlink.compiled import VELOCITY, ClientEnd, read_all, send_all
from sitl.fleet import Fleet
from sitl.simulation import Core, Simulation, load_core
from sitl.vehicle.kinds import KINDS

Array = np.ndarray[Any, Any]

SPEED = 1.0
"""Of the set-points [m/s]: every rover reaches it."""


def begin(frame: str, core: Core, estimator: str = "ekf") -> Pilot:
    """A copter hovers at 10 m, a rover drives north at a velocity; both have settled."""
    pilot = Pilot(Simulation(frame, core=core, estimator=estimator))
    pilot.boot()
    pilot.arm()
    if core.kind.name == "copter":
        pilot.send_command("NAV_TAKEOFF", altitude=10.0)
        pilot.fly(20.0)
    else:
        pilot.stream_setpoint(20.0, VELOCITY_ONLY, (SPEED, 0.0, 0.0))
    return pilot


def go_on(core: Core, vehicles: Array) -> None:
    """Where no client repeats it, the rovers' velocity has just come again: without, they stop after 3 s."""
    if core.kind.name == "rover":
        vehicles["autopilot"]["modes"]["guided"]["update_us"] = vehicles["time_us"]


FLEET = 256
"""Vehicles."""


def repeat(run: Callable[[], float], repeats: int) -> list[float]:
    """Real-time factors: simulated seconds that ``run`` passes, per second of this process's CPU time."""
    factors = []
    for _ in range(repeats):
        start = time.process_time()
        simulated = run()
        factors.append(simulated / (time.process_time() - start))
    return sorted(factors)


def show(name: str, factors: list[float]) -> float:
    """Print a row; returns the median."""
    median = statistics.median(factors)
    print(f"{name:58s} {median:9.0f}x   ({factors[0]:.0f} .. {factors[-1]:.0f})", flush=True)
    return median


def kernel(pilot: Pilot, core: Core) -> Callable[[], float]:
    """The compiled core alone, 10 simulated seconds a call."""
    simulation = pilot.simulation
    advance = core.bind(simulation.fleet, simulation.index)

    def run() -> float:
        start = simulation.time_us
        for _ in range(5):
            go_on(core, simulation.fleet)
            advance(800)
        return (simulation.time_us - start) * 1e-6

    return run


def fleet(pilot: Pilot, core: Core, size: int) -> Callable[[], float]:
    """Copies of the vehicle in one array, a tenth of a second each in turn; the simulated seconds of all."""
    vehicles = np.repeat(pilot.simulation.fleet, size)

    def run() -> float:
        start = vehicles["time_us"].sum()
        for _ in range(5):
            go_on(core, vehicles)
            for index in range(size):
                core(vehicles, index, 40)
        return float(vehicles["time_us"].sum() - start) * 1e-6

    return run


def streaming(pilot: Pilot, rate_hz: int, messages: tuple[str, ...]) -> Callable[[], float]:
    """A client that sends a velocity set-point and reads telemetry as MAVLink bytes at ``rate_hz``, in lockstep."""
    simulation, client = pilot.simulation, pilot.connection.endpoint
    client.send("REQUEST_DATA_STREAM", target_system=1, target_component=1)  # stops all streams, a rover's own too
    simulation.bridge.is_stepped = True  # a message a loop is allowed
    for name in messages:
        client.set_interval(name, rate_hz)
    kind = message("SET_POSITION_TARGET_LOCAL_NED")
    place, others = (0.0, 0.0, 0.0), (0.0,) * 7
    period_us = 1_000_000 // rate_hz
    steps = 20 * rate_hz
    got = 0

    def run() -> float:
        nonlocal got
        for k in range(steps):
            velocity = SPEED if k % (4 * rate_hz) < 2 * rate_hz else -SPEED
            client.send_payload(kind, kind.pack(0, *place, velocity, *others, VELOCITY_ONLY, 1, 1, MavFrame.LOCAL_NED))
            simulation.advance_to(simulation.time_us + period_us)
            got += len(client.receive())
        return steps / rate_hz

    run()
    assert got >= steps * len(messages), f"only {got} messages for {steps} steps"
    return run


def streaming_compiled(pilot: Pilot, rate_hz: int, messages: tuple[str, ...]) -> Callable[[], float]:
    """The same in a fleet of one, with the environments' end of MAVLink, which is compiled: packs and reads records.
    The client looks at the numbers in arrays, as environments do."""
    simulation, client = pilot.simulation, pilot.connection.endpoint
    client.send("REQUEST_DATA_STREAM", target_system=1, target_component=1)
    simulation.bridge.is_stepped = True  # a message a loop is allowed
    for name in messages:
        client.set_interval(name, rate_hz)
    simulation.advance_to(simulation.time_us)
    fleet = Fleet(simulation.scenario, core=simulation.core)
    fleet.put(0, simulation.snapshot())
    ends: Any = ClientEnd.fleet(1)
    end, row, commands, no_scan = ClientEnd.of(ends, 0), np.arange(1), np.zeros((1, 4)), np.zeros((1, 0), np.float32)
    end.system, ports = 1, fleet.ports.ctypes.data
    send, read = send_all.bind(ends, np.zeros((1, 3)), ports), read_all.bind(ends, no_scan, no_scan, ports)
    period_us, steps = 1_000_000 // rate_hz, 20 * rate_hz
    northward, yaw = ends["velocity"][:, 0], ends["euler"][:, 2]

    def run() -> float:
        north = 0.0
        for k in range(steps):
            commands[0, 0] = SPEED if k % (4 * rate_hz) < 2 * rate_hz else -SPEED
            send(row, VELOCITY, commands)
            fleet.advance_us(period_us)
            read(row)
            north += northward.item() * math.cos(yaw.item())  # they are there to be used
        assert end.position_ms == end.attitude_ms >= fleet.clocks[0][0] // 1000 - 1, "telemetry is missing"
        return steps / rate_hz

    return run


def snapshots(pilot: Pilot, repeats: int) -> None:
    """Microseconds for a snapshot and for a restore of vehicle, mission and MAVLink state."""
    simulation = pilot.simulation
    kept = simulation.snapshot()
    for name, run in (("snapshot", simulation.snapshot), ("restore", lambda: simulation.restore(kept))):
        times = timeit.repeat(run, number=2000, repeat=repeats, timer=time.process_time)
        print(f"{name:58s} {statistics.median(times) / 2000 * 1e6:9.1f} us", flush=True)


def compile_times(kind: str) -> None:
    """The whole core from nothing, and a warm start, in a cache folder of their own."""
    code = f"from sitl.vehicle import core_entry, kinds; core_entry.load_core(kinds.KINDS[{kind!r}])"
    with tempfile.TemporaryDirectory() as folder:
        env = {**os.environ, "SITL_CACHE_DIR": folder}
        for name in ("compile the whole core", "warm start to a loaded core"):
            start = time.perf_counter()
            subprocess.run([sys.executable, "-c", code], env=env, check=True)
            print(f"{name:58s} {time.perf_counter() - start:9.1f} s", flush=True)


def measure(frame: str, repeats: int, compilation: bool) -> None:
    """Print every value of one airframe."""
    kind = KINDS[vehicles.load(frame).kind]
    core = load_core(kind)
    pilot = begin(frame, core)
    alone = show(f"{frame}, EKF and all loops: compiled core alone", repeat(kernel(pilot, core), repeats))
    show(f"{frame}, a fleet of {FLEET} in steps of 0.1 s: sum of all", repeat(fleet(pilot, core, FLEET), repeats))
    truth = begin(frame, core, "truth")
    show(f"{frame}, --estimator truth: compiled core alone", repeat(kernel(truth, core), repeats))
    two = ("LOCAL_POSITION_NED", "ATTITUDE")
    for rate in (10, 50):
        name = f"{frame}, MAVLink in the loop at {rate} Hz ({len(two)} messages)"
        factor = show(name, repeat(streaming(begin(frame, core), rate, two), repeats))
        print(f"{'   of the core alone':58s} {factor / alone:9.2f}")
        factor = show(
            "   read by a compiled client", repeat(streaming_compiled(begin(frame, core), rate, two), repeats)
        )
        print(f"{'   of the core alone':58s} {factor / alone:9.2f}")
    snapshots(pilot, repeats)
    if compilation:
        compile_times(kind.name)


def main() -> None:
    """Print every value of the vehicles asked for; compilation too when asked for."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--vehicle", choices=tuple(KINDS), help="the first airframe of this kind; else one of each")
    which.add_argument("--frame", choices=vehicles.names())
    parser.add_argument("--compile", action="store_true", help="also measure compilation")
    parser.add_argument("--repeats", type=int, default=7, metavar="N", help="runs of each, of which the median counts")
    options = parser.parse_args()
    if options.repeats < 1:
        parser.error(f"--repeats {options.repeats} must be 1 or more")
    print(f"one core, CPU time, median of {options.repeats} (lowest .. highest)")
    kinds = (options.vehicle,) if options.vehicle else tuple(KINDS)
    for frame in (options.frame,) if options.frame else [vehicles.names(kind)[0] for kind in kinds]:
        measure(frame, options.repeats, options.compile)


if __name__ == "__main__":
    main()
