# SPDX-License-Identifier: BSD-3-Clause
"""The datagram that an autopilot sends: its servo pulses, how long a step it would like, and a count.

Little endian: u16 magic (18458 with 16 pulses, 29569 with 32), u16 frame rate [Hz], u32 frame count, u16 pulses [us].
"""

from __future__ import annotations

import struct
from typing import NamedTuple

from ...errors import SitlError

MAGIC = {16: 18458, 32: 29569}
"""Pulses in a frame -> its first number."""
_LAYOUT = {count: struct.Struct(f"<HHI{count}H") for count in MAGIC}
_BY_SIZE = {layout.size: (MAGIC[count], layout) for count, layout in _LAYOUT.items()}
OUTPUTS = 16
"""Pulses of a frame that the border takes."""
COUNT_MASK = 0xFFFFFFFF
COUNT_AT = slice(4, 8)
"""Bytes of the count in a datagram."""


class ServoError(SitlError, ValueError):
    """Bytes that are no frame of servos; the message says why."""


class Servos(NamedTuple):
    """One frame of an autopilot."""

    rate: int
    """Steps a second that the autopilot would like [Hz]."""
    number: int
    """Frames before this one; a frame that is sent again has the same."""
    pulses: tuple[int, ...]
    """16 or 32 of them [us]; 0: no pulse."""


def encode(frame: Servos) -> bytes:
    """The datagram of a frame of 16 or 32 pulses."""
    count = len(frame.pulses)
    if count not in MAGIC:
        raise ServoError(f"a frame has 16 or 32 pulses, not {count}")
    return _LAYOUT[count].pack(MAGIC[count], frame.rate, frame.number & COUNT_MASK, *frame.pulses)


def decode(datagram: bytes) -> Servos:
    """The frame in a datagram.

    Raises:
        ServoError: it is none.
    """
    known = _BY_SIZE.get(len(datagram))
    if known is None:
        raise ServoError(f"{len(datagram)} bytes, where a frame of servos has {' or '.join(map(str, _BY_SIZE))}")
    magic, layout = known
    numbers = layout.unpack(datagram)
    if numbers[0] != magic:
        raise ServoError(f"it begins with {numbers[0]}, where a frame of this size begins with {magic}")
    return Servos(numbers[1], numbers[2], numbers[3:])


def is_frame(datagram: bytes) -> bool:
    """Whether a datagram is a frame of servos."""
    known = _BY_SIZE.get(len(datagram))
    return known is not None and int.from_bytes(datagram[:2], "little") == known[0]
