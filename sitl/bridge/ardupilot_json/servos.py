# SPDX-License-Identifier: BSD-3-Clause
"""The datagram that an autopilot sends: its servo pulses, how long a step it would like, and a count.

Little endian: u16 magic (18458 with 16 pulses, 29569 with 32), u16 frame rate [Hz], u32 frame count, u16 pulses [us].
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...core.record_reader import locate
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


class Controls(dict[int, float]):
    """Pulse [us] -> actuator control: -1 .. 1 of a servo or a wheel's motor, 0 .. 1 of a rotor; worked out once each.

    Args:
        is_reversible: whether the outputs are servos or wheels.
    """

    def __init__(self, is_reversible: bool) -> None:
        super().__init__({0: 0.0})
        self._is_reversible = is_reversible

    def __missing__(self, pulse: int) -> float:
        if self._is_reversible:
            value = min(max((pulse - 1500.0) / 500.0, -1.0), 1.0)
        else:
            value = min(max((pulse - 1000) * 0.001, 0.0), 1.0)
        self[pulse] = value
        return value

    def of(self, pulses: Sequence[int]) -> list[float]:
        """The border's 16 actuator controls of a frame."""
        return [self[pulse] for pulse in pulses[:OUTPUTS]]


def actuators_writer(fleet: np.ndarray[Any, Any], index: int, is_reversible: bool) -> Callable[[Sequence[int]], None]:
    """A function that writes the pulses of a frame [us] into a record's actuators.

    It packs all of them at once: assignments to arrays of the record convert number by number, and take three times as
    long.

    Args:
        fleet: records of vehicles, whose memory stays in place.
        index: of the vehicle.
        is_reversible: see ``Controls``.
    """
    start = index * fleet.dtype.itemsize
    controls_at = start + locate(fleet.dtype, "actuators.controls")[0]
    pulses_at = start + locate(fleet.dtype, "actuators.pwm")[0]
    memory, controls = fleet.view("u1").data, Controls(is_reversible)
    write_controls = struct.Struct(f"<{OUTPUTS}f").pack_into
    write_pulses = struct.Struct(f"<{OUTPUTS}q").pack_into

    def put(pulses: Sequence[int]) -> None:
        write_controls(memory, controls_at, *controls.of(pulses))
        write_pulses(memory, pulses_at, *pulses[:OUTPUTS])

    return put
