# SPDX-License-Identifier: BSD-3-Clause
"""Digest of named values over time: a hash of all, and for each name a check sum and a byte for each step of time."""

from __future__ import annotations

import base64
import hashlib
import zlib
from collections.abc import Mapping
from typing import Any, NamedTuple


def packed(data: bytes) -> str:
    """Bytes as text."""
    return base64.b64encode(zlib.compress(data, 9)).decode()


def unpacked(text: str) -> bytes:
    """The bytes again."""
    return zlib.decompress(base64.b64decode(text))


class Row(NamedTuple):
    """All values of one name."""

    check_sum: int
    """CRC-32 of all."""
    steps: bytes
    """For each step up to its last one 1 .. 255 by its values, 0 where there was none."""


class Tape:
    """Takes values of many names as time goes on."""

    def __init__(self) -> None:
        self._all = hashlib.sha256()
        self._times: list[float] = []
        self._sums: dict[str, int] = {}
        self._steps: dict[str, dict[int, int]] = {}

    def add(self, time: float, name: str, value: bytes) -> None:
        """A value; a new time [s, or number of a step] begins a new step."""
        if not self._times or self._times[-1] != time:
            self._times.append(time)
        self._all.update(value)
        self._sums[name] = zlib.crc32(value, self._sums.get(name, 0))
        steps, step = self._steps.setdefault(name, {}), len(self._times) - 1
        steps[step] = zlib.crc32(value, steps.get(step, 0))

    def result(self) -> dict[str, Any]:
        """As JSON."""
        rows = bytearray(len(self._steps) * len(self._times))
        for k, steps in enumerate(self._steps.values()):
            for step, check_sum in steps.items():
                rows[k * len(self._times) + step] = check_sum % 255 + 1
        sums = b"".join(self._sums[name].to_bytes(4, "little") for name in self._steps)
        return {
            "sha256": self._all.hexdigest(),
            "times": self._times,
            "names": packed("\n".join(self._steps).encode()),
            "sums": packed(sums),
            "rows": packed(bytes(rows)),
        }


def read(result: Mapping[str, Any]) -> dict[str, Row]:
    """The rows of a tape's result, by their names."""
    names, width = unpacked(result["names"]).decode().split("\n"), len(result["times"])
    sums, rows = unpacked(result["sums"]), unpacked(result["rows"])
    return {
        name: Row(int.from_bytes(sums[4 * k : 4 * k + 4], "little"), rows[k * width : (k + 1) * width].rstrip(b"\0"))
        for k, name in enumerate(names)
    }
