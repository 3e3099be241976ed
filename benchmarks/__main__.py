# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks``: real-time factors on one core, medians of several repeats, with the spread."""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
import timeit
from collections.abc import Callable

import numpy as np

from missions.pilot import VELOCITY_ONLY, Pilot
from sitl import vehicles
from sitl.bridge.dialect import message
from sitl.core import compile as compiler
from sitl.simulation import Core, load_core

from .hover import hovering

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

    def run() -> float:
        core(simulation.fleet, simulation.index, 4000)
        return 10.0

    return run


def fleet(pilot: Pilot, core: Core, size: int) -> Callable[[], float]:
    """Copies of the vehicle in one array, a tenth of a second each in turn; the simulated seconds of all."""
    vehicles = np.repeat(pilot.simulation.fleet, size)

    def run() -> float:
        for _ in range(5):
            for index in range(size):
                core(vehicles, index, 40)
        return 0.5 * size

    return run


def streaming(pilot: Pilot, rate_hz: int, messages: tuple[str, ...]) -> Callable[[], float]:
    """A client that sends a velocity set-point and reads telemetry as MAVLink bytes at ``rate_hz``, in lockstep."""
    simulation, client = pilot.simulation, pilot.client
    for name in ("EKF_STATUS_REPORT", "SYS_STATUS", "LOCAL_POSITION_NED", "ATTITUDE"):
        client.set_interval(name, 0.0)
    for name in messages:
        client.set_interval(name, rate_hz)
    kind = message("SET_POSITION_TARGET_LOCAL_NED")
    period_us = 1_000_000 // rate_hz
    steps = 20 * rate_hz
    got = 0

    def run() -> float:
        nonlocal got
        for k in range(steps):
            payload = kind.payload(
                target_system=1, target_component=1, coordinate_frame=1, type_mask=VELOCITY_ONLY,
                vx=1.0 if k % (4 * rate_hz) < 2 * rate_hz else -1.0,
            )  # fmt: skip
            client.send_payload(kind, payload)
            simulation.advance_to(simulation.time_us + period_us)
            got += len(client.receive())
        return steps / rate_hz

    run()
    assert got >= steps * len(messages), f"only {got} messages for {steps} steps"
    return run


def snapshots(pilot: Pilot, repeats: int) -> None:
    """Microseconds for a snapshot and for a restore of vehicle, mission and MAVLink state."""
    simulation = pilot.simulation
    kept = simulation.snapshot()
    for name, run in (("snapshot", simulation.snapshot), ("restore", lambda: simulation.restore(kept))):
        times = timeit.repeat(run, number=2000, repeat=repeats, timer=time.process_time)
        print(f"{name:58s} {statistics.median(times) / 2000 * 1e6:9.1f} us", flush=True)


def compile_times() -> None:
    """The whole core from nothing, and a warm start, in a cache folder of their own."""
    import os
    import subprocess
    import sys

    with tempfile.TemporaryDirectory() as folder:
        env = {**os.environ, "SITL_CACHE_DIR": folder}
        for name in ("compile the whole core", "warm start to a loaded core"):
            start = time.perf_counter()
            subprocess.run(
                [sys.executable, "-c", "from sitl.simulation import load_core; load_core()"], env=env, check=True
            )
            print(f"{name:58s} {time.perf_counter() - start:9.1f} s", flush=True)


def main() -> None:
    """Print every figure; compilation when asked for."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks")
    parser.add_argument("--frame", default="erle_copter", choices=vehicles.names())
    parser.add_argument("--compile", action="store_true", help="also measure compilation")
    parser.add_argument("--repeats", type=int, default=7, metavar="N", help="runs of each, of which the median counts")
    options = parser.parse_args()
    if options.repeats < 1:
        parser.error(f"--repeats {options.repeats} must be 1 or more")
    print(f"one core, CPU time, median of {options.repeats} (lowest .. highest); units: {len(compiler.UNITS)}")
    core = load_core()
    pilot = hovering(options.frame, core)
    name = f"{options.frame}, EKF and all loops: compiled core alone"
    alone = show(name, repeat(kernel(pilot, core), options.repeats))
    name = f"{options.frame}, a fleet of {FLEET} in steps of 0.1 s: sum of all"
    show(name, repeat(fleet(pilot, core, FLEET), options.repeats))
    truth = hovering(options.frame, core, "truth")
    show(f"{options.frame}, --estimator truth: compiled core alone", repeat(kernel(truth, core), options.repeats))
    two = ("LOCAL_POSITION_NED", "ATTITUDE")
    for rate, messages in ((10, two), (50, two)):
        name = f"{options.frame}, MAVLink in the loop at {rate} Hz ({len(messages)} messages)"
        factor = show(name, repeat(streaming(hovering(options.frame, core), rate, messages), options.repeats))
        print(f"{'   of the core alone':58s} {factor / alone:9.2f}")
    snapshots(pilot, options.repeats)
    if options.compile:
        compile_times()


if __name__ == "__main__":
    main()
