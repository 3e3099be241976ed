# SPDX-License-Identifier: BSD-3-Clause
"""Land on a pad, which may move."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from sitl.core import elementary_arrays as arrays
from sitl.core.elementary import cos, sin

from ..options import EnvOptionError
from ..rewards import Floats, Step
from ..robots.robot import Robot
from ..senses import LandingRobot, SensingRobot
from .moving import MovingTask

SLOW, GENTLE = 0.5, 1.0
"""Greatest horizontal speed relative to the pad, and speed of sinking, of a landing that is success [m/s]."""
DOWN = 0.12
"""The robot has touched down when its base is so little above the floor [m], or when its autopilot says so."""
LET_DOWN = 0.35
"""Height below which a vehicle that runs elsewhere is put down by its autopilot [m].

Its own idea of its height is wrong by decimetres: an agent that has learnt to touch down does so above the ground, or
stands on it and goes on flying.
"""


STANDS = 0.1
"""A vehicle that runs elsewhere and sinks no faster than this near the ground stands on it [m/s].

It reports its landing seconds later, and its estimate of its position moves on by decimetres meanwhile.
"""


class Land(MovingTask):
    """Land softly on a pad on the floor.

    Reward of a step: ``progress`` times the decrease of the distance to the pad [m], plus ``each_second`` times the
    step's seconds. Touching the floor ends the episode. It is success, with ``success_reward``, on the pad, below
    0.5 m/s relative to the pad and with a descent rate below 1 m/s; else the reward is ``crash_reward``.

    "goal" and "path" are exact vectors to the pad, and the landing is judged by the robot's true position. The true
    height of a vehicle in another process is unknown. There, if the pad does not move, the autopilot lands the vehicle
    below 0.35 m, and the episode ends when the autopilot reports a landing (EXTENDED_SYS_STATE); it is judged by
    where it stopped sinking.

    Args:
        offset: greatest distance of the random pad from the start, along each horizontal axis [m].
        pad: radius of the pad [m].
        speed: speed of the pad, in a random direction that reverses every 10 s [m/s].
        progress: reward for each metre nearer.
        each_second: reward per second.
        success_reward: reward for a landing on the pad.
        lost: distance from the pad beyond which the episode ends [m]; infinite: the arena alone ends it.
        others: further arguments of ``MovingTask``; ``radius`` and ``scale`` have no effect.
    """

    lands = True
    """It ends on the ground: a guard's floor must let it down there."""

    def __init__(
        self,
        offset: float = 5.0,
        pad: float = 0.5,
        speed: float = 0.0,
        progress: float = 1.0,
        each_second: float = -0.2,
        success_reward: float = 20.0,
        lost: float = math.inf,
        **others: Any,
    ) -> None:
        super().__init__(**others, lost=lost)
        if not (offset >= 0.0 and pad > 0.0 and speed >= 0.0):
            raise EnvOptionError(f"Land(offset={offset}, pad={pad}, speed={speed}); none below 0, pad above 0")
        self.offset, self.pad, self.speed = offset, pad, speed
        self.progress, self.each_second, self.success_reward = progress, each_second, success_reward

    def prepare(self, robot: Robot) -> None:
        """See ``Task``."""
        if not isinstance(robot, SensingRobot):
            raise EnvOptionError(f"task: robot {robot.name!r} cannot land")
        super().prepare(robot)
        if not self.flies:
            raise EnvOptionError(f"task: robot {robot.name!r} does not fly, so it cannot land")
        if not isinstance(robot, LandingRobot):
            raise EnvOptionError(f"task: robot {robot.name!r} does not say when it has landed")
        robot.ask_for("EXTENDED_SYS_STATE")
        self._sensing: SensingRobot = robot
        self._landing: LandingRobot = robot
        self._lets_down = self.speed == 0.0 and robot.let_down(LET_DOWN)
        self._limits = self._limits._replace(low=(*self._limits.low[:2], -math.inf))
        self._velocity = np.zeros((robot.count, 3))
        """Of each robot's pad at first [m/s]."""
        self._distance, self._sinking = np.zeros(robot.count), np.zeros(robot.count)
        self._touched = np.zeros((robot.count, 3))
        """Way from where it touched the ground to the pad; as long as it flies, from where it is [m]."""

    def _draw(self, index: int, rng: np.random.Generator) -> None:
        way, heading = rng.uniform(-self.offset, self.offset, 2), rng.uniform(0.0, math.tau)
        self.centre[index, :2] += way
        self.centre[index, 2] = self._robot.world.floor_z
        self._velocity[index, :2] = self.speed * cos(heading), self.speed * sin(heading)

    def start(self, index: int, robot: Robot, rng: np.random.Generator) -> None:
        """See ``Task``."""
        super().start(index, robot, rng)
        way = self.centre[index] - self._sensing.judged_state()[index, :3]
        self._distance[index], self._sinking[index] = np.sqrt((way * way).sum()), 0.0
        self._touched[index] = way

    def along(self, time: Floats) -> Floats:
        """See ``MovingTask``: 10 s there, 10 s back."""
        there = 10.0 - np.abs(time % 20.0 - 10.0)
        out: Floats = self.centre[:, None] + there[..., None] * self._velocity[:, None]
        return out

    def ways(self, count: int) -> Floats:
        """See ``PlacesTask``: by where the robot really is."""
        return self.ways_from(self._sensing.judged_state()[:, :4], count)

    def _judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        time, state = step.robot.time, self._sensing.judged_state()
        self.places[:, 0] = pad = self.along(time[:, None])[:, 0]
        way = pad - state[:, :3]
        squared = (way * way).sum(axis=1)
        distance = np.sqrt(squared)
        self._note_errors(time, squared)
        gain, spent = self.progress * (self._distance - distance), self.each_second * step.seconds
        rewards += gain + spent
        self._distance = distance
        height = state[:, 2] - step.robot.world.floor_z
        touches = (height < DOWN) & (not self._lets_down)
        down = (touches | self._landing.has_landed()) & ~terminated
        turned = np.where(time % 20.0 < 10.0, 1.0, -1.0)[:, None]
        c, s = arrays.cos(state[:, 3]), arrays.sin(state[:, 3])
        east = np.stack([state[:, 4] * c - state[:, 5] * s, state[:, 4] * s + state[:, 5] * c], axis=1)
        slip = arrays.hypot(*(east - turned * self._velocity[:, :2]).T)
        flies = (state[:, 6] < -STANDS) | (height > LET_DOWN) | (not self._lets_down)
        self._touched[flies] = way[flies]
        on = arrays.hypot(self._touched[:, 0], self._touched[:, 1]) < self.pad
        self.success = down & on & (slip < SLOW) & (self._sinking < GENTLE)
        rewards[self.success] += self.success_reward
        rewards[down & ~self.success] += self.crash_reward
        landing = self.success_reward * self.success + self.crash_reward * (down & ~self.success)
        step.note(progress=gain, time=spent, landing=landing)
        terminated |= down
        self._end_lost(step, distance > self.lost, rewards, terminated)
        is_agents = height > (LET_DOWN if self._lets_down else -math.inf)
        self._sinking = np.where(is_agents, 0.0 - state[:, 6], self._sinking)

    def memory(self, index: int) -> Any:
        """See ``Task``."""
        numbers = float(self._distance[index]), float(self._sinking[index])
        return *super().memory(index), (self._velocity[index].copy(), *numbers, self._touched[index].copy())

    def recall(self, index: int, memory: Any) -> None:
        """See ``Task``."""
        super().recall(index, memory)
        self._velocity[index], self._distance[index], self._sinking[index], self._touched[index] = memory[5]
