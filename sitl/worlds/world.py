# SPDX-License-Identifier: BSD-3-Clause
"""A world: solids, floor, start poses; and what is computed from them once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from .geometry import Geometry, compile_geometry
from .shapes import Lap, Marking, Solid, Start, WorldError


@dataclass(frozen=True)
class World:
    """One world, as its file says, in the file's frame (x forward, y left, z up; metres, radians)."""

    name: str
    solids: tuple[Solid, ...]
    """Boxes (also what the file calls segments) and cylinders, in the order of the file."""
    starts: tuple[Start, ...]
    description: str = ""
    source: str = ""
    floor_z: float = 0.0
    """Height of the floor [m]; it has no edge."""
    friction: float = 1.0
    """Coefficient of the floor."""
    plan_height: float = 0.5
    """Height at which plans are cut [m]: that of the lidar of the robot that it was made for."""
    markings: tuple[Marking, ...] = ()
    laps: tuple[Lap, ...] = ()

    def __post_init__(self) -> None:
        if not self.starts:
            raise WorldError(f"world {self.name!r} has no start pose; it needs one")

    @cached_property
    def geometry(self) -> Geometry:
        """Arrays for ray casting and contacts, in the simulator's NED frame."""
        return compile_geometry(self.solids, self.floor_z)

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """Least x, least y, greatest x, greatest y of all solids and starts [m]."""
        points = [tuple(p) for s in self.solids for p in s.footprint()]
        points += [tuple(p) for m in self.markings for p in m.footprint()]
        points += [s.position[:2] for s in self.starts]
        xs, ys = [float(p[0]) for p in points], [float(p[1]) for p in points]
        return min(xs), min(ys), max(xs), max(ys)

    def start(self, robot: str | None = None, name: str | None = None) -> Start:
        """The start pose called ``name``, or else the first for ``robot``, or else the first for any robot.

        Raises:
            WorldError: no start of that name; the message lists those there are.
        """
        if name is not None:
            for start in self.starts:
                if start.name == name:
                    return start
            known = ", ".join(s.name for s in self.starts)
            raise WorldError(f"world {self.name!r} has no start {name!r}; it has {known}")
        for wanted in (robot, None):
            for start in self.starts:
                if start.robot == wanted:
                    return start
        return self.starts[0]
