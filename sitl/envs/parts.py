# SPDX-License-Identifier: BSD-3-Clause
"""Observations made of parts, by name: each part is some numbers of a robot, and any parts go together."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from sitl.core import elementary_arrays as arrays
from sitl.core.array_kernels import Kernel, Line, Table
from sitl.core.elementary import sincos
from sitl.core.kernels import law

from .actions import Discrete, Normalised
from .gathering import ACTIONS, CHOSEN, SCAN, STATE, TRUTH, Gathering
from .gathering import REPORTS as REPORTS_
from .gathering import TRUE_REPORTS as TRUE_REPORTS_
from .observations import Digits
from .options import EnvOptionError, unknown
from .pictures import PICTURES
from .robots.robot import Floats, Robot, floors_of
from .senses import FAR, REPORTS, SENSES, TRUE, TRUE_REPORTS, ReportingRobot, SensingRobot

Narrow = npt.NDArray[np.float32]


class Surroundings(Protocol):
    """What parts look at besides the robot: see ``sitl.envs.session.Session``."""

    robot: Robot
    seconds: float
    task: Any
    action: Any
    actions: npt.NDArray[Any]
    acted: npt.NDArray[np.bool_]


class Part(Protocol):
    """Some numbers of each robot."""

    @property
    def columns(self) -> Sequence[str]:
        """Name and unit of each; valid after ``prepare``."""

    @property
    def low(self) -> Sequence[float]:
        """Least value of each; what is beyond is clipped."""

    @property
    def high(self) -> Sequence[float]:
        """Greatest value of each."""

    # reads_scan = False: it reads no lidar (``senses.reads_scan``).

    def prepare(self, session: Surroundings) -> None:
        """Called once, before the first episode, when the task is prepared.

        Raises:
            EnvOptionError: this robot or task has no such part.
        """

    def write(self, out: Narrow) -> None:
        """Write the numbers of now, a row a robot, shape (count, columns)."""

    # A ``GatheredPart`` is written faster, unless it inherits ``gather`` and has a ``write`` of its own.


class GatheredPart(Part, Protocol):
    """One whose numbers a plan gathers, for robots whose arrays stay in place."""

    def gather(self, plan: Gathering) -> None:
        """Plan what ``write`` writes."""


class State:
    """Columns of the robot's state: "pose", "velocity", "attitude", "rates", and with "true_" as they really are."""

    reads_scan = False

    def __init__(self, name: str) -> None:
        self._is_true = name.startswith(TRUE)
        self._sense = sense = SENSES[name.removeprefix(TRUE)]
        self.columns, self.high = sense.columns, sense.bounds
        self.low = [-bound for bound in sense.bounds]
        self._slice = slice(sense.first, sense.first + len(sense.columns))

    def prepare(self, session: Surroundings) -> None:
        """See ``Part``."""
        if not isinstance(session.robot, SensingRobot):
            raise EnvOptionError(f"observation: robot {session.robot.name!r} has no {self.columns[0]!r}")
        self._robot = session.robot

    def write(self, out: Narrow) -> None:
        """See ``Part``."""
        state = self._robot.true_state() if self._is_true else self._robot.state
        out[:] = state[:, self._slice]

    def gather(self, plan: Gathering) -> None:
        """See ``Part``."""
        if self._is_true:
            plan.before(self._robot.true_state)
        plan.take(TRUTH if self._is_true else STATE, self._slice.start, len(self.columns))


@law
def write_headings(state: Table, out: Table, first: int) -> None:
    """Write cosines and sines of headings.

    Args:
        state: of robots (``senses.SensingRobot``), shape (count, 12).
        out: shape (count, n).
        first: column of the cosine.
    """
    for i in range(out.shape[0]):
        s, c = sincos(state[i, 3])
        out[i, first], out[i, first + 1] = c, s


@law
def write_directions(angles: Line, out: Table, first: int) -> None:
    """Write cosines and sines of angles [rad], shape (count,), as ``write_headings`` does."""
    for i in range(out.shape[0]):
        s, c = sincos(angles[i])
        out[i, first], out[i, first + 1] = c, s


_headings, _point = Kernel(write_headings), Kernel(write_directions)


class Heading:
    """Cosine and sine of the heading, which do not jump at +-pi as the yaw of "pose" does."""

    columns = ("cosine of the yaw", "sine of the yaw")
    low, high = (-1.0, -1.0), (1.0, 1.0)

    def prepare(self, session: Surroundings) -> None:
        """See ``Part``."""
        self._robot = session.robot

    def write(self, out: Narrow) -> None:
        """See ``Part``."""
        yaw = self._robot.pose[:, 3]
        out[:, 0], out[:, 1] = arrays.cos(yaw), arrays.sin(yaw)

    def gather(self, plan: Gathering) -> None:
        """See ``Part``."""
        robot: Any = self._robot
        plan.compute(2, lambda table, first: _headings.bind(robot.state, table, first))


class Reported:
    """What a vehicle reports by a message of its own: "acceleration", "battery", "wind",
    "range_finder" (``REPORTS``)."""

    reads_scan = False

    def __init__(self, name: str) -> None:
        self._name, self._report = name, REPORTS[name]
        self.columns, self.low, self.high = self._report.columns, self._report.low, self._report.high

    def prepare(self, session: Surroundings) -> None:
        """See ``Part``."""
        robot = session.robot
        if not isinstance(robot, ReportingRobot):
            raise EnvOptionError(
                f"observation {self._name!r}: robot {robot.name!r} sends no {self._report.message}; vehicles with an "
                "autopilot do"
            )
        robot.ask_for(self._report.message)
        self._robot, first = robot, self._report.first
        self._slice = slice(first, first + len(self.columns))

    def write(self, out: Narrow) -> None:
        """See ``Part``."""
        out[:] = self._robot.reports[:, self._slice]

    def gather(self, plan: Gathering) -> None:
        """See ``Part``."""
        plan.take(REPORTS_, self._slice.start, len(self.columns))


class TrueReport:
    """What a vehicle would report by a message, as it really is: "true_acceleration", "true_battery", "true_wind"."""

    reads_scan = False

    def __init__(self, name: str) -> None:
        self._name, self._report = name, TRUE_REPORTS[name]
        self.columns, self.low, self.high = self._report.columns, self._report.low, self._report.high

    def prepare(self, session: Surroundings) -> None:
        """See ``Part``."""
        robot = session.robot
        if not isinstance(robot, ReportingRobot):
            raise EnvOptionError(
                f"observation {self._name!r}: robot {robot.name!r} has none; vehicles with an autopilot do"
            )
        self._robot, first = robot, self._report.first
        self._slice = slice(first, first + len(self.columns))

    def write(self, out: Narrow) -> None:
        """See ``Part``."""
        out[:] = self._robot.true_reports()[:, self._slice]

    def gather(self, plan: Gathering) -> None:
        """See ``Part``."""
        plan.before(self._robot.true_reports)
        plan.take(TRUE_REPORTS_, self._slice.start, len(self.columns))


class Height:
    """Height above the world's floor [m], as the robot believes, or as it really is."""

    reads_scan = False
    columns = ("height [m]",)
    low, high = (-FAR,), (FAR,)

    def __init__(self, is_true: bool = False) -> None:
        self._is_true = is_true

    def prepare(self, session: Surroundings) -> None:
        """See ``Part``."""
        self._robot: Any = session.robot
        if self._is_true and not isinstance(session.robot, SensingRobot):
            raise EnvOptionError(f"observation 'true_height': robot {session.robot.name!r} does not know it")

    def write(self, out: Narrow) -> None:
        """See ``Part``."""
        pose = self._robot.true_state() if self._is_true else self._robot.pose
        out[:, 0] = pose[:, 2] - floors_of(self._robot)


class Readings:
    """All readings of the lidar [m], from right to left; its range where nothing is in range."""

    def prepare(self, session: Surroundings) -> None:
        """See ``Part``."""
        self._robot = robot = session.robot
        self.columns = tuple(f"range at {math.degrees(angle):.1f} deg [m]" for angle in robot.angles)
        self.low, self.high = [0.0] * len(self.columns), [robot.range_max] * len(self.columns)

    def write(self, out: Narrow) -> None:
        """See ``Part``."""
        out[:] = self._robot.scan

    def gather(self, plan: Gathering) -> None:
        """See ``Part``."""
        plan.take(SCAN, 0, len(self.columns))


class DigitReadings:
    """The paper's digits (``observations.Digits``) as real numbers."""

    def prepare(self, session: Surroundings) -> None:
        """See ``Part``."""
        self._robot, self._digits = session.robot, Digits()
        space: Any = self._digits.space(session.robot)
        self.high = (space.nvec - 1).tolist()
        self.low, self.columns = [0.0] * len(self.high), tuple(f"digit {k} [m]" for k in range(len(self.high)))

    def write(self, out: Narrow) -> None:
        """See ``Part``."""
        out[:] = self._digits.observe(self._robot)


class LastAction:
    """The agent's last action; zeros before the first one of an episode. Discrete actions are one-hot."""

    reads_scan = False

    def prepare(self, session: Surroundings) -> None:
        """See ``Part``."""
        self._session, space = session, session.action.space
        self._rows = len(session.action.names) if isinstance(session.action, Discrete) else 0
        if self._rows:
            self.columns = tuple(f"last action was {name!r}" for name in session.action.names)
            self.low, self.high = [0.0] * self._rows, [1.0] * self._rows
        else:
            self.low, self.high = space.low.tolist(), space.high.tolist()
            columns, share = session.action.setpoint.columns, isinstance(session.action, Normalised)
            names = [
                columns[c].partition(" [")[0] + " [-1, 1]" if share else columns[c] for c in session.action.columns
            ]
            self.columns = tuple(f"last {name}" for name in names)

    def write(self, out: Narrow) -> None:
        """See ``Part``."""
        actions = self._session.actions
        out[:] = np.eye(self._rows, dtype=np.float32)[actions] if self._rows else actions
        out[~self._session.acted] = 0.0

    def gather(self, plan: Gathering) -> None:
        """See ``Part``."""
        plan.take(CHOSEN if self._rows else ACTIONS, 0, len(self.columns))


OFFSET = ("ahead [m]", "to the left [m]", "above [m]")


class Path:
    """Vectors to the next ``count`` targets of the task: forward, left, up [m] in the frame of the robot's heading.

    "goal" is the vector to the next one alone.
    """

    reads_scan = False

    def __init__(self, count: int = 3) -> None:
        self.count = count
        targets = ("target",) if count == 1 else tuple(f"target {k + 1}" for k in range(count))
        self.columns = tuple(f"{target} {name}" for target in targets for name in OFFSET)
        self.high = (3.0 * FAR,) * (3 * count)
        self.low = (-3.0 * FAR,) * (3 * count)

    def prepare(self, session: Surroundings) -> None:
        """See ``Part``."""
        if not hasattr(session.task, "offsets"):
            raise EnvOptionError(f'observation "goal", "path": task {session.task!r} has no target')
        self._task = session.task

    def write(self, out: Narrow) -> None:
        """See ``Part``."""
        out[:] = self._task.offsets(self.count).reshape(out.shape)

    def gather(self, plan: Gathering) -> None:
        """See ``Part``."""
        task, width = self._task, len(self.columns)
        writes = getattr(task, "offsets_writer", lambda count, table, first: None)

        def maker(table: Floats, first: int) -> Callable[[], object]:
            def copy() -> None:
                table[:, first : first + width] = task.offsets(self.count).reshape(-1, width)

            found: Callable[[], object] | None = writes(self.count, table, first)
            return found or copy

        plan.compute(width, maker)


class Route:
    """Where the route to the target leads next, as a planner with a map tells it: forward and left [m] in the frame of
    the robot's heading, and the length of the shortest obstacle-free path.

    Args:
        ahead: how far along the path [m].
    """

    columns = ("route ahead [m]", "route to the left [m]", "length of the shortest path [m]")
    reads_scan = False

    def __init__(self, ahead: float = 2.0) -> None:
        if not 0.0 < ahead < FAR:
            raise EnvOptionError(f"Route(ahead={ahead!r}); it must be above 0 and below {FAR:g} m")
        self.ahead = float(ahead)
        self.low, self.high = (-self.ahead, -self.ahead, 0.0), (self.ahead, self.ahead, 3.0 * FAR)

    def prepare(self, session: Surroundings) -> None:
        """See ``Part``."""
        if not hasattr(session.task, "plan_routes"):
            raise EnvOptionError(
                f'observation "route": task {session.task!r} plans no path; Among, and the ids with it, do: '
                "CopterForest, CopterRooms, RoverLabyrinth"
            )
        self._task = session.task
        session.task.plan_routes()
        self._table = np.zeros((session.robot.count, 3))

    def write(self, out: Narrow) -> None:
        """See ``Part``."""
        self._task.routes(self.ahead, self._table, 0)
        out[:] = self._table

    def gather(self, plan: Gathering) -> None:
        """See ``Part``."""
        plan.compute(3, lambda table, first: lambda: self._task.routes(self.ahead, table, first))


class GoalHeading:
    """Difference between the heading that the task wants and the robot's."""

    columns = ("cosine of the heading error", "sine of the heading error, counter-clockwise")
    low, high = (-1.0, -1.0), (1.0, 1.0)

    def prepare(self, session: Surroundings) -> None:
        """See ``Part``."""
        if not hasattr(session.task, "turns"):
            raise EnvOptionError(f'observation "goal_heading": task {session.task!r} wants no heading')
        self._task = session.task

    def write(self, out: Narrow) -> None:
        """See ``Part``."""
        turns = self._task.turns()
        out[:, 0], out[:, 1] = arrays.cos(turns), arrays.sin(turns)

    def gather(self, plan: Gathering) -> None:
        """See ``Part``."""
        task = self._task

        def maker(table: Floats, first: int) -> Callable[[], object]:
            return lambda: _point.unchecked()(np.ascontiguousarray(task.turns(), np.float64), table, first)

        plan.compute(2, maker)


PARTS: dict[str, Callable[[], Part]] = {
    **{name: lambda name=name: State(name) for name in (*SENSES, *(TRUE + sense for sense in SENSES))},  # type: ignore[misc]
    "heading": Heading,
    **{name: lambda name=name: Reported(name) for name in REPORTS},  # type: ignore[misc]
    **{name: lambda name=name: TrueReport(name) for name in TRUE_REPORTS},  # type: ignore[misc]
    "height": Height,
    "true_height": lambda: Height(is_true=True),
    "scan": Readings,
    "digits": DigitReadings,
    "last_action": LastAction,
    "goal": lambda: Path(1),
    "path": Path,
    "route": Route,
    "goal_heading": GoalHeading,
}
"""By name."""


def part_of(part: str | Part) -> Part:
    """A part by its name, or the part itself.

    Raises:
        EnvOptionError: no such part.
    """
    if isinstance(part, str):
        if part in PICTURES:
            raise EnvOptionError(
                f"observation: {part!r} is a picture, which is no row of numbers; it is alone ({part!r}), or an entry "
                f'of a dict ("{part}+velocity")'
            )
        if part not in PARTS:
            raise unknown("observation: part", part, PARTS)
        return PARTS[part]()
    if isinstance(part, type) or not hasattr(part, "write"):
        raise EnvOptionError(f"observation: {part!r} is neither a part's name ({', '.join(PARTS)}) nor a part")
    return part
