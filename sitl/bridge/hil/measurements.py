# SPDX-License-Identifier: BSD-3-Clause
"""What physics sends for a tick: the samples that are new, and HIL_SENSOR, which ends it."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np

from ...core.record_reader import RecordReader
from ..dialect import MessageType
from . import battery, gps, hits, sensor, wheels
from .numbers import PHYSICS
from .ranging import RangeWriter, ScanWriter
from .sender import Sender


class Source(Protocol):
    """Something that measures at a rate of its own."""

    @property
    def marks(self) -> tuple[str, ...]:
        """Fields of the record that change when there is a new sample."""
        ...

    def messages(self) -> list[tuple[MessageType, bytes]]:
        """The last sample."""
        ...


class _Plain:
    """A source of one kind of message."""

    def __init__(self, kind: MessageType, writer: Any) -> None:
        self.marks: tuple[str, ...] = writer.marks
        self._kind, self._writer = kind, writer

    def messages(self) -> list[tuple[MessageType, bytes]]:
        return [(self._kind, payload) for payload in self._writer.payloads()]


class Measurements:
    """Frames of one vehicle's ticks.

    Args:
        fleet, index: the record, whose memory stays in place.
        v: view of it.
        sender: counts the frames.
    """

    def __init__(self, fleet: np.ndarray[Any, Any], index: int, v: Any, sender: Sender | None = None) -> None:
        reader = RecordReader(fleet, index)
        self.sender = sender or Sender(*PHYSICS)
        self._imu = sensor.SensorWriter(reader)
        sources: list[Source] = [
            _Plain(gps.KIND, gps.GpsWriter(reader)),
            _Plain(battery.KIND, battery.BatteryWriter(reader)),
            _Plain(wheels.KIND, wheels.WheelWriter(reader)),
            ScanWriter(reader, v),
            RangeWriter(reader, v),
            _Plain(hits.KIND, hits.HitWriter(reader, "physics.obstacles", hits.SOLID)),
        ]
        if hasattr(v.physics, "ground"):
            sources.append(_Plain(hits.KIND, hits.HitWriter(reader, "physics.ground", hits.GROUND)))
        self._read = reader.fields(*(mark for source in sources for mark in source.marks))
        self._slots: list[tuple[slice, Source]] = []
        at = 0
        for source in sources:
            self._slots.append((slice(at, at + len(source.marks)), source))
            at += len(source.marks)
        self._seen: tuple[Any, ...] = ()

    def everything(self) -> bytes:
        """All that is known now, as new: for an autopilot that has just come."""
        self._seen = self._read()
        frames = [self._frames(source) for _, source in self._slots]
        return b"".join(frames) + self.sender.frame(sensor.KIND, self._imu.payload(True))

    def tick(self) -> bytes:
        """What is new since the last call."""
        marks = self._read()
        if marks == self._seen:
            return self.sender.frame(sensor.KIND, self._imu.payload())
        seen, self._seen = self._seen, marks
        frames = [self._frames(source) for place, source in self._slots if marks[place] != seen[place]]
        return b"".join(frames) + self.sender.frame(sensor.KIND, self._imu.payload())

    def _frames(self, source: Source) -> bytes:
        return b"".join([self.sender.frame(kind, payload) for kind, payload in source.messages()])
