# SPDX-License-Identifier: BSD-3-Clause
"""Telemetry logs (.tlog).

Frames as they went over the wire, each behind its time (Unix microseconds, 8 bytes, big-endian).

The format of MAVProxy and QGroundControl; ``mavlogdump.py`` and Mission Planner read it. Times are an epoch
plus simulated time, so the same run gives the same file.
"""

from __future__ import annotations

import contextlib
import mmap
import os
import struct
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType
from typing import BinaryIO

from ..errors import SitlError

_TIME = struct.Struct(">Q")
_FLUSH_BYTES = 1 << 13
"""A run that is killed loses no more: a second or two."""


MOST_BYTES = 1 << 30
"""Of a log."""
GAP_US, BACK_US = 3_600_000_000, 1_000_000


class LogError(SitlError, ValueError):
    """A log that cannot be written, a file that is none, or a log without the messages that were asked for."""


class TlogWriter:
    """Writes a .tlog.

    As a tap of a bridge (``bridge.taps.append(writer)``) it gets every frame of every client, in both
    directions; behind a ``LogLink`` it gets streams of its own. The two can be used together.
    """

    def __init__(self, path: str | Path, epoch_us: int) -> None:
        self.path = Path(path)
        self.epoch_us = epoch_us
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self._file: BinaryIO | None = self.path.open("wb")
        self._pending: list[bytes] = []
        self._size = 0

    def frame(self, time_us: int, raw: bytes) -> None:
        """Append one frame, sent or received at simulated ``time_us``; nothing after ``close``."""
        self.write(_TIME.pack(self.epoch_us + time_us) + raw)

    def write(self, data: bytes) -> None:
        """Append frames, each behind its time."""
        if self._file is None:
            return
        self._pending.append(data)
        self._size += len(data)
        if self._size >= _FLUSH_BYTES:
            self.flush()

    def flush(self) -> None:
        """Write out what is collected.

        Raises:
            LogError: that cannot be done (a full disk); what was written stays, and nothing is added to it.
        """
        if self._file is None or not self._pending:
            return
        data = b"".join(self._pending)
        self._pending.clear()
        self._size = 0
        try:
            self._file.write(data)
            self._file.flush()
        except OSError as error:
            file, self._file = self._file, None
            with contextlib.suppress(OSError):
                file.close()
            raise LogError(f"log {str(self.path)!r} cannot be written: {error.strerror or error}") from None

    def close(self) -> None:
        """Write everything and close the file."""
        self.flush()
        if self._file is not None:
            self._file.close()
            self._file = None

    def __enter__(self) -> TlogWriter:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def read_tlog(path: str | Path) -> Iterator[tuple[int, bytes]]:
    """(Unix time [us], frame) of each frame of a log; what is cut off at the end is left out, and what is no frame is
    passed over up to where two follow each other.

    Raises:
        LogError: it has more than ``MOST_BYTES``.
        OSError: it cannot be read.
    """
    with Path(path).open("rb") as file:
        size = os.fstat(file.fileno()).st_size
        if size > MOST_BYTES:
            raise LogError(f"log {str(path)!r} has {size} bytes; at most {MOST_BYTES} are read")
        if not size:
            return
        with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
            at = 0
            while at + _TIME.size + 3 <= size:
                end = _end(data, at)
                if end == at:
                    at = _next(data, at + 1)
                    continue
                if end > size:
                    return
                yield _TIME.unpack_from(data, at)[0], data[at + _TIME.size : end]
                at = end


def read_steady(path: str | Path) -> Iterator[tuple[int, int, bytes]]:
    """(Number of jumps of the clock so far, time since the first frame [us], frame) of each frame of a log.

    A longer gap than ``GAP_US``, or a larger step back than ``BACK_US``, means that the recording computer's clock was
    set: these jumps are left out.
    """
    begin: int | None = None
    time = jumps = 0
    for stamp, frame in read_tlog(path):
        begin = stamp if begin is None else begin
        late = stamp - begin - time
        if late > GAP_US or late < -BACK_US:
            begin, jumps = stamp - time, jumps + 1
        time = max(stamp - begin, time)  # another link's clock may be a little behind
        yield jumps, time, frame


def _end(data: mmap.mmap, at: int) -> int:
    """Where a frame with its time ends; ``at`` if none begins there."""
    mark, size, flags = data[at + _TIME.size : at + _TIME.size + 3]
    if mark == 0xFD:  # MAVLink 2; flag 1: a signature follows
        return at + _TIME.size + size + 12 + (13 if flags & 1 else 0)
    return at + _TIME.size + size + 8 if mark == 0xFE else at


def _next(data: mmap.mmap, at: int) -> int:
    """Where a frame begins that another one, or the end, follows."""
    size = len(data)
    while at + _TIME.size + 3 <= size:
        end = _end(data, at)
        if end > at and (end == size or (end + _TIME.size + 3 <= size and _end(data, end) > end)):
            return at
        at += 1
    return size
