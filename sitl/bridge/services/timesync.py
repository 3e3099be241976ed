# SPDX-License-Identifier: BSD-3-Clause
"""TIMESYNC: answers with simulated nanoseconds (https://mavlink.io/en/services/timesync.html).

Our own requests are a stream.
"""

from __future__ import annotations

from typing import Any

from ..channel import Channel
from ..dialect import message
from .service import Handler, Sender, Service

KIND = message("TIMESYNC")


class TimesyncService(Service):
    """Time: a request has tc1 = 0; the answer repeats its ts1 and gives simulated nanoseconds in tc1."""

    def handlers(self) -> dict[str, Handler]:
        return {"TIMESYNC": self._timesync}

    def _timesync(self, channel: Channel, m: Any, sender: Sender) -> None:
        if m.tc1 == 0:
            extension = (
                {"target_system": sender[0], "target_component": sender[1]} if "target_system" in KIND.fields else {}
            )
            channel.send(KIND, KIND.payload(tc1=self.bridge.now_us * 1000, ts1=m.ts1, **extension))
