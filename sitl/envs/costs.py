# SPDX-License-Identifier: BSD-3-Clause
"""Costs: what a step violates, beside its reward, as constrained learning (safe RL) wants it.

A cost is a function of a ``Step`` that returns a number of 0 or more for each robot, as a reward term does. Those here
go by where robots really are; where nobody knows that, as of a vehicle at a connection, by the estimate, whatever the
task is judged by.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from copy import deepcopy
from typing import Any

import numpy as np
import numpy.typing as npt

from sitl.core import elementary_arrays as arrays
from sitl.core.array_kernels import Kernel, Line, Table
from sitl.core.kernels import law
from sitl.core.vectors import Vec2
from sitl.worlds.contact import Volume, nearest_of
from sitl.worlds.shapes import to_ned

from .arena import Arena, arena_of, flies
from .options import EnvOptionError, unknown
from .rewards import Floats, Step, Term
from .robots.kind import volume
from .robots.robot import Robot, world_of
from .senses import ReportingRobot, SensingRobot

TOTAL = "cost"
"""Key of the sum in ``info``; those of single costs are "cost_NAME"."""


def state_of(step: Step) -> Floats:
    """True states of robots, or what they believe where nobody knows better, shape (count, 12): see ``SensingRobot``.

    To be read only."""
    if step.judge.knows_truth:
        return step.judge.state()
    robot: Any = step.robot
    out: Floats = robot.state
    return out


@law
def write_distances(solids: Table, positions: Table, radius: float, bottom: float, top: float, out: Line) -> None:
    """Write how far the nearest solid is from each robot [m], below 0 inside; inf: there is none.

    Args:
        solids: rows of a ``Geometry``.
        positions: x, y, z [m] of the robots' bases in the world's frame, shape (count, 3 or more).
        radius: of the robots' volume [m].
        bottom, top: heights of its ends above the base [m].
        out: shape (count,).
    """
    for i in range(out.shape[0]):
        north, east, down = to_ned(positions[i, 0], positions[i, 1], positions[i, 2])
        body = Volume(Vec2(north, east), down - top, down - bottom, radius)
        out[i] = nearest_of(solids, solids.shape[0], body).distance


_distances = Kernel(write_distances)


class _Limit:
    """Base of costs of 1 for each step at whose end a limit is exceeded."""

    reads_scan = False

    def _checked(self, name: str, value: float, unit: str, low: float = 0.0) -> float:
        if not (isinstance(value, int | float | np.number) and low < value < math.inf):
            raise EnvOptionError(f"cost {type(self).__name__}({name}={value!r}); it must be above {low:g} {unit}")
        return float(value)


class Fence(_Limit):
    """1 for each step at whose end the robot is outside of a box. What does not fly is judged in x and y.

    Args:
        box: the box; None: the task's arena, or of a task without one ``arena_of`` the robot.
    """

    name = "fence"

    def __init__(self, box: Arena | None = None) -> None:
        if box is not None and (np.shape(box) != (2, 3) or not (np.array(box[0]) < np.array(box[1])).all()):
            raise EnvOptionError(f"cost Fence(box={box!r}); it must be an Arena of (x, y, z) low < high [m]")
        self.box = None if box is None else Arena(*box)

    def prepare(self, robot: Robot, task: Any) -> None:
        """Called once, when the task is prepared."""
        self._low, self._high = np.zeros((robot.count, 3)), np.zeros((robot.count, 3))
        for index in range(robot.count):
            self.enter(index, robot, task)

    def enter(self, index: int, robot: Robot, task: Any) -> None:
        """The next episode of a robot is in the world that it is in now."""
        arena_at = getattr(task, "arena_at", None)
        arena = self.box or (arena_at(index) if arena_at else arena_of(robot, world=world_of(robot, index)))
        self._low[index], self._high[index] = arena
        if self.box is None:
            self._low[index, 2] = -math.inf  # an arena's floor is where positions are drawn from, and pads lie below it
        if not flies(robot):
            self._low[index, 2], self._high[index, 2] = -math.inf, math.inf

    def __call__(self, step: Step) -> Floats:
        """See ``rewards.Term``."""
        position = state_of(step)[:, :3]
        out: Floats = np.asarray(((position < self._low) | (position > self._high)).any(axis=1), np.float64)
        return out


class Proximity(_Limit):
    """1 for each step at whose end a solid is nearer than ``distance`` [m] to the robot's volume. The floor is none."""

    name = "proximity"

    def __init__(self, distance: float = 0.5) -> None:
        self.distance = self._checked("distance", distance, "m")

    def prepare(self, robot: Robot, task: Any) -> None:
        """Called once, when the task is prepared."""
        vehicle: Any = robot
        body = volume(vehicle.airframe, 0.0) if flies(robot) else robot.volume  # without the way up of a take-off
        self._volume = float(body.radius), float(body.bottom), float(body.top)
        self._worlds = [world_of(robot, index) for index in range(robot.count)]

    def enter(self, index: int, robot: Robot, task: Any) -> None:
        """The next episode of a robot is in the world that it is in now."""
        self._worlds[index] = world_of(robot, index)

    def distances(self, step: Step) -> Floats:
        """Distance of each robot's volume to the nearest solid [m], shape (count,)."""
        positions = np.ascontiguousarray(state_of(step)[:, :3])
        out = np.empty(len(positions))
        rows: dict[int, list[int]] = {}
        for index, world in enumerate(self._worlds):
            rows.setdefault(id(world), []).append(index)
        for which in rows.values():
            found = np.empty(len(which))
            _distances(self._worlds[which[0]].geometry.solids, positions[which], *self._volume, found)
            out[which] = found
        return out

    def __call__(self, step: Step) -> Floats:
        """See ``rewards.Term``."""
        out: Floats = (self.distances(step) < self.distance).astype(np.float64)
        return out


class Tilt(_Limit):
    """1 for each step at whose end the robot leans further than ``angle`` [rad] from upright."""

    name = "tilt"

    def __init__(self, angle: float = 0.35) -> None:
        self.angle = self._checked("angle", angle, "rad")

    def __call__(self, step: Step) -> Floats:
        """See ``rewards.Term``."""
        roll, pitch = state_of(step)[:, 8:10].T
        out: Floats = (arrays.cos(roll) * arrays.cos(pitch) < arrays.cos(np.array([self.angle]))).astype(np.float64)
        return out


class Speed(_Limit):
    """1 for each step at whose end the robot is faster than ``speed`` [m/s]."""

    name = "speed"

    def __init__(self, speed: float = 3.0) -> None:
        self.speed = self._checked("speed", speed, "m/s")

    def __call__(self, step: Step) -> Floats:
        """See ``rewards.Term``."""
        velocity = state_of(step)[:, 4:7]
        out: Floats = ((velocity * velocity).sum(axis=1) > self.speed * self.speed).astype(np.float64)
        return out


class Energy(_Limit):
    """What the battery gives in a step [kJ]: the power at its end times its duration, times ``per_kilojoule``."""

    name = "energy"

    def __init__(self, per_kilojoule: float = 1.0) -> None:
        self.per_kilojoule = self._checked("per_kilojoule", per_kilojoule, "/ kJ")

    def prepare(self, robot: Robot, task: Any) -> None:
        """Called once, when the task is prepared."""
        if not isinstance(robot, ReportingRobot):
            raise EnvOptionError(f"cost 'energy': robot {robot.name!r} has no battery; vehicles with an autopilot do")
        if not getattr(robot, "knows_truth", False):
            robot.ask_for("SYS_STATUS")

    def __call__(self, step: Step) -> Floats:
        """See ``rewards.Term``."""
        robot: Any = step.robot
        volts, amperes = (robot.true_reports() if step.judge.knows_truth else robot.reports)[:, 3:5].T
        out: Floats = self.per_kilojoule * 1e-3 * step.seconds * volts * amperes
        return out


class Crash(_Limit):
    """1 for a step that ends in a crash."""

    name = "crash"

    def __call__(self, step: Step) -> Floats:
        """See ``rewards.Term``."""
        return step.crashed.astype(np.float64)


COSTS: dict[str, Callable[..., Term]] = {
    "fence": Fence,
    "proximity": Proximity,
    "tilt": Tilt,
    "speed": Speed,
    "energy": Energy,
    "crash": Crash,
}
"""By name, with default arguments."""


class Costs:
    """What the option ``costs`` names.

    Args:
        given: names of ``COSTS`` (as text: "proximity+tilt"), objects of their classes, functions of a
            ``Step``, or mappings of "cost" -> a name and arguments by name (data, as recipes have it).

    Raises:
        EnvOptionError: another name or argument, a name twice, or a robot that has no such cost.
    """

    def __init__(self, given: Any) -> None:
        if not isinstance(given, str | Iterable):
            raise EnvOptionError(f"costs = {given!r}; it must be names of {', '.join(COSTS)}, or () for none")
        if isinstance(given, str):
            given = given.split("+")
        listed = [given] if isinstance(given, Mapping) else list(given)
        terms = [_term(one) for one in listed]
        names = [getattr(term, "name", f"term_{k}") for k, term in enumerate(terms)]
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            raise EnvOptionError(f"costs: {twice!r} is given more than once; give one an attribute `name` of its own")
        self._terms = dict(zip(names, terms))

    def __bool__(self) -> bool:
        return bool(self._terms)

    @property
    def reads_scan(self) -> bool:
        """Whether one of them reads the lidar (``senses.reads_scan``)."""
        return any(getattr(term, "reads_scan", True) for term in self._terms.values())

    def prepare(self, robot: Robot, task: Any) -> None:
        """Called once, when the task is prepared."""
        for name, term in self._terms.items():
            if isinstance(term, _Limit) and not isinstance(robot, SensingRobot):
                raise EnvOptionError(f"cost {name!r}: robot {robot.name!r} does not tell its state")
            prepare = getattr(term, "prepare", None)
            if prepare is not None:
                prepare(robot, task)
        self._entering = [term.enter for term in self._terms.values() if hasattr(term, "enter")]

    def enter(self, index: int, robot: Robot, task: Any) -> None:
        """The next episode of a robot is in the world that it is in now."""
        for enter in self._entering:
            enter(index, robot, task)

    def of(self, step: Step) -> dict[str, npt.NDArray[Any]]:
        """Entries of ``info``: each cost of the step, "cost_NAME", and their sum, "cost"; shape (count,)."""
        found = {name: np.broadcast_to(np.asarray(term(step), np.float64), (step.robot.count,))
                 for name, term in self._terms.items()}  # fmt: skip
        total = np.zeros(step.robot.count)
        for one in found.values():
            total = total + one
        return {TOTAL: total, **{f"{TOTAL}_{name}": one for name, one in found.items()}}


def _term(given: Any) -> Term:
    if isinstance(given, Mapping):
        arguments = dict(given)
        name = arguments.pop("cost", None)
        if name not in COSTS:
            raise unknown("costs: cost", name, COSTS)
        try:
            return COSTS[name](**arguments)
        except TypeError as error:
            raise EnvOptionError(f"costs: {dict(given)!r}: {error}") from None
    if isinstance(given, str):
        if given not in COSTS:
            raise unknown("costs: cost", given, COSTS)
        return COSTS[given]()
    if isinstance(given, type) or not callable(given):
        raise EnvOptionError(f"costs: {given!r} is neither a name ({', '.join(COSTS)}) nor a function of a step")
    return deepcopy(given)
