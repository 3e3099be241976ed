# SPDX-License-Identifier: BSD-3-Clause
"""Frames of one end of the link."""

from __future__ import annotations

from ..dialect import MessageType
from ..frame import encode_v2


class Sender:
    """Makes the frames of one end, counted."""

    def __init__(self, system: int, component: int) -> None:
        self._system, self._component = system, component
        self._sequence = 255

    def frame(self, kind: MessageType, payload: bytes) -> bytes:
        """A MAVLink 2 frame."""
        self._sequence = self._sequence + 1 & 255
        return encode_v2(kind, payload, self._sequence, self._system, self._component)
