# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.cameras``: steps a second of environments that observe by depth pictures and cameras.

One core, CPU time, the best of several runs; the autopilot, MAVLink and the task are in each step.
``benchmarks.ray_casting`` times the pictures alone.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence
from typing import Any

import gymnasium as gym

from sitl import envs
from sitl.envs.pictures import Camera, Depth

ENV = "sitl/CopterForest-v1"
STATE = ["goal", "velocity", "attitude"]
ROBOTS = 16
"""Of the vector environment."""


def observations() -> dict[str, Any]:
    """What is observed, by the name of its row."""
    return {
        "state": STATE,
        "state and lidar": [*STATE, "scan"],
        "state and depth, 32 x 24": {"depth": Depth(32, 24), "state": STATE},
        "state and depth, 64 x 48": {"depth": Depth(), "state": STATE},
        "the same at 5 Hz, held between": {"depth": Depth(rate=5.0), "state": STATE},
        "state and depth, 128 x 96": {"depth": Depth(128, 96), "state": STATE},
        "state and grey, 64 x 48": {"camera": Camera(grey=True), "state": STATE},
        "state and colour, 64 x 48": {"camera": Camera(), "state": STATE},
        "state and colour, 128 x 96": {"camera": Camera(128, 96), "state": STATE},
    }


def single(observation: Any, steps: int) -> Callable[[], float]:
    """A run of an environment; gives steps a second."""
    env = gym.make(ENV, observation=observation)
    env.action_space.seed(0)
    actions = [env.action_space.sample() for _ in range(64)]
    env.reset(seed=0)

    def run() -> float:
        start = time.process_time()
        for k in range(steps):
            if any(env.step(actions[k % 64])[2:4]):
                env.reset()
        return steps / (time.process_time() - start)

    return run


def vector(observation: Any, steps: int) -> Callable[[], float]:
    """The same of ``ROBOTS`` in a vector; steps of all."""
    env: Any = gym.make_vec(ENV, num_envs=ROBOTS, observation=observation)
    env.action_space.seed(0)
    actions = [env.action_space.sample() for _ in range(64)]
    env.reset(seed=0)
    calls = max(steps // ROBOTS, 1)

    def run() -> float:
        start = time.process_time()
        for k in range(calls):
            env.step(actions[k % 64])
        return calls * ROBOTS / (time.process_time() - start)

    return run


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.cameras", description=__doc__)
    parser.add_argument("--repeats", type=int, default=5, metavar="N", help="runs of each, of which the best counts")
    parser.add_argument("--steps", type=int, default=1000, metavar="N", help="of a run")
    options = parser.parse_args(arguments)
    if options.repeats < 1 or options.steps < 1:
        parser.error("--repeats and --steps must be 1 or more")
    envs.register()
    runs = {
        name: (single(observation, options.steps), vector(observation, options.steps))
        for name, observation in observations().items()
    }
    best = dict.fromkeys(runs, (0.0, 0.0))
    for _ in range(options.repeats):  # in turns, so that what else the machine does meets all alike
        for name, (one, many) in runs.items():
            best[name] = max(best[name][0], one()), max(best[name][1], many())
    print(f"| {ENV}: observation | steps/s, `gym.make` | steps/s, vector of {ROBOTS} |\n|---|---|---|")
    for name, (one_rate, many_rate) in best.items():
        print(f"| {name} | {one_rate:,.0f} | {many_rate:,.0f} |")


if __name__ == "__main__":
    main()
