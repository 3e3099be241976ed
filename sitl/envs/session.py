# SPDX-License-Identifier: BSD-3-Clause
"""Robot, world, task, observation and action of an environment, for one robot or many, below Gymnasium's classes."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from sitl import worlds
from sitl.worlds import World, WorldError

from . import robots
from .actions import SETPOINTS, Action, Discrete
from .latency import LATENCY, Latency
from .latency import Memory as Late
from .observations import OBSERVATIONS, Observation
from .options import EnvOptionError, unknown
from .randomisation import Randomisation, Randomise, ranges_of
from .rewards import ByAction, Step
from .robots.robot import LateRobot, Robot
from .starts import StartOption, Starts
from .tasks import TASKS, Task

FORMS = ("discrete", "continuous")
RESET_OPTIONS = ("pose", "reset_mask")
"""Options of ``reset``; the second one only in vector environments."""
MAX_STEP_S = 3600.0
"""Longest step, in simulated time [s]."""


@dataclass(frozen=True)
class Snapshot:
    """State of one robot and its episode; picklable."""

    robot: Any
    task: Any
    rng: Mapping[str, Any]
    """State of the random generator of later episodes."""
    steps: int = 0
    """Steps of the episode so far; counted by vector environments only."""
    ended: bool = False
    """Whether the next step of a vector environment starts another episode."""
    late: Late | None = None
    """Pending commands; None: there is no latency."""


class Session:
    """Robot, task, observation and action of an environment with ``count`` robots; arguments as in ``Navigate``."""

    def __init__(
        self,
        count: int,
        robot: str | Callable[..., Robot],
        world: str | Path | World,
        task: str | Task,
        observation: str | Observation,
        action: str | Mapping[str, Sequence[float]] | Action,
        setpoint: str | None,
        step_time: float | None,
        start: StartOption | None,
        randomise: Randomise | None,
        robot_options: Mapping[str, Any],
        latency: float = 0.0,
    ) -> None:
        try:
            found = worlds.load(world)
        except WorldError as error:
            raise EnvOptionError(str(error)) from None
        self.robot = robots.load(robot, found, count, robot_options)
        self.count = count
        self.action = self._choose_action(action, setpoint)
        self.seconds = self._check_step_time(step_time)
        ranges = ranges_of(randomise)
        self.latency = self._make_latency(latency, ranges)
        """None: commands take effect at once."""
        self.randomisation = Randomisation(ranges, self.robot, self.latency)
        self.starts = Starts(start, self.robot)
        self.task: Task = _named("task", task, TASKS, "judge")
        self.observation: Observation = _named("observation", observation, OBSERVATIONS, "observe")
        if not isinstance(self.action.space, gym.spaces.Discrete) and any(
            isinstance(term, ByAction) for term in getattr(self.task, "terms", ())
        ):
            raise EnvOptionError('task: a reward by action (as "paper" has) needs a table of actions, as "discrete"')
        self.actions = self.action.room(count)
        """Actions of the next ``advance``, a row a robot, as ``action.check`` returns them."""
        self.commands = np.zeros((count, self.action.setpoint.width))
        self.rewards = np.zeros(count)
        self.terminated = np.zeros(count, np.bool_)
        self.step = Step(self.robot, self.seconds)
        self.step.actions, self.step.commands, self.step.crashed = self.actions, self.commands, self.terminated
        self.task.prepare(self.robot)
        watch = getattr(self.observation, "watch", None)
        if watch is not None:
            watch(self.task)
        self.observation_space = self.observation.space(self.robot)

    def _choose_action(self, action: str | Mapping[str, Sequence[float]] | Action, setpoint: str | None) -> Action:
        robot = self.robot
        kinds = {kind.name: kind for kind in robot.setpoints}
        if setpoint is not None and (not isinstance(setpoint, str) or setpoint not in kinds):
            if isinstance(setpoint, str) and setpoint in SETPOINTS:
                raise EnvOptionError(f"setpoint {setpoint!r}: {robot.name} takes {', '.join(kinds)}")
            raise unknown("setpoint", setpoint, kinds)
        usual = robot.setpoints[0] if setpoint is None else kinds[setpoint]
        if isinstance(action, Mapping):
            return Discrete(usual, action)
        if isinstance(action, str):
            if action not in FORMS:
                raise unknown("action", action, FORMS)
            return robot.action(action, usual)
        if isinstance(action, type) or not hasattr(action, "commands"):
            raise EnvOptionError(f"action {action!r} is neither a name ({', '.join(FORMS)}) nor a table nor an Action")
        if action.setpoint.name not in kinds:
            raise EnvOptionError(f"action gives {action.setpoint.name!r}; {robot.name} takes {', '.join(kinds)}")
        return action

    def _check_step_time(self, step_time: float | None) -> float:
        seconds, tick = self.robot.step_time if step_time is None else step_time, self.robot.tick
        valid = isinstance(seconds, int | float | np.number) and math.isfinite(seconds)
        ticks = round(seconds / tick) if valid else 0
        if not 1 <= ticks <= MAX_STEP_S / tick or abs(seconds / tick - ticks) > 1e-5:
            raise EnvOptionError(
                f"step_time = {seconds!r}; it must be above 0 s, at most {MAX_STEP_S:g} s, and a whole number of "
                f"{tick:g} s"
            )
        return round(ticks * tick, 9)  # exact, also for a float32 or a sum of tenths

    def _make_latency(self, seconds: float, randomise: Randomise) -> Latency | None:
        drawn = LATENCY.name in randomise
        if drawn and seconds != 0.0:
            raise EnvOptionError(f"latency = {seconds!r}, and randomise draws one: give one of them")
        none = isinstance(seconds, int | float) and not isinstance(seconds, bool) and seconds == 0.0 and not drawn
        return None if none else Latency(self.robot, seconds, self.seconds, self.action.setpoint.width)

    def reset(self, index: int, rng: np.random.Generator, options: Mapping[str, Any] | None) -> None:
        """Start an episode of one robot; call ``look`` afterwards.

        Args:
            index: index of the robot.
            rng: random generator of its episodes.
            options: "pose": start pose (x, y, yaw) or (x, y, z, yaw) in the world frame [m, rad].
        """
        for option in options or ():
            if option not in RESET_OPTIONS:
                raise unknown("reset: option", option, RESET_OPTIONS[:1])
        pose = self.starts.draw(rng)
        if options and options.get("pose") is not None:
            pose = self.starts.pose(options["pose"])
        seed = int(rng.integers(1 << 32))
        self.randomisation.draw(index, self.robot, rng)
        if self.latency is not None:
            self.latency.begin(index)
        self.robot.reset(index, pose, seed)
        self.task.start(index, self.robot, rng)

    def look(self, rows: npt.NDArray[np.bool_] | None = None) -> None:
        """Read the lidars of these robots (None: all) after ``reset``; ``rows`` has shape (count,)."""
        self.robot.look(rows)

    def advance(self, rows: npt.NDArray[np.bool_] | None = None) -> None:
        """Advance these robots (None: all) by one step; fills ``rewards`` and ``terminated``, shapes (count,)."""
        self.action.commands(self.actions, self.commands)
        if self.latency is None:
            self.robot.apply(self.action.setpoint, self.commands)
            self.robot.advance(self.seconds, rows)
        else:
            self._advance_late(self.latency, rows)
        self.task.judge(self.step, self.rewards, self.terminated)

    def _advance_late(self, latency: Latency, rows: npt.NDArray[np.bool_] | None) -> None:
        latency.post(self.commands, rows)
        self.robot.apply(self.action.setpoint, latency.due)
        cast(LateRobot, self.robot).advance_late(self.seconds, latency.waits, rows)

    def snapshot(self, index: int, rng: np.random.Generator) -> Snapshot:
        """A snapshot of one robot, with the state of its random generator."""
        late = None if self.latency is None else self.latency.memory(index)
        return Snapshot(self.robot.snapshot(index), self.task.memory(index), rng.bit_generator.state, late=late)

    def restore(self, index: int, snapshot: Snapshot, rng: np.random.Generator) -> None:
        """Restore one robot and its random generator.

        Raises:
            EnvOptionError: no snapshot, or one of another kind of robot.
        """
        if not isinstance(snapshot, Snapshot):
            raise EnvOptionError(f"{snapshot!r} is no snapshot of an environment")
        if (snapshot.late is None) != (self.latency is None):
            raise EnvOptionError("snapshot cannot be restored: of it and this environment, one has a latency")
        self.task.recall(index, snapshot.task)
        self.robot.restore(index, snapshot.robot)
        if self.latency is not None and snapshot.late is not None:
            self.latency.recall(index, snapshot.late)
        rng.bit_generator.state = dict(snapshot.rng)


def _named(option: str, value: Any, known: Mapping[str, Callable[[], Any]], method: str) -> Any:
    """The object of a name, or a copy of the given object, so that two environments do not share its state."""
    if isinstance(value, str):
        if value not in known:
            raise unknown(option, value, known)
        return known[value]()
    if isinstance(value, type) or not hasattr(value, method):
        raise EnvOptionError(f"{option} {value!r} is neither a name ({', '.join(known)}) nor an object with {method}()")
    return deepcopy(value)
