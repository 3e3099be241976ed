# SPDX-License-Identifier: BSD-3-Clause
"""Messages to bytes and bytes to messages: the client's end of a link, without time and without waiting."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple, Protocol

from ..bridge.dialect import FieldError, MessageType, message
from ..bridge.frame import Splitter, encode_v2
from ..bridge.links.inprocess import InProcessLink
from ..core.mavlink import MavAutopilot, MavResult, MavType


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
        """Send a COMMAND_LONG (MAV_CMD ``number``) with up to seven parameters to the autopilot of a system."""
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
        cut = self._splitter.cut(data)
        return [_received((kind.name, kind.decode(payload))) for kind, payload, _, _, _, _, _ in cut]


HEARTBEAT, ACK, TEXT, PARAMETER = (message(name) for name in ("HEARTBEAT", "COMMAND_ACK", "STATUSTEXT", "PARAM_VALUE"))
AUTOPILOT = 1
"""MAV_COMP_ID_AUTOPILOT1: messages of other components do not count."""
KEPT_TEXTS = 10


class Inbox:
    """Takes bytes from the vehicle apart and passes each message on.

    Only the autopilot of one system counts. Which one, the first HEARTBEAT of an autopilot says, unless ``system`` is
    set before; until then nothing counts. What another client was answered does not count either.

    Args:
        on_message: gets the name and the fields of each message.
    """

    def __init__(self, on_message: Callable[[str, Any], None] = lambda name, fields: None) -> None:
        self.on_message = on_message
        self.own: Endpoint | None = None
        """The client's other direction, whose ids answers are for; None: whoever was answered counts."""
        self.system = 0
        """MAVLink id of the vehicle; 0 before it was heard."""
        self.acks: dict[int, Any] = {}
        """The last COMMAND_ACK of each command."""
        self.parameters: dict[str, float] = {}
        """Values as they were sent last."""
        self.last_texts: list[str] = []
        """The last status texts, newest last."""
        self.count = 0
        """Messages so far that a vehicle whose time stands does not send: all but HEARTBEAT and texts."""
        self.boots = 0
        """How often the vehicle's clock has gone back."""
        self.witness: Callable[[MessageType, Any], None] | None = None
        """Gets kind and fields of what counts, while somebody wants to know."""
        self.overhear: Callable[[list[tuple[Any, ...]]], None] | None = None
        """Gets all frames, whoever sent them, while somebody wants to know (``proof``)."""
        self._time_ms = self._before_boot_ms = 0
        self._splitter = Splitter()

    @property
    def time_ms(self) -> int:
        """The vehicle's clock, from ``time_boot_ms`` of what it sends [ms]; a reboot does not set it back."""
        return self._before_boot_ms + self._time_ms

    def feed(self, data: bytes) -> None:
        """Take bytes from the vehicle, in any pieces."""
        for kind, payload, _, system, component, _, _ in self._cut(data):
            if self._is_of_vehicle(kind, system, component):
                fields = kind.decode(payload)
                if self.is_for_us(kind, fields):
                    self._note(kind, fields, system)
                    self.on_message(kind.name, fields)

    def _cut(self, data: bytes) -> list[tuple[Any, ...]]:
        """Frames that these bytes complete."""
        frames = self._splitter.cut(data)
        if self.overhear is not None:
            self.overhear(frames)
        return frames

    def _is_of_vehicle(self, kind: MessageType, system: int, component: int) -> bool:
        """Whether a message may count, by its sender."""
        return component == AUTOPILOT and (system == self.system or (self.system == 0 and kind is HEARTBEAT))

    def is_for_us(self, kind: MessageType, fields: Any) -> bool:
        """Whether a message of the vehicle counts, by what it says: no heartbeat that is not an autopilot's, and no
        answer to another client. A target of 0 is everybody, or of an autopilot that does not tell."""
        if kind is HEARTBEAT:
            return fields.autopilot != MavAutopilot.INVALID and fields.type != MavType.GCS
        if self.own is None or not hasattr(fields, "target_system"):
            return True
        component = getattr(fields, "target_component", 0)
        return fields.target_system in (0, self.own.system) and component in (0, self.own.component)

    def _note(self, kind: MessageType, fields: Any, system: int) -> None:
        if self.witness is not None:
            self.witness(kind, fields)
        if kind is TEXT:
            self.last_texts = [*self.last_texts[1 - KEPT_TEXTS :], fields.text.decode("ascii", "replace")]
        elif kind is HEARTBEAT:
            self.system = system
        else:
            self.count += 1
            if kind is ACK:
                if fields.result != MavResult.IN_PROGRESS:
                    self.acks[int(fields.command)] = fields
            elif kind is PARAMETER:
                self.parameters[fields.param_id.decode("ascii", "replace")] = float(fields.param_value)
            elif hasattr(fields, "time_boot_ms"):
                self._tick(int(fields.time_boot_ms))

    def _tick(self, time_ms: int) -> None:
        if time_ms < self._time_ms - 1000:  # more than an old message that comes late
            self.boots += 1
            self._before_boot_ms += self._time_ms
            self._time_ms = time_ms
        self._time_ms = max(time_ms, self._time_ms)
