# SPDX-License-Identifier: BSD-3-Clause
"""Missions as a vehicle can fly them."""

from __future__ import annotations

from collections.abc import Container
from dataclasses import replace

from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.mission.mission import Mission
from sitl.core.mavlink import MavCmd

from .document import MissionFile
from .splines import straightened


def for_vehicle(file: MissionFile, taken: Container[int]) -> MissionFile:
    """The mission as it is, where its commands are among those ``taken``.

    A bare path gets a take-off and a return where there is such a thing; curves become waypoints where there are none.
    """
    file = as_flight(file) if MavCmd.NAV_TAKEOFF in taken else file
    return file if MavCmd.NAV_SPLINE_WAYPOINT in taken else straightened(file)


def as_flight(file: MissionFile) -> MissionFile:
    """A bare path with a take-off to its first height before it and a return to launch behind it."""
    if not file.is_path:
        return file
    home, *path = file.mission.items
    take_off = MissionItem(MavCmd.NAV_TAKEOFF, path[0].frame, z=path[0].z)
    return replace(
        file, is_path=False, mission=Mission.of([home, take_off, *path, MissionItem(MavCmd.NAV_RETURN_TO_LAUNCH)])
    )
