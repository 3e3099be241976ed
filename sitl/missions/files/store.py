# SPDX-License-Identifier: BSD-3-Clause
"""Mission files on disk; the suffix chooses the format."""

from __future__ import annotations

from pathlib import Path

from . import plan, plan_writer, wpl
from .document import MissionFile
from .mistakes import MissionFileError

SUFFIXES = (".plan", ".waypoints", ".txt")


def load(path: str | Path) -> MissionFile:
    """Read a file; .plan is QGroundControl's JSON, everything else QGC WPL 110.

    Raises:
        MissionFileError: the file cannot be read, or something in it cannot be taken.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise MissionFileError(f"{path}: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        raise MissionFileError(f"{path}: byte {error.start} is no text (UTF-8)") from None
    is_plan = path.suffix.lower() == ".plan"
    return plan.parse(text, str(path)) if is_plan else wpl.parse(text, str(path))


def save(file: MissionFile, path: str | Path) -> None:
    """Write a file; what the text format cannot hold (fence, rally points) is left out there.

    Raises:
        MissionFileError: the suffix is of neither format, or the file cannot be written.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise MissionFileError(f"{path}: suffix {suffix!r} is not one of {', '.join(SUFFIXES)}")
    text = plan_writer.write(file) if suffix == ".plan" else wpl.write(file)
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise MissionFileError(f"{path}: {error.strerror or error}") from None
