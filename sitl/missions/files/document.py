# SPDX-License-Identifier: BSD-3-Clause
"""A mission as a document: its items, geometry on a plane, and the mistakes of files."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from sitl.autopilot.mission import validate
from sitl.autopilot.mission.item import COMMANDS, NUMBER_COMMANDS, MissionItem
from sitl.autopilot.mission.mission import Mission
from sitl.autopilot.mission.validate import HIGHEST, LOCATION_FRAMES
from sitl.core.mavlink import MavAutopilot, MavCmd, MavFrame, MavMissionResult
from sitl.errors import OptionError
from sitl.vehicle.kinds import KINDS

from .plane import Location


def kind_of_type(vehicle_type: int | None) -> str | None:
    """Name of the kind of vehicle that a MAV_TYPE is; None: of none."""
    kind = KINDS.of_mav_type(vehicle_type) if vehicle_type is not None else None
    return kind.name if kind is not None else None


@dataclass(frozen=True)
class FenceCircle:
    """A geofence circle."""

    centre: Location
    radius: float
    """[m]"""
    inclusion: bool = True
    """To stay inside; else to stay out."""
    frame: int = MavFrame.GLOBAL_RELATIVE_ALT
    """MAV_FRAME of the items; a fence has no height of its own."""


@dataclass(frozen=True)
class FencePolygon:
    """A geofence polygon."""

    corners: tuple[Location, ...]
    inclusion: bool = True
    frame: int = MavFrame.GLOBAL_RELATIVE_ALT


@dataclass(frozen=True)
class RallyPoint:
    """A location to return to instead of home."""

    place: Location
    height: float
    """[m] in the frame."""
    frame: int = MavFrame.GLOBAL_RELATIVE_ALT
    """MAV_FRAME; RELATIVE: above home."""


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
    firmware_type: int = MavAutopilot.ARDUPILOTMEGA
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
    is_path: bool = False
    """It is a bare path: waypoints without a take-off and an end."""
    notes: tuple[str, ...] = ()
    """What the user should know of how the file was read."""

    @property
    def home(self) -> tuple[float, float, float] | None:
        """Planned home: latitude, longitude [deg], altitude above mean sea level [m]; None when the file has none."""
        if not self.mission.items or self.mission.items[0].no_location:
            return None
        first = self.mission.items[0]
        return (first.x * 1e-7, first.y * 1e-7, first.z)

    @property
    def kind(self) -> str | None:
        """Name of the kind of vehicle; None when neither the file nor its items tell."""
        kind = kind_of_type(self.vehicle_type)
        if kind is not None:
            return kind
        flies = any(item.command in (MavCmd.NAV_TAKEOFF, MavCmd.NAV_LAND) for item in self.mission.items)
        return next(name for name, kind in KINDS.items() if kind.flies) if flies else None

    @property
    def has_fence_or_rally(self) -> bool:
        """Whether it holds more than a mission."""
        return bool(self.circles or self.polygons or self.rally)

    @property
    def fence_items(self) -> tuple[MissionItem, ...]:
        """The geofence as a vehicle takes it: point of return, polygons, circles."""
        back = self.breach_return
        items = [] if back is None else [_at(MavCmd.NAV_FENCE_RETURN_POINT, (back[0], back[1]), z=back[2])]
        for polygon in self.polygons:
            command = (
                MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION
                if polygon.inclusion
                else MavCmd.NAV_FENCE_POLYGON_VERTEX_EXCLUSION
            )
            items += [_at(command, corner, len(polygon.corners), frame=polygon.frame) for corner in polygon.corners]
        for circle in self.circles:
            command = MavCmd.NAV_FENCE_CIRCLE_INCLUSION if circle.inclusion else MavCmd.NAV_FENCE_CIRCLE_EXCLUSION
            items.append(_at(command, circle.centre, circle.radius, frame=circle.frame))
        return tuple(items)

    @property
    def rally_items(self) -> tuple[MissionItem, ...]:
        """The rally points as a vehicle takes them."""
        return tuple(
            _at(MavCmd.NAV_RALLY_POINT, point.place, z=point.height, frame=point.frame) for point in self.rally
        )

    def simple(self) -> MissionFile:
        """A copy in which complex items are replaced by their simple items."""
        return replace(self, complexes=())


class MissionFileError(OptionError):
    """A mission file that cannot be read or written; names the file, the line or item, the value, what is allowed."""


FRAME_NAMES = {
    0: "global", 2: "mission", 3: "relative", 5: "global int", 6: "relative int", 10: "terrain", 11: "terrain int",
}  # fmt: skip

INT32_MAX = 2**31 - 1
"""Parameters 5 and 6 travel as whole numbers."""
LARGEST = 3.4028234663852886e38
"""Parameters travel in single precision."""


def has_degrees(command: int) -> bool:
    """Whether parameters 5 and 6 are latitude and longitude, or stand where these do: MAVLink carries them as degE7."""
    return command not in NUMBER_COMMANDS


def make(
    command: int, frame: int, values: tuple[float, ...], autocontinue: int, where: str, current: int = 0
) -> MissionItem:
    """An item of its seven parameters (locations in degrees).

    Raises:
        MissionFileError: says ``where``, which value, and what is allowed.
    """
    p1, p2, p3, p4, x, y, z = values
    if not (math.isfinite(x) and math.isfinite(y)):
        raise MissionFileError(f"{where}: location {x}, {y} is not a pair of numbers")
    if command not in COMMANDS:
        known = ", ".join(f"{number} {c.name}" for number, c in COMMANDS.items())
        raise MissionFileError(f"{where}: command {command} is not known here; known are {known}")
    for k in range(7):
        if math.isfinite(values[k]) and abs(values[k]) > LARGEST:
            if k in (4, 5) and COMMANDS[command].has_location:
                raise MissionFileError(
                    f"{where}: {_reason(MavMissionResult.INVALID_PARAM1 + k, command, frame, values)}"
                )
            raise MissionFileError(
                f"{where}: parameter {k + 1} is {values[k]}: it is within +-{LARGEST:.2g}, MAVLink's single precision"
            )
    scale = 1e7 if has_degrees(command) else 1.0
    if scale == 1.0 and (x != int(x) or y != int(y)):
        k = 5 if x != int(x) else 6
        raise MissionFileError(f"{where}: parameter {k} is {values[k - 1]}: a whole number is needed{_of(command)}")
    item = MissionItem(command, frame, p1, p2, p3, p4, round(x * scale), round(y * scale), z, autocontinue, current)
    result = validate.check(item, COMMANDS)
    if result == MavMissionResult.ACCEPTED and not COMMANDS[command].has_location:
        result = _numbers(item)
    if result != MavMissionResult.ACCEPTED:
        raise MissionFileError(f"{where}: {_reason(result, command, frame, values)}")
    return item


def _numbers(item: MissionItem) -> int:
    """Result for parameters 5 to 7 where no location stands: files have numbers there that MAVLink carries."""
    if abs(item.x) > INT32_MAX:
        return MavMissionResult.INVALID_PARAM5_X
    if abs(item.y) > INT32_MAX:
        return MavMissionResult.INVALID_PARAM6_Y
    return MavMissionResult.ACCEPTED if math.isfinite(item.z) else MavMissionResult.INVALID_PARAM7


def _of(command: int) -> str:
    return f" (command {command} {COMMANDS[command].name})"


def _reason(result: int, command: int, frame: int, values: tuple[float, ...]) -> str:
    """Reason for the refusal of an item, in words."""
    of = _of(command)
    if result == MavMissionResult.UNSUPPORTED_FRAME:
        known = ", ".join(f"{number} {FRAME_NAMES[number]}" for number in LOCATION_FRAMES)
        return f"frame {frame} is not known for locations; known are {known}{of}"
    if result == MavMissionResult.ERROR:
        said = "item 0 is home" if int(values[0]) == 0 else "items are numbered from 1, home is 0"
        return f"DO_JUMP to item {values[0]:g} cannot be flown: {said}{of}"
    k = result - MavMissionResult.INVALID_PARAM1
    value = values[k]
    if not COMMANDS[command].has_location or k < 4:
        if math.isfinite(value):
            limit = f"{INT32_MAX * (1e-7 if has_degrees(command) else 1.0):.10g}"
            return f"parameter {k + 1} is {value}: it is within +-{limit}, which MAVLink carries{of}"
        return f"parameter {k + 1} is {value}: a finite number is needed{of}"
    if result == MavMissionResult.INVALID_PARAM5_X:
        return f"latitude {value} is not within -90 .. 90 degrees{of}"
    if result == MavMissionResult.INVALID_PARAM6_Y:
        return f"longitude {value} is not within -180 .. 180 degrees{of}"
    return f"altitude {value} is not a number of metres within +-{HIGHEST:g}{of}"


def degrees(item: MissionItem) -> Location:
    """Location of an item [deg]."""
    return (round(item.x * 1e-7, 8), round(item.y * 1e-7, 8))


def numbers(item: MissionItem) -> tuple[float, ...]:
    """The seven parameters of an item, locations in degrees."""
    x, y = degrees(item) if has_degrees(item.command) else (item.x, item.y)
    return (item.p1, item.p2, item.p3, item.p4, x, y, item.z)


def _at(
    command: int, location: Location, p1: float = 0.0, z: float = 0.0, frame: int = MavFrame.GLOBAL_RELATIVE_ALT
) -> MissionItem:
    lat, lon = location
    return MissionItem(command, frame, float(p1), x=round(lat * 1e7), y=round(lon * 1e7), z=z)
