# SPDX-License-Identifier: BSD-3-Clause
"""PING: a request to nobody in particular is sent back (https://mavlink.io/en/services/ping.html)."""

from __future__ import annotations

from typing import Any

from ..channel import Channel
from ..dialect import message
from .service import Handler, Sender, Service

KIND = message("PING")


class PingService(Service):
    """Ping: a request has target 0/0; the answer carries its time and number back to the sender."""

    def handlers(self) -> dict[str, Handler]:
        return {"PING": self._ping}

    def _ping(self, channel: Channel, m: Any, sender: Sender) -> None:
        if m.target_system == 0 and m.target_component == 0:
            channel.send(KIND, KIND.pack(m.time_usec, m.seq, *sender))
