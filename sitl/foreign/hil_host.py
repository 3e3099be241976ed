# SPDX-License-Identifier: BSD-3-Clause
"""Serves a plant to an autopilot over the MAVLink HIL link, a step at a time: for environments, which hold its time."""

from __future__ import annotations

import contextlib
import select
import socket
import time
from collections.abc import Callable

from ..bridge.hil.physics_end import PhysicsEnd
from ..errors import OptionError
from ..plants.local import LocalPlant
from ..plants.physics_server import SimulatedPlant
from ..vehicle.record import TICK_US

WAIT_S = 0.2
_READ = 1 << 16


class HilHost:
    """One plant at a TCP port. Before PX4 has booted, which it cannot do while time stands, physics goes on by the
    clock on the wall, as its simulators do.

    Args:
        plant: at power-on.
        address: host and port to listen on; port 0: a free one.
        clock: wall time [s].

    Raises:
        OptionError: the port cannot be had.
    """

    def __init__(
        self, plant: LocalPlant, address: tuple[str, int], clock: Callable[[], float] = time.monotonic
    ) -> None:
        self.boots = 0
        """How many autopilots have connected."""
        self._wall, self._connection, self._heard = clock, None, b""
        self._due = float("-inf")
        self.seat(plant)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            self._socket.bind(address)
            self._socket.listen(1)
        except OSError as error:
            self._socket.close()
            where = f"hil:tcp:{address[0]}:{address[1]}"
            raise OptionError(f"{where} cannot be listened on: {error.strerror or error}") from None
        self._socket.settimeout(WAIT_S)

    _connection: socket.socket | None

    def seat(self, plant: LocalPlant) -> None:
        """Serve this plant from now on."""
        self.plant, self.end = plant, PhysicsEnd(SimulatedPlant(plant))

    @property
    def address(self) -> tuple[str, int]:
        """(host, port) that it listens on."""
        host, port = self._socket.getsockname()[:2]
        return host, port

    @property
    def time_us(self) -> int:
        """Simulated time since power-on [us]."""
        return self.end.time_us

    def listen(self) -> bool:
        """Wait a moment for an answer of the autopilot; whether there is one, or a step is due without."""
        if self._heard:
            return True
        if self._connection is None:
            self._accept()
            return False
        if self.end.freewheels:
            wait = min(max(self._due - self._wall(), 0.0), WAIT_S)
            if not select.select([self._connection], [], [], wait)[0]:
                return self._wall() >= self._due
        try:
            self._heard = self._connection.recv(_READ)
        except TimeoutError:
            return False
        except OSError:
            self._heard = b""
        if not self._heard:
            self._drop()
        return bool(self._heard)

    def _accept(self) -> None:
        try:
            connection, _ = self._socket.accept()
        except OSError:
            return
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        connection.settimeout(WAIT_S)
        self._connection = connection
        self.end.greet()
        self.boots += 1

    def step(self, until_us: int | None = None) -> None:
        """Take the answer and step, or step without one while the autopilot boots."""
        if self._connection is None:
            return
        heard, self._heard = self._heard, b""
        if heard:
            out = self.end.feed(heard)
        elif self.end.freewheels:
            out = self.end.go_on()
            self._due = max(self._due + 1e-6 * TICK_US, self._wall())
        else:
            return
        if out:
            try:
                self._connection.sendall(out)
            except OSError:
                self._drop()

    def _drop(self) -> None:
        if self._connection is not None:
            with contextlib.suppress(OSError):
                self._connection.close()
        self._connection = None

    def close(self) -> None:
        """Serve no more; the plant is the caller's."""
        self._drop()
        self._socket.close()
