# SPDX-License-Identifier: BSD-3-Clause
"""Digests of one flight while it is flown: everything that was sent, and the whole record every few seconds."""

from __future__ import annotations

import base64
import hashlib
import zlib
from functools import cache
from typing import Any

import numpy as np

from .leaves import Leaf, leaves

CHECKPOINT_US = 4_000_000
"""Simulated time between two looks at the record [us]."""


@cache
def leaves_of(dtype: np.dtype[Any]) -> list[Leaf]:
    """The same, once a process."""
    return leaves(dtype)


def packed(data: bytes) -> str:
    """Bytes as text."""
    return base64.b64encode(zlib.compress(data, 9)).decode()


def unpacked(text: str) -> bytes:
    """The bytes again."""
    return zlib.decompress(base64.b64decode(text))


class Series:
    """Digest of a stream of named values over time: one for all, and a byte for each name and step of time."""

    def __init__(self) -> None:
        self._all = hashlib.sha256()
        self._steps: dict[str, dict[int, int]] = {}
        self.count = 0

    def add(self, name: str, step: int, value: bytes) -> None:
        """One value."""
        self._all.update(value)
        self.count += 1
        steps = self._steps.setdefault(name, {})
        steps[step] = zlib.crc32(value, steps.get(step, 0))

    def result(self) -> dict[str, Any]:
        """As JSON."""
        names = {}
        for name, steps in sorted(self._steps.items()):
            row = bytearray(max(steps) + 1)
            for step, crc in steps.items():
                row[step] = crc % 255 + 1  # 0: nothing at this step
            names[name] = packed(bytes(row))
        return {"sha256": self._all.hexdigest(), "count": self.count, "names": names}


class Record:
    """Digest of a record at checkpoints: a chained check sum for each leaf, and a byte for each leaf and checkpoint."""

    def __init__(self) -> None:
        self.leaves: list[Leaf] = []
        self.times: list[int] = []
        self._chain = np.zeros(0, np.uint32)
        self._last = np.zeros(0, np.uint32)
        self._changes: list[bytes] = []

    def look(self, time_us: int, dtype: np.dtype[Any], record: bytes) -> None:
        """A checkpoint."""
        if not self.leaves:
            self.leaves = leaves_of(dtype)
            self._chain = np.zeros(len(self.leaves), np.uint32)
            self._last = np.zeros(len(self.leaves), np.uint32)
        now = np.array([leaf.check_sum(record) for leaf in self.leaves], np.uint32)
        for k, value in enumerate(now):
            self._chain[k] = zlib.crc32(value.tobytes(), int(self._chain[k]))
        self._changes.append(np.where(now == self._last, 0, now % 255 + 1).astype(np.uint8).tobytes())
        self._last = now
        self.times.append(time_us)

    def result(self) -> dict[str, Any]:
        """As JSON; the paths of the leaves apart, under "paths"."""
        changes = np.frombuffer(b"".join(self._changes), np.uint8).reshape(len(self.times), len(self.leaves))
        return {
            "paths": [leaf.path for leaf in self.leaves],
            "times_us": self.times,
            "chain": packed(self._chain.astype("<u4").tobytes()),
            "changes": packed(changes.T.tobytes()),
        }
