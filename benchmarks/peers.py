# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.peers``: our environments beside those of other simulators, in one run.

Other simulators need packages of other versions, so each may live in a virtual environment of its own::

    python -m benchmarks.peers --python /path/to/crazyflow/bin/python --python /path/to/pyflyt/bin/python

Each interpreter measures what it has of CartPole, crazyflow, gym-pybullet-drones and PyFlyt; ours is always measured.
All run this file, restricted to the same cores, one after the other, in turns. Wall time, because some use threads;
values are medians. Other simulators fly without an autopilot and without MAVLink.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

Row = tuple[Callable[[], Any], int, float]
"""A step; the vehicles that it advances; its simulated seconds."""


def cartpole(count: int) -> Row:
    """CartPole-v1 without wrappers; the only size is 1."""
    gym = importlib.import_module("gymnasium")
    env = gym.make("CartPole-v1").unwrapped
    env.reset(seed=0)

    def step() -> None:
        if env.step(1)[2]:
            env.reset()

    return step, 1, 0.02


def crazyflow(count: int) -> Row:
    """Reach a position by attitude set-points at 50 Hz; physics at 500 Hz."""
    importlib.import_module("crazyflow.envs")
    gym, np = importlib.import_module("gymnasium"), importlib.import_module("numpy")
    env = gym.make_vec("DroneReachPos-v0", num_envs=count, freq=50)
    env.reset(seed=0)
    action = np.zeros((count, 4), np.float32)
    action[:, 3] = 0.3
    return lambda: np.asarray(env.step(action)[1]), count, 0.02


def pyflyt(count: int) -> Row:
    """Hover by rates and thrust at 40 Hz, physics at 240 Hz; the only size is 1."""
    importlib.import_module("PyFlyt.gym_envs")
    gym, np = importlib.import_module("gymnasium"), importlib.import_module("numpy")
    env = gym.make("PyFlyt/QuadX-Hover-v4").unwrapped
    env.reset(seed=0)
    action = np.array([0.0, 0.0, 0.0, 0.3])

    def step() -> None:
        result = env.step(action)
        if result[2] or result[3]:
            env.reset()

    return step, 1, 1 / 40


def pybullet_drones(count: int) -> Row:
    """Hover by motor speeds at 30 Hz, physics at 240 Hz; the only size is 1."""
    module = importlib.import_module("gym_pybullet_drones.envs.HoverAviary")
    np = importlib.import_module("numpy")
    env = module.HoverAviary()
    env.reset(seed=0)
    action = np.zeros((1, 4), np.float32)

    def step() -> None:
        result = env.step(action)
        if result[2] or result[3]:
            env.reset()

    return step, 1, 1 / 30


def office_copter(count: int) -> Row:
    """An Erle-Copter in the office at 10 Hz: autopilot, MAVLink, lidar; ticks at 400 Hz."""
    importlib.import_module("sitl.envs")
    gym, np = importlib.import_module("gymnasium"), importlib.import_module("numpy")
    threads = min(len(os.sched_getaffinity(0)), count) if hasattr(os, "sched_getaffinity") else 1
    env = gym.make_vec("GazeboOfficeErleCopterLIDAR-v0", num_envs=count, threads=threads)
    env.reset(seed=0)
    actions = np.zeros(count, np.int64)
    return lambda: env.step(actions), count, 0.1


ROWS: dict[str, tuple[Callable[[int], Row], tuple[int, ...]]] = {
    "CartPole-v1": (cartpole, (1,)),
    "gym-sitl office copter": (office_copter, (1, 64, 1024)),
    "crazyflow": (crazyflow, (1, 64, 1024)),
    "PyFlyt": (pyflyt, (1,)),
    "gym-pybullet-drones": (pybullet_drones, (1,)),
}


def measure(cores: int, seconds: float, only: list[str]) -> list[tuple[str, float, float, float]]:
    """Name and size, steps a second, simulated seconds a second, cores used; of what is installed here."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:cores])
    found = []
    for name, (make, sizes) in ROWS.items():
        if only and name not in only:
            continue
        for size in sizes:
            try:
                step, count, simulated = make(size)
            except ImportError:
                break
            for _ in range(3):  # compiles, fills caches
                step()
            begun, used, steps = time.perf_counter(), time.process_time(), 0
            while (passed := time.perf_counter() - begun) < seconds:
                step()
                steps += count
            rate = steps / passed
            found.append((f"{name}, {count}", rate, rate * simulated, (time.process_time() - used) / passed))
    return found


def asked(python: str, cores: int, seconds: float, only: list[str]) -> list[tuple[str, float, float, float]]:
    """``measure`` by another interpreter."""
    command = [python, __file__, "--measure", "--cores", str(cores), "--seconds", str(seconds), *only]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode:
        raise SystemExit(f"{python} failed:\n{run.stderr.strip()}")
    rows = json.loads(run.stdout.strip().splitlines()[-1])
    return [(name, rate, factor, used) for name, rate, factor, used in rows]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.peers")
    parser.add_argument(
        "--python", action="append", default=[], metavar="PATH", help="interpreter with another simulator"
    )
    parser.add_argument("--cores", type=int, default=1, metavar="N", help="cores that each may use (default 1)")
    parser.add_argument("--repeats", type=int, default=3, metavar="N", help="of which the median counts (default 3)")
    parser.add_argument("--seconds", type=float, default=3.0, metavar="S", help="of wall time a value (default 3)")
    parser.add_argument("--measure", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("only", nargs="*", metavar="NAME", help=f"of {', '.join(ROWS)} (default all)")
    options = parser.parse_args()
    if options.cores < 1 or options.repeats < 1 or not options.seconds > 0.0:
        parser.error("--cores and --repeats must be 1 or more, --seconds more than 0")
    if unknown := [name for name in options.only if name not in ROWS]:
        parser.error(f"no simulator {unknown[0]!r}: one of {', '.join(ROWS)}")
    if options.measure:
        print(json.dumps(measure(options.cores, options.seconds, options.only)))
        return
    found: dict[str, list[tuple[float, float, float]]] = {}
    for _ in range(options.repeats):
        for python in (sys.executable, *options.python):
            for name, *values in asked(python, options.cores, options.seconds, options.only):
                found.setdefault(name, []).append((values[0], values[1], values[2]))
    title = f"{options.cores} core(s), wall time"
    print(f"{title:36s} {'steps/s':>10s} {'x real time':>12s} {'cores used':>11s}   steps/s, all")
    for name, runs in found.items():
        rate, factor, used = (statistics.median(column) for column in zip(*runs, strict=True))
        spread = f"{min(r[0] for r in runs):,.0f} .. {max(r[0] for r in runs):,.0f}"
        print(f"{name:36s} {rate:10,.0f} {factor:11,.0f}x {used:11.2f}   {spread}")


if __name__ == "__main__":
    main()
