# SPDX-License-Identifier: BSD-3-Clause
"""What a mission file holds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from sitl.autopilot.mission.item import NAV_LAND, NAV_TAKEOFF
from sitl.autopilot.mission.mission import Mission
from sitl.vehicle.kinds import KINDS

FIXED_WING, QUADROTOR, GROUND_ROVER, BOAT = 1, 2, 10, 11
"""MAV_TYPE"""
ARDUPILOT = 3
"""MAV_AUTOPILOT_ARDUPILOTMEGA"""


def kind_of_type(vehicle_type: int | None) -> str | None:
    """Name of the kind of vehicle that a MAV_TYPE is; None: of none."""
    kind = KINDS.of_mav_type(vehicle_type) if vehicle_type is not None else None
    return kind.name if kind is not None else None


Place = tuple[float, float]
"""Latitude, longitude [deg]."""


@dataclass(frozen=True)
class FenceCircle:
    """A geofence circle."""

    centre: Place
    radius: float
    """[m]"""
    inclusion: bool = True
    """To stay inside; else to stay out."""


@dataclass(frozen=True)
class FencePolygon:
    """A geofence polygon."""

    corners: tuple[Place, ...]
    inclusion: bool = True


@dataclass(frozen=True)
class RallyPoint:
    """A place to return to instead of home."""

    place: Place
    height: float
    """Height above home [m]."""


@dataclass(frozen=True)
class Complex:
    """A complex item of a plan (survey, corridor, structure), and which items of the mission are its."""

    kind: str
    """"survey", "CorridorScan" or "StructureScan"."""
    first: int
    """Number of its first item in the mission."""
    count: int
    entry: Mapping[str, Any]
    """The item as in the plan file."""
    stored: bool
    """True: its simple items were in the file; False: they were generated."""


@dataclass(frozen=True)
class MissionFile:
    """A mission with what a plan says besides. Item 0 of the mission is home, (0, 0) when the file does not know it."""

    mission: Mission
    name: str = "mission"
    """Path, for messages."""
    vehicle_type: int | None = None
    """MAV_TYPE; None: the format does not say."""
    firmware_type: int = ARDUPILOT
    """MAV_AUTOPILOT"""
    cruise_speed: float | None = None
    """Planned speed of vehicles on wings or wheels [m/s]; no mission item carries it."""
    hover_speed: float | None = None
    """Planned speed of multirotors [m/s]."""
    circles: tuple[FenceCircle, ...] = ()
    polygons: tuple[FencePolygon, ...] = ()
    breach_return: tuple[float, float, float] | None = None
    """Return point after a fence breach: latitude, longitude [deg], height above home [m]."""
    rally: tuple[RallyPoint, ...] = ()
    complexes: tuple[Complex, ...] = ()

    @property
    def home(self) -> tuple[float, float, float] | None:
        """Planned home: latitude, longitude [deg], altitude above mean sea level [m]; None when the file has none."""
        if not self.mission.items or self.mission.items[0].no_place:
            return None
        first = self.mission.items[0]
        return (first.x * 1e-7, first.y * 1e-7, first.z)

    @property
    def kind(self) -> str | None:
        """Name of the kind of vehicle; None when neither the file nor its items tell."""
        kind = kind_of_type(self.vehicle_type)
        if kind is not None:
            return kind
        flies = any(item.command in (NAV_TAKEOFF, NAV_LAND) for item in self.mission.items)
        return next(name for name, kind in KINDS.items() if kind.flies) if flies else None

    @property
    def has_fence_or_rally(self) -> bool:
        """Whether it holds more than a mission."""
        return bool(self.circles or self.polygons or self.rally)

    def simple(self) -> MissionFile:
        """A copy in which complex items are replaced by their simple items."""
        return replace(self, complexes=())
