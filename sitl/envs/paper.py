# SPDX-License-Identifier: BSD-3-Clause
"""The paper's environments as data (Zamora et al., "Extending the OpenAI Gym for robotics", arXiv:1608.05742).

Values are those of the authors' code at the time of the paper (erlerobot/gym-gazebo).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from .actions import DRIVE, Discrete
from .observations import Digits
from .tasks import paper


def turtlebot(world: str, speed: float = 0.3, turning_speed: float = 0.05, reward: float = 5.0) -> dict[str, Any]:
    """Options of a Turtlebot environment.

    Args:
        world: name of the world.
        speed: speed of "forward" [m/s].
        turning_speed: speed of "left" and "right" [m/s], which turn at 0.3 rad/s.
        reward: reward of "forward"; "left" and "right" give 1, a crash -200.
    """
    rows = {"forward": (speed, 0.0), "left": (turning_speed, 0.3), "right": (turning_speed, -0.3)}
    return {
        "robot": "turtlebot",
        "world": world,
        "task": paper(forward=reward),
        "observation": Digits(),
        "action": Discrete(DRIVE, rows),
        "step_time": 0.6,
    }


def autopilot(robot: str, world: str) -> dict[str, Any]:
    """Options of an environment of a vehicle with an autopilot, steered by RC overrides."""
    return {
        "robot": robot,
        "world": world,
        "task": paper(),
        "observation": Digits(),
        "action": "discrete",
        "setpoint": "rc",
        "step_time": 0.1,
        "boots": 1,  # as published
    }


PRESETS: dict[str, Callable[[], dict[str, Any]]] = {
    "circuit-turtlebot": lambda: turtlebot("circuit"),
    "circuit2-turtlebot": lambda: turtlebot("circuit2"),
    "maze-turtlebot": lambda: turtlebot("maze", speed=0.25, reward=3.0),
    "round-turtlebot": lambda: turtlebot("round", turning_speed=0.1),
    "maze-erle-rover": lambda: autopilot("erle_rover", "maze_erlerover"),
    "office-erle-copter": lambda: autopilot("erle_copter", "office_erlecopter"),
}
"""Options of ``Navigate`` by the preset's name; ``sitl.envs.ids.PAPER`` says which environment has which."""
