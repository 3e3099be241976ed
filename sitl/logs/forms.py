# SPDX-License-Identifier: BSD-3-Clause
"""What form a file with a flight has, by its content; for other files, what they are, in words for a message."""

from __future__ import annotations

from pathlib import Path

from .dataflash.formats import is_binary, is_text
from .tlog import LogError

RECORDING, TLOG, DATAFLASH = "a recording", "a .tlog", "a DataFlash log"
_SUFFIXES = {".rec": RECORDING, ".snapshot": RECORDING, ".tlog": TLOG}
_RECORDING_MARK = b"\x89SITLREC"
_OTHERS = (
    (b"ULog\x01\x12\x35", "a log of PX4 (.ulg)"),
    (b"QGC WPL", "a mission"),
    (b"\x89PNG", "a picture"),
    (b"GIF8", "a picture"),
    (b"\xff\xd8\xff", "a picture"),
    (b"%PDF", "a document (PDF)"),
    (b"PK\x03\x04", "a packed file (.zip): unpack it"),
    (b"\x1f\x8b", "a packed file (.gz): unpack it"),
    (b"BZh", "a packed file (.bz2): unpack it"),
    (b"\xfd7zXZ\0", "a packed file (.xz): unpack it"),
    (b"7z\xbc\xaf\x27\x1c", "a packed file (.7z): unpack it"),
    (b"#ROSBAG", "a ROS bag"),
    (b"\x93NUMPY", "an array of numpy"),
)
_START = 1 << 16
_LINE = 40


def of(path: Path) -> str:
    """``RECORDING``, ``TLOG`` or ``DATAFLASH``; else what it is, in words. A log that is damaged where it begins is of
    the form that its name says.

    Raises:
        LogError: it cannot be read.
    """
    if path.is_dir():
        raise LogError(f"{str(path)!r} is a folder, not a log")
    try:
        with path.open("rb") as file:
            start = file.read(_START)
    except FileNotFoundError:
        raise LogError(f"{str(path)!r} does not exist") from None
    except OSError as error:
        raise LogError(f"{str(path)!r} cannot be read: {error.strerror or error}") from None
    if start.startswith(_RECORDING_MARK):
        return RECORDING
    other = next((words for mark, words in _OTHERS if start.startswith(mark)), "")
    if other:
        return other
    if is_binary(start) or is_text(start):
        return DATAFLASH
    if _is_tlog(start):
        return TLOG
    return _SUFFIXES.get(path.suffix.lower(), "") or _words(start)


def _is_tlog(start: bytes) -> bool:
    """Whether there are two frames behind their times."""
    if len(start) < 20 or start[8] not in (0xFD, 0xFE):
        return False
    end = 8 + start[9] + (12 + 13 * (start[10] & 1) if start[8] == 0xFD else 8)
    return end == len(start) or (len(start) > end + 8 and start[end + 8] in (0xFD, 0xFE))


def _words(start: bytes) -> str:
    if not start:
        return "empty"
    if start[0] in (0xFD, 0xFE):
        return "no log, or MAVLink without times (MAVProxy's .tlog.raw)"
    line = start.split(b"\n", 1)[0][:_LINE]
    try:
        text = line.decode("utf-8")
    except UnicodeDecodeError:
        return f"no log: it begins with the bytes {start[:8].hex(' ')}"
    if text.isprintable() or text.rstrip("\r").isprintable():
        return f"no log but a text: it begins with {text.strip()!r}"
    return f"no log: it begins with the bytes {start[:8].hex(' ')}"
