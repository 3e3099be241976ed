# SPDX-License-Identifier: BSD-3-Clause
"""Complex items of plans: surveys, corridors and structures, as the items that they stand for.

QGroundControl stores the items of surveys and corridors (``TransectStyleComplexItem.Items``); those are flown. Where
they are missing, and for structures, the path is made here: the path only, a camera is not triggered.
"""

from __future__ import annotations

import math

from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.mission.validate import HIGHEST, MAX_ITEMS
from sitl.core.elementary import cos, sin
from sitl.core.mavlink import MavCmd, MavFrame
from sitl.core.sums import separation

from .document import make
from .json_reader import Node
from .plane import Plane, Point, along, area, moved, shifted

Line = list[Point]
FROM_RIGHT, FROM_END = 1, 2
"""Bits of an entry: the rightmost line first; each line begins where it would have ended."""


def count_of(width: float, spacing: float) -> int:
    """Number of lines that cover a width [m]: each covers half a spacing on both sides, plus a thousandth."""
    return max(1, math.ceil(width / spacing - 1e-3))


def across_polygon(polygon: list[Point], spacing: float, heading: float) -> list[Line]:
    """Lines over a polygon, from left to right, each in the direction of ``heading`` [rad].

    They lie ``spacing`` [m] apart and evenly in the width of the polygon. Of a polygon with bays a line runs from its
    first edge to its last.
    """
    forward = (cos(heading), sin(heading))
    right = (-forward[1], forward[0])
    side = [p[0] * right[0] + p[1] * right[1] for p in polygon]
    ahead = [p[0] * forward[0] + p[1] * forward[1] for p in polygon]
    low, width = min(side), max(side) - min(side)
    count = count_of(width, spacing)
    first = low + (width - (count - 1) * spacing) / 2.0
    lines = []
    for k in range(count):
        at = first + k * spacing
        cuts = []
        for j in range(len(polygon)):
            a, b = side[j - 1], side[j]
            if (a <= at < b) or (b <= at < a):
                cuts.append(ahead[j - 1] + (ahead[j] - ahead[j - 1]) * (at - a) / (b - a))
        if len(cuts) >= 2:
            ends = (min(cuts), max(cuts))
            lines.append([(right[0] * at + forward[0] * s, right[1] * at + forward[1] * s) for s in ends])
    return lines


def along_corridor(polyline: list[Point], width: float, spacing: float) -> list[Line]:
    """Lines [m] beside each other over a corridor of a width [m], from left to right."""
    count = count_of(width, spacing)
    return [shifted(polyline, (k - (count - 1) / 2.0) * spacing) for k in range(count)]


def lengthened(line: Line, distance: float) -> Line:
    """A line that begins and ends so much further out [m]."""
    if distance == 0.0:
        return line
    first = moved(line[0], along(line[1], line[0]), distance)
    last = moved(line[-1], along(line[-2], line[-1]), distance)
    return [first, *line[1:-1], last]


def there_and_back(lines: list[Line], entry: int, turnaround: float, alternate: bool = False) -> Line:
    """The path over all lines.

    Args:
        lines: from left to right.
        entry: where it begins (FROM_RIGHT, FROM_END).
        turnaround: how far it goes beyond both ends of each line before it turns [m].
        alternate: every other line first, the ones between on the way back.
    """
    ordered = lines[::-1] if entry & FROM_RIGHT else lines
    if alternate:
        ordered = ordered[::2] + ordered[1::2][::-1]
    path: Line = []
    for k, line in enumerate(ordered):
        whole = lengthened(line, turnaround)
        path += whole[::-1] if (k % 2 == 1) != bool(entry & FROM_END) else whole
    return path


SURVEY, CORRIDOR, STRUCTURE = "survey", "CorridorScan", "StructureScan"
KINDS = (SURVEY, CORRIDOR, STRUCTURE)
LANDINGS = {"fwLandingPattern": "fixed-wing aircraft", "vtolLandingPattern": "VTOL aircraft"}
STYLE = "TransectStyleComplexItem"
FRAMES = {
    1: MavFrame.GLOBAL_RELATIVE_ALT,
    2: MavFrame.GLOBAL,
    3: MavFrame.GLOBAL_RELATIVE_ALT,
    4: MavFrame.GLOBAL_TERRAIN_ALT,
}
"""CameraCalc.DistanceMode -> frame; 3 is heights above terrain from the ground station, and the ground is flat here."""
FARTHEST = 1e5
"""Greatest width, spacing, turnaround [m]."""
ENTRIES = (FROM_END, FROM_END | FROM_RIGHT, 0, FROM_RIGHT)
"""Corner for entryLocation 0 .. 3: top left, top right, bottom left, bottom right, when lines run upwards."""


def kind(entry: Node) -> str:
    """Kind of a complex item.

    Raises:
        MissionFileError: none that copters or rovers fly.
    """
    found = entry["complexItemType"]
    name = found.text
    if name in LANDINGS:
        raise found.fail(f"{name!r} is a landing of {LANDINGS[name]}; copters and rovers fly {', '.join(KINDS)}")
    if name not in KINDS:
        raise found.fail(f"{name!r} is not one of {', '.join(KINDS)}")
    return name


def stored(entry: Node) -> list[Node] | None:
    """The items that the ground station stored; None when there are none."""
    if kind(entry) == STRUCTURE or STYLE not in entry:
        return None
    items = entry[STYLE].get("Items", [])
    return list(items) or None


def expand(entry: Node) -> list[MissionItem]:
    """The path that a complex item describes, as waypoints."""
    makers = {SURVEY: _survey, CORRIDOR: _corridor, STRUCTURE: _structure}
    return makers[kind(entry)](entry)


def _survey(entry: Node) -> list[MissionItem]:
    style = entry[STYLE]
    plane, polygon = _polygon(entry)
    spacing, turnaround = _spacing(style), style.get("TurnAroundDistance", 0.0).number(0.0, FARTHEST)
    heading = math.radians(entry.get("angle", 0.0).number(-360.0, 360.0))
    start = ENTRIES[entry.get("entryLocation", 0).whole(0, 1, 2, 3)]
    alternate = entry.get("flyAlternateTransects", False).flag
    path: list[Point] = []
    for turn in (0.0, math.pi / 2.0) if style.get("Refly90Degrees", False).flag else (0.0,):
        _limit(entry, max(separation(a, b) for a in polygon for b in polygon) / spacing)
        lines = across_polygon(polygon, spacing, heading + turn)
        path += there_and_back(lines, start, turnaround, alternate)
    if not path:
        raise entry["polygon"].fail("no line crosses it: its corners lie on one line")
    height, frame = _height(style)
    return [_waypoint(plane, point, height, frame, entry) for point in path]


def _corridor(entry: Node) -> list[MissionItem]:
    style = entry[STYLE]
    locations = [corner.location() for corner in entry["polyline"]]
    if len(locations) < 2:
        raise entry["polyline"].fail(f"{len(locations)} locations; a corridor has two or more")
    plane = Plane(locations[0])
    spacing, turnaround = _spacing(style), style.get("TurnAroundDistance", 0.0).number(0.0, FARTHEST)
    width = entry["CorridorWidth"].number(0.0, FARTHEST)
    _limit(entry, width / spacing * len(locations))
    lines = along_corridor([plane.point(location) for location in locations], width, spacing)
    path = there_and_back(lines, entry.get("EntryPoint", 0).whole(0, 1, 2, 3), turnaround)
    height, frame = _height(style)
    return [_waypoint(plane, point, height, frame, entry) for point in path]


def _structure(entry: Node) -> list[MissionItem]:
    """Round a structure at a distance, layer by layer, beginning and ending over its first corner."""
    plane, polygon = _polygon(entry)
    camera = entry["CameraCalc"]
    if area(polygon) > 0.0:  # to its left is outside
        polygon = [polygon[0], *polygon[:0:-1]]
    ring = shifted(polygon, camera["DistanceToSurface"].number(0.0, FARTHEST), closed=True)
    layer = camera["AdjustedFootprintFrontal"].number(0.01, FARTHEST)
    if "ScanBottomAlt" in entry:  # version 3
        bottom, top = entry["ScanBottomAlt"].number(-HIGHEST, HIGHEST), entry["StructureHeight"].number(0.0, HIGHEST)
        entrance = entry["EntranceAltitude"].number(-HIGHEST, HIGHEST)
        falls, frame = entry.get("StartFromTop", False).flag, MavFrame.GLOBAL_RELATIVE_ALT
    else:
        bottom = entrance = entry["Altitude"].number(-HIGHEST, HIGHEST)
        top, falls = bottom, False
        frame = MavFrame.GLOBAL_RELATIVE_ALT if entry.get("altitudeRelative", True).flag else MavFrame.GLOBAL
    layers = entry["Layers"].number(1.0, MAX_ITEMS)
    _limit(entry, layers * (len(ring) + 1))
    heights = [top - layer * (k + 0.5) if falls else bottom + layer * (k + 0.5) for k in range(int(layers))]
    around = [(point, height) for height in heights for point in (*ring, ring[0])]
    path = [(ring[0], entrance), *around, (ring[0], entrance)]
    return [_waypoint(plane, point, height, frame, entry) for point, height in path]


def _polygon(entry: Node) -> tuple[Plane, list[Point]]:
    locations = [corner.location() for corner in entry["polygon"]]
    if len(locations) < 3:
        raise entry["polygon"].fail(f"{len(locations)} corners; a polygon has three or more")
    plane = Plane(locations[0])
    return plane, [plane.point(location) for location in locations]


def _spacing(style: Node) -> float:
    """Distance of neighbouring lines [m]."""
    return style["CameraCalc"]["AdjustedFootprintSide"].number(0.01, FARTHEST)


def _height(style: Node) -> tuple[float, int]:
    """Height of a flat path [m] and its frame."""
    camera = style["CameraCalc"]
    height = camera["DistanceToSurface"].number(-HIGHEST, HIGHEST)
    if "DistanceMode" in camera:
        return height, FRAMES[camera["DistanceMode"].whole(*FRAMES)]
    return height, MavFrame.GLOBAL_RELATIVE_ALT if camera.get(
        "DistanceToSurfaceRelative", True
    ).flag else MavFrame.GLOBAL


def _limit(entry: Node, lines: float) -> None:
    """Refuse what would be more items than a mission holds."""
    if lines > MAX_ITEMS:
        raise entry.fail(f"about {lines:.0f} lines or corners; a mission holds {MAX_ITEMS} items")


def _waypoint(plane: Plane, point: Point, height: float, frame: int, entry: Node) -> MissionItem:
    lat, lon = plane.location(point)
    return make(MavCmd.NAV_WAYPOINT, frame, (0.0, 0.0, 0.0, math.nan, lat, lon, height), 1, entry.where)
