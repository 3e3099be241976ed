# SPDX-License-Identifier: BSD-3-Clause
"""Domain randomisation: properties of the robot, and its latency, drawn anew for every episode."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from sitl.vehicle.faults import Failure, is_fault
from sitl.vehicles import Airframe
from sitl.vehicles.airframe import Value
from sitl.vehicles.properties.property import Property

from .faults import FailingRobot, amount_of, drawn
from .latency import LATENCY, Latency
from .options import EnvOptionError, unknown
from .robots.robot import Robot

Range = tuple[Value, Value]
Randomise = str | Mapping[str, Range | Callable[[np.random.Generator], Any] | int]
"""Property, or fault -> (low, high) of a uniform distribution, or a function that draws a value; DRAWS -> number of
sets; IDENTIFIED -> whether the intervals of the airframe are among them. IDENTIFIED itself: only these. Vectors are
drawn element by element. A fault ("gps/wrong", "motor:2", "SIM_WIND_SPD") begins with the episode; its amount is
drawn."""
IDENTIFIED = "identified"
"""Key, or value of the option: each property within the 95 % interval that was measured (``Airframe.intervals``)."""
DRAWS = "draws"
"""Key whose value N means: N sets of properties are drawn once (always the same ones), and each episode takes one."""
_MAX_DRAWS = 100_000


def ranges_of(randomise: Any) -> Mapping[str, Any]:
    """The option as a mapping, {} for None.

    Raises:
        EnvOptionError: it is none, and no word for one.
    """
    if randomise is None or isinstance(randomise, Mapping):
        return randomise or {}
    if isinstance(randomise, str) and randomise == IDENTIFIED:
        return {IDENTIFIED: True}
    raise EnvOptionError(
        f"randomise = {randomise!r}; it must map properties to (low, high), or be {IDENTIFIED!r} or None (null)"
    )


class Randomisation:
    """Draws properties of a robot, and amounts of faults, for each episode.

    Args:
        ranges: see ``ranges_of``; "latency" is one of the properties.
        robot: robot whose properties are drawn.
        latency: latency of its commands; None: it has none.

    Raises:
        EnvOptionError: unknown property or fault, no valid range, or a range beyond the limits.
    """

    def __init__(self, ranges: Mapping[str, Any], robot: Robot, latency: Latency | None = None) -> None:
        self.ranges: dict[str, Any] = _with_intervals(ranges, robot)
        self._latency = latency
        draws = self.ranges.pop(DRAWS, None)
        known = {**robot.properties, LATENCY.name: LATENCY}
        self._faults: dict[str, Failure] = {}
        self._failing: dict[int, list[Failure]] = {}
        """Robot -> what fails in its next episode."""
        for name, values in self.ranges.items():
            if is_fault(name):
                self._faults[name] = amount_of(name, values if callable(values) else _range(name, values, 1), robot)
            elif name not in known:
                raise unknown("randomise: property", name, [*known, DRAWS])
            elif not callable(values):
                self._check(known[name], values, robot)
        self._sets: list[dict[str, Any]] | None = None
        if draws is not None:
            if not isinstance(draws, int) or isinstance(draws, bool) or not 1 <= draws <= _MAX_DRAWS:
                raise EnvOptionError(f"randomise: {DRAWS} = {draws!r}; it must be a whole number 1 .. {_MAX_DRAWS}")
            rng = np.random.default_rng(0)
            self._sets = [self._drawn(rng) for _ in range(draws)]

    @staticmethod
    def _check(prop: Property, values: Any, robot: Robot) -> None:
        name = prop.name
        low, high = _range(name, values, prop.length)
        ends = np.atleast_1d(low), np.atleast_1d(high)
        if not all(prop.low <= least <= most <= prop.high for least, most in zip(*ends)):
            limits = f"{prop.low:g} .. {prop.high:g} {prop.unit}".strip()
            raise EnvOptionError(f"randomise: {name} = {values!r}; it must be low <= high within {limits}")
        if name in ("range_max", "lidar_max"):
            robot.range_max = max(robot.range_max, high)
        if name == "radius":  # random positions have clearance for the greatest
            robot.volume = replace(robot.volume, radius=max(robot.volume.radius, high))

    def _drawn(self, rng: np.random.Generator) -> dict[str, Any]:
        return {
            name: _plain(values(rng) if callable(values) else rng.uniform(*values))
            for name, values in self.ranges.items()
        }

    def draw(self, index: int, robot: Robot, seed: tuple[int, int]) -> None:
        """Give one robot its properties for the next episode; ``seed`` is of the random numbers that draw them."""
        if not self.ranges and self._sets is None:
            return  # most environments: to make a generator would take longer than the rest of their reset
        rng = np.random.default_rng(seed)
        properties = self._drawn(rng) if self._sets is None else self._sets[int(rng.integers(len(self._sets)))]
        self._failing[index] = []
        for name, value in properties.items():
            if name in self._faults:
                self._failing[index].append(drawn(self._faults[name], value, robot))
            elif name != LATENCY.name:
                robot.set_property(index, name, value)
            elif self._latency is not None:
                self._latency.set(index, value)

    def begin(self, index: int, robot: Robot) -> None:
        """The episode of a robot begins: let fail in it what was drawn. After its ``reset``."""
        for failure in self._failing.pop(index, ()):
            if isinstance(robot, FailingRobot):
                robot.fail(index, failure)


def _with_intervals(ranges: Mapping[str, Any], robot: Robot) -> dict[str, Any]:
    """The ranges, and where IDENTIFIED is true those of the airframe that are not given otherwise."""
    out = dict(ranges)
    wanted = out.pop(IDENTIFIED, False)
    if not isinstance(wanted, bool):
        raise EnvOptionError(f"randomise: {IDENTIFIED} = {wanted!r}; it must be True or False")
    if not wanted:
        return out
    airframe: Airframe | None = getattr(robot, "airframe", None)
    if airframe is None or not airframe.intervals:
        title = f"robot {robot.name!r}" if airframe is None else airframe.title
        raise EnvOptionError(
            f"randomise: {IDENTIFIED}: {title} has no intervals: give the frame of a file with [intervals], as "
            "`sitl identify` writes it"
        )
    return {**airframe.intervals, **out}


def _range(name: str, values: Any, length: int) -> tuple[Any, Any]:
    """Low and high: numbers, or vectors of this length."""
    shape = () if length == 1 else (length,)
    try:
        low, high = (np.asarray(v, float) for v in values)
    except (TypeError, ValueError):
        low = high = np.empty(0)
    if low.shape != shape or high.shape != shape:
        each = "" if length == 1 else f", of {length} numbers each,"
        raise EnvOptionError(f"randomise: {name} = {values!r}; it must be (low, high){each} or a function")
    return _plain(low), _plain(high)


def _plain(value: Any) -> Any:
    """A float, or a tuple of floats: what ``Robot.set_property`` takes."""
    found = np.asarray(value, float)
    return tuple(found.tolist()) if found.ndim else float(found)
