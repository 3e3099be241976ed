# SPDX-License-Identifier: BSD-3-Clause
"""Start states of vehicles in a fleet: one is prepared by boot and take-off, and moved to where each episode starts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from sitl.core.elementary import cos, sin
from sitl.errors import OptionError
from sitl.move import WIND, Move
from sitl.plants.surroundings import start_pose
from sitl.vehicles.airframe import Value
from sitl.worlds import World
from sitl.worlds.shapes import to_heading, to_ned

from ..options import EnvOptionError
from .robot import Pose
from .vehicles import EpisodeState, VehicleSetup

MOVE, BOOT = "move", "boot"
BEGINS = (MOVE, BOOT)
"""Values of the option ``begin``."""
_WINDS = [prop.name for prop in WIND]


class Prepared:
    """A vehicle that has been prepared, and how it comes to other starts.

    Args:
        state: after its take-off.
        setup: of the environment's vehicles.
        pose: where it booted.
    """

    def __init__(self, state: EpisodeState, setup: VehicleSetup, pose: Pose) -> None:
        self.state, self._setup, self._pose = state, setup, pose
        record = setup.scenario.kind.record
        v = record.of(np.frombuffer(bytearray(state.simulation.record), record.dtype), 0)
        self._along = float(setup.airframe.value("base_along"))
        wind = v.physics.wind  # type: ignore[attr-defined]
        self._wind = {"wind_speed": wind.speed, "wind_direction": wind.direction, "wind_turbulence": wind.turbulence}

    def to(
        self,
        pose: Pose,
        properties: Sequence[tuple[str, Value]],
        seed: int,
        world: World,
        walks: tuple[float, float] | None = None,
    ) -> Move:
        """The move to a pose: over it, as level and as still as it was prepared.

        Args:
            pose: x, y, z [m], yaw [rad] in the world.
            properties: that differ from the prepared vehicle's, by name.
            seed: of the sensors' noise.
            world: that the pose is in.
            walks: slow error of the receiver (``Move.walks``); gusts are drawn, too. None: as prepared.

        Raises:
            EnvOptionError: the pose is off the floor.
        """
        changed: dict[str, Any] = dict(properties)
        wind = None
        if any(name in changed for name in _WINDS):
            speed, direction, turbulence = (changed.pop(name, self._wind[name]) for name in _WINDS)
            wind = speed, direction, turbulence
        elif walks is not None and self._wind["wind_turbulence"] > 0.0:
            wind = self._wind["wind_speed"], self._wind["wind_direction"], self._wind["wind_turbulence"]
        along = changed.get("base_along", self._along)
        if pose == self._pose and "base_along" not in changed and walks is None:
            return Move(wind=wind, properties=changed, seed=seed)
        try:
            start_pose(world, (*pose[:3], math.degrees(pose[3])), self._setup.airframe.name)
        except OptionError as error:
            raise EnvOptionError(str(error)) from None
        north, east, _ = to_ned(*pose[:3])
        heading = math.remainder(to_heading(pose[3]), math.tau)
        return Move(
            north - along * cos(heading),
            east - along * sin(heading),
            heading=heading,
            wind=wind,
            properties=changed,
            seed=seed,
            walks=walks,
        )
