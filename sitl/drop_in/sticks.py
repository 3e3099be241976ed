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
FOR_EVER_US = 1 << 62


class StickPort(Link):
    """Writes what it hears into the vehicle's receiver; no MAVLink client ever appears on it.

    Args:
        v: the vehicle's record.
        host, port: where it listens.

    Raises:
        LinkAddressError: the port is taken or not allowed.
    """

    def __init__(self, v: Any, host: str, port: int) -> None:
        super().__init__(f"udpin:{host}:{port}")
        self._v = v
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
            self.hear(frame)

    def hear(self, frame: bytes) -> None:
        """Put a frame into the receiver: pulses [us], little-endian; channels that it does not have, or as 0, stay."""
        sensors, count = self._v.sensors, min(len(frame) // 2, RC_INPUTS)
        for k, pulse in enumerate(struct.unpack_from(f"<{count}H", frame)):
            if pulse:
                sensors.rc_channels[k] = pulse
        sensors.rc_count += 1
        sensors.rc_time_us = FOR_EVER_US

    def close(self) -> None:
        if self._selector is not None:
            self._selector.unregister(self._socket)
            self._selector = None
        self._socket.close()
        super().close()
