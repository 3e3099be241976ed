# SPDX-License-Identifier: BSD-3-Clause
"""KML and KMZ: a path as waypoints, polygons as a fence.

https://developers.google.com/kml/documentation/kmlreference. One line (LineString or gx:Track) is the mission's path;
each Polygon is an area to stay in, its holes areas to stay out of. Whatever else is there is passed over.

These files come from anywhere: a document type, entities, and what is beyond the limits below are refused.
"""

from __future__ import annotations

import io
import lzma
import math
import zipfile
import zlib
from dataclasses import dataclass, field
from xml.parsers import expat

from sitl.autopilot.mission.item import MissionItem, home_item
from sitl.autopilot.mission.mission import Mission
from sitl.autopilot.mission.validate import MAX_ITEMS
from sitl.core.mavlink import MavCmd, MavFrame

from .document import FencePolygon, MissionFile, MissionFileError, make
from .json_reader import shown
from .plane import Location

LARGEST, LARGEST_TEXT = 16 * 1024 * 1024, 1024 * 1024
"""Of a document, unpacked, and of the text of one element [bytes]."""
MOST_MEMBERS, MOST_ELEMENTS, DEEPEST = 1000, 200_000, 64
"""Files in an archive; elements of a document, and how deep they lie in each other."""
ABSOLUTE, ABOVE_GROUND = "absolute", "relativeToGround"
FRAMES = {ABSOLUTE: MavFrame.GLOBAL, ABOVE_GROUND: MavFrame.GLOBAL_TERRAIN_ALT}
"""altitudeMode -> frame; of the others (clampToGround, sea floor) heights say nothing."""
LINES, RING = ("LineString", "Track"), "LinearRing"


@dataclass
class Shape:
    """A line or a ring of a document."""

    name: str
    """Of its Placemark."""
    line: int
    """Where it begins."""
    mode: str = "clampToGround"
    locations: list[tuple[float, float, float]] = field(default_factory=list)
    """Latitude, longitude [deg], height [m]."""
    is_hole: bool = False


class Reader:
    """Collects the lines and rings of a document."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._parser = expat.ParserCreate()
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.CharacterDataHandler = self._text_of
        self._parser.StartDoctypeDeclHandler = self._doctype
        self._parser.buffer_text = True
        self._open: list[str] = []
        self._count = 0
        self._text: list[str] = []
        self._size = 0
        self._placemark = ""
        self._shape: Shape | None = None
        self._mode = "clampToGround"
        self.lines: list[Shape] = []
        self.rings: list[Shape] = []
        self.points = 0

    def read(self, data: bytes) -> None:
        """Read a document.

        Raises:
            MissionFileError: it is no XML, or beyond a limit.
        """
        try:
            self._parser.Parse(data, True)
        except LookupError as error:
            raise MissionFileError(f"{self._name}: no XML that is read here: {error}") from None
        except expat.ExpatError as error:
            said = expat.ErrorString(error.code)
            raise MissionFileError(f"{self._name}:{error.lineno}: no XML: {said} (column {error.offset + 1})") from None

    def _fail(self, text: str) -> MissionFileError:
        return MissionFileError(f"{self._name}:{self._parser.CurrentLineNumber}: {text}")

    def _doctype(self, *_: object) -> None:
        raise self._fail("a document type (<!DOCTYPE ...>), which KML does not need: entities are not read")

    def _start(self, tag: str, _: dict[str, str]) -> None:
        self._count += 1
        self._open.append(tag.rpartition(":")[2])
        if self._count > MOST_ELEMENTS or len(self._open) > DEEPEST:
            raise self._fail(f"more than {MOST_ELEMENTS} elements, or more than {DEEPEST} in each other")
        if self._count == 1 and self._open != ["kml"]:
            raise self._fail(f"the document is {shown(tag)}, not 'kml'; of XML only KML is read")
        self._text, self._size = [], 0
        tag = self._open[-1]
        if tag == "Placemark":
            self._placemark = ""
        elif tag == "Polygon":
            self._mode = "clampToGround"
        elif tag in LINES or tag == RING:
            self._shape = Shape(self._placemark, self._parser.CurrentLineNumber)
            self._shape.is_hole = "innerBoundaryIs" in self._open
            in_polygon = "Polygon" in self._open
            (self.rings if tag == RING and in_polygon else self.lines).append(self._shape)

    def _text_of(self, text: str) -> None:
        self._size += len(text)
        if self._size > LARGEST_TEXT:
            raise self._fail(f"an element with more than {LARGEST_TEXT} characters")
        self._text.append(text)

    def _end(self, _: str) -> None:
        tag, text = self._open.pop(), "".join(self._text).strip()
        self._text, self._size = [], 0
        shape = self._shape
        if tag == "name" and self._open and self._open[-1] == "Placemark":
            self._placemark = text[:60]
        elif tag == "altitudeMode" and shape is not None:
            shape.mode = text
        elif tag == "coordinates":
            if shape is None:
                self.points += 1
            else:
                shape.locations += [self._location(word.split(","), "longitude,latitude") for word in text.split()]
        elif tag == "coord" and shape is not None:
            shape.locations.append(self._location(text.split(), "longitude latitude"))
        elif tag in LINES or tag == RING:
            self._shape = None

    def _location(self, words: list[str], form: str) -> tuple[float, float, float]:
        try:
            lon, lat, height = map(float, (*words, "0")[: max(len(words), 3)])
        except ValueError:
            raise self._fail(f"{shown(' '.join(words))} is not {form} and a height or none") from None
        if not (-90.0 <= lat <= 90.0 and -180.0 <= lon <= 180.0 and math.isfinite(height)):
            raise self._fail(f"{shown(' '.join(words))}: longitude is within -180 .. 180, latitude within -90 .. 90")
        return (lat, lon, height)


def parse(data: bytes, name: str = "mission", altitude: float | None = None) -> MissionFile:
    """The path and the areas of a document.

    Args:
        data: of a .kml.
        name: for messages.
        altitude: height of the path above home in place of its own [m].

    Raises:
        MissionFileError: says where; or the path lies on the ground and ``altitude`` is not given; or there is none,
            or more than one, and no area.
    """
    reader = Reader(name)
    reader.read(data)
    polygons = tuple(_polygon(ring, name) for ring in reader.rings)
    paths = [line for line in reader.lines if line.locations]
    if len(paths) > 1:
        named = ", ".join(f"{shown(path.name)} (line {path.line})" for path in paths[:8])
        raise MissionFileError(f"{name}: {len(paths)} paths ({named}); a mission is one: save it as a file of its own")
    if not paths and not polygons:
        raise MissionFileError(f"{name}: no path (LineString, gx:Track) and no polygon; {reader.points} single points")
    mission = Mission.of(_items(paths[0], name, altitude)) if paths else Mission()
    said = "heights are above the sea; the file does not say how high the ground is (--home LAT,LON,ALT,HEADING)"
    over_sea = any(item.frame == MavFrame.GLOBAL for item in mission.items[1:])
    return MissionFile(mission, name, polygons=polygons, is_path=bool(paths), notes=(said,) if over_sea else ())


def _items(path: Shape, name: str, altitude: float | None) -> list[MissionItem]:
    """The path as waypoints, home where it begins."""
    where = f"{name}:{path.line}"
    if len(path.locations) >= MAX_ITEMS - 2:
        raise MissionFileError(f"{where}: a path of {len(path.locations)} locations; a mission holds {MAX_ITEMS} items")
    frame = FRAMES.get(path.mode)
    if altitude is None and frame is None:
        raise MissionFileError(
            f"{where}: the path lies on the ground (altitudeMode {path.mode[:40]}): its height is missing "
            "(--altitude METRES above home, or altitude=)"
        )
    if altitude is not None or frame is None:
        frame = MavFrame.GLOBAL_RELATIVE_ALT
    lat, lon, _ = path.locations[0]
    items = [home_item(round(lat * 1e7), round(lon * 1e7), 0.0)]
    for lat, lon, height in path.locations:
        height = height if altitude is None else altitude
        items.append(make(MavCmd.NAV_WAYPOINT, frame, (0.0, 0.0, 0.0, 0.0, lat, lon, height), 1, where))
    return items


def _polygon(ring: Shape, name: str) -> FencePolygon:
    corners: list[Location] = [location[:2] for location in ring.locations]
    if len(corners) > 1 and corners[0] == corners[-1]:
        corners.pop()
    if len(corners) < 3:
        raise MissionFileError(f"{name}:{ring.line}: {len(corners)} corners; a polygon has three or more")
    return FencePolygon(tuple(corners), not ring.is_hole)


def unpack(data: bytes, name: str) -> bytes:
    """The document of a KMZ archive: its first .kml, as Google Earth takes it.

    Raises:
        MissionFileError: it cannot be unpacked, has none, or is beyond a limit.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = archive.infolist()
            if len(members) > MOST_MEMBERS:
                raise MissionFileError(f"{name}: {len(members)} files in it; at most {MOST_MEMBERS} are allowed")
            found = next((member for member in members if member.filename.lower().endswith(".kml")), None)
            if found is None:
                raise MissionFileError(f"{name}: an archive without a .kml")
            with archive.open(found) as file:
                document = file.read(LARGEST + 1)  # its size as the archive states it may be untrue
    except (zipfile.BadZipFile, zlib.error, lzma.LZMAError, EOFError, OSError, ValueError, RuntimeError) as error:
        raise MissionFileError(f"{name}: cannot be unpacked: {error}") from None
    if len(document) > LARGEST:
        raise MissionFileError(f"{name}: {shown(found.filename)} is larger than {LARGEST} bytes")
    return document
