# SPDX-License-Identifier: BSD-3-Clause
"""One change of a simulation that a policy is tried under: figures, noise, latency, world, physics, any option."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from sitl import worlds
from sitl.errors import did_you_mean
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

    def place(position: tuple[float, float, float]) -> tuple[float, float, float]:
        x, y, z = position
        return stretch * x, side * stretch * y, z

    def solid(one: Solid) -> Solid:
        if isinstance(one, Box):
            x, y, z = one.size
            return replace(one, centre=place(one.centre), size=(stretch * x, stretch * y, z), yaw=side * one.yaw)
        return replace(one, centre=place(one.centre), radius=stretch * one.radius)

    what = [*(["mirrored"] if mirror else []), *([f"x {stretch:g}"] if stretch != 1.0 else [])]
    return World(
        name=" ".join([found.name, *what]),
        solids=tuple(solid(one) for one in found.solids),
        starts=tuple(replace(s, position=place(s.position), yaw=side * s.yaw) for s in found.starts),
        description=found.description,
        source=found.source,
        floor_z=found.floor_z,
        friction=found.friction,
        plan_height=found.plan_height,
    )


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
    """Figure of the robot -> factor of its default value."""
    set: Mapping[str, float] = field(default_factory=dict)
    """Figure -> value, in the figure's unit."""
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
        for key in ("scale", "set"):
            for figure, value in _table(where, key, getattr(self, key)).items():
                if not _is_number(value):
                    raise AgentError(f"{where}: {key}.{figure} = {value!r}; it must be a number")
        for figure in {*self.scale} & {*self.set}:
            raise AgentError(f"{where}: figure {figure!r} is both scaled and set; give one of them")
        if self.latency is not None and not (_is_number(self.latency) and self.latency >= 0.0):
            raise AgentError(f"{where}: latency = {self.latency!r}; it must be a number from 0 on [s]")
        if not _is_number(self.stretch) or not 0.1 <= self.stretch <= 10.0:
            raise AgentError(f"{where}: stretch = {self.stretch!r}; it must be a number from 0.1 to 10")
        for key in ("mirror", "by_default"):
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

    def env_options(self, robot: Any, home: Mapping[str, Any]) -> dict[str, Any]:
        """Options of the environment with this change.

        Args:
            robot: robot of the environment at home (``sitl.envs.robots.robot.Robot``).
            home: options of the environment at home.

        Raises:
            AgentError: the robot has no such figure.
        """
        out = {**home, **self.options}
        figures = {name: scaled(robot, name, factor) for name, factor in self.scale.items()}
        figures.update({name: float(value) for name, value in self.set.items()})
        if figures:
            out["randomise"] = {name: (value, value) for name, value in figures.items()}
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
    values = {name: value for name, (value, _) in (changed.pop("randomise", None) or {}).items()}
    if "latency" in changed:
        values["latency"] = changed.pop("latency")
    if changed or not drawn:
        return False
    ranges = {name: drawn[name] for name in values if isinstance(drawn.get(name), list | tuple)}
    return len(ranges) == len(values) and all(low <= values[name] <= high for name, (low, high) in ranges.items())


def usual(robot: Any, figure: str) -> float:
    """Default value of a figure of the robot.

    Raises:
        AgentError: it has none.
    """
    if figure not in robot.figures:
        hint = did_you_mean(figure, robot.figures)
        raise AgentError(f"robot {robot.name!r} has no figure {figure!r}{hint}")
    airframe = getattr(robot, "airframe", None)
    try:
        return float(airframe.value(figure))  # type: ignore[union-attr]
    except (AttributeError, KeyError):
        raise AgentError(f"figure {figure!r} of robot {robot.name!r} has no usual value to scale: set it") from None


def scaled(robot: Any, figure: str, factor: float) -> float:
    """``factor`` times the default value, rounded."""
    return float(f"{factor * usual(robot, figure):.12g}")


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _table(where: str, key: str, value: Any) -> Mapping[str, Any]:
    if not isinstance(value, Mapping):
        raise AgentError(f"{where}: {key} = {value!r}; it must be a table of names and values")
    return value
