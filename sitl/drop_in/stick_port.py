# SPDX-License-Identifier: BSD-3-Clause
"""The pilot's sticks from a UDP port, as ArduPilot's simulator takes them: 8 or 16 unsigned 16-bit pulses a datagram.

The receiver repeats the last frame until the next one: tools send when a stick moves.
"""

from __future__ import annotations

import struct
from typing import Any

from ..bridge.links.link import DatagramLink, LinkAddressError
from ..core.border import RC_INPUTS

FEWEST = 8
AT_REST = (1500, 1500, 1500, 1500, 1800, 1000, 1000, 1800)
"""Pulses of the channels, from 1, that no frame has had so far, as in ArduPilot's simulator [us]."""
LEAST_THROTTLE = 1000
"""Of the third in its copters."""
FOR_EVER_US = 1 << 62


class StickPort(DatagramLink):
    """Writes what it hears into the vehicle's receiver; no MAVLink client ever appears on it.

    Args:
        v: the vehicle's record.
        host, port: where it listens.
        throttle: pulse of the third channel until a frame has one [us].

    Raises:
        LinkAddressError: the port is taken or not allowed.
    """

    def __init__(self, v: Any, host: str, port: int, throttle: int = AT_REST[2]) -> None:
        name = f"udpin:{host}:{port}"
        try:
            super().__init__(name, (host, port))
        except OSError as error:
            raise LinkAddressError(f"sticks on {name} cannot be heard: {error.strerror or error}") from None
        self._v = v
        self._at_rest = (*AT_REST[:2], throttle, *AT_REST[3:])

    def _readable(self) -> None:
        frame = b""
        while True:
            try:
                data = self._socket.recv(2048)
            except OSError:
                break
            if len(data) >= 2 * FEWEST:
                frame = data
        if frame:
            self.receive(frame)

    def receive(self, frame: bytes) -> None:
        """Put a frame into the receiver: pulses [us], little-endian; channels that it does not have, or as 0, stay."""
        sensors, count = self._v.sensors, min(len(frame) // 2, RC_INPUTS)
        for k, pulse in enumerate(struct.unpack_from(f"<{count}H", frame)):
            if pulse:
                sensors.rc_channels[k] = pulse
            elif k < len(self._at_rest) and sensors.rc_channels[k] == 0:
                sensors.rc_channels[k] = self._at_rest[k]
        sensors.rc_count += 1
        sensors.rc_time_us = FOR_EVER_US
