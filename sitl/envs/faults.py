# SPDX-License-Identifier: BSD-3-Clause
"""Faults of episodes: which one, and when, is drawn for each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt

from sitl.errors import OptionError
from sitl.vehicle.faults import LATEST_S, Failure

from .options import EnvOptionError
from .robots.robot import Robot

Faults = Mapping[str, float | tuple[float, float]]
"""Fault as ``Failure.of_text`` has it, without times ("" for none) -> when it begins in an episode: seconds, or
(earliest, latest) of a uniform distribution. It stays until the episode ends."""
NEVER = float("inf")


@runtime_checkable
class FailingRobot(Protocol):
    """A robot in which things can fail."""

    def check_failure(self, failure: Failure) -> None:
        """OptionError when the robots have no such fault."""

    def fail(self, index: int, failure: Failure) -> None:
        """Let something fail in one robot; times count from now. After its ``reset``."""


def amount_of(name: str, values: Any, robot: Robot) -> Failure:
    """A fault whose amount is drawn for each episode (``Randomise``).

    Args:
        name: of the fault, as "gps/wrong", "motor:2" or "SIM_WIND_SPD".
        values: (low, high), or a function.
        robot: that fails.

    Raises:
        EnvOptionError: no such fault, it takes no amount, or a value that it cannot have.
    """
    if not isinstance(robot, FailingRobot):
        raise EnvOptionError(f"randomise: {name}: robot {robot.name!r} has no faults; vehicles with an autopilot do")
    try:
        failure = Failure.of_text(name)
        if "=" in name or "@" in name:
            raise OptionError(f"fault {name!r}: amounts are drawn, and it begins with the episode: neither is said")
        low, high = (1.0, 1.0) if callable(values) else values
        if not low <= high:
            raise OptionError(f"fault {name!r}: {values!r} is not (low, high)")
        for share in () if callable(values) else (0.0, 1.0, 0.618):  # the last for what takes whole numbers alone
            robot.check_failure(replace(failure, amount=low + share * (high - low)))
    except OptionError as error:
        raise EnvOptionError(f"randomise: {error}") from None
    return failure


def drawn(failure: Failure, amount: float, robot: Robot) -> Failure:
    """A fault with the amount that was drawn.

    Raises:
        EnvOptionError: it cannot have that.
    """
    try:
        found = replace(failure, amount=amount)
        if isinstance(robot, FailingRobot):
            robot.check_failure(found)
    except OptionError as error:
        raise EnvOptionError(f"randomise: {error}") from None
    return found


class EpisodeFaults:
    """Draws a fault for each episode, each as likely.

    Args:
        faults: see ``Faults``.
        robot: robot that fails.

    Raises:
        EnvOptionError: a fault that the robot does not have, or a time that cannot be.
    """

    def __init__(self, faults: Any, robot: Robot) -> None:
        if not isinstance(faults, Mapping) or not faults:
            raise EnvOptionError(f"faults = {faults!r}; it must map faults to their times")
        if not isinstance(robot, FailingRobot):
            raise EnvOptionError(f"faults: robot {robot.name!r} has none; vehicles with an autopilot do")
        self._robot = robot
        self._choices = [self._choice(text, when) for text, when in faults.items()]
        self.number = np.zeros(robot.count, np.int64)
        """Of the fault of each robot's episode, from 1 in the order of the option; 0: none."""
        self.begins = np.full(robot.count, NEVER)
        """When it begins in the episode [s]."""

    def _choice(self, text: Any, when: Any) -> tuple[Failure | None, float, float]:
        try:
            low, high = (float(t) for t in when) if isinstance(when, tuple | list) else (float(when),) * 2
        except (TypeError, ValueError):
            low = high = -1.0
        if not 0.0 <= low <= high <= LATEST_S:
            raise EnvOptionError(f"faults: {text!r}: {when!r} is neither a time [s] nor (earliest, latest)")
        try:
            failure = Failure.of_text(text) if text else None
            if failure is not None and (failure.begin or failure.end is not None):
                raise OptionError(f"fault {text!r}: its time stands behind it, as {{'gps': (5, 20)}}")
            if failure is not None and isinstance(self._robot, FailingRobot):
                self._robot.check_failure(failure)
        except OptionError as error:
            raise EnvOptionError(f"faults: {error}") from None
        return failure, low, high

    def unreached(self, steps: int | None, step_s: float) -> str:
        """Which fault begins in no episode of so many steps [s each], and why; "": each may."""
        last = NEVER if steps is None or steps < 0 else steps * step_s
        for failure, earliest, _ in self._choices:
            if failure is not None and earliest >= last:
                title = str(failure).partition("@")[0]
                return f"faults: {title} begins at {earliest:g} s, and an episode of {steps} steps ends at {last:g} s"
        return ""

    def begin(self, index: int, rng: np.random.Generator) -> None:
        """Draw for the next episode of one robot, which has just been reset."""
        number = int(rng.integers(len(self._choices)))
        failure, low, high = self._choices[number]
        at = float(rng.uniform(low, high))
        self.number[index], self.begins[index] = (number + 1, at) if failure is not None else (0, NEVER)
        if failure is not None:
            self._robot.fail(index, replace(failure, begin=at))

    def seen(self, time: npt.NDArray[np.float64]) -> npt.NDArray[np.int64]:
        """Number of the fault of each robot that has begun by its time in the episode [s]; 0: none."""
        return np.where(time >= self.begins, self.number, 0)

    def memory(self, index: int) -> tuple[int, float]:
        """What ``recall`` needs."""
        return int(self.number[index]), float(self.begins[index])

    def recall(self, index: int, memory: tuple[int, float]) -> None:
        """Go on from there; the robot's snapshot has the fault itself."""
        self.number[index], self.begins[index] = memory
