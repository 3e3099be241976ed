# SPDX-License-Identifier: BSD-3-Clause
"""Fences and rally points as lists of locations: "QGC WPL" items of them, ``.fen``, ``.poly`` and ``RALLY`` lines.

As in pymavlink's loaders (``mavwp.MissionItemProtocol_Fence``, ``MissionItemProtocol_Rally``); ``.poly`` as Mission
Planner and MAVProxy write it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.mission.mission import Mission
from sitl.core.mavlink import MavCmd, MavFrame

from .document import FenceCircle, FencePolygon, MissionFile, MissionFileError, RallyPoint, degrees
from .plane import Location

RALLY_WORD = "RALLY"
RALLY_COLUMNS = 7
FEWEST = 3
"""Corners of a polygon."""


def of_fence(items: list[MissionItem], lines: list[str]) -> MissionFile:
    """The fence of mission items; ``lines`` says where each is.

    Raises:
        MissionFileError: a polygon has other corners than its items say.
    """
    circles: list[FenceCircle] = []
    polygons: list[FencePolygon] = []
    back = None
    k = 0
    while k < len(items):
        item = items[k]
        location = degrees(item)
        if item.command == MavCmd.NAV_FENCE_RETURN_POINT:
            back = (*location, item.z)
        elif item.command in (MavCmd.NAV_FENCE_CIRCLE_INCLUSION, MavCmd.NAV_FENCE_CIRCLE_EXCLUSION):
            circles.append(
                FenceCircle(location, item.p1, item.command == MavCmd.NAV_FENCE_CIRCLE_INCLUSION, item.frame)
            )
        else:
            count = int(item.p1)
            corners = [i for i in items[k : k + max(count, 1)] if (i.command, i.p1) == (item.command, item.p1)]
            if count < FEWEST or len(corners) != count:
                raise MissionFileError(
                    f"{lines[k]}: a polygon of {item.p1:g} corners begins here, and {len(corners)} follow; "
                    f"it has {FEWEST} or more, and parameter 1 of each says how many"
                )
            polygons.append(
                FencePolygon(
                    tuple(map(degrees, corners)), item.command == MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION, item.frame
                )
            )
            k += count - 1
        k += 1
    return MissionFile(Mission(), circles=tuple(circles), polygons=tuple(polygons), breach_return=back)


def of_rally(items: list[MissionItem], lines: list[str]) -> MissionFile:
    """The rally points of mission items."""
    return MissionFile(Mission(), rally=tuple(RallyPoint(degrees(item), item.z, item.frame) for item in items))


def parse_fence(text: str, name: str) -> MissionFile:
    """A ``.fen``: the location to return to, then the corners of a polygon to stay in, the first of them once more.

    Raises:
        MissionFileError: names the line.
    """
    locations = _locations(text, name)
    if len(locations) < FEWEST + 2:
        raise MissionFileError(
            f"{name}: {len(locations)} lines; a fence has a location to return to, {FEWEST} or more corners, and the "
            "first corner once more (a bare polygon is read from a .poly)"
        )
    (back, _), (first, _), (last, where) = locations[0], locations[1], locations[-1]
    if last != first:
        closes = "line 1" if last == back else "no other"
        raise MissionFileError(
            f"{where}: the last location is that of {closes}: line 1 is where to return to, and the last location "
            "closes the polygon that begins behind it. Put a location to return to first, or name the "
            "file .poly, a bare polygon"
        )
    corners = tuple(location for location, _ in locations[1:-1])
    return MissionFile(
        Mission(), name, polygons=(FencePolygon(corners, frame=MavFrame.GLOBAL),), breach_return=(*back, 0.0)
    )


def parse_polygon(text: str, name: str) -> MissionFile:
    """A ``.poly``: corners of a polygon, the first once more or not; as a fence to stay in.

    Raises:
        MissionFileError: names the line.
    """
    locations = _locations(text, name)
    if len(locations) > 1 and locations[-1][0] == locations[0][0]:
        locations.pop()
    if len(locations) < FEWEST:
        raise MissionFileError(f"{name}: {len(locations)} corners; a polygon has {FEWEST} or more")
    return MissionFile(Mission(), name, polygons=(FencePolygon(tuple(location for location, _ in locations)),))


def parse_rally(text: str, name: str) -> MissionFile:
    """Lines "RALLY latitude longitude altitude break-altitude direction flags"; the last three are for planes.

    Raises:
        MissionFileError: names the line.
    """
    points: list[RallyPoint] = []
    planes = False
    for where, words in _rows(text, name):
        if len(words) != RALLY_COLUMNS or words[0].upper() != RALLY_WORD:
            raise MissionFileError(
                f"{where}: {' '.join(words)[:60]!r} is not {RALLY_WORD} and six numbers: latitude, longitude, "
                "altitude, break altitude, direction, flags"
            )
        values = [_number(word, where) for word in words[1:]]
        points.append(RallyPoint(_location(values[0], values[1], where), values[2]))
        planes = planes or values[3] != 0.0 or values[4] != 0.0
    said = "break altitudes and directions of rally points are for planes and left out"
    return MissionFile(Mission(), name, rally=tuple(points), notes=(said,) if planes else ())


def _rows(text: str, name: str) -> Iterator[tuple[str, list[str]]]:
    """The words of each line that has some, and where it is."""
    for number, line in enumerate(text.splitlines(), start=1):
        words = line.split()
        if words and not words[0].startswith("#"):
            yield f"{name}:{number}", words


def _locations(text: str, name: str) -> list[tuple[Location, str]]:
    """Lines of latitude and longitude [deg], and where each is."""
    found = []
    for where, words in _rows(text, name):
        if len(words) != 2:
            raise MissionFileError(f"{where}: {' '.join(words)[:60]!r} is not a latitude and a longitude")
        found.append((_location(_number(words[0], where), _number(words[1], where), where), where))
    return found


def _location(lat: float, lon: float, where: str) -> Location:
    if not -90.0 <= lat <= 90.0:
        raise MissionFileError(f"{where}: latitude {lat} is not within -90 .. 90 degrees")
    if not -180.0 <= lon <= 180.0:
        raise MissionFileError(f"{where}: longitude {lon} is not within -180 .. 180 degrees")
    return (lat, lon)


def _number(text: str, where: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise MissionFileError(f"{where}: {text[:40]!r} is not a number")
    return value
