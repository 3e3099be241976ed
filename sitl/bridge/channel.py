# SPDX-License-Identifier: BSD-3-Clause
"""One client as the bridge sees it: its own sequence numbers, MAVLink version, streams and counts.

What the core needs of it is in its port, a record (``wire/port.py``).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ..core.constants import NEVER
from .dialect import MessageType, message_by_id
from .frame import Frame, encode_v1, encode_v2
from .links.faulty_direction import Directions, DirectionState, FaultyDirection
from .links.link import Peer
from .wire.frames import COMPONENT
from .wire.port import IN_BYTES, INCOMING, OUT, STATE, Port
from .wire.spool import FRAMES, Spool

_FIRST = 4


class Ports:
    """The ports of a vehicle's clients, side by side in memory."""

    def __init__(self) -> None:
        self._memory = np.zeros(_FIRST, Port.dtype)
        self.count = 0
        self.address = int(self._memory.ctypes.data)
        """Of the first one; it changes when clients come."""

    def arrange(self, channels: list[Channel]) -> None:
        """Give each channel its port, in their order; what the ports hold is kept."""
        held = [bytes(channel.port._bytes) for channel in channels]
        if len(channels) > len(self._memory):
            self._memory = np.zeros(2 * len(channels), Port.dtype)
            self.address = int(self._memory.ctypes.data)
        self.count = len(channels)
        for k, (channel, content) in enumerate(zip(channels, held, strict=True)):
            channel.port = Port.of(self._memory, k)
            channel.port._bytes[:] = content
            channel.address = self.address + k * Port.dtype.itemsize


class ChannelState(NamedTuple):
    """What a channel needs to go on from a snapshot."""

    number: int
    port: bytes
    directions: tuple[DirectionState, DirectionState] | None = None
    """Of a link with faults."""


class Channel:
    """Frames to and from one client.

    It speaks MAVLink 2, except to a client that has only ever been heard in MAVLink 1.
    """

    def __init__(
        self, peer: Peer, number: int, system: int, is_watched: Callable[[], bool], logs: Sequence[Channel] = ()
    ) -> None:
        self.peer = peer
        self.number = number
        self._is_watched, self._logs = is_watched, logs
        self.port = Port()
        self.address = 0
        """Address of the port, once the bridge has allotted its memory."""
        self.port.version, self.port.system, self.port.next_us = 2, system, NEVER
        self.spool: Spool | None = None
        """What the core sends while time passes, for a client that takes frames of several times in one piece."""
        self.spool_address = 0
        if peer.spools:
            self._spool_memory = Spool.fleet(1)
            self.spool_address = int(self._spool_memory.ctypes.data)
            self.spool = Spool.of(self._spool_memory, 0)
            self.spool.stamped = peer.stamps

    @property
    def name(self) -> str:
        """Link and address, for people."""
        return self.peer.name

    @property
    def system(self) -> int:
        """Our system id in outgoing frames."""
        return self.port.system

    @property
    def version(self) -> int:
        """Version of MAVLink that the client is sent."""
        return self.port.version

    @property
    def congested(self) -> bool:
        """Whether telemetry should wait: the client reads too slowly, or its link carries no more."""
        peer = self.peer
        return peer.congested or (peer.directions is not None and peer.directions.to_client.is_full)

    def snapshot(self) -> ChannelState:
        """Everything that later frames depend on; what is in transit is the client's, unless the link has faults."""
        faulty = self.peer.directions.snapshot() if self.peer.directions is not None else None
        return ChannelState(self.number, bytes(self.port._bytes[:STATE]), faulty)

    def restore(self, state: ChannelState) -> None:
        """Go on from a snapshot of this channel."""
        self.port._bytes[:STATE] = state.port
        self.peer.directions = (
            Directions(*map(FaultyDirection.restored, state.directions)) if state.directions is not None else None
        )

    # ------------------------------------------------------------------ out

    def send(self, kind: MessageType, payload: bytes) -> None:
        """Answer this client: queue one message for it and for all logs."""
        self.put(kind, payload)
        for log in self._logs:
            if log is not self:
                log.put(kind, payload)

    def put(self, kind: MessageType, payload: bytes) -> None:
        """Queue one message; the bridge flushes all channels when it is done."""
        port = self.port
        if port.out_count or self.has_spooled():
            self.collect()
        encode = encode_v2 if port.version == 2 else encode_v1
        frame = encode(kind, payload, port.sequence, port.system, COMPONENT)
        if frame:
            port.sequence = (port.sequence + 1) & 0xFF
            port.sent += 1
            self.peer.outbox.append(frame)

    def has_spooled(self) -> bool:
        """Whether the core has sent something while time passed."""
        return self.spool is not None and self.spool.used > 0

    def hand_over(self) -> None:
        """Give the frames that the core made to a peer that ``waits``, while nobody watches."""
        port, peer = self.port, self.peer
        if peer.outbox:  # they come first
            peer.flush()
        peer.accept(bytes(port._bytes[OUT : OUT + port.out_size]))
        port.out_count = port.out_size = 0

    def collect(self) -> None:
        """Queue the frames that the core made."""
        spool, port = self.spool, self.port
        if spool is not None and spool.used:
            self.peer.spooled(bytes(spool._bytes[FRAMES : FRAMES + spool.used]))
            spool.used = 0
        if not port.out_count:
            return
        data = bytes(port._bytes[OUT : OUT + port.out_size])
        if port.out_count == 1 or (self.peer.joins_frames and not self._is_watched()):
            self.peer.outbox.append(data)
        else:
            ends = port.out_end[: port.out_count].tolist()
            self.peer.outbox.extend(data[start:end] for start, end in pairwise((0, *ends)))
        port.out_count = port.out_size = 0

    # ------------------------------------------------------------------ in

    def takes(self, data: bytes) -> bool:
        """Hand bytes from the client to the port, if it has space for all of them."""
        port = self.port
        size = port.in_size
        end = size + len(data)
        if end > IN_BYTES:
            return False
        port._bytes[INCOMING + size : INCOMING + end] = data
        port.in_size = end
        return True

    def feed(self, data: bytes) -> bytes:
        """Hand bytes from the client to the port; returns those for which there is no space yet."""
        free = IN_BYTES - self.port.in_size
        self.takes(data[:free])
        return data[free:]

    def frame(self) -> Frame:
        """The frame that the core stopped at."""
        port = self.port
        memory: Any = port._bytes
        start, end, payload = port.frame_start, port.frame_end, port.frame_payload
        raw = bytes(memory[INCOMING + start : INCOMING + end])
        return Frame(
            message_by_id(port.frame_number),
            raw[payload - start : payload - start + port.frame_payload_size],
            port.frame_sequence,
            port.frame_sender >> 8,
            port.frame_sender & 0xFF,
            port.frame_version,
            raw,
        )
