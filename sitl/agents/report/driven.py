# SPDX-License-Identifier: BSD-3-Clause
"""Greedy evaluations that keep where the robot went."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from sitl.envs.boxes import Parts
from sitl.worlds import World
from sitl.worlds.shapes import from_ned

from .. import environments
from ..evaluate import Evaluation, Played, evaluate, stage
from ..runs.evaluation_plan import EvaluationPlan
from ..runs.folder import RunFolder

Floats = npt.NDArray[np.float64]
DRAWN = 20
"""Number of episodes whose trails are kept."""


@dataclass(frozen=True)
class Facts:
    """Facts about the environment that a run was evaluated in."""

    world: World
    robot: str
    """Name of the robot."""
    observation: str
    """Description of the observation."""
    action: str
    step_s: float
    """Simulated time of a step [s]."""


@dataclass(frozen=True)
class Whereabouts:
    """Extent of an episode's path: it shows a robot that shuttles in a corner or has left for open ground."""

    farthest_m: float
    """Greatest distance from its start [m]."""
    left: bool
    """The episode ended outside of the rectangle around the walls of the world; False where it has none."""


@dataclass(frozen=True)
class Driven:
    """An evaluation."""

    evaluation: Evaluation
    trails: tuple[Floats, ...]
    """x, y of the first episodes after each step [m], each of shape (steps + 1, 2)."""
    whereabouts: tuple[Whereabouts, ...]
    """Extents of all episodes."""
    facts: Facts

    @property
    def left(self) -> int:
        """Episodes that ended outside of the world's walls, neither by a crash nor by a goal reached."""
        pairs = zip(self.whereabouts, self.evaluation.episodes)
        return sum(where.left and not (played.crashed or played.reached) for where, played in pairs)

    @property
    def farthest_m(self) -> float:
        """Greatest distance from the start [m], median of the episodes."""
        return float(np.median([where.farthest_m for where in self.whereabouts]))


class Trails(gym.Wrapper[Any, Any, Any, Any]):
    """Notes where the robot is after each reset and step; changes nothing.

    Args:
        env: environment with one robot.
    """

    def __init__(self, env: gym.Env[Any, Any]) -> None:
        super().__init__(env)
        self._noted: list[list[tuple[float, float]]] = []
        self.worlds: list[World] = []
        """That of each episode."""
        self._where = position_of(env)

    def reset(self, **arguments: Any) -> Any:
        """See ``gymnasium.Env``."""
        found = self.env.reset(**arguments)
        self._noted.append([self._where()])
        self.worlds.append(self.env.unwrapped.world)  # type: ignore[attr-defined]
        return found

    def step(self, action: Any) -> Any:
        """See ``gymnasium.Env``."""
        found = self.env.step(action)
        self._noted[-1].append(self._where())
        return found

    @property
    def trails(self) -> tuple[Floats, ...]:
        """x, y after each step [m], of each episode."""
        return tuple(np.array(points) for points in self._noted)


def whereabouts(trail: Floats, world: World) -> Whereabouts:
    """Extent of an episode's path.

    Args:
        trail: x, y [m], shape (n, 2).
        world: world that the robot was in.
    """
    x0, y0, x1, y1 = world.bounds
    x, y = trail[-1].tolist()
    farthest = float(np.hypot(*(trail - trail[0]).T).max())
    return Whereabouts(farthest, bool(world.solids) and not (x0 <= x <= x1 and y0 <= y <= y1))


def position_of(env: gym.Env[Any, Any]) -> Callable[[], tuple[float, float]]:
    """Says where the robot of an environment really is: x, y [m]. The pose of a vehicle with an autopilot is what its
    autopilot believes, which is metres off at times."""
    robot: Any = env.unwrapped.robot  # type: ignore[attr-defined]
    if not hasattr(robot, "view"):

        def measured() -> tuple[float, float]:
            x, y = robot.pose[0, :2].tolist()
            return x, y

        return measured

    def true() -> tuple[float, float]:
        return from_ned(*robot.view(0).physics.body.pos)[:2]

    return true


def drive(path: Path, plan: EvaluationPlan, watch: Callable[[Played], None] = lambda played: None) -> Driven:
    """Play what the run in a folder has learnt.

    Args:
        path: path of the folder.
        plan: how.
        watch: called after each episode.

    Raises:
        AgentError: it has learnt nothing yet, or the plan's environment is another kind.
    """
    run = RunFolder(path)
    with stage(run, plan) as (env, policy, poses):
        noted = Trails(env)
        found = evaluate(noted, policy, plan.episodes, poses=poses, watch=watch)
        about = facts(env, {**run.config.env_options, **plan.options}.get("observation", "digits"))
        trails = noted.trails
        return Driven(found, trails[:DRAWN], tuple(map(whereabouts, trails, noted.worlds)), about)


def facts(env: gym.Env[Any, Any], asked: Any) -> Facts:
    """Facts about an environment; ``asked``: the option ``observation``, as far as it is given."""
    inner: Any = env.unwrapped
    made, space = inner.session.observation, env.observation_space
    named = asked if isinstance(asked, str) else type(made).__name__
    seen = ", ".join(made.names) if isinstance(made, Parts) else named
    shape = f" ({space.shape[0]})" if space.shape else ""
    acts = env.action_space
    names = getattr(getattr(inner.session, "action", None), "names", ())
    return Facts(
        world=inner.robot.world,
        robot=inner.robot.name,
        observation=f"{seen}{shape}",
        action=", ".join(names) if isinstance(acts, gym.spaces.Discrete) else f"{acts.shape[0]} set-points",  # type: ignore[index]
        step_s=environments.step_time(env),
    )
