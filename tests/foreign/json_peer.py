# SPDX-License-Identifier: BSD-3-Clause
"""An autopilot's end of the JSON wire for tests: a socket, frames at will."""

from __future__ import annotations

import json
import socket

from sitl.bridge.ardupilot_json.servos import Servos, encode


class Peer:
    """Says frames to a ``JsonHost`` in the same thread, which has its turn in between."""

    def __init__(self, host) -> None:
        self.host = host
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.connect(host.address)
        self.socket.setblocking(False)

    def send(self, number: int, pulse: int = 1000, rate: int = 400, pulses: int = 16) -> None:
        self.socket.send(encode(Servos(rate, number, (pulse,) * pulses)))

    def lines(self) -> list[dict]:
        """All answers that are there."""
        found = []
        while True:
            try:
                found.append(json.loads(self.socket.recv(65535)))
            except BlockingIOError:
                return found

    def ask(self, number: int, **frame) -> dict:
        """A frame, and the one line that answers it."""
        self.send(number, **frame)
        assert self.host.listen()
        self.host.step()
        (line,) = self.lines()
        return line

    def close(self) -> None:
        self.socket.close()
