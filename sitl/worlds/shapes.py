# SPDX-License-Identifier: BSD-3-Clause
"""What a world consists of, in the frame of world files.

x forward, y left, z up; metres; yaw counter-clockwise from x, in radians.

From the frame of world files (x forward, y left, z up) to the simulator's NED, and back.

North is x, east is -y, down is -z, heading is -yaw: as in the original, where simulated x was north and y west. Signs
change and nothing else, so no bit is lost on the way.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..core import elementary_arrays as arrays
from ..core.elementary import cos, sin
from ..core.kernels import law
from ..errors import SitlError

Array = npt.NDArray[np.float64]
CIRCLE_CORNERS = 32
"""Corners of the polygon that stands for a circle in plans."""


class WorldError(SitlError, ValueError):
    """A world that is not known, or a world file that cannot be used; the message says where and what is allowed."""


@dataclass(frozen=True)
class Box:
    """A solid box that stands level."""

    centre: tuple[float, float, float]
    """x, y, z [m]."""
    size: tuple[float, float, float]
    """Full lengths along its own x and y, and along z [m]."""
    yaw: float = 0.0
    """[rad]."""
    name: str = ""
    colour: str = "grey"
    """Of pictures: one of ``tables.COLOURS``."""

    @property
    def low(self) -> float:
        """z of the underside [m]."""
        return self.centre[2] - 0.5 * self.size[2]

    @property
    def high(self) -> float:
        """z of the top [m]."""
        return self.centre[2] + 0.5 * self.size[2]

    def footprint(self) -> Array:
        """Corners seen from above, counter-clockwise, shape (4, 2) [m]."""
        return rectangle(self.centre[0], self.centre[1], self.size[0], self.size[1], self.yaw)


@dataclass(frozen=True)
class Cylinder:
    """A solid cylinder with a vertical axis."""

    centre: tuple[float, float, float]
    """x, y, z of its middle [m]."""
    radius: float
    """[m]."""
    height: float
    """[m]."""
    name: str = ""
    colour: str = "grey"
    """As of a ``Box``."""

    @property
    def low(self) -> float:
        """z of the underside [m]."""
        return self.centre[2] - 0.5 * self.height

    @property
    def high(self) -> float:
        """z of the top [m]."""
        return self.centre[2] + 0.5 * self.height

    def footprint(self) -> Array:
        """A polygon on the circle, counter-clockwise, shape (CIRCLE_CORNERS, 2) [m]."""
        return circle(self.centre[0], self.centre[1], self.radius)


Solid = Box | Cylinder


@dataclass(frozen=True)
class Start:
    """A pose at which a robot may start."""

    name: str
    position: tuple[float, float, float]
    """x, y and z of the robot's base [m]."""
    yaw: float
    """[rad]."""
    robot: str | None = None
    """The robot it is meant for; None: any."""

    @property
    def north_east_down(self) -> tuple[float, float, float]:
        """The position in the simulator's frame [m]: north is x, east is -y, down is -z."""

        return to_ned(*self.position)

    @property
    def heading(self) -> float:
        """In the simulator's frame [rad]: clockwise from north, seen from above."""

        return to_heading(self.yaw)


@dataclass(frozen=True)
class Lap:
    """A way round."""

    name: str
    length: float
    """[m]."""
    clearance: float | None = None
    """Distance to walls that the path keeps [m]."""


@dataclass(frozen=True)
class Marking:
    """Something painted on the floor: drawn, and nothing else."""

    centre: tuple[float, float]
    """x, y [m]."""
    radius: float = 0.0
    """Of a disc [m]; 0 for a rectangle."""
    size: tuple[float, float] = (0.0, 0.0)
    """Of a rectangle: full lengths along its own x and y [m]."""
    yaw: float = 0.0
    """Of a rectangle [rad]."""
    colour: str = "grey"
    name: str = ""

    def footprint(self) -> Array:
        """Corners seen from above, counter-clockwise, shape (n, 2) [m]."""
        if self.radius > 0.0:
            return circle(self.centre[0], self.centre[1], self.radius, 96)
        return rectangle(self.centre[0], self.centre[1], self.size[0], self.size[1], self.yaw)


def rectangle(x: float, y: float, length: float, width: float, yaw: float) -> Array:
    """Corners of a rectangle about (x, y), counter-clockwise, shape (4, 2) [m]; yaw [rad]."""
    along = 0.5 * length * np.array([cos(yaw), sin(yaw)])
    across = 0.5 * width * np.array([-sin(yaw), cos(yaw)])
    return np.array([-along - across, along - across, along + across, -along + across]) + (x, y)


def circle(x: float, y: float, radius: float, corners: int = CIRCLE_CORNERS) -> Array:
    """Corners of a regular polygon on the circle about (x, y), counter-clockwise, shape (corners, 2) [m]."""
    angles = np.arange(corners) * (2.0 * math.pi / corners)
    return radius * np.stack([arrays.cos(angles), arrays.sin(angles)], axis=1) + (x, y)


@law
def to_ned(x: float, y: float, z: float) -> tuple[float, float, float]:
    """North, east, down [m] of a point of a world file [m]."""
    return x, 0.0 - y, 0.0 - z


@law
def from_ned(north: float, east: float, down: float) -> tuple[float, float, float]:
    """x, y, z [m] of a point in the simulator's frame [m]."""
    return north, 0.0 - east, 0.0 - down


@law
def to_heading(yaw: float) -> float:
    """Heading [rad], clockwise from north, of a yaw [rad], counter-clockwise from x."""
    return 0.0 - yaw


@law
def from_heading(heading: float) -> float:
    """Yaw [rad], counter-clockwise from x, of a heading [rad], clockwise from north."""
    return 0.0 - heading
