# SPDX-License-Identifier: BSD-3-Clause
"""Message signing: SETUP_SIGNING, and what a vehicle with a key takes and sends."""

from __future__ import annotations

from typing import Any

from ...core.mavlink import MavSeverity
from ..channel import Channel
from ..dialect import message
from ..frame import Splitter
from ..host import Host
from ..listener import Sender
from ..signing import Signing, SigningState, Stream, is_signed, unsigned
from .service import Handler, Service
from .statustext import StatusTextService

TAKEN_UNSIGNED = frozenset((message("RADIO_STATUS").id, message("RADIO").id))
"""Radios say them on their own account."""


class SigningService(Service):
    """One key for all links. Links within the process need no signatures and get none."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self.signing = Signing()
        self._splitters: dict[int, Splitter] = {}
        """Of channels by their numbers: what they sent is cut into frames here first."""
        self.refused = 0
        """Frames that were not signed as they had to be."""

    def handlers(self) -> dict[str, Handler]:
        return {"SETUP_SIGNING": self._set_up}

    def channel_removed(self, channel: Channel) -> None:
        self._splitters.pop(channel.number, None)

    def snapshot(self) -> Any:
        key, timestamp, streams = self.signing.state()
        return (key, timestamp, tuple((tuple(stream), last) for stream, last in streams))

    def restore(self, state: Any) -> None:
        key, timestamp, streams = state
        self.signing = Signing(SigningState(key, timestamp, tuple((Stream(*of), last) for of, last in streams)))

    def follow(self, old: SigningService) -> None:
        """Keep the key over a reboot."""
        self.signing = old.signing

    def _set_up(self, channel: Channel, m: Any, sender: Sender) -> None:
        if m.target_component not in (0, 1):
            return
        if self.bridge.autopilot.armed():
            self.bridge.get(StatusTextService).say(MavSeverity.ERROR, "ERROR: Won't setup signing when armed")
            return
        self.signing.set_key(bytes(m.secret_key), m.initial_timestamp)
        self._splitters.clear()

    @property
    def is_on(self) -> bool:
        """Whether there is a key."""
        return self.signing.is_on

    def concerns(self, channel: Channel) -> bool:
        """Whether what a client sends has to be signed, and what it is sent is."""
        return self.signing.is_on and channel.peer.is_signed

    def received(self, channel: Channel, data: bytes) -> bytes:
        """What of a client's bytes the vehicle may act on: whole frames, without their signatures."""
        splitter = self._splitters.setdefault(channel.number, Splitter())
        taken = bytearray()
        for frame in splitter.feed(data):
            if is_signed(frame) and self.signing.accepts(frame.raw, frame.system, frame.component):
                taken += unsigned(frame)
            elif not is_signed(frame) and (channel.peer.takes_unsigned or frame.kind.id in TAKEN_UNSIGNED):
                taken += frame.raw
            else:
                self.refused += 1
        return bytes(taken)

    def sent(self, channel: Channel, frames: list[bytes]) -> list[bytes]:
        """Frames to a client, signed."""
        bridge = self.bridge
        self.signing.follow_date(bridge.epoch_us + bridge.elapsed_us)
        return [self.signing.signed(frame, channel.number) for frame in frames]
