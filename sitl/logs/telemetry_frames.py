# SPDX-License-Identifier: BSD-3-Clause
"""Messages of a telemetry log as arrays of their fields: all of a name from one system at once."""

from __future__ import annotations

import os
import re
from collections import defaultdict
from collections.abc import Callable, Collection
from pathlib import Path

import numpy as np
from fastcrc import crc16
from pymavlink.dialects.v20 import ardupilotmega as dialect

from .dataflash.tables import Array
from .tlog import read_steady

_AUTOPILOT = 1
"""MAV_COMP_ID_AUTOPILOT1"""
_EACH = 1 << 12
"""Frames between two words about the progress."""
_KINDS = {kind.msgname: kind for kind in dialect.mavlink_map.values()}


class Rows:
    """All messages of a name from one vehicle."""

    def __init__(self, name: str, payloads: list[bytes], logged_us: list[int]) -> None:
        of = _KINDS[name]
        self.dtype = np.dtype(list(zip(of.ordered_fieldnames, _split(of.unpacker.format))))
        size = self.dtype.itemsize
        data = b"".join(payload[:size].ljust(size, b"\0") for payload in payloads)
        self.raw = np.frombuffer(data, self.dtype)
        self.logged = 1e-6 * np.array(logged_us, float)

    def __len__(self) -> int:
        return len(self.raw)

    def __contains__(self, field: str) -> bool:
        return field in (self.dtype.names or ())

    def __getitem__(self, field: str) -> Array:
        column = self.raw[field]
        return column if column.dtype.kind in "SV" or (column.dtype == np.uint8 and column.ndim > 1) else column * 1.0

    def texts(self, field: str) -> list[str]:
        """A column of texts."""
        return [bytes(value).split(b"\0", 1)[0].decode("utf-8", "replace") for value in self.raw[field]]

    def where(self, which: Array) -> Rows:
        """Those that a mask says."""
        found = Rows.__new__(Rows)
        found.dtype, found.raw, found.logged = self.dtype, self.raw[which], self.logged[which]
        return found


def _split(text: str) -> list[str]:
    """NumPy's types of a ``struct`` format as pymavlink writes them ("<iih10HB16s")."""
    found = []
    for count, code in re.findall(r"(\d*)([a-zA-Z])", text):
        kind = f"S{count or 1}" if code == "s" else np.dtype("<" + code).str
        found.append(kind if code == "s" or not count else f"({count},){kind}")
    return found


def read(
    path: Path, names: Collection[str], progress: Callable[[int, int], None] | None = None
) -> tuple[dict[tuple[int, str], Rows], int]:
    """Messages of autopilots by system and name, and how many of these had a wrong checksum.

    Args:
        path: of the .tlog.
        names: messages that are wanted.
        progress: called with how many bytes are read, and how many there are.

    Raises:
        LogError, OSError: it cannot be read.
    """
    payloads: dict[tuple[int, int], list[bytes]] = defaultdict(list)
    times: dict[tuple[int, int], list[int]] = defaultdict(list)
    wanted = {_KINDS[name].id: name for name in names}
    extra = {number: bytes([_KINDS[name].crc_extra]) for number, name in wanted.items()}
    total, done, bad = os.path.getsize(path), 0, 0
    for count, (_, time_us, frame) in enumerate(read_steady(path)):
        done += 8 + len(frame)
        if progress is not None and count % _EACH == 0:
            progress(done, total)
        if frame[0] == 0xFD:  # MAVLink 2
            begin, system, component, number = 10, frame[5], frame[6], int.from_bytes(frame[7:10], "little")
        else:
            begin, system, component, number = 6, frame[3], frame[4], frame[5]
        if component != _AUTOPILOT or number not in extra:
            continue
        end = begin + frame[1]
        if crc16.mcrf4xx(frame[1:end] + extra[number], 0xFFFF) != int.from_bytes(frame[end : end + 2], "little"):
            bad += 1
            continue
        payloads[system, number].append(frame[begin:end])
        times[system, number].append(time_us)
    if progress is not None:
        progress(total, total)
    found = {(s, wanted[n]): Rows(wanted[n], payloads[s, n], times[s, n]) for s, n in payloads}
    return found, bad
