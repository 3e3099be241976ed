# SPDX-License-Identifier: BSD-3-Clause
"""Links that are slow or paid by the byte, as a satellite's: all their telemetry is HIGH_LATENCY2, while it is on.

https://mavlink.io/en/services/high_latency.html
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..channel import Channel
from ..dialect import message
from ..host import Host
from ..wire.streams import set_interval
from .service import Service

HIGH_LATENCY2 = message("HIGH_LATENCY2").id
EVERY_US = 5_000_000
"""Unless a client asks for another interval."""


class HighLatencyService(Service):
    """MAV_CMD_CONTROL_HIGH_LATENCY switches these links on and off; other links do not mind."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._is_on = False
        self._every_us: Mapping[int, int] = {}
        """By numbers of channels; replaced, never changed."""

    def has(self, channel: Channel) -> bool:
        """Whether the client is on such a link."""
        return any(link.is_high_latency and channel.peer in link.peers for link in self.bridge.links)

    def channel_added(self, channel: Channel) -> None:
        if self.has(channel):
            self._apply(channel)

    def switch(self, on: bool) -> None:
        """Send HIGH_LATENCY2 on these links from now on, or no more."""
        self._is_on = on
        for channel in self.bridge.channels:
            if self.has(channel):
                self._apply(channel)

    def set_interval(self, channel: Channel, interval_us: int) -> None:
        """How often while it is on; 0: the usual."""
        self._every_us = {**self._every_us, channel.number: interval_us or EVERY_US}
        self._apply(channel)

    def _apply(self, channel: Channel) -> None:
        every_us = self._every_us.get(channel.number, EVERY_US) if self._is_on else 0
        set_interval(channel.port, HIGH_LATENCY2, every_us, self.bridge.now_us, True)

    def snapshot(self) -> Any:
        return self._is_on, tuple(self._every_us.items())

    def restore(self, state: Any) -> None:
        self._is_on, every = state
        self._every_us = dict(every)
