# SPDX-License-Identifier: BSD-3-Clause
"""What a page takes from a copy of a vehicle's record, whoever flies it: motion, lidar, wind, signals."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..vehicle.kind import Kind
from ..worlds import World
from . import kind as kinds
from .frame import CALM, Points, Stage
from .signals import Signals

Array = np.ndarray[Any, Any]


class RecordSource:
    """A copy of one vehicle's record; the vehicle is never waited for, and nothing in it changes.

    Args:
        kind: of vehicle.
        fleet: the array with its record; the copy is of this memory.
        index: of it there.
        title: name of the airframe.
        world: solids around it; None: a plain.
        modes: names of all modes that can be asked for.
    """

    def __init__(
        self, kind: Kind, fleet: Array, index: int, title: str, world: World | None, modes: tuple[str, ...] = ()
    ) -> None:
        self._original, self._index, self._kind = fleet, index, kind
        self._fleet = kind.record.fleet(1)
        self._bytes = self._fleet.view("u1")
        self._v = kind.record.of(self._fleet, 0)
        self._view = kinds.of(kind)
        self._stands = CALM
        """Where its own world's origin is in the scene, NED [m]."""
        self._scan: tuple[int, Points | None] = (-1, None)
        self._signals: Signals | None = None
        self._read = dict[str, float]
        airframe = kind.record.of(fleet, index).physics.airframe
        self.stage = Stage(title, self._view.shape(airframe), world, modes, kind.flies)

    def _copy(self) -> bytes:
        """The record as it is now; called where the vehicle is."""
        return self._original[self._index : self._index + 1].tobytes()

    def _take(self, record: bytes) -> Any:
        """Give the copy a moment's bytes; called where the page is. Returns its view."""
        self._bytes[:] = np.frombuffer(record, np.uint8)
        return self._v

    def signal_names(self) -> list[str]:
        """What can be plotted."""
        return self._find_signals().names

    def choose_signals(self, names: tuple[str, ...]) -> None:
        """Frames have these signals from now on.

        Raises:
            sitl.view.signals.SignalError: there is no such signal; those before stay.
        """
        self._read = self._find_signals().reader(names)  # type: ignore[assignment]

    def _find_signals(self) -> Signals:
        if self._signals is None:
            self._signals = Signals(self._kind, self._fleet, self._v)
        return self._signals

    def _moment(self) -> dict[str, Any]:
        """Fields of a frame that are the same whoever flies the vehicle."""
        v = self._v
        body, solids = v.physics.body, v.physics.obstacles
        rotors, steering, rolled, (ground_hits, ground_speed, ground_us) = self._view.motion(v)
        is_last = solids.hit_count > 0 and solids.hit_time_us >= ground_us
        return {
            "pos": body.pos + self._stands, "stands": self._stands, "q": body.q, "vel": body.vel,
            "rotors": rotors, "steering": steering, "rolled": rolled, "touching": bool(solids.touching),
            "hits": int(solids.hit_count) + ground_hits,
            "hit_speed": float(solids.hit_speed) if is_last else ground_speed,
            "scan": self._scanned(), "wind": v.physics.wind.vel, "signals": self._read(),
        }  # fmt: skip

    def _scanned(self) -> Points | None:
        """What the lidar met, on the body [m]."""
        sensors, airframe = self._v.sensors, self._v.physics.airframe
        count = int(sensors.lidar_samples)
        if count == 0 or sensors.lidar_count == 0:
            return None
        if self._scan[0] != sensors.lidar_count:
            ranges = np.asarray(sensors.lidar_ranges[:count], float)
            half = 0.5 * sensors.lidar_fov
            angles = np.linspace(-half, half, count)  # counter-clockwise from the right
            met = np.isfinite(ranges) & (ranges < sensors.lidar_max)
            self._scan = (int(sensors.lidar_count), hits(ranges[met], angles[met]) + np.array(airframe.lidar_at))
        return self._scan[1]


def hits(ranges: Points, angles: Points) -> Points:
    """Where rays of a lidar end, forward, right, down of it [m], shape (n, 3).

    Args:
        ranges: lengths of the rays [m], shape (n,).
        angles: their directions, counter-clockwise seen from above [rad], shape (n,).
    """
    return np.stack([ranges * np.cos(angles), -ranges * np.sin(angles), np.zeros(len(ranges))], axis=1)
