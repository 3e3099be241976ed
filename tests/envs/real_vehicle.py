# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle that looks like a real one to clients: no SIM_ parameters, no simulator's truth; it keeps what it heard."""

from __future__ import annotations

import contextlib
import socket
import threading
from typing import Any

from sitl.bridge.frame import Splitter, encode_v2
from sitl.client.endpoint import Endpoint
from sitl.simulation import Simulation

_STEP_US = 20_000


class RealVehicle:
    """A simulation behind a UDP port, in a thread; what gives it away does not pass.

    Args:
        simulation: the vehicle as it is now, armed and in the air, say.
        hidden: whether its SIM_ parameters are kept from clients.
    """

    def __init__(self, simulation: Simulation, hidden: bool = True) -> None:
        self.simulation, self.hidden = simulation, hidden
        self.heard: list[tuple[str, Any]] = []
        """Name and fields of each message that came from the client."""
        self._client, self._splitter, self._sequence = Endpoint(), Splitter(), 0
        simulation.bridge.add_link(self._client.link)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("127.0.0.1", 0))
        self._socket.settimeout(0.001)
        self.port = self._socket.getsockname()[1]
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._serve)

    def __enter__(self) -> RealVehicle:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._thread.join()
        self._socket.close()

    def _serve(self) -> None:
        peer = None
        while not self._stop.is_set():
            with contextlib.suppress(TimeoutError):
                data, peer = self._socket.recvfrom(1 << 16)
                for frame in self._splitter.feed(data):
                    self._take(frame)
            self.simulation.advance_to(self.simulation.time_us + _STEP_US)
            said = self._client.link.receive()
            for at in range(0, len(said) if peer else 0, 8192):
                self._socket.sendto(said[at : at + 8192], peer)

    def _take(self, frame: Any) -> None:
        fields = frame.kind.decode(frame.payload)
        self.heard.append((frame.kind.name, fields))
        if self.hidden and frame.kind.name == "PARAM_REQUEST_READ" and fields.param_id.startswith(b"SIM_"):
            return
        self._client.link.send(encode_v2(frame.kind, frame.payload, self._sequence, 255, 190))
        self._sequence = (self._sequence + 1) & 0xFF

    def commands(self) -> set[int]:
        """Numbers of the commands that came."""
        return {int(fields.command) for name, fields in self.heard if name in ("COMMAND_LONG", "COMMAND_INT")}
