# SPDX-License-Identifier: BSD-3-Clause
"""Whose messages the vehicle acts on: everybody's, or (MAV_OPTIONS bit 0) those of its ground stations alone."""

from __future__ import annotations

from typing import Any

from ...autopilot.shell_parameters import GCS_SYSID_HI, MAV_OPTIONS, ONLY_GROUND_STATIONS
from ..channel import Channel
from ..frame import Splitter
from .service import Service
from .signing import TAKEN_UNSIGNED as OF_RADIOS

_NAMES = (MAV_OPTIONS, GCS_SYSID_HI, "MAV_GCS_SYSID", "MAV_SYSID")


class SenderService(Service):
    """Takes frames of other systems than MAV_GCS_SYSID .. MAV_GCS_SYSID_HI, the vehicle itself and radios out of what
    comes in, without a word, while MAV_OPTIONS says so."""

    def __init__(self, bridge: Any) -> None:
        super().__init__(bridge)
        self._splitters: dict[int, Splitter] = {}
        """Of channels by their numbers: what they sent is cut into frames here first."""
        self.refused = 0
        """Frames of others."""
        self._look()

    def _look(self) -> None:
        values = self.bridge.vehicle.parameters
        self.is_on = MAV_OPTIONS in values.table and int(values[MAV_OPTIONS]) & ONLY_GROUND_STATIONS != 0
        """Whether not everybody is heard."""
        if not self.is_on:
            self._splitters.clear()
            return
        first = int(values["MAV_GCS_SYSID"])
        last = max(first, int(values[GCS_SYSID_HI]))
        self._systems = frozenset((*range(first, last + 1), int(values["MAV_SYSID"])))

    def parameter_changed(self, name: str) -> None:
        if name in _NAMES:
            self._look()

    def channel_removed(self, channel: Channel) -> None:
        self._splitters.pop(channel.number, None)

    def snapshot(self) -> int:
        return self.refused

    def restore(self, state: int) -> None:
        self.refused = state
        self._look()

    def received(self, channel: Channel, data: bytes) -> bytes:
        """What of a client's bytes the vehicle may act on: whole frames."""
        taken = bytearray()
        for frame in self._splitters.setdefault(channel.number, Splitter()).feed(data):
            if frame.system in self._systems or frame.kind.id in OF_RADIOS:
                taken += frame.raw
            else:
                self.refused += 1
        return bytes(taken)
