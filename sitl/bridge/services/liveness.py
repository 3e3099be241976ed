# SPDX-License-Identifier: BSD-3-Clause
"""HEARTBEAT, PING and TIMESYNC: who is there, and what time it is.

TIMESYNC: answers with simulated nanoseconds (https://mavlink.io/en/services/timesync.html).

Our own requests are a stream.
"""

from __future__ import annotations

from typing import Any

from ..channel import Channel
from ..dialect import MessageType, message
from ..host import Host
from ..listener import Sender
from .senders import SenderService
from .service import Handler, Service


class HeartbeatService(Service):
    """Heartbeats of ground stations (https://mavlink.io/en/services/heartbeat.html); our own is a stream."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._channels: frozenset[int] = frozenset()
        """Numbers of channels on which other components of our own system were received."""

    def snapshot(self) -> tuple[int, ...]:
        return tuple(sorted(self._channels))

    def restore(self, state: tuple[int, ...]) -> None:
        self._channels = frozenset(state)

    def channel_removed(self, channel: Channel) -> None:
        self._channels -= {channel.number}

    def to_components(self, kind: MessageType, payload: bytes) -> None:
        """Send to every other component of our own system that has been heard, once a channel."""
        for channel in self.bridge.channels:
            if channel.number in self._channels:
                channel.send(kind, payload)

    def handlers(self) -> dict[str, Handler]:
        return {"HEARTBEAT": self._heartbeat}

    def _heartbeat(self, channel: Channel, message: Any, sender: Sender) -> None:
        if sender[0] == self.bridge.system:
            self._channels |= {channel.number}
        if self.bridge.get(SenderService).is_ground_station(sender[0]):
            self.bridge.vehicle.v.autopilot.modes.failsafe.gcs_us = self.bridge.now_us


PING_KIND = message("PING")


class PingService(Service):
    """Ping: a request has target 0/0; the answer carries its time and number back to the sender."""

    def handlers(self) -> dict[str, Handler]:
        return {"PING": self._ping}

    def _ping(self, channel: Channel, m: Any, sender: Sender) -> None:
        if m.target_system == 0 and m.target_component == 0:
            channel.send(PING_KIND, PING_KIND.pack(m.time_usec, m.seq, *sender))


TIMESYNC_KIND = message("TIMESYNC")


class TimesyncService(Service):
    """Time: a request has tc1 = 0; the answer repeats its ts1 and gives simulated nanoseconds in tc1."""

    def handlers(self) -> dict[str, Handler]:
        return {"TIMESYNC": self._timesync}

    def _timesync(self, channel: Channel, m: Any, sender: Sender) -> None:
        if m.tc1 == 0:
            extension = (
                {"target_system": sender[0], "target_component": sender[1]}
                if "target_system" in TIMESYNC_KIND.fields
                else {}
            )
            now = max(self.bridge.now_us * 1000, 1)  # 0 would be a request
            channel.send(TIMESYNC_KIND, TIMESYNC_KIND.payload(tc1=now, ts1=m.ts1, **extension))
