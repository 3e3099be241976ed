# SPDX-License-Identifier: BSD-3-Clause
"""Mission files: what kind a file is, by its content first and then by its name; read and written."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from sitl.core.whole_file import write_whole

from . import kml, lists, plan, wpl
from .document import MissionFile, MissionFileError

LARGEST = 16 * 1024 * 1024
"""Of a file [bytes]."""
SUFFIXES = (".plan", ".waypoints", ".txt")
"""That are written."""
READ_TEXT = "QGC WPL text (.waypoints, .txt), .plan, .kml, .kmz, .fen, .poly, RALLY lines"
ARCHIVE = b"PK\x03\x04"
UTF_16 = (b"\xff\xfe", b"\xfe\xff")


def load(path: str | Path, altitude: float | None = None) -> MissionFile:
    """Read a file of any kind: QGC WPL text, a .plan, KML or KMZ, a fence (.fen), a polygon (.poly), rally points.

    Args:
        path: of the file.
        altitude: height above home of a KML's path [m]; other files say their own.

    Raises:
        MissionFileError: the file cannot be read, or something in it cannot be taken.
    """
    path = Path(path)
    name = str(path)
    try:
        with path.open("rb") as file:
            data = file.read(LARGEST + 1)
    except OSError as error:
        raise MissionFileError(f"{path}: {error.strerror or error}") from None
    if len(data) > LARGEST:
        raise MissionFileError(f"{path}: larger than {LARGEST} bytes")
    if data.startswith(ARCHIVE):
        return kml.parse(kml.unpack(data, name), name, altitude)
    content = _decoded(data, name)
    start = content.lstrip()[:1]
    if not start:
        raise MissionFileError(f"{name}: there is nothing in it; {READ_TEXT} are read")
    if start == "<":
        return kml.parse(data if data.startswith(UTF_16) else data.lstrip(), name, altitude)
    if altitude is not None:
        raise MissionFileError(f"{name}: altitude {altitude:g} is for the path of a KML; this file says its heights")
    if start in ("{", "[") or (path.suffix.lower() == ".plan" and not _first(content).startswith("QGC WPL")):
        return plan.parse(content, name)
    return _of_lines(content, name, path.suffix.lower())


def _decoded(data: bytes, name: str) -> str:
    """The text of a file."""
    encoding = "utf-16" if data.startswith(UTF_16) else "utf-8-sig"
    try:
        return data.decode(encoding)
    except UnicodeDecodeError as error:
        if data.lstrip().startswith(b"<"):
            return "<"  # XML says its encoding
        raise MissionFileError(f"{name}: byte {error.start} is no text ({encoding[:6].rstrip('-').upper()})") from None


def _of_lines(content: str, name: str, suffix: str) -> MissionFile:
    first = _first(content)
    words = first.split()
    if words and words[0].upper() == lists.RALLY_WORD:
        return lists.parse_rally(content, name)
    if len(words) == 2 and all(map(_is_number, words)):
        return lists.parse_polygon(content, name) if suffix == ".poly" else lists.parse_fence(content, name)
    if suffix in (".fen", ".poly") and not first.startswith("QGC WPL"):
        raise MissionFileError(f"{name}: {first[:60]!r} is not a latitude and a longitude")
    return wpl.parse(content, name)


def _first(content: str) -> str:
    """The first line that is no comment."""
    lines = (line.strip() for line in content.splitlines())
    return next((line for line in lines if line and not line.startswith("#")), "")


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def joined(file: MissionFile, *others: MissionFile) -> MissionFile:
    """A mission with the fences and rally points of other files."""
    for other in others:
        file = replace(
            file,
            circles=file.circles + other.circles,
            polygons=file.polygons + other.polygons,
            breach_return=file.breach_return or other.breach_return,
            rally=file.rally + other.rally,
            notes=file.notes + other.notes,
        )
    return file


def save(file: MissionFile, path: str | Path) -> None:
    """Write a file; what the text format cannot hold (fence, rally points beside a mission) is left out there.

    Raises:
        MissionFileError: the suffix is of neither format, or the file cannot be written.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise MissionFileError(f"{path}: suffix {suffix!r} is not one of {', '.join(SUFFIXES)}")
    write_whole(path, plan.write(file) if suffix == ".plan" else wpl.write(file), MissionFileError, f"mission {path}")
