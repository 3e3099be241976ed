# SPDX-License-Identifier: BSD-3-Clause
"""The pilot's sticks from a UDP port, as ArduPilot's simulator takes them: 8 or 16 unsigned 16-bit pulses a datagram.

The receiver repeats the last frame until the next one: tools send when a stick moves.
"""

from __future__ import annotations

import selectors
import socket
import struct
from collections.abc import Callable
from typing import Any

from ..bridge.links.link import Link, LinkAddressError, Peer, Selector
from ..core.border import RC_INPUTS

FEWEST = 8
AT_REST = (1500, 1500, 1500, 1500, 1800, 1000, 1000, 1800)
"""Pulses of the channels, from 1, that no frame has had so far, as in ArduPilot's simulator [us]."""
LEAST_THROTTLE = 1000
"""Of the third in its copters."""
FOR_EVER_US = 1 << 62


class StickPort(Link):
    """Writes what it hears into the vehicle's receiver; no MAVLink client ever appears on it.

    Args:
        v: the vehicle's record.
        host, port: where it listens.
        throttle: pulse of the third channel until a frame has one [us].

    Raises:
        LinkAddressError: the port is taken or not allowed.
    """

    def __init__(self, v: Any, host: str, port: int, throttle: int = AT_REST[2]) -> None:
        super().__init__(f"udpin:{host}:{port}")
        self._v = v
        self._at_rest = (*AT_REST[:2], throttle, *AT_REST[3:])
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        self._selector: Selector | None = None
        try:
            self._socket.bind((host, port))
        except OSError as error:
            self._socket.close()
            raise LinkAddressError(f"sticks on {self.name} cannot be heard: {error.strerror or error}") from None

    def attach(self, selector: Selector, on_peer: Callable[[Peer], None]) -> None:
        self._selector = selector
        selector.register(self._socket, selectors.EVENT_READ, self._readable)
        super().attach(selector, on_peer)

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

    def close(self) -> None:
        if self._selector is not None:
            self._selector.unregister(self._socket)
            self._selector = None
        self._socket.close()
        super().close()
