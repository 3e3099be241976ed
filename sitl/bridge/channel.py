# SPDX-License-Identifier: BSD-3-Clause
"""One client as the bridge sees it: its own sequence numbers, MAVLink version, streams and statistics."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from .dialect import MessageType
from .frame import Frame, Splitter, encode_v1, encode_v2
from .links.link import Peer
from .stream_table import Entry, Layout, StreamTable

COMPONENT = 1
"""MAV_COMP_ID_AUTOPILOT1."""


@dataclass
class Statistics:
    """Counts of one channel."""

    received: int = 0
    sent: int = 0
    lost: int = 0
    """Gaps in the client's sequence numbers."""


class ChannelState(NamedTuple):
    """What a channel needs to go on from a snapshot."""

    number: int
    sequence: int
    version: int
    heard_v2: bool
    streams: Layout


class Channel:
    """Frames to and from one client.

    It speaks MAVLink 2, except to a client that has only ever been heard in MAVLink 1.
    """

    def __init__(self, peer: Peer, number: int, system: int) -> None:
        self.peer = peer
        self.number = number
        self.system = system
        """Our system id in outgoing frames."""
        self.version = 2
        self.heard_v2 = False
        self.sequence = 0
        self.splitter = Splitter()
        self.streams = StreamTable()
        self.statistics = Statistics()
        self._expected: dict[tuple[int, int], int] = {}

    @property
    def name(self) -> str:
        """Link and address, for people."""
        return self.peer.name

    def snapshot(self) -> ChannelState:
        """Everything that later frames depend on; what is in transit is the client's."""
        return ChannelState(self.number, self.sequence, self.version, self.heard_v2, self.streams.snapshot())

    def restore(self, state: ChannelState | None, entries: Mapping[int, Entry], now_us: int) -> None:
        """Go on from a snapshot; None: the channel is newer than the snapshot, only time has changed."""
        if state is None:
            self.streams.restore(None, entries, now_us)
            return
        _, self.sequence, self.version, self.heard_v2, streams = state
        self.streams.restore(streams, entries, now_us)

    def send(self, kind: MessageType, payload: bytes) -> None:
        """Queue one message; the bridge flushes all channels when it is done."""
        encode = encode_v2 if self.version == 2 else encode_v1
        frame = encode(kind, payload, self.sequence, self.system, COMPONENT)
        if frame:
            self.sequence = (self.sequence + 1) & 0xFF
            self.statistics.sent += 1
            self.peer.outbox.append(frame)

    def receive(self, on_received: Callable[[Channel, bytes], None] | None = None) -> list[Frame]:
        """Frames that came in since the last call; ``on_received`` gets the bytes."""
        data = self.peer.take()
        if not data:
            return []
        if on_received is not None:
            on_received(self, data)
        frames = self.splitter.feed(data)
        self.statistics.received += len(frames)
        expected = self._expected
        for frame in frames:
            sender, sequence = (frame.system, frame.component), frame.sequence
            if sender in expected:
                self.statistics.lost += (sequence - expected[sender]) & 0xFF
                expected[sender] = (sequence + 1) & 0xFF
            elif len(expected) < 256:
                expected[sender] = (sequence + 1) & 0xFF
            if frame.version == 2:
                self.heard_v2, self.version = True, 2
            elif not self.heard_v2:
                self.version = 1
        return frames
