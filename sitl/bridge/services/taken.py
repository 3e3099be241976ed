# SPDX-License-Identifier: BSD-3-Clause
"""Messages that laws take."""

from __future__ import annotations

from functools import partial
from typing import Any

from ..channel import Channel
from ..wire.choose import Taker, message_of
from ..wire.message import Message
from .service import Handler, Sender, Service
from .statustext import EventService


class TakerService(Service):
    """Set-points for GUIDED, and the ground station's sticks, which the firmware forgets after RC_OVERRIDE_TIME.

    Laws take these messages (``Profile.takes``).
    """

    def handlers(self) -> dict[str, Handler]:
        messages = {law: message_of(law) for law in self.bridge.profile.takes}
        return {cls.kind.name: partial(self._take, law, cls) for law, cls in messages.items()}

    def _take(self, law: Taker, cls: type[Message], channel: Channel, m: Any, sender: Sender) -> None:
        v = self.bridge.vehicle.v
        told = v.autopilot.events.count
        law(cls(memoryview(bytearray(cls.kind.payload(**m._asdict())))), v, sender[0])
        if v.autopilot.events.count != told:
            self.bridge.get(EventService).read()
