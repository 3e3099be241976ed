# SPDX-License-Identifier: BSD-3-Clause
"""Messages to bytes and bytes to messages: the client's end of a link, without time and without waiting."""

from __future__ import annotations

import math
from functools import partial
from typing import Any, NamedTuple, Protocol

from ..bridge.dialect import FieldError, message
from ..bridge.frame import Splitter, encode_v2
from ..bridge.links.inprocess import InProcessLink


class Received(NamedTuple):
    """A message from the vehicle: its name and its fields (a named tuple)."""

    name: str
    fields: Any


_received = partial(tuple.__new__, Received)


class ByteStream(Protocol):
    """What carries the bytes: an :class:`InProcessLink`, or a socket."""

    def send(self, data: bytes) -> None:
        """To the vehicle."""

    def receive(self) -> bytes:
        """All bytes from the vehicle since the last call."""


class Endpoint:
    """Encodes messages onto a link and decodes what comes back. It waits for nothing.

    Args:
        link: the link that the vehicle's bridge has, or the client's end of another; None: a new one in process.
        system, component: MAVLink ids of the sender; 255 and 190 are a ground station's.
    """

    def __init__(self, link: ByteStream | None = None, system: int = 255, component: int = 190) -> None:
        self.link: Any = link or InProcessLink()
        self.system, self.component = system, component
        self.sequence = 0
        """Of the next frame, 0 .. 255."""
        self._splitter = Splitter()

    def send(self, name: str, **fields: Any) -> None:
        """Encode and send one message; fields not given are zero.

        Raises:
            UnknownMessageError: no such message, or it has no such field.
            FieldError: a value that its field cannot carry.
        """
        kind = message(name)
        self.send_payload(kind, kind.payload(**fields))

    def send_payload(self, kind: Any, payload: bytes) -> None:
        """Send one message whose payload is packed already (the quick way for set-points)."""
        self.link.send(encode_v2(kind, payload, self.sequence, self.system, self.component))
        self.sequence = (self.sequence + 1) & 0xFF

    def command(self, number: int, *params: float, target: int = 1, confirmation: int = 0) -> None:
        """Send a COMMAND_LONG (MAV_CMD ``number``) with up to seven parameters."""
        if len(params) > 7:
            raise FieldError("COMMAND_LONG", f"param{len(params)}", params[-1], "param1 .. param7")
        values = dict(zip(("param1", "param2", "param3", "param4", "param5", "param6", "param7"), params))
        self.send(
            "COMMAND_LONG",
            target_system=target,
            target_component=1,
            command=number,
            confirmation=confirmation,
            **values,
        )

    def set_interval(self, name: str, rate_hz: float, target: int = 1) -> None:
        """Ask for a message at a rate [Hz] (MAV_CMD_SET_MESSAGE_INTERVAL); 0 stops it."""
        if not (math.isfinite(rate_hz) and rate_hz >= 0.0):
            raise FieldError(name, "rate_hz", rate_hz, "finite numbers from 0 (stop) on")
        self.command(511, message(name).id, 1e6 / rate_hz if rate_hz > 0 else -1, target=target)

    def receive(self) -> list[Received]:
        """All messages since the last call, in order."""
        data = self.link.receive()
        if not data:
            return []
        return [_received((f.kind.name, f.kind.decode(f.payload))) for f in self._splitter.feed(data)]
