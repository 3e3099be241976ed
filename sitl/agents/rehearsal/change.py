# SPDX-License-Identifier: BSD-3-Clause
"""One change of a simulation that a policy is tried under: properties, noise, latency, world, physics, any option."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

import numpy as np

from sitl import worlds
from sitl.envs.randomisation import IDENTIFIED
from sitl.errors import did_you_mean
from sitl.vehicles.airframe import Value
from sitl.worlds import World
from sitl.worlds.lists import is_range
from sitl.worlds.shapes import Box, Solid

from ..errors import AgentError, check_names


def altered(world: str | Path | World, mirror: bool = False, stretch: float = 1.0) -> World:
    """A mirrored or stretched copy of a world; heights stay.

    Args:
        world: name, .toml file or World.
        mirror: left and right change places.
        stretch: factor of all lengths along x and y.
    """
    found = worlds.load(world)
    side = -1.0 if mirror else 1.0

    def moved(position: tuple[float, float, float]) -> tuple[float, float, float]:
        x, y, z = position
        return stretch * x, side * stretch * y, z

    def solid(one: Solid) -> Solid:
        if isinstance(one, Box):
            x, y, z = one.size
            return replace(one, centre=moved(one.centre), size=(stretch * x, stretch * y, z), yaw=side * one.yaw)
        return replace(one, centre=moved(one.centre), radius=stretch * one.radius)

    what = [*(["mirrored"] if mirror else []), *([f"x {stretch:g}"] if stretch != 1.0 else [])]
    return World(
        name=" ".join([found.name, *what]),
        solids=tuple(solid(one) for one in found.solids),
        starts=tuple(replace(s, position=moved(s.position), yaw=side * s.yaw) for s in found.starts),
        description=found.description,
        source=found.source,
        floor_z=found.floor_z,
        friction=found.friction,
        plan_height=found.plan_height,
    )


Options = Mapping[str, Any]
GROUPS = ("world", "physics", "vehicle", "sensors", "latency", "step", "together")
"""Groups of changes; reports are divided by them."""


@dataclass(frozen=True)
class Change:
    """A change, as plan files have it.

    Raises:
        AgentError: a key's value that cannot be.
    """

    name: str
    group: str
    """One of ``GROUPS``."""
    scale: Mapping[str, float] = field(default_factory=dict)
    """Property of the robot -> factor of its default value."""
    set: Mapping[str, Value] = field(default_factory=dict)
    """Property -> value, in the property's unit; of a vector a list."""
    identified: bool = False
    """Each episode draws the properties that were measured within their intervals (``Airframe.intervals``)."""
    latency: float | None = None
    """Latency [s]; None: unchanged."""
    mirror: bool = False
    """Mirror the world left to right."""
    stretch: float = 1.0
    """Factor of the world's horizontal lengths."""
    options: Mapping[str, Any] = field(default_factory=dict)
    """Options of the environment, in place of the original ones."""
    episodes: int | None = None
    """Largest number of episodes played; for slow physics."""
    by_default: bool = True
    """Whether it is tried without being named."""

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name.strip():
            raise AgentError(f"name = {self.name!r}; it must be text")
        where = f"change {self.name!r}"
        if self.group not in GROUPS:
            raise AgentError(f"{where}: group = {self.group!r}; it is one of {', '.join(GROUPS)}")
        for name, value in _table(where, "scale", self.scale).items():
            if not _is_number(value):
                raise AgentError(f"{where}: scale.{name} = {value!r}; it must be a number")
        for name, given in _table(where, "set", self.set).items():
            if not _is_number(given) and not (isinstance(given, list | tuple) and all(map(_is_number, given))):
                raise AgentError(f"{where}: set.{name} = {given!r}; it must be a number, or a list of a vector's")
        for name in {*self.scale} & {*self.set}:
            raise AgentError(f"{where}: property {name!r} is both scaled and set; give one of them")
        if self.latency is not None and not (_is_number(self.latency) and self.latency >= 0.0):
            raise AgentError(f"{where}: latency = {self.latency!r}; it must be a number from 0 on [s]")
        if not _is_number(self.stretch) or not 0.1 <= self.stretch <= 10.0:
            raise AgentError(f"{where}: stretch = {self.stretch!r}; it must be a number from 0.1 to 10")
        for key in ("mirror", "by_default", "identified"):
            if not isinstance(getattr(self, key), bool):
                raise AgentError(f"{where}: {key} = {getattr(self, key)!r}; it must be true or false")
        count = self.episodes
        if count is not None and (not isinstance(count, int) or isinstance(count, bool) or count < 1):
            raise AgentError(f"{where}: episodes = {count!r}; it must be a whole number from 1 on")
        taken = {"latency", "randomise", *(["world"] if self._alters_world else [])} & {
            *_table(where, "options", self.options)
        }
        if taken:
            raise AgentError(f"{where}: {taken.pop()} has keys of its own in a change, it is no option there")
        if self.scale and "frame" in self.options:
            raise AgentError(f"{where}: scale is of the robot at home; with another frame give the values by set")

    @property
    def _alters_world(self) -> bool:
        return self.mirror or self.stretch != 1.0

    @classmethod
    def of(cls, values: Any) -> Change:
        """From the keys and values of a file.

        Raises:
            AgentError: no such key, a missing one, or a value that cannot be.
        """
        if not isinstance(values, Mapping):
            raise AgentError(f"change = {values!r}; it must be a table")
        check_names(values, [item.name for item in fields(cls)], f"change {values.get('name', '')!r}: key {{!r}}")
        for key in ("name", "group"):
            if key not in values:
                raise AgentError(f"change {dict(values)!r}: key {key!r} is missing")
        return cls(**values)

    def env_options(
        self, robot: Any, home: Mapping[str, Any], drawn: Mapping[str, Any] | None = None
    ) -> dict[str, Any]:
        """Options of the environment with this change.

        Args:
            robot: robot of the environment at home (``sitl.envs.robots.robot.Robot``).
            home: options of the environment at home.
            drawn: what its episodes draw by themselves, as its wind (``Randomisation.ranges``), which stays.

        Raises:
            AgentError: the robot has no such property.
        """
        out = {**home, **self.options}
        properties = {name: scaled(robot, name, factor) for name, factor in self.scale.items()} | dict(self.set)
        if properties or self.identified:
            out["randomise"] = dict(drawn or {}) | {name: (value, value) for name, value in properties.items()}
        if self.identified:
            out["randomise"][IDENTIFIED] = True
        if self.latency is not None:
            out["latency"] = float(self.latency)
        if self._alters_world:
            of_home = home.get("world")
            if of_home is not None and (not isinstance(of_home, str | Path | World) or is_range(of_home)):
                raise AgentError(f"change {self.name!r} mirrors or stretches one world; at home there are {of_home!r}")
            out["world"] = altered(robot.world, self.mirror, float(self.stretch))
        return out


def is_covered(options: Mapping[str, Any], home: Mapping[str, Any], drawn: Mapping[str, Any] | None) -> bool:
    """Whether the randomisation of a policy's training covers a change: everything that differs was drawn from ranges
    around it.

    Args:
        options: options of the environment under the change.
        home: at home.
        drawn: the option ``randomise`` of the training.
    """
    changed = {name: value for name, value in options.items() if name not in home or home[name] is not value}
    randomise = changed.pop("randomise", None) or {}
    if IDENTIFIED in randomise:
        return False  # of another vehicle, which ``options`` says, or of one whose properties were not guessed
    fixed = ((name, tuple(range_)) for name, range_ in randomise.items() if not callable(range_))
    values = {name: low for name, (low, high) in fixed if low == high}  # others are drawn at home, too
    if "latency" in changed:
        values["latency"] = changed.pop("latency")
    if changed or not drawn or isinstance(drawn, str):
        return False
    ranges = {name: drawn[name] for name in values if isinstance(drawn.get(name), list | tuple)}
    return len(ranges) == len(values) and all(low <= values[name] <= high for name, (low, high) in ranges.items())


def usual(robot: Any, name: str) -> Value:
    """Default value of a property of the robot.

    Raises:
        AgentError: it has none.
    """
    if name not in robot.properties:
        hint = did_you_mean(name, robot.properties)
        raise AgentError(f"robot {robot.name!r} has no property {name!r}{hint}")
    airframe = getattr(robot, "airframe", None)
    try:
        value: Any = np.asarray(airframe.value(name), float)  # type: ignore[union-attr,type-var]
    except (AttributeError, KeyError):
        raise AgentError(f"property {name!r} of robot {robot.name!r} has no usual value to scale: set it") from None
    return tuple(value.tolist()) if value.ndim else float(value)


def scaled(robot: Any, name: str, factor: float) -> Value:
    """``factor`` times the default value, rounded; of a vector each element."""
    value = usual(robot, name)
    if isinstance(value, tuple):
        return tuple(float(f"{factor * one:.12g}") for one in value)
    return float(f"{factor * value:.12g}")  # type: ignore[operator]


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _table(where: str, key: str, value: Any) -> Mapping[str, Any]:
    if not isinstance(value, Mapping):
        raise AgentError(f"{where}: {key} = {value!r}; it must be a table of names and values")
    return value
