# SPDX-License-Identifier: BSD-3-Clause
"""Land on a pad, which may move."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sitl.core.array_kernels import Flags, Kernel, Line, Table
from sitl.core.elementary import cos, hypot, sin, sincos
from sitl.core.kernels import law
from sitl.worlds import World

from ..arena import Arena
from ..options import EnvOptionError
from ..rewards import Floats, Step
from ..robots.robot import Robot, floors_of, world_of
from ..senses import LandingRobot, SensingRobot
from .moving import MovingTask, end_lost, note_error
from .target_task import Outcome, checked_far

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


class Landing(NamedTuple):
    """How ``Land`` judges; lengths [m]."""

    pad: float
    progress: float
    far: float
    """Distances from there on count as this one in progress."""
    time: float
    """What a step costs."""
    success_reward: float
    crash_reward: float
    lost: float
    lost_reward: float
    settle: float
    """Time at the start that does not count in the error [s]."""
    lets_down: bool
    """Whether the autopilot puts the robot down."""


class Grounds(NamedTuple):
    """What robots land on, and whether they have."""

    floors: Line
    """Heights of the floors of the robots' worlds [m], shape (count,)."""
    pads: Table
    """Where the pads are [m], shape (count, 3)."""
    landed: Flags
    """Whether the autopilots say so, shape (count,)."""


class SoFar(NamedTuple):
    """What is known of robots before a step, a row each; becomes that of after it."""

    velocity: Table
    """Of the pads at first [m/s], shape (count, 3)."""
    distance: Line
    """From the pad [m]."""
    sinking: Line
    """[m/s]"""
    touched: Table
    """Offset from where a robot touched the ground to the pad; as long as it flies, from where it is [m], (count,
    3)."""
    sums: Table
    """See ``MovingTask.sums``."""
    errors: Line
    """See ``MovingTask.errors``."""


@law
def write_pads(velocity: Table, centre: Table, times: Table, out: Table) -> None:
    """Write where pads are: 10 s there, 10 s back.

    Args:
        velocity: at first [m/s], shape (count, 3).
        centre: where each begins [m], shape (count, 3).
        times: [s], shape (count, k).
        out: [m], shape (count * k, 3).
    """
    for i in range(times.shape[0]):
        for k in range(times.shape[1]):
            there = 10.0 - abs(times[i, k] % 20.0 - 10.0)
            for axis in range(3):
                out[i * times.shape[1] + k, axis] = centre[i, axis] + there * velocity[i, axis]


@law
def judge_land(rule: Landing, state: Table, grounds: Grounds, time: Line, so_far: SoFar, outcome: Outcome) -> None:
    """Judge a step of robots that land.

    Args:
        rule: see ``Landing``.
        state: x, y, z [m], yaw [rad], forward, left, up [m/s] as they really are, shape (count, 8 or more).
        grounds: see ``Grounds``.
        time: of each robot's episode [s], shape (count,).
        so_far: see ``SoFar``.
        outcome: see ``Outcome``; terms of the rewards: progress, time, landing and, if there is a price, the
            loss of the pad.
    """
    pads, success, rewards, terminated, paid = (
        grounds.pads, outcome.success, outcome.rewards, outcome.terminated, outcome.paid
    )  # fmt: skip
    for i in range(rewards.shape[0]):
        x, y, z = pads[i, 0] - state[i, 0], pads[i, 1] - state[i, 1], pads[i, 2] - state[i, 2]
        squared = x * x + y * y + z * z
        distance = math.sqrt(squared)
        so_far.errors[i] = note_error(so_far.sums, i, squared, time[i] >= rule.settle)
        gain = rule.progress * (min(so_far.distance[i], rule.far) - min(distance, rule.far))
        rewards[i] += gain + rule.time
        so_far.distance[i] = distance
        height, climb = state[i, 2] - grounds.floors[i], state[i, 6]
        down = ((height < DOWN and not rule.lets_down) or grounds.landed[i]) and not terminated[i]
        turned = 1.0 if time[i] % 20.0 < 10.0 else -1.0
        s, c = sincos(state[i, 3])
        ahead, left = state[i, 4] * c - state[i, 5] * s, state[i, 4] * s + state[i, 5] * c
        slip = hypot(ahead - turned * so_far.velocity[i, 0], left - turned * so_far.velocity[i, 1])
        if climb < -STANDS or height > LET_DOWN or not rule.lets_down:
            so_far.touched[i, 0], so_far.touched[i, 1], so_far.touched[i, 2] = x, y, z
        on = hypot(so_far.touched[i, 0], so_far.touched[i, 1]) < rule.pad
        success[i] = down and on and slip < SLOW and so_far.sinking[i] < GENTLE
        landing = 0.0
        if down:
            landing = rule.success_reward if success[i] else rule.crash_reward
            rewards[i] += landing
            terminated[i] = True
        paid[0, i], paid[1, i], paid[2, i] = gain, rule.time, landing
        if outcome.crashed[i]:
            paid[0, i], paid[1, i], paid[2, i] = 0.0, 0.0, 0.0
        end_lost(i, distance > rule.lost, rule.lost_reward, outcome, 3)
        if height > LET_DOWN or not rule.lets_down:
            so_far.sinking[i] = 0.0 - climb


_pads, _land = Kernel(write_pads), Kernel(judge_land)


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
        far: distance from which on nearer is worth nothing, and farther costs nothing [m].
        each_second: reward per second.
        success_reward: reward for a landing on the pad.
        lost: distance from the pad beyond which the episode ends [m]; infinite: the arena alone ends it.
        others: further arguments of ``MovingTask``; ``radius`` and ``scale`` have no effect.
    """

    sees_truth = True
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
        far: float = math.inf,
        **others: Any,
    ) -> None:
        super().__init__(**others, lost=lost)
        if not (offset >= 0.0 and pad > 0.0 and speed >= 0.0):
            raise EnvOptionError(f"Land(offset={offset}, pad={pad}, speed={speed}); none below 0, pad above 0")
        self.offset, self.pad, self.speed = offset, pad, speed
        self.progress, self.each_second, self.success_reward = progress, each_second, success_reward
        self.far = checked_far(self, far)

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
        self._velocity = np.zeros((robot.count, 3))
        """Of each robot's pad at first [m/s]."""
        self._distance, self._sinking = np.zeros(robot.count), np.zeros(robot.count)
        self._touched = np.zeros((robot.count, 3))
        """Offset from where it touched the ground to the pad; as long as it flies, from where it is [m]."""

    def _bounded(self, limits: Arena, world: World) -> Arena:
        return limits._replace(low=(*limits.low[:2], -math.inf))

    def _draw(self, index: int, rng: np.random.Generator) -> None:
        offset, heading = rng.uniform(-self.offset, self.offset, 2), rng.uniform(0.0, math.tau)
        self.centre[index, :2] += offset
        self.centre[index, 2] = world_of(self._robot, index).floor_z
        self._velocity[index, :2] = self.speed * cos(heading), self.speed * sin(heading)

    def start(self, index: int, robot: Robot, rng: np.random.Generator) -> None:
        """See ``Task``."""
        super().start(index, robot, rng)
        offset = self.centre[index] - self._sensing.judged_state()[index, :3]
        self._distance[index], self._sinking[index] = np.sqrt((offset * offset).sum()), 0.0
        self._touched[index] = offset

    def along(self, time: Floats) -> Floats:
        """See ``MovingTask``: 10 s there, 10 s back."""
        return self._along(time)

    def _write_along(self, times: Floats, out: Floats) -> None:
        _pads.unchecked()(self._velocity, self.centre, times, out)

    def _from(self) -> Floats:
        """See ``TargetTask``: where the robot really is."""
        return self._sensing.judged_state()

    def _judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        time = np.ascontiguousarray(step.robot.time)
        floors = np.ascontiguousarray(np.broadcast_to(floors_of(step.robot), time.shape), np.float64)
        self._move(time)
        rule = Landing(
            float(self.pad), float(self.progress), float(self.far), float(self.each_second * step.seconds),
            float(self.success_reward), float(self.crash_reward), float(self.lost), float(self.lost_reward),
            float(self.settle),
            self._lets_down,
        )  # fmt: skip
        grounds = Grounds(floors, self._spots, np.ascontiguousarray(self._landing.has_landed()))
        so_far = SoFar(self._velocity, self._distance, self._sinking, self._touched, self.sums, self.errors)
        _land.unchecked()(
            rule, step.judge.true_table(), grounds, time, so_far, self._outcome(rewards, terminated)
        )  # fmt: skip

    def paid_names(self) -> tuple[str, ...]:
        """See ``TargetTask``."""
        return "progress", "time", "landing", *(("lost",) if self.lost_reward else ())

    def memory(self, index: int) -> Any:
        """See ``Task``."""
        numbers = float(self._distance[index]), float(self._sinking[index])
        return *super().memory(index), (self._velocity[index].copy(), *numbers, self._touched[index].copy())

    def recall(self, index: int, memory: Any) -> None:
        """See ``Task``."""
        super().recall(index, memory)
        self._velocity[index], self._distance[index], self._sinking[index], self._touched[index] = memory[5]
