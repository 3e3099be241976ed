# SPDX-License-Identifier: BSD-3-Clause
"""Actions: an action space, and the set-point of each action; the kinds of set-points with their units."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from operator import index
from typing import Any, Protocol

import gymnasium as gym
import numpy as np
import numpy.typing as npt
from gymnasium.error import InvalidAction

from sitl.core.array_kernels import IntLine, Kernel, Line, NarrowLine, NarrowTable, Table
from sitl.core.kernels import law

from .options import EnvOptionError


@dataclass(frozen=True)
class Setpoint:
    """A kind of set-point; one set-point is a row of numbers."""

    name: str
    columns: tuple[str, ...]
    """Name and unit of each number."""
    only: str = ""
    """Where alone it can be had, for messages; "": wherever the robot takes it."""

    @property
    def width(self) -> int:
        """Number of columns."""
        return len(self.columns)


DRIVE = Setpoint("drive", ("forward [m/s]", "turn [rad/s]"))
"""Speeds of a robot without autopilot; turn is counter-clockwise seen from above."""
RC_OVERRIDE = Setpoint("rc", tuple(f"channel {k} [us]" for k in range(1, 9)))
"""RC_CHANNELS_OVERRIDE; 0 releases a channel."""
LOITER_STICKS = Setpoint("loiter", RC_OVERRIDE.columns)
"""RC_CHANNELS_OVERRIDE in LOITER: sticks ask a copter for velocities, and centred ones hold the position."""
VELOCITY = Setpoint("velocity", ("forward [m/s]", "left [m/s]", "up [m/s]", "turn [rad/s]"))
"""SET_POSITION_TARGET_LOCAL_NED, velocities along the body's heading; turn counter-clockwise."""
POSITION = Setpoint("position", ("x [m]", "y [m]", "z [m]", "yaw [rad]"))
"""SET_POSITION_TARGET_LOCAL_NED, a position in the frame of world files."""
ATTITUDE = Setpoint("attitude", ("roll [rad]", "pitch [rad]", "turn [rad/s]", "climb or throttle [-1, 1]"))
"""SET_ATTITUDE_TARGET; roll to the right, pitch up, turn counter-clockwise."""
ACCELERATION = Setpoint("acceleration", ("forward [m/s^2]", "left [m/s^2]", "up [m/s^2]", "turn [rad/s]"))
"""SET_POSITION_TARGET_LOCAL_NED, accelerations along the body's heading; turn counter-clockwise."""
THRUST = Setpoint("thrust", ("roll [rad]", "pitch [rad]", "turn [rad/s]", "thrust [0, 1]"))
"""SET_ATTITUDE_TARGET as ``ATTITUDE``, but with a thrust, a share of the greatest, in place of the climb rate."""
RATES = Setpoint("rates", ("roll rate [rad/s]", "pitch rate [rad/s]", "turn [rad/s]", "thrust [0, 1]"))
"""SET_ATTITUDE_TARGET with rates of the body alone (roll to the right, pitch up) and a thrust."""
MOTORS = Setpoint(
    "motors",
    tuple(f"motor {k} [0, 1]" for k in range(1, 9)),
    only="motors are driven directly, past the autopilot, by no message of MAVLink: of copters in process on native "
    "physics only",
)
"""Controls of a copter's motors, as an autopilot's outputs would be: the direct path, no autopilot behind it."""

SETPOINTS = {
    kind.name: kind
    for kind in (DRIVE, RC_OVERRIDE, LOITER_STICKS, VELOCITY, POSITION, ATTITUDE, ACCELERATION, THRUST, RATES, MOTORS)
}


Floats = npt.NDArray[np.float64]


class Action(Protocol):
    """Converts actions of one robot or many (a row a robot) to set-points."""

    setpoint: Setpoint
    """The kind of set-point; it gives the meaning and unit of each column."""

    @property
    def space(self) -> gym.Space[Any]:
        """Action space of one robot."""

    def buffer(self, count: int) -> npt.NDArray[Any]:
        """A zero array for the actions of ``count`` robots, shape (count,) or (count, columns)."""

    def check(self, action: Any) -> Any:
        """One robot's action as a row of the array that ``buffer`` returns.

        Raises:
            InvalidAction: it is not in the space.
        """

    # def take(self, actions, out) -> bool: many at once, see ``Continuous.take``; without it each is checked alone.
    # def clip(self, action), def clip_all(self, actions, out): see ``Continuous``; without them, and for the option
    # ``clip_actions=False``, actions outside of the space are refused.

    def commands(self, actions: npt.NDArray[Any], out: Floats) -> None:
        """Write the set-points of the actions into ``out``, shape (count, setpoint.width), in the units of
        ``setpoint``."""


def _is_row(row: Any, width: int) -> bool:
    """Whether ``row`` is ``width`` finite numbers."""
    try:
        numbers = np.asarray(row, np.float64)
    except (TypeError, ValueError):
        return False
    return numbers.shape == (width,) and bool(np.all(np.isfinite(numbers)))


@law
def take_boxed(actions: NarrowTable, low: NarrowLine, high: NarrowLine, out: Table) -> bool:
    """Copy actions, shape (count, n), if all are within their bounds, shape (n,); tells whether they are."""
    for i in range(actions.shape[0]):
        for k in range(actions.shape[1]):
            if not low[k] <= actions[i, k] <= high[k]:
                return False
    for i in range(actions.shape[0]):
        for k in range(actions.shape[1]):
            out[i, k] = float(actions[i, k])
    return True


@law
def take_chosen(actions: IntLine, count: int, out: IntLine) -> bool:
    """Copy numbers of actions if all are from 0 to below ``count``; tells whether they are."""
    for i in range(actions.shape[0]):
        if not 0 <= actions[i] < count:
            return False
    for i in range(actions.shape[0]):
        out[i] = actions[i]
    return True


_take, _choose = Kernel(take_boxed), Kernel(take_chosen)


class Discrete:
    """A table of set-points; action k is row k.

    Args:
        setpoint: kind of set-point of the rows.
        rows: name of the action -> its set-point, in the units of ``setpoint``.
    """

    def __init__(self, setpoint: Setpoint, rows: Mapping[str, Sequence[float]]) -> None:
        self.setpoint = setpoint
        self.names = tuple(rows)
        for name, row in rows.items():
            if not _is_row(row, setpoint.width):
                raise EnvOptionError(f"action {name!r} = {row!r}; it must be {setpoint.width} finite numbers: "
                                     f"{', '.join(setpoint.columns)}")  # fmt: skip
        if not rows:
            raise EnvOptionError("a table of actions needs a row")
        self.table = np.array(list(rows.values()), np.float64)
        self.space: gym.spaces.Discrete = gym.spaces.Discrete(len(rows))
        self._count = len(rows)

    def buffer(self, count: int) -> npt.NDArray[Any]:
        """See ``Action``."""
        return np.zeros(count, np.int64)

    def check(self, action: Any) -> int:
        """See ``Action``."""
        try:
            number = index(action)
        except TypeError:
            number = -1
        if 0 <= number < self._count:
            return number
        names = ", ".join(f"{k} {name}" for k, name in enumerate(self.names))
        raise InvalidAction(f"action {action!r} is not in {self.space}: {names}")

    def take(self, actions: npt.NDArray[Any], out: npt.NDArray[np.int64]) -> bool:
        """See ``Continuous.take``; actions of shape (count,)."""
        if actions.dtype.kind not in "iu" or actions.shape != out.shape:
            return False
        return bool(_choose.unchecked()(np.ascontiguousarray(actions, np.int64), self._count, out))

    def commands(self, actions: npt.NDArray[Any], out: Floats) -> None:
        """See ``Action``."""
        self.table.take(actions, 0, out, "clip")

    def nearest(self, command: Floats) -> np.int64:
        """The action whose set-point is nearest to one, of shape (setpoint.width,); columns count by their range."""
        span = np.ptp(self.table, axis=0)
        away = (self.table - command) / np.where(span > 0.0, span, 1.0)
        return np.int64((away * away).sum(axis=1).argmin())


class Continuous:
    """A box of set-points.

    Args:
        setpoint: kind of set-point.
        low, high: limits of each number of the action, in the set-point's units.
        columns: columns of the set-point that the action sets; the others stay 0. None: all.
    """

    def __init__(
        self, setpoint: Setpoint, low: Sequence[float], high: Sequence[float], columns: Sequence[int] | None = None
    ) -> None:
        self.setpoint = setpoint
        self.columns = list(range(setpoint.width)) if columns is None else list(columns)
        if len(set(self.columns)) != len(self.columns) or not set(self.columns) <= set(range(setpoint.width)):
            raise EnvOptionError(f"columns {columns!r}: each must be another of 0 .. {setpoint.width - 1}")
        first = self.columns[0] if self.columns else 0
        together = self.columns == list(range(first, first + len(self.columns)))
        self._slice = slice(first, first + len(self.columns)) if together else self.columns
        if len(low) != len(self.columns) or len(high) != len(self.columns):
            raise EnvOptionError(f"limits {low!r} .. {high!r} are not {len(self.columns)} numbers each")
        if not all(a < b for a, b in zip(low, high)):
            raise EnvOptionError(f"limits {low!r} .. {high!r}: each low must be less than its high")
        self.space = gym.spaces.Box(np.array(low, np.float32), np.array(high, np.float32))
        self._low, self._high = self.space.low.tolist(), self.space.high.tolist()

    def buffer(self, count: int) -> npt.NDArray[Any]:
        """See ``Action``."""
        return np.zeros((count, len(self.columns)))

    def check(self, action: Any) -> Any:
        """See ``Action``."""
        numbers = self._within(action)
        if numbers is not None:
            return numbers
        names = ", ".join(
            f"{self.setpoint.columns[c]} {a:g} .. {b:g}" for c, a, b in zip(self.columns, self._low, self._high)
        )
        raise InvalidAction(f"action {action!r} is not in {self.space}: {names}")

    def _within(self, action: Any) -> Any:
        """The action as a row, if it is in the space."""
        try:
            numbers = np.asarray(action, np.float32).tolist()
            if len(numbers) != len(self._low):
                return None
            for a, x, b in zip(self._low, numbers, self._high):
                if not a <= x <= b:
                    return None
        except (TypeError, ValueError):
            return None
        return numbers

    def clip(self, action: Any) -> Any:
        """As ``check``, but finite numbers outside of their limits become the limits."""
        numbers = self._within(action)
        if numbers is not None:
            return numbers
        row = np.empty((1, len(self.columns)))
        try:
            is_finite = self.clip_all(np.asarray(action, np.float64)[np.newaxis], row)
        except (TypeError, ValueError):
            is_finite = False
        return row[0].tolist() if is_finite else self.check(action)

    def clip_all(self, actions: npt.NDArray[Any], out: Floats) -> bool:
        """``clip`` of an action for each row of ``out``; False: one of them is not finite, or they have another shape,
        and nothing is written."""
        if actions.shape != out.shape or actions.dtype.kind not in "fiu" or not np.isfinite(actions).all():
            return False
        out[...] = np.clip(actions.astype(np.float64), self._low, self._high).astype(np.float32)
        return True

    def take(self, actions: npt.NDArray[Any], out: Floats) -> bool:
        """Write actions of many robots, shape (count, columns), as ``check`` gives them, into an array that ``buffer``
        returned. False: an action is not in the space, or they are no such array; nothing is written."""
        if actions.dtype.kind not in "fiu" or actions.shape != out.shape:
            return False
        return bool(_take.unchecked()(np.ascontiguousarray(actions, np.float32), self.space.low, self.space.high, out))

    def commands(self, actions: npt.NDArray[Any], out: Floats) -> None:
        """See ``Action``."""
        out[:, self._slice] = actions

    def nearest(self, command: Floats) -> npt.NDArray[np.float32]:
        """The action whose set-point is nearest to one, of shape (setpoint.width,)."""
        wanted = np.asarray(command, np.float64)[self.columns].astype(np.float32)
        return np.clip(wanted, self.space.low, self.space.high)


@law
def scale_actions(actions: Table, columns: IntLine, middle: Line, half: Line, out: Table) -> None:
    """Write set-points of actions within [-1, 1].

    Args:
        actions: shape (count, n).
        columns: of ``out``, for each number of an action, shape (n,).
        middle, half: middle and half of the range of each number, in its unit, shape (n,).
        out: shape (count, width).
    """
    for i in range(actions.shape[0]):
        for k in range(actions.shape[1]):
            out[i, columns[k]] = middle[k] + half[k] * actions[i, k]


_scale = Kernel(scale_actions)


class Normalised(Continuous):
    """A box of set-points whose actions are all within [-1, 1]: -1 is the low limit, 1 the high one.

    Args:
        box: the actions in their units.
    """

    def __init__(self, box: Continuous) -> None:
        super().__init__(box.setpoint, box.space.low.tolist(), box.space.high.tolist(), box.columns)
        low, high = box.space.low.astype(np.float64), box.space.high.astype(np.float64)
        self._middle, self._half = 0.5 * (low + high), 0.5 * (high - low)
        self._numbers = np.array(self.columns, np.int64)
        self.limits = tuple(zip(self._low, self._high))
        """(Low, high) of each number in the set-point's unit."""
        self.space = gym.spaces.Box(-1.0, 1.0, (len(self.columns),), np.float32)
        self._low, self._high = self.space.low.tolist(), self.space.high.tolist()

    def commands(self, actions: npt.NDArray[Any], out: Floats) -> None:
        """See ``Action``."""
        _scale.unchecked()(actions, self._numbers, self._middle, self._half, out)

    def nearest(self, command: Floats) -> npt.NDArray[np.float32]:
        """See ``Continuous``."""
        share = (np.asarray(command, np.float64)[self.columns] - self._middle) / self._half
        return np.clip(share, -1.0, 1.0).astype(np.float32)
