# SPDX-License-Identifier: BSD-3-Clause
"""Environments of this checkout beside those of another, in one run: ``python -m benchmarks.envs --beside PATH``.

Each checkout has a process of its own, which runs this file; they take turns, so that what else the machine does meets
both alike. CPU time, of the quickest repeat.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

IDS = ("sitl/CopterHover", "sitl/CopterGates", "sitl/CopterTrajectory", "sitl/CopterLand", "sitl/CopterForest",
       "sitl/RoverWaypoint", "sitl/RoverParking")  # fmt: skip
"""One of each kind of task, without version."""
PPO = "ppo"
"""In place of a number of robots: a training of stable-baselines3 with 64."""


def stepping(name: str, count: int) -> Callable[[int], float]:
    """A function that makes steps and gives the CPU time of one [s]; resets are part of them.

    Args:
        name: of an environment.
        count: robots of a vector; 0: ``gymnasium.make``.
    """
    import gymnasium as gym

    import sitl.envs  # noqa: F401 - registers

    kind = {"num_envs": count, "vectorization_mode": "vector_entry_point"}
    env: Any = gym.make_vec(name, **kind) if count else gym.make(name)  # type: ignore[arg-type]
    env.action_space.seed(0)
    actions = [env.action_space.sample() for _ in range(64)]
    env.reset(seed=0)
    env.step(actions[0])  # loads compiled code, which is not timed

    def run(steps: int) -> float:
        start = time.process_time()
        for k in range(steps):
            _, _, terminated, truncated, _ = env.step(actions[k // 8 % 64])
            if not count and (terminated or truncated):
                env.reset()
        return (time.process_time() - start) / steps

    return run


def share(name: str) -> Callable[[int], float]:
    """A function that trains for steps and gives the part of the CPU time that the environment took."""
    import torch
    from stable_baselines3 import PPO as Learner

    from sitl.envs.sb3 import Sb3VecEnv

    torch.set_num_threads(1)
    env, spent = Sb3VecEnv(name, 64), [0.0]
    plain = env.step_wait

    def timed() -> Any:
        start = time.process_time()
        found = plain()
        spent[0] += time.process_time() - start
        return found

    env.step_wait = timed  # type: ignore[method-assign]
    model = Learner("MlpPolicy", env, n_steps=32, device="cpu")

    def run(steps: int) -> float:
        spent[0], start = 0.0, time.process_time()
        model.learn(steps)
        return spent[0] / (time.process_time() - start)

    return run


def serve() -> None:
    """Answer orders, a line each: [name, robots, steps] -> a number, or null for an id that is not there."""
    warnings.simplefilter("ignore")
    made: dict[tuple[str, Any], Callable[[int], float] | None] = {}
    out, sys.stdout = sys.stdout, sys.stderr
    for line in sys.stdin:
        name, count, steps = json.loads(line)
        if (name, count) not in made:
            try:
                made[name, count] = share(name) if count == PPO else stepping(name, count)
            except Exception as error:
                print(f"{name}: {type(error).__name__}: {error}", file=sys.stderr)
                made[name, count] = None
        run = made[name, count]
        print(json.dumps(run(steps) if run else None), file=out, flush=True)


class Checkout:
    """A process with the environments of one checkout."""

    def __init__(self, path: Path) -> None:
        self._process = subprocess.Popen(
            [sys.executable, __file__], cwd=path, env={**os.environ, "PYTHONPATH": str(path)}, text=True,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
        )  # fmt: skip

    def ask(self, name: str, count: int | str, steps: int) -> float | None:
        """What ``serve`` answers."""
        assert self._process.stdin is not None and self._process.stdout is not None
        print(json.dumps([name, count, steps]), file=self._process.stdin, flush=True)
        answer: float | None = json.loads(self._process.stdout.readline() or "null")
        return answer

    def close(self) -> None:
        """End the process."""
        self._process.communicate()


def compare(other: Path, names: Sequence[str], vectors: Sequence[int | str], repeats: int, steps: int) -> None:
    """Print what both checkouts need, and the ratio.

    Args:
        other: the other checkout; the first column is its.
        names: ids with their versions.
        vectors: numbers of robots; 0: ``gymnasium.make``; ``PPO``: a training.
        repeats: of which the quickest counts.
        steps: of a repeat, of one robot; vectors make as many in all, but 8 at least.
    """
    sides = Checkout(other.resolve()), Checkout(Path(__file__).resolve().parents[1])
    print(f"{'CPU time of a robot step [us]':44s} {'before':>9s} {'now':>9s} {'ratio':>7s}")
    for name in names:
        for count in vectors:
            number = 8192 if count == PPO else max(steps // max(int(count), 1), 8)
            found: list[list[float]] = [[], []]
            for _ in range(repeats):
                for mine, side in zip(found, sides):
                    answer = side.ask(name, count, number)
                    if answer is not None:
                        mine.append(answer)
            label = f"{name}, " + ("single" if count == 0 else "SB3 PPO, our share" if count == PPO else f"{count}")
            best = [min(mine) if mine else float("nan") for mine in found]
            if count == PPO:
                print(f"{label:44s} {best[0]:9.1%} {best[1]:9.1%}", flush=True)
            else:
                before, now = (1e6 * one / max(int(count), 1) for one in best)
                print(f"{label:44s} {before:9.1f} {now:9.1f} {before / now:7.2f}", flush=True)
    for side in sides:
        side.close()


if __name__ == "__main__":
    serve()
