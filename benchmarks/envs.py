# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.envs``: steps a second of the environments beside CartPole-v1's, one core, one process.

Every environment is made with ``gymnasium.make`` (all its wrappers) and driven by the same loop, with resets. The
repeats take turns, so that what else the machine does meets all alike. CPU time, medians.
"""

from __future__ import annotations

import argparse
import statistics
import time
import timeit
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np

from sitl import envs

from .beside import IDS, PPO, compare

CARTPOLE = "CartPole-v1"
VECTORS = (16, 256, 1024)
"""Robots."""
_ID = "GazeboCircuit2TurtlebotLIDAR-v0"
_ROVER, _COPTER = "GazeboMazeErleRoverLIDAR-v0", "GazeboOfficeErleCopterLIDAR-v0"
"""With an autopilot: every step is MAVLink bytes in both directions."""


def single(name: str, steps: int) -> Callable[[], float]:
    """A run of ``steps`` steps, resets included; gives steps a second."""
    env = gym.make(name)
    env.reset(seed=0)
    rng = np.random.default_rng(0)
    actions = [int(a) for a in rng.integers(env.action_space.n, size=997)]  # type: ignore[attr-defined]
    env.step(actions[0])  # loads compiled code, which is not timed
    env.reset()

    def run() -> float:
        step, reset = env.step, env.reset
        start = time.process_time()
        for k in range(steps):
            _, _, terminated, truncated, _ = step(actions[k % 997])
            if terminated or truncated:
                reset()
        return steps / (time.process_time() - start)

    return run


def vector(name: str, count: int, steps: int) -> Callable[[], float]:
    """The same with ``count`` robots; gives the steps a second of all."""
    env = gym.make_vec(name, num_envs=count, vectorization_mode="vector_entry_point")
    env.reset(seed=0)
    env.action_space.seed(0)
    actions = [env.action_space.sample() for _ in range(64)]
    env.step(actions[0])

    def run() -> float:
        start = time.process_time()
        for k in range(steps // count):
            env.step(actions[k % 64])
        return steps // count * count / (time.process_time() - start)

    return run


def drawn(name: str, steps: int) -> Callable[[], float]:
    """Steps a second when each is drawn."""
    env = gym.make(name, render_mode="rgb_array")
    env.reset(seed=0)
    env.render()

    def run() -> float:
        start = time.process_time()
        for _ in range(steps):
            env.step(1)
            env.render()
        env.reset()
        return steps / (time.process_time() - start)

    return run


MASSES = {_ROVER: {"mass": (2.0, 3.0)}, _COPTER: {"mass": (1.0, 1.3)}}


def print_resets(repeats: int) -> None:
    """Time of resets of each kind."""
    for name, masses in MASSES.items():
        both = {"start": "random", "randomise": masses}
        kinds: tuple[tuple[str, dict[str, Any], int], ...] = (
            ("same start", {}, 200),
            ("new pose", {"start": "random"}, 200),
            ("new properties", {"randomise": masses}, 200),
            ("new pose and properties", both, 200),
            ("the same by boot", {**both, "begin": "boot"}, 2),
        )
        for kind, given, number in kinds:
            env = gym.make(name, **given).unwrapped
            env.reset(seed=0)
            env.step(0)
            found = timeit.repeat(env.reset, number=number, repeat=repeats, timer=time.process_time)
            print(f"{name + ', reset: ' + kind:58s} {statistics.median(found) * 1e6 / number:10.1f} us")


def main() -> None:
    """Print every value, and its ratio to CartPole-v1's of the same run."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.envs")
    parser.add_argument("--repeats", type=int, default=7, metavar="N", help="runs of each, of which the median counts")
    parser.add_argument("--steps", type=int, default=20_000, metavar="N", help="of a run")
    parser.add_argument("--copters", type=int, default=0, metavar="N", help="also a vector of N copters (256: 250 MB)")
    parser.add_argument("--beside", type=Path, metavar="PATH", help="instead: ratios to this checkout's environments")
    parser.add_argument("--ids", nargs="+", metavar="ID", help="with --beside; the default is one of each kind of task")
    parser.add_argument(
        "--vectors", nargs="+", default=[0, 64], metavar="N", type=lambda n: n if n == PPO else int(n),
        help=f"with --beside: numbers of robots; 0: gymnasium.make; {PPO}: the share of a training",
    )  # fmt: skip
    options = parser.parse_args()
    if options.repeats < 1 or options.steps < 1024:
        parser.error("--repeats must be 1 or more, --steps 1024 or more")
    if options.beside is not None:
        names = options.ids or [f"{name}-{version}" for name in IDS for version in ("v0", "v1")]
        compare(options.beside, names, options.vectors, options.repeats, options.steps)
        return
    rows: dict[str, tuple[Callable[[], float], float]] = {CARTPOLE: (single(CARTPOLE, options.steps), 0.02)}
    for name in envs.PAPER:
        seconds = gym.make(name).unwrapped.step_time  # type: ignore[attr-defined]
        rows[name] = (single(name, options.steps if "Turtlebot" in name else options.steps // 10), seconds)
    for count in VECTORS:
        rows[f"{_ID}, vector of {count}"] = (vector(_ID, count, max(options.steps, 4 * count)), 0.6)
    rows[f"{_ROVER}, vector of 16"] = (vector(_ROVER, 16, options.steps // 10), 0.1)
    if options.copters:
        count = options.copters
        rows[f"{_COPTER}, vector of {count}"] = (vector(_COPTER, count, max(options.steps // 10, 4 * count)), 0.1)
    rows[f"{_ID}, every step drawn"] = (drawn(_ID, options.steps // 40), 0.6)
    results: dict[str, list[float]] = {name: [] for name in rows}
    for _ in range(options.repeats):
        for name, (run, _) in rows.items():
            results[name].append(run())
    base = statistics.median(results[CARTPOLE])
    title = f"one core, CPU time, median of {options.repeats}"
    print(f"{title:58s} {'steps/s':>10s} {'x real time':>12s} CartPole = 1")
    for name, (_, seconds) in rows.items():
        found = sorted(results[name])
        median = statistics.median(found)
        spread = f"({found[0]:,.0f} .. {found[-1]:,.0f})"
        print(f"{name:58s} {median:10,.0f} {median * seconds:11,.0f}x {median / base:8.2f}   {spread}")
    for name in (_ID, _ROVER, _COPTER):
        env = gym.make(name).unwrapped
        env.reset(seed=0)
        kept = env.snapshot()  # type: ignore[attr-defined]
        calls = (("reset", env.reset), ("snapshot", env.snapshot), ("restore", partial(env.restore, kept)))  # type: ignore[attr-defined]
        for call, run_call in calls:
            found = timeit.repeat(run_call, number=200, repeat=options.repeats, timer=time.process_time)
            print(f"{name + ', ' + call:58s} {statistics.median(found) * 1e6 / 200:10.1f} us")
    print_resets(options.repeats)


if __name__ == "__main__":
    main()
