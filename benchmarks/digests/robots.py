# SPDX-License-Identifier: BSD-3-Clause
"""Turtlebots, and the Gymnasium environments: what each step gives."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from . import tree
from .leaves import leaves
from .tape import Tape

PAPER = (
    "GazeboCircuitTurtlebotLIDAR-v0", "GazeboCircuit2TurtlebotLIDAR-v0", "GazeboMazeTurtlebotLIDAR-v0",
    "GazeboRoundTurtlebotLIDAR-v0", "GazeboMazeErleRoverLIDAR-v0", "GazeboOfficeErleCopterLIDAR-v0",
)  # fmt: skip
FLYING = (
    "CopterHover", "CopterReachGoal", "CopterWaypoint", "CopterCourse", "CopterGates", "CopterRace", "CopterTrajectory",
    "CopterFollow", "CopterLand", "CopterLandMoving", "CopterForest", "CopterRooms", "RoverReachGoal", "RoverWaypoint",
    "RoverCourse", "RoverLabyrinth", "RoverSlalom", "RoverRace", "RoverParking",
)  # fmt: skip
COPTER = {"robot": "erle_copter", "world": "office_erlecopter", "observation": "scan+pose", "action": "continuous"}
ROVER = {"robot": "erle_rover", "world": "maze_erlerover", "observation": "scan+pose", "action": "continuous"}
NAVIGATES: dict[str, dict[str, Any]] = {
    "turtlebot-goal": {
        "robot": "turtlebot", "world": "maze", "task": "goal", "observation": "scan+goal", "action": "continuous",
        "step_time": 0.2, "start": "random",
        "randomise": {"range_noise": (0.0, 0.02), "wheel_radius_left": (0.0345, 0.0355)},
    },
    "turtlebot-late": {"robot": "turtlebot", "world": "round", "observation": "scan+pose", "latency": 0.2},
    "copter-velocity": COPTER,
    "copter-attitude": COPTER | {
        "setpoint": "attitude", "randomise": {"mass": (1.0, 1.4), "wind_speed": (0.0, 2.0), "latency": (0.0, 0.2)},
    },
    "copter-rc": COPTER | {"setpoint": "rc", "observation": "digits", "action": "discrete"},
    "copter-pybullet": COPTER | {"physics": "pybullet"},
    "rover-velocity": ROVER | {
        "task": "goal", "observation": "scan+pose+goal", "randomise": {"mass": (1.5, 2.5), "lidar_noise": (0.0, 0.05)},
    },
    "rover-position": ROVER | {"setpoint": "position"},
    "rover-attitude": ROVER | {"setpoint": "attitude"},
}  # fmt: skip


class Steps:
    """Digests of what each step gives."""

    def __init__(self) -> None:
        self.given, self.record = Tape(), Tape()
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
            self.given.add(self.step, name, str(value).encode())
        elif np.asarray(value).dtype.kind in "biuf":
            self.given.add(self.step, name, np.asarray(value, np.float64).tobytes())

    def result(self) -> dict[str, Any]:
        """As JSON."""
        return {"end": self.step, "given": self.given.result(), "record": self.record.result()}


def environment(name: str, steps: int, vector: int = 0, **options: Any) -> Steps:
    """Random actions; episodes follow each other."""
    import gymnasium as gym

    importlib.import_module("sitl.envs")  # registers them
    taken = Steps()
    env: Any = gym.make_vec(name, num_envs=vector, **options) if vector else gym.make(name, **options)
    env.action_space.seed(5)
    taken.add("observation", env.reset(seed=5)[0])
    for taken.step in range(1, steps + 1):
        given = env.step(env.action_space.sample())
        for what, value in zip(("observation", "reward", "terminated", "truncated", "info"), given):
            taken.add(what, value)
        if not vector and (given[2] or given[3]):
            taken.add("observation", env.reset()[0])
    env.close()
    return taken


def turtlebots(world: str, steps: int = 300) -> Steps:
    """Four Turtlebots on random commands: their scans, and their records every 20 steps."""
    taken = Steps()
    robots = tree.locate("Turtlebots", "sitl.turtlebots.native")(world, 4)
    random = np.random.default_rng(5)
    for index in range(4):
        robots.reset(index, seed=index)
    for taken.step in range(steps):
        robots.commands[:] = random.uniform((-0.1, -1.0), (0.6, 1.0), (4, 2))
        robots.advance(0.2)
        taken.add("scan", robots.scan)
        if taken.step % 20 == 19:
            for leaf in leaves(np.dtype([("robots", robots.fleet.dtype, (4,))])):
                taken.record.add(taken.step, leaf.path, leaf.wide(robots.fleet.tobytes()))
    robots.close()
    return taken


def flights() -> dict[str, Callable[[], Steps]]:
    """All of them, by name."""
    return {
        **{f"turtlebot/{world}": partial(turtlebots, world) for world in ("circuit", "circuit2", "maze", "round")},
        **{f"env/{name}": partial(environment, name, 300) for name in PAPER},
        **{
            f"env/navigate-{name}": partial(environment, "sitl/Navigate-v0", 200, **options)
            for name, options in NAVIGATES.items()
        },
        **{f"env/{name}": partial(environment, f"sitl/{name}-v0", 100) for name in FLYING},
        "env/vector-turtlebot": partial(environment, PAPER[1], 200, 8),
        "env/vector-copter": partial(environment, PAPER[5], 100, 3),
    }
