# SPDX-License-Identifier: BSD-3-Clause
"""The samples of a tick: what physics sends, HIL_GPS among them, HIL_SENSOR last; and what the autopilot takes."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

import numpy as np

from ...core.elementary import atan2, hypot
from ...core.record_reader import RecordReader
from ..dialect import MessageType, message
from ..telemetry.units import DEG, int16, uint16
from . import ranging, rc_inputs, sensor, truth
from .protocol import LATEST_US, PHYSICS, RefusedError, Sender
from .ranging import RangeWriter, ScanWriter

GPS_KIND = message("HIL_GPS")
S = "sensors.gps_"
_POSITION = 2
"""Least GPS_FIX_TYPE with a position."""
_MOST_FIX = 8
"""Greatest GPS_FIX_TYPE."""


class GpsWriter:
    """From a record to payloads.

    Args:
        reader: of the record.
        airframe: its record, with the properties of its receiver.
    """

    marks = (S + "count", S + "fix")
    """Fields whose change means that there is something new."""

    def __init__(self, reader: RecordReader, airframe: Any) -> None:
        names = ("count", "time_us", "fix", "lat", "lon", "alt", "eph", "epv", "vel", "satellites")
        self._read = reader.fields(*(S + name for name in names))
        self._usual, self._accuracy = as_dop(airframe), as_accuracy(airframe)
        self._had_fix = False
        self.is_quiet = False
        """Whether nothing is said before there is a position: PX4 takes the one that comes without a fix for true, and
        when it jumps to the first fix its checks of drift hold it on the ground for half a minute. It also takes eph
        and epv, in MAVLink DOP, for standard deviations [cm], by which its filter weighs fixes: of a receiver with RTK
        they would be 60 and 90 cm."""

    def payloads(self) -> list[bytes]:
        """The last fix; nothing before the first."""
        count, t, fix, lat, lon, alt, eph, epv, vn, ve, vd, satellites = self._read()
        if count == 0 or (self.is_quiet and fix < _POSITION and not self._had_fix):
            return []
        self._had_fix = self._had_fix or fix >= _POSITION
        course = uint16(atan2(ve, vn) * DEG * 100.0 % 36000.0)
        speeds = uint16(hypot(vn, ve)), int16(vn), int16(ve), int16(vd), course
        if self.is_quiet and (eph, epv) == self._usual:
            eph, epv = self._accuracy
        return [GPS_KIND.pack(t, lat, lon, alt, uint16(eph), uint16(epv), *speeds, fix & 0xFF, satellites & 0xFF, 0, 0)]


class _Sent(NamedTuple):
    """How sure a receiver is of a fix."""

    eph: int
    epv: int


def as_dop(airframe: Any) -> _Sent:
    """What a receiver tells while nothing disturbs it: DOP [0.01]."""
    return _Sent(math.floor(100.0 * airframe.gps_hdop + 0.5), math.floor(100.0 * airframe.gps_vdop + 0.5))


def as_accuracy(airframe: Any) -> _Sent:
    """The same as standard deviations [cm], horizontally of each axis."""
    wide = hypot(airframe.gps_noise_horizontal, airframe.gps_drift_horizontal)
    high = hypot(airframe.gps_noise_vertical, airframe.gps_drift_vertical)
    return _Sent(max(uint16(100.0 * wide), 1), max(uint16(100.0 * high), 1))


class GpsReader:
    """From payloads into a record."""

    def __init__(self, v: Any) -> None:
        self._sensors = v.sensors

    @staticmethod
    def read(payload: bytes) -> tuple[Any, ...]:
        """The fields, checked.

        Raises:
            RefusedError: a position that is not on the globe, or an absurd time or fix.
        """
        values: tuple[Any, ...] = GPS_KIND.unpack_from(payload.ljust(GPS_KIND.size, b"\0"))
        t, lat, lon, fix = values[0], values[1], values[2], values[11]
        if not (abs(lat) <= 900_000_000 and abs(lon) <= 1_800_000_000):
            raise RefusedError(f"{GPS_KIND.name}: latitude {lat}, longitude {lon} degE7 is not on the globe")
        if t >= LATEST_US or fix > _MOST_FIX:
            raise RefusedError(f"{GPS_KIND.name}: time_usec {t}, fix_type {fix}")
        return values

    def write(self, values: tuple[Any, ...]) -> None:
        """Put checked fields into the record."""
        t, lat, lon, alt, eph, epv, _, vn, ve, vd, _, fix, satellites, _, _ = values
        s = self._sensors
        if t != s.gps_time_us:
            s.gps_count += 1
            s.gps_time_us = t
        s.gps_fix, s.gps_lat, s.gps_lon, s.gps_alt = fix, lat, lon, alt
        s.gps_eph, s.gps_epv, s.gps_satellites = eph, epv, satellites
        s.gps_vel = (vn, ve, vd)


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
        self.imu = sensor.SensorWriter(reader)
        self._gps = GpsWriter(reader, v.physics.airframe)
        sources: list[Source] = [
            _Plain(GPS_KIND, self._gps),
            _Plain(sensor.BATTERY_KIND, sensor.BatteryWriter(reader)),
            _Plain(sensor.WHEELS_KIND, sensor.WheelWriter(reader)),
            ScanWriter(v),
            RangeWriter(reader, v),
            _Plain(truth.HITS_KIND, truth.HitWriter(reader, "physics.obstacles", truth.SOLID)),
        ]
        if hasattr(v.physics, "ground"):
            sources.append(_Plain(truth.HITS_KIND, truth.HitWriter(reader, "physics.ground", truth.GROUND)))
        self.marks = tuple(mark for source in sources for mark in source.marks)
        """Fields of the record that change when there is more to report than HIL_SENSOR."""
        self._read = reader.fields(*self.marks)
        self._slots: list[tuple[slice, Source]] = []
        at = 0
        for source in sources:
            self._slots.append((slice(at, at + len(source.marks)), source))
            at += len(source.marks)
        self._seen: tuple[Any, ...] = ()

    @property
    def is_foreign(self) -> bool:
        """Whether they are for an autopilot that is not ours."""
        return self._gps.is_quiet

    @is_foreign.setter
    def is_foreign(self, value: bool) -> None:
        self._gps.is_quiet = self.imu.is_dithered = value

    def everything(self) -> bytes:
        """All that is known now, as new: for an autopilot that has just come."""
        self._seen = self._read()
        frames = [self._frames(source) for _, source in self._slots]
        return b"".join(frames) + self.sender.frame(sensor.SENSOR_KIND, self.imu.payload(True))

    def tick(self) -> bytes:
        """What is new since the last call."""
        marks = self._read()
        if marks == self._seen:
            return self.sender.frame(sensor.SENSOR_KIND, self.imu.payload())
        seen, self._seen = self._seen, marks
        frames = [self._frames(source) for index, source in self._slots if marks[index] != seen[index]]
        return b"".join(frames) + self.sender.frame(sensor.SENSOR_KIND, self.imu.payload())

    def _frames(self, source: Source) -> bytes:
        return b"".join([self.sender.frame(kind, payload) for kind, payload in source.messages()])


Readers = tuple[Any, ...]


class Inbox:
    """Writes one vehicle's ``sensors``.

    Args:
        fleet, index: the record, whose memory stays in place; it has the properties of its airframe.
        v: view of it.
    """

    def __init__(self, fleet: np.ndarray[Any, Any], index: int, v: Any) -> None:
        self._imu = sensor.SensorReader(fleet, index)
        self._readers: dict[int, Readers] = {
            GPS_KIND.id: (GpsReader(v),),
            sensor.BATTERY_KIND.id: (sensor.BatteryReader(v),),
            sensor.WHEELS_KIND.id: (sensor.WheelReader(v),),
            rc_inputs.KIND.id: (rc_inputs.SticksReader(v),),
            ranging.VECTOR.id: (ranging.RangeReader(v), truth.HitReader(v)),
            ranging.DISTANCE.id: (ranging.DistanceReader(v),),
            ranging.SCAN.id: (ranging.ScanReader(v, int(v.physics.airframe.lidar_samples)),),
        }
        self._kept: list[tuple[Callable[[Any], None], Any]] = []
        self._is_spoilt = False

    def keep(self, number: int, payload: bytes) -> bool:
        """Check a message and keep it for its tick; False when it is none of these.

        Raises:
            RefusedError: the tick cannot be taken any more.
        """
        readers = self._readers.get(number)
        if readers is None:
            return False
        try:
            for reader in readers:
                values = reader.read(payload)
                if values is not None:
                    self._kept.append((reader.write, values))
        except RefusedError:
            self._is_spoilt = True
            raise
        return True

    def end(self, payload: bytes) -> sensor.Values | None:
        """Check the HIL_SENSOR that ends a tick; None when an earlier message has spoilt the tick.

        Raises:
            RefusedError: the tick cannot be taken.
        """
        try:
            values = self._imu.read(payload)
        except RefusedError:
            self.forget()
            raise
        if self._is_spoilt:
            self.forget()
            return None
        return values

    def take(self, values: sensor.Values, is_all: bool = False) -> None:
        """Put a tick into the record; ``is_all``: all its samples are new to us."""
        if self._kept:
            for write, kept in self._kept:
                write(kept)
            self._kept.clear()
        self._imu.write(values, is_all)

    def forget(self) -> None:
        """Leave what was kept: it belongs to a tick that is not taken."""
        self._kept.clear()
        self._is_spoilt = False
