# SPDX-License-Identifier: BSD-3-Clause
"""What the autopilot takes from the physics: samples are kept until the HIL_SENSOR that ends their tick is taken."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from . import battery, gps, hits, ranging, sensor, sticks, wheels
from .numbers import RefusedError

Readers = tuple[Any, ...]


class Inbox:
    """Writes one vehicle's ``sensors``.

    Args:
        fleet, index: the record, whose memory stays in place; it has the figures of its airframe.
        v: view of it.
    """

    def __init__(self, fleet: np.ndarray[Any, Any], index: int, v: Any) -> None:
        self._imu = sensor.SensorReader(fleet, index)
        self._readers: dict[int, Readers] = {
            gps.KIND.id: (gps.GpsReader(v),),
            battery.KIND.id: (battery.BatteryReader(v),),
            wheels.KIND.id: (wheels.WheelReader(v),),
            sticks.KIND.id: (sticks.SticksReader(v),),
            ranging.VECTOR.id: (ranging.RangeReader(v), hits.HitReader(v)),
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
