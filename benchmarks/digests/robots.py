# SPDX-License-Identifier: BSD-3-Clause
"""Turtlebots, and the Gymnasium environments: what each step gives."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from . import tree
from .tape import Record, Series

PAPER = (
    "GazeboCircuitTurtlebotLIDAR-v0", "GazeboCircuit2TurtlebotLIDAR-v0", "GazeboMazeTurtlebotLIDAR-v0",
    "GazeboRoundTurtlebotLIDAR-v0", "GazeboMazeErleRoverLIDAR-v0", "GazeboOfficeErleCopterLIDAR-v0",
)  # fmt: skip
NAVIGATE = "sitl/Navigate-v0"
NAVIGATES: dict[str, dict[str, Any]] = {
    "turtlebot-goal": {
        "robot": "turtlebot", "world": "maze", "task": "goal", "observation": "scan+goal", "action": "continuous",
        "step_time": 0.2, "start": "random",
        "randomise": {"range_noise": (0.0, 0.02), "wheel_radius_left": (0.0345, 0.0355)},
    },
    "turtlebot-late": {"robot": "turtlebot", "world": "round", "observation": "scan+pose", "latency": 0.2},
    "copter-velocity": {
        "robot": "erle_copter", "world": "office_erlecopter", "action": "continuous", "observation": "scan+pose",
    },
    "copter-attitude": {
        "robot": "erle_copter", "world": "office_erlecopter", "setpoint": "attitude", "action": "continuous",
        "observation": "scan+pose", "randomise": {"mass": (1.0, 1.4), "wind_speed": (0.0, 2.0), "latency": (0.0, 0.2)},
    },
    "copter-rc": {"robot": "erle_copter", "world": "office_erlecopter", "setpoint": "rc", "observation": "digits"},
    "copter-pybullet": {
        "robot": "erle_copter", "world": "office_erlecopter", "action": "continuous", "physics": "pybullet",
        "observation": "scan+pose",
    },
    "rover-velocity": {
        "robot": "erle_rover", "world": "maze_erlerover", "task": "goal", "action": "continuous",
        "observation": "scan+pose+goal", "randomise": {"mass": (1.5, 2.5), "lidar_noise": (0.0, 0.05)},
    },
    "rover-position": {
        "robot": "erle_rover", "world": "maze_erlerover", "setpoint": "position", "action": "continuous",
        "observation": "scan+pose",
    },
    "rover-attitude": {
        "robot": "erle_rover", "world": "maze_erlerover", "setpoint": "attitude", "action": "continuous",
        "observation": "scan+pose",
    },
}  # fmt: skip


class Steps:
    """Digests of what each step gives."""

    def __init__(self) -> None:
        self.given, self.record = Series(), Record()
        self.step = 0

    def add(self, name: str, value: Any) -> None:
        """A number, an array, or what is made of them."""
        if isinstance(value, dict):
            for key in sorted(value):
                self.add(f"{name}.{key}", value[key])
        elif isinstance(value, tuple | list) and not all(isinstance(each, int | float) for each in value):
            for k, each in enumerate(value):
                self.add(f"{name}[{k}]", each)
        elif isinstance(value, str) or value is None:
            self.given.add(name, self.step, str(value).encode())
        elif np.asarray(value).dtype.kind in "biuf":
            self.given.add(name, self.step, np.asarray(value, np.float64).tobytes())

    def result(self) -> dict[str, Any]:
        """As JSON."""
        digests: dict[str, Any] = {"steps": self.step, "given": self.given.result()}
        if self.record.times:
            digests["record"] = self.record.result()
        return digests


def environment(name: str, steps: int, vector: int = 0, **options: Any) -> Steps:
    """Random actions; episodes follow each other."""
    import gymnasium as gym

    tree.register_envs()
    taken = Steps()
    env: Any = gym.make_vec(name, num_envs=vector, **options) if vector else gym.make(name, **options)
    env.action_space.seed(5)
    observation, info = env.reset(seed=5)
    taken.add("observation", observation)
    for taken.step in range(1, steps + 1):
        observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
        given = (("observation", observation), ("reward", reward), ("terminated", terminated), ("truncated", truncated))
        for what, value in (*given, ("info", info)):
            taken.add(what, value)
        if not vector and (terminated or truncated):
            observation, info = env.reset()
            taken.add("observation", observation)
    env.close()
    return taken


def turtlebots(world: str, steps: int = 300) -> Steps:
    """Four Turtlebots on random commands: their scans, and their records every 20 steps."""
    taken = Steps()
    robots = tree.locate("Turtlebots", "sitl.turtlebot")(world, 4)
    random = np.random.default_rng(5)
    for index in range(4):
        robots.reset(index, seed=index)
    for taken.step in range(steps):
        robots.commands[:] = random.uniform((-0.1, -1.0), (0.6, 1.0), (4, 2))
        robots.advance(0.2)
        taken.add("scan", robots.scan)
        if taken.step % 20 == 19:
            whole = np.dtype([("robots", robots.fleet.dtype, (4,))])
            taken.record.look(taken.step * 200_000, whole, robots.fleet.tobytes())
    robots.close()
    return taken


def flights() -> dict[str, Callable[[], Steps]]:
    """All of them, by name."""
    found: dict[str, Callable[[], Steps]] = {}
    for world in ("circuit", "circuit2", "maze", "round"):
        found[f"turtlebot/{world}"] = partial(turtlebots, world)
    for name in PAPER:
        found[f"env/{name}"] = partial(environment, name, 300)
    for name, options in NAVIGATES.items():
        found[f"env/navigate-{name}"] = partial(environment, NAVIGATE, 200, **options)
    found["env/vector-turtlebot"] = partial(environment, PAPER[1], 200, 8)
    found["env/vector-copter"] = partial(environment, PAPER[5], 100, 3)
    return found
