# SPDX-License-Identifier: BSD-3-Clause
"""Lockstep over a link: time stands until a client grants it (COMMAND_INT 31010, MAV_CMD_USER_1).

A client sends what the vehicle is to hear, then a grant; the vehicle hears both at the same simulated instant, goes up
to the time granted, sends all telemetry that falls due on the way, and only then answers. Only ``sitl run --lockstep``
has grants; elsewhere the commands are UNSUPPORTED.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..channel import Channel
from ..dialect import message
from ..links.link import Peer
from .results import ACCEPTED, DENIED
from .service import Sender

if TYPE_CHECKING:
    from ..bridge import Bridge

GRANT, RESEED = 31010, 31011
"""MAV_CMD_USER_1: x = simulated time since the start of the simulation [ms] up to which the vehicle may go; the
answer's ``result_param2`` is the time reached [ms]. An older or repeated grant gets only its answer, so that x = 0 asks
for the time. MAV_CMD_USER_2: x (32 bits) = seed of all sensor noise from now on; answered at once."""

ACK = message("COMMAND_ACK")


class Grants:
    """How far clients let the vehicle go, and which of them wait for an answer."""

    def __init__(self) -> None:
        self.until_us = 0
        """Simulated time since the start that has been granted [us]."""
        self._asked: list[tuple[Peer, Sender, int]] = []

    def command(self, bridge: Bridge, channel: Channel, fields: Any, sender: Sender) -> bool:
        """Take a COMMAND_INT; False when it is none of these."""
        if fields.command == GRANT:
            if fields.x < 0:
                _ack(channel, GRANT, DENIED, sender, 0)
            else:
                self.until_us = max(self.until_us, 1000 * fields.x)
                self._asked.append((channel.peer, sender, 1000 * fields.x))
        elif fields.command == RESEED:
            bridge.vehicle.reseed(fields.x & 0xFFFFFFFF)
            _ack(channel, RESEED, ACCEPTED, sender, 0)
        return fields.command in (GRANT, RESEED)

    def answer(self, bridge: Bridge) -> None:
        """Answer all grants whose time has been reached."""
        now = bridge.elapsed_us
        journal = bridge.board.journal
        if journal is not None and any(wanted <= now for _, _, wanted in self._asked):
            journal.answered()
        for peer, sender, wanted in self._asked:
            if wanted <= now:
                for channel in bridge.channels:  # a reboot in between has made new ones
                    if channel.peer is peer:
                        _ack(channel, GRANT, ACCEPTED, sender, now // 1000)
        self._asked = [asked for asked in self._asked if asked[2] > now]
        bridge.flush()


def _ack(channel: Channel, number: int, result: int, sender: Sender, time_ms: int) -> None:
    system, component = sender
    fields = {"command": number, "result": result, "target_system": system, "target_component": component}
    channel.send(ACK, ACK.payload(result_param2=time_ms, **fields))
