# SPDX-License-Identifier: BSD-3-Clause
"""Whether what is heard under the ids of one vehicle comes from one vehicle.

What one vehicle sends on one link is numbered without a break, has one clock, and says one state at a time. Losses,
repetitions and reordering, which links do, are borne; what is doubtful all the same speaks against.
"""

from __future__ import annotations

from collections import OrderedDict
from typing import Any

from ..bridge.dialect import MessageType
from ..core.mavlink import MavModeFlag
from .endpoint import HEARTBEAT

REMEMBERED = 128
"""Frames among which a repeated one is looked for. A number comes again after 256."""
LATE = 32
"""So many frames, a frame may come late."""
COLLISION = 64
"""Among so many frames, no number stands on two different ones."""
BREAKS = 3
"""Breaks of the numbers that are two vehicles': one or two may be bursts of losses, or a reboot."""
BACK_MS = 1000
"""So much older than one before it, a message may be that comes late [ms]."""


class Voices:
    """Looks at each frame that is heard under the vehicle's ids.

    Args:
        is_held: whether the vehicle's time stands meanwhile.
    """

    def __init__(self, is_held: bool) -> None:
        self._is_held = is_held
        self.doubt = ""
        """What tells that there are two; "": nothing."""
        self._recent: OrderedDict[tuple[int, int, bytes], None] = OrderedDict()
        self._count = self._breaks = 0
        self._last: int | None = None
        self._indices: dict[int, int] = {}
        """Number of a frame to its index among all."""
        self._time_ms = 0
        self._states: list[tuple[int, ...]] = []
        """What HEARTBEATs have reported, each change."""

    @property
    def has_changed(self) -> bool:
        """Whether HEARTBEATs have reported two states. If one vehicle has changed its own,
        the first does not return."""
        return len(self._states) > 1

    def is_repeated(self, kind: MessageType, payload: bytes, sequence: int) -> bool:
        """Whether the link has brought this very frame already."""
        frame = sequence, kind.id, payload
        if frame in self._recent:
            return True
        self._recent[frame] = None
        if len(self._recent) > REMEMBERED:
            self._recent.popitem(last=False)
        return False

    def take(self, kind: MessageType, sequence: int, fields: Any) -> None:
        """A frame that is not repeated."""
        self._number(sequence)
        if kind is HEARTBEAT:
            self._state(fields)
        elif getattr(fields, "time_boot_ms", 0):
            self._clock(kind, int(fields.time_boot_ms))

    def _number(self, sequence: int) -> None:
        self._count += 1
        if self._last is not None:
            ahead = (sequence - self._last) & 0xFF
            collides = self._count - self._indices.get(sequence, -COLLISION - 1) <= COLLISION
            if collides or 128 <= ahead < 256 - LATE:
                self._breaks += 1
        self._last = sequence
        self._indices[sequence] = self._count
        if self._breaks >= BREAKS:
            self._doubts("its frames have two series of numbers")

    def _state(self, fields: Any) -> None:
        state = fields.type, fields.autopilot, fields.base_mode & MavModeFlag.SAFETY_ARMED, fields.custom_mode
        if self._states and state == self._states[-1]:
            return
        if state in self._states or (self._states and state[:2] != self._states[-1][:2]):
            reported = " and ".join(f"{'armed' if armed else 'disarmed'} in mode {mode} (type {type})"
                                for type, _, armed, mode in (self._states[-1], state))  # fmt: skip
            self._doubts(f"its HEARTBEATs say by turns that it is {reported}")
        self._states.append(state)

    def _clock(self, kind: MessageType, time_ms: int) -> None:
        if self._is_held:
            self._doubts(f"{kind.name} comes while its time stands")
        elif time_ms < self._time_ms - BACK_MS:
            self._doubts(f"its clock goes back from {self._time_ms} to {time_ms} ms")
        self._time_ms = max(self._time_ms, time_ms)

    def _doubts(self, why: str) -> None:
        self.doubt = self.doubt or why
