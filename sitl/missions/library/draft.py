# SPDX-License-Identifier: BSD-3-Clause
"""Builds missions from positions in metres north and east of home."""

from __future__ import annotations

import math
from typing import Any

from sitl.autopilot.mission import item as c
from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.mission.mission import Mission
from sitl.core.elementary import cos, sin
from sitl.core.geodesy import add_offset
from sitl.core.mavlink import MavCmd, MavFrame
from sitl.physics.native.power_on import DEFAULT_HOME
from sitl.vehicle.kinds import KINDS

from ..files import FenceCircle, FencePolygon, MissionFile, RallyPoint, complex_items
from ..files.document import Complex
from ..files.json_reader import Node

LAT, LON, ALT, _ = DEFAULT_HOME
Location = tuple[float, float]


def degrees(north: float, east: float) -> Location:
    """Latitude, longitude [deg] of a position north, east of home [m]."""
    lat, lon = add_offset(round(LAT * 1e7), round(LON * 1e7), north, east)
    return (round(lat) * 1e-7, round(lon) * 1e-7)


class Draft:
    """A mission under construction; each method adds items and returns the draft."""

    def __init__(self, kind: str, description: str, *, text: bool = False, **index: Any) -> None:
        self.kind, self.description, self.index = kind, description, index
        self.suffix = ".waypoints" if text else ".plan"
        """Suffix of the file, which gives its format."""
        self.speed: float | None = None
        """Ground speed [m/s]; None: the airframe's."""
        self._items = [c.home_item(round(LAT * 1e7), round(LON * 1e7), ALT)]
        self._complexes: list[Complex] = []
        self._fence: dict[str, Any] = {}

    @property
    def next(self) -> int:
        """Number of the item that comes next."""
        return len(self._items)

    def add(
        self,
        command: int,
        *params: float,
        at: Location | None = None,
        z: float = 0.0,
        frame: int = MavFrame.GLOBAL_RELATIVE_ALT,
    ) -> Draft:
        """Add any command; ``at``: north, east of home [m]."""
        p1, p2, p3, p4 = (*params, *(0.0,) * (4 - len(params)))
        x, y = (round(v * 1e7) for v in degrees(*at)) if at is not None else (0, 0)
        self._items.append(MissionItem(command, frame, p1, p2, p3, p4, x, y, z))
        return self

    def take_off(self, height: float) -> Draft:
        """Take off vertically to a height above home [m]."""
        return self.add(MavCmd.NAV_TAKEOFF, z=height)

    def to(
        self,
        *points: tuple[float, ...],
        z: float = 0.0,
        wait: float = 0.0,
        frame: int = MavFrame.GLOBAL_RELATIVE_ALT,
    ) -> Draft:
        """Waypoints (north, east[, height above home]) [m]."""
        for point in points:
            self.add(
                MavCmd.NAV_WAYPOINT,
                wait,
                at=(point[0], point[1]),
                z=point[2] if len(point) > 2 else z,
                frame=frame,
            )
        return self

    def curve(self, *points: tuple[float, ...], z: float = 0.0) -> Draft:
        """Spline waypoints (north, east[, height above home]) [m]."""
        for point in points:
            self.add(MavCmd.NAV_SPLINE_WAYPOINT, at=(point[0], point[1]), z=point[2] if len(point) > 2 else z)
        return self

    def land(self, at: Location | None = None) -> Draft:
        """Land at north, east [m]; None: at the current position."""
        return self.add(MavCmd.NAV_LAND, at=at)

    def home(self) -> Draft:
        """Return to launch."""
        return self.add(MavCmd.NAV_RETURN_TO_LAUNCH)

    def pace(self, speed: float) -> Draft:
        """Ground speed from here on [m/s]."""
        self.speed = self.speed or speed
        return self.add(MavCmd.DO_CHANGE_SPEED, 1.0, speed, -1.0)

    def jump(self, seq: int, times: int) -> Draft:
        """Jump to an item ``times`` times."""
        return self.add(MavCmd.DO_JUMP, float(seq), float(times))

    def complex(self, entry: dict[str, Any]) -> Draft:
        """Add a survey, corridor or structure by its description in the plan format."""
        node = Node({"type": "ComplexItem", **entry}, "draft")
        items = complex_items.expand(node)
        self._complexes.append(Complex(complex_items.kind(node), self.next, len(items), node.value, False))
        self._items += items
        return self

    def fence(self, **parts: Any) -> Draft:
        """Geofence and rally points."""
        self._fence = parts
        return self

    def file(self) -> MissionFile:
        """The mission file."""
        return MissionFile(
            Mission.of(self._items),
            vehicle_type=KINDS[self.kind].mav_type,
            cruise_speed=self.speed or (10.0 if KINDS[self.kind].flies else 1.2),
            hover_speed=self.speed or 5.0,
            complexes=tuple(self._complexes),
            **self._fence,
        )


def transects(spacing: float, height: float, turnaround: float = 0.0) -> dict[str, Any]:
    """The common part of surveys and corridors in the plan format; spacing and height [m]."""
    return {
        "CameraCalc": {
            "AdjustedFootprintFrontal": spacing,
            "AdjustedFootprintSide": spacing,
            "CameraName": "Manual (no camera specs)",
            "DistanceMode": 1,
            "DistanceToSurface": height,
            "version": 2,
        },
        "CameraShots": 0,
        "CameraTriggerInTurnAround": False,
        "HoverAndCapture": False,
        "Items": [],
        "Refly90Degrees": False,
        "TurnAroundDistance": turnaround,
        "VisualTransectPoints": [],
        "version": 2,
    }


def survey(corners: list[Location], angle: float, style: dict[str, Any], entry: int = 0) -> dict[str, Any]:
    """A survey of a polygon with corners north, east of home [m]."""
    return {
        "TransectStyleComplexItem": style,
        "angle": angle,
        "complexItemType": "survey",
        "entryLocation": entry,
        "flyAlternateTransects": False,
        "polygon": [list(degrees(*corner)) for corner in corners],
        "splitConcavePolygons": False,
        "version": 5,
    }


def circle(centre: Location, radius: float, count: int, start_deg: float = 0.0) -> list[Location]:
    """Positions on a circle, clockwise from a direction; north, east of home [m]."""
    turns = [math.radians(start_deg + 360.0 * k / count) for k in range(count)]
    return [(centre[0] + radius * cos(a), centre[1] + radius * sin(a)) for a in turns]


__all__ = ["Draft", "FenceCircle", "FencePolygon", "RallyPoint", "circle", "degrees", "survey", "transects"]
