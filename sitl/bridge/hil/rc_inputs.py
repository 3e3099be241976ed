# SPDX-License-Identifier: BSD-3-Clause
"""HIL_RC_INPUTS_RAW: frames of a receiver that the physics side has, pulses [us]. They end when the pilot is gone.

PX4 takes RC_CHANNELS in its place.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..dialect import MessageType, message
from .protocol import LATEST_US, RefusedError

KIND, CHANNELS = message("HIL_RC_INPUTS_RAW"), message("RC_CHANNELS")
UNUSED = 65535
CARRIED = 12
"""Channels of a frame."""
LOWEST, HIGHEST = 800, 2200
"""No receiver gives other pulses [us]."""
_STRONGEST = 254


def frame_for(is_foreign: bool, time_us: int, pulses: Sequence[int]) -> tuple[MessageType, bytes]:
    """The message and payload that this autopilot takes."""
    if not is_foreign:
        return KIND, sticks_payload(time_us, pulses)
    given = {f"chan{k}_raw": int(pulse) for k, pulse in enumerate(pulses, 1)}
    count = len(given)
    return CHANNELS, CHANNELS.payload(time_boot_ms=time_us // 1000, chancount=count, rssi=_STRONGEST, **given)


def sticks_payload(time_us: int, pulses: Sequence[int]) -> bytes:
    """A frame of up to twelve channels."""
    given = [int(pulse) for pulse in pulses][:CARRIED]
    return KIND.pack(time_us, *given, *(UNUSED,) * (CARRIED - len(given)), _STRONGEST)


class SticksReader:
    """From payloads into a record."""

    def __init__(self, v: Any) -> None:
        self._sensors = v.sensors

    @staticmethod
    def read(payload: bytes) -> tuple[int, list[int]]:
        """Time [us] and pulses; 0 for channels that are not used.

        Raises:
            RefusedError: a pulse that no receiver gives.
        """
        t, *pulses, _ = KIND.unpack_from(payload.ljust(KIND.size, b"\0"))
        pulses = [0 if pulse == UNUSED else pulse for pulse in pulses]
        for k, pulse in enumerate(pulses, 1):
            if pulse and not LOWEST <= pulse <= HIGHEST:
                raise RefusedError(f"{KIND.name}.chan{k}_raw = {pulse}: {LOWEST} .. {HIGHEST} us are allowed")
        if t >= LATEST_US:
            raise RefusedError(f"{KIND.name}.time_usec = {t}")
        return t, pulses

    def write(self, values: tuple[int, list[int]]) -> None:
        """Put a frame into the record."""
        s = self._sensors
        s.rc_time_us, s.rc_channels[:CARRIED] = values
        s.rc_count += 1
