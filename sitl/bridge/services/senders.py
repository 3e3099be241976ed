# SPDX-License-Identifier: BSD-3-Clause
"""Whose messages the vehicle acts on: everybody's, or (MAV_OPTIONS bit 0) those of its ground stations alone.

Ground stations are the systems from MAV_GCS_SYSID to MAV_GCS_SYSID_HI. The core knows the first alone: sticks of the
others reach it as the first one's.
"""

from __future__ import annotations

from ...autopilot.shell_parameters import GCS_SYSID_HI, MAV_OPTIONS, ONLY_GROUND_STATIONS
from ..channel import Channel
from ..dialect import message
from ..frame import Splitter, encode_v2
from ..host import Host
from .service import Service
from .signing import TAKEN_UNSIGNED as OF_RADIOS

_STICKS = frozenset((message("RC_CHANNELS_OVERRIDE").id, message("MANUAL_CONTROL").id))
"""Nothing answers them."""
_NAMES = (MAV_OPTIONS, "MAV_GCS_SYSID", GCS_SYSID_HI, "MAV_SYSID")


class SenderService(Service):
    """Knows the ground stations, and takes frames of others than them, the vehicle itself and radios out of what comes
    in, without a word, while MAV_OPTIONS says so."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._splitters: dict[int, Splitter] = {}
        """Of channels by their numbers: what they sent is cut into frames here first."""
        self.refused = 0
        """Frames of others."""
        self._look()

    def _look(self) -> None:
        options, first, last, own = (int(self.bridge.parameter(name) or 0) for name in _NAMES)
        self._only = options & ONLY_GROUND_STATIONS != 0
        """Whether not everybody is heard."""
        self._first, self._last = first, max(first, last)
        self.is_on = self._only or last > first
        """Whether frames are looked at before the core gets them."""
        if not self.is_on:
            self._splitters.clear()
        self._systems = frozenset((*range(first, self._last + 1), own))

    def is_ground_station(self, system: int) -> bool:
        """Whether a system's sticks and heartbeats count."""
        return self._first <= system <= self._last

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
            if self._only and frame.system not in self._systems and frame.kind.id not in OF_RADIOS:
                self.refused += 1
            elif frame.kind.id in _STICKS and self._first < frame.system <= self._last:
                taken += encode_v2(frame.kind, frame.payload, frame.sequence, self._first, frame.component)
            else:
                taken += frame.raw
        return bytes(taken)
