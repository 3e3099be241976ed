# SPDX-License-Identifier: BSD-3-Clause
"""KML and KMZ: paths and polygons are read; what is hostile or beyond the limits is refused."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.core.mavlink import MavCmd, MavFrame
from sitl.missions.files import MissionFile, MissionFileError, as_flight, kml, load, save
from tests import mutations

PATH = "149.1652,-35.3632,20 149.1653,-35.3630,25\n149.1654,-35.3630,30"
OPEN = '<?xml version="1.0" encoding="UTF-8"?>\n<kml xmlns="http://www.opengis.net/kml/2.2" xmlns:gx="g"><Document>'
CLOSE = "</Document></kml>"


def placemark(inside: str, name: str = "my path") -> str:
    """A place mark of a shape."""
    return f"<Placemark><name>{name}</name>{inside}</Placemark>"


def line(mode: str = "absolute", places: str = PATH) -> str:
    """A path."""
    return placemark(f"<LineString><altitudeMode>{mode}</altitudeMode><coordinates>{places}</coordinates></LineString>")


def ring(tag: str, places: str) -> str:
    """A boundary of a polygon."""
    return f"<{tag}><LinearRing><coordinates>{places}</coordinates></LinearRing></{tag}>"


def document(*marks: str) -> bytes:
    """A KML of place marks."""
    return (OPEN + "".join(marks) + CLOSE).encode()


@pytest.mark.parametrize(
    ("mode", "altitude", "frame", "heights"),
    [
        ("absolute", None, MavFrame.GLOBAL, [20.0, 25.0, 30.0]),
        ("relativeToGround", None, MavFrame.GLOBAL_TERRAIN_ALT, [20.0, 25.0, 30.0]),
        ("clampToGround", 12.0, MavFrame.GLOBAL_RELATIVE_ALT, [12.0] * 3),
        ("absolute", 12.0, MavFrame.GLOBAL_RELATIVE_ALT, [12.0] * 3),
    ],
)
def test_a_path(mode: str, altitude: float | None, frame: int, heights: list[float]) -> None:
    """Waypoints in its order; heights are what its mode says, or above home where they are given."""
    found = kml.parse(document(line(mode)), "m", altitude)
    items = found.mission.items[1:]
    assert [(i.command, i.frame, i.z) for i in items] == [(MavCmd.NAV_WAYPOINT, frame, z) for z in heights]
    assert (items[0].x, items[0].y) == (-353632000, 1491652000)
    assert found.home == (-35.3632, 149.1652, 0.0)
    assert bool(found.notes) == (frame == MavFrame.GLOBAL)


def test_a_path_is_flown_with_a_take_off_and_a_return() -> None:
    """Which it lacks; other missions stay as they are."""
    flight = as_flight(kml.parse(document(line("relativeToGround"))))
    assert [i.command for i in flight.mission.items[1:]] == [22, 16, 16, 16, 20]
    assert (flight.mission.items[1].frame, flight.mission.items[1].z) == (MavFrame.GLOBAL_TERRAIN_ALT, 20.0)
    assert as_flight(flight) is flight


def test_a_track_is_a_path() -> None:
    """As loggers write them: longitude, latitude, height apart."""
    track = "<gx:Track><altitudeMode>absolute</altitudeMode><gx:coord>149.1 -35.1 7</gx:coord></gx:Track>"
    item = kml.parse(document(placemark(track))).mission.items[1]
    assert (item.x, item.y, item.z) == (-351000000, 1491000000, 7.0)


def test_polygons_are_a_fence(tmp_path: Path) -> None:
    """To stay in; their holes to stay out of. A document of these alone has no mission."""
    outer, inner = "1,1 1,2 2,2 2,1 1,1", "1.4,1.4 1.4,1.6 1.6,1.6 1.4,1.4"
    area = f"<Polygon>{ring('outerBoundaryIs', outer)}{ring('innerBoundaryIs', inner)}</Polygon>"
    (tmp_path / "area.kml").write_bytes(document(placemark(area)))
    found = load(tmp_path / "area.kml")
    assert [(len(p.corners), p.inclusion) for p in found.polygons] == [(4, True), (3, False)]
    assert found.polygons[0].corners[1] == (2.0, 1.0)
    assert not found.mission.items
    save(found, tmp_path / "area.waypoints")
    assert load(tmp_path / "area.waypoints").polygons == found.polygons


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_encodings(encoding: str, tmp_path: Path) -> None:
    text = document(line()).decode().replace("UTF-8", encoding[:6].rstrip("-").replace("utf-16", "UTF-16"))
    (tmp_path / "m.kml").write_bytes(text.encode(encoding))
    assert len(load(tmp_path / "m.kml").mission) == 4


def archive(name: str = "doc.kml", data: bytes | None = None, compression: int = zipfile.ZIP_DEFLATED) -> bytes:
    """A KMZ."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", compression) as file:
        file.writestr("files/icon.png", b"icon")
        file.writestr(name, document(line()) if data is None else data)
    return out.getvalue()


def test_an_archive(tmp_path: Path) -> None:
    (tmp_path / "m.kmz").write_bytes(archive())
    assert len(load(tmp_path / "m.kmz").mission) == 4


BOMB = '<!DOCTYPE kml [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]><kml><Document><name>&b;</name></Document></kml>'
OUTSIDE = '<!DOCTYPE kml SYSTEM "file:///etc/hostname"><kml></kml>'


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (
            document(line("clampToGround")),
            r"m:2: the path lies on the ground \(.*clampToGround\).*--altitude",
        ),
        (document(line(), line()), r"m: 2 paths \('my path' \(line 2\), 'my path' \(line 3\)\); a mission is one"),
        (
            document("<Placemark><Point><coordinates>1,2</coordinates></Point></Placemark>"),
            r"no path.*1 single points",
        ),
        (document(line(places="1,two")), r"m:2: '1 two' is not longitude,latitude"),
        (document(line(places="1")), r"m:2: '1' is not longitude,latitude"),
        (document(line(places="1,91")), r"m:2: '1 91': longitude is within"),
        (document(line(places="1,nan")), r"m:2: '1 nan': longitude is within"),
        (document(line(places="1,2,inf")), r"m:2: '1 2 inf': longitude"),
        (document(line(places="1,2 " * 800)), r"m:2: a path of 800 locations; a mission holds"),
        (document(placemark("<Polygon>" + ring("outerBoundaryIs", "1,1 2,2") + "</Polygon>")), r"m:2: 2 corners"),
        (b"<kml><Document>", r"m:1: no XML: no element found"),
        (b"<html></html>", r"m:1: the document is 'html', not 'kml'"),
        (BOMB.encode(), r"m:1: a document type"),
        (OUTSIDE.encode(), r"m:1: a document type"),
        (b"<kml>" + b"<a>" * 100, r"m:1: more than 200000 elements, or more than 64 in each other"),
        (b"<kml>" + b"<a/>" * 200_001, r"m:1: more than 200000 elements"),
        (b"<kml><a>" + b"x" * 1_100_000, r"m:1: an element with more than 1048576 characters"),
    ],
)
def test_refused(data: bytes, message: str) -> None:
    """With the line; nothing is read from elsewhere, and nothing grows."""
    with pytest.raises(MissionFileError, match=message):
        kml.parse(data, "m")


def many() -> bytes:
    """An archive of more files than are allowed."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as file:
        for k in range(1001):
            file.writestr(f"{k}", b"")
    return out.getvalue()


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (archive("doc.txt"), "an archive without a .kml"),
        (archive(data=b" " * (kml.LARGEST + 1)), r"'doc\.kml' is larger than 16777216 bytes"),
        (archive()[:200], "cannot be unpacked"),
        (many(), "1001 files in it; at most 1000"),
    ],
)
def test_archives_refused(data: bytes, message: str, tmp_path: Path) -> None:
    """Also one whose document is small packed and huge unpacked."""
    (tmp_path / "m.kmz").write_bytes(data)
    with pytest.raises(MissionFileError, match=message):
        load(tmp_path / "m.kmz")


WHOLE = archive(compression=zipfile.ZIP_STORED)


@given(st.integers(0, len(WHOLE) - 1), st.integers(0, 255), st.sampled_from([archive(), WHOLE, document(line())]))
def test_no_byte_breaks_it(place: int, value: int, data: bytes) -> None:
    """A changed byte gives a mission or a MissionFileError."""
    changed = bytearray(data)
    changed[place % len(data)] = value

    def read() -> MissionFile:
        return kml.parse(kml.unpack(bytes(changed), "m.kml") if data.startswith(b"PK") else bytes(changed), "m.kml")

    found = mutations.read_or_refused(read, MissionFileError, "m.kml")
    assert found is not None or bytes(changed) != data
