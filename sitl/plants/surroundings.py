# SPDX-License-Identifier: BSD-3-Clause
"""The world around one vehicle: where it starts, and the floor that it stands on.

Body positions are NED from the world's origin on the floor; the world's own heights count from its z = 0.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from sitl.core.elementary import cos, sin

from ..errors import OptionError
from ..scenario import StartPose
from ..vehicles import Airframe
from ..worlds import World, contact
from ..worlds.shapes import to_heading, to_ned

OFF_FLOOR = 0.5
"""Greatest height of a start pose over the floor [m]: a vehicle stands at power-on."""
INSIDE = 1e-6
"""A vehicle that overlaps a solid by this at its start stands in it [m]."""


class Surroundings:
    """One vehicle's world.

    Args:
        world: of the vehicle.
        start: where it stands at power-on; None: the world's start pose for this airframe.
        airframe: of the vehicle.

    Raises:
        OptionError, WorldError: a start pose that is not known, off the floor or in a solid.
    """

    def __init__(self, world: World, start: StartPose | None, airframe: Airframe) -> None:
        self.world = world
        self.floor = float(world.floor_z)
        """Height of the floor in the world's frame [m]."""
        x, y, z, yaw = start_pose(world, start, airframe.name)
        self.start = (x, y, z, yaw)
        """x, y, z [m], yaw [rad] of the vehicle's base, in the world's frame."""
        self.heading = math.remainder(to_heading(yaw), 2.0 * math.pi)
        """At power-on [rad]."""
        along = float(airframe.value("base_along"))
        north, east, _ = to_ned(x, y, z)
        self.position = (north - along * cos(self.heading), east - along * sin(self.heading), 0.0)
        """Of the body's origin at power-on, NED from the world's origin on the floor [m]."""
        self._check_free(airframe)

    def attach(self, v: Any, lists_solids: bool) -> None:
        """Put a vehicle that has just been powered on, at home, at its start.

        Args:
            v: view of its record.
            lists_solids: native physics finds the solids near the vehicle in its record; other engines have their own.
        """
        v.physics.body.pos = self.position
        v.physics.obstacles.present = lists_solids and len(self.world.geometry) > 0

    def _check_free(self, airframe: Airframe) -> None:
        top, bottom = float(airframe.value("contact_top")), float(airframe.value("contact_bottom"))
        radius = float(airframe.value("contact_radius"))
        for along in np.asarray(airframe.value("contact_along"), float)[: int(airframe.value("contact_discs") or 1)]:
            north = self.position[0] + along * cos(self.heading)
            east = self.position[1] + along * sin(self.heading)
            at = contact.clearance(self.world.geometry, north, east, -self.floor - top, bottom - self.floor, radius)
            if at.distance < -INSIDE:
                name = self.world.solids[at.solid].name or f"number {at.solid}"
                x, y, _, yaw = self.start
                raise OptionError(
                    f"start at x {x:g}, y {y:g} m, yaw {math.degrees(yaw):g} deg: {airframe.name} would stand in solid "
                    f"{name} of world {self.world.name!r} ({-at.distance:.3f} m deep)"
                )


def start_pose(world: World, start: StartPose | None, robot: str) -> tuple[float, float, float, float]:
    """x, y, z [m], yaw [rad] of a start pose.

    Raises:
        OptionError: not a name or four numbers, or not on the floor.
        WorldError: the world has no start pose of this name.
    """
    if start is None or isinstance(start, str):
        found = world.start(robot, start)
        x, y, z, yaw = *found.position, found.yaw
    else:
        try:
            x, y, z, degrees = (float(number) for number in start)
        except (TypeError, ValueError):
            x, y, z, degrees = (math.nan,) * 4
        if not all(map(math.isfinite, (x, y, z, degrees))):
            raise OptionError(
                f"start {start!r} is neither the name of a start pose nor (x, y, z, yaw) in metres and degrees"
            )
        yaw = math.radians(degrees)
    if not abs(z - world.floor_z) <= OFF_FLOOR:
        raise OptionError(
            f"start at z = {z:g} m: a vehicle stands on the floor at power-on; within {OFF_FLOOR:g} m of z = "
            f"{world.floor_z:g} m is allowed"
        )
    return x, y, z, yaw
