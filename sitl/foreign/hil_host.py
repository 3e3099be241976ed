# SPDX-License-Identifier: BSD-3-Clause
"""Serves a plant to an autopilot over the MAVLink HIL link step by step, for environments, which control its time."""

from __future__ import annotations

import contextlib
import select
import socket
import time
from collections.abc import Callable

from ..bridge.hil.physics_end import PhysicsEnd
from ..core.constants import TICK_US
from ..errors import OptionError
from ..plants.json_link import wait_in_kernel
from ..plants.local import LocalPlant
from ..plants.physics_server import SimulatedPlant
from .hil_ticks import HilTicks

WAIT_S = 0.2
_READ = 1 << 16


class HilHost:
    """Serves one plant at a TCP port. PX4 cannot boot while time stands still: until it has booted, physics goes
    on with the wall clock.

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
        """Number of autopilots that have connected."""
        self.before_boot_us = 0
        self._wall, self._connection, self._received = clock, None, b""
        self._due, self._is_due = float("-inf"), False
        self.attach(plant)
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

    def attach(self, plant: LocalPlant) -> None:
        """Serve another plant from now on."""
        self.plant, self.end = plant, PhysicsEnd(SimulatedPlant(plant))
        self._ticks = HilTicks(plant, self.end)

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
        """Wait up to 0.2 s for an answer of the autopilot; True: there is one, or a step is due without."""
        if self._received:
            return True
        if self._connection is None:
            self._accept()
            return False
        end, early = self.end, self._due - self._wall()
        longest = end.wait_s
        if end.freewheels:
            longest = max(early, 0.0)
        elif end.is_starting and early > 0.0:  # it answers, but its time must not outrun the wall clock yet
            time.sleep(min(early, WAIT_S))
            if early > WAIT_S:
                return False
        if longest is not None and not select.select([self._connection], [], [], min(longest, WAIT_S))[0]:
            self._is_due = longest <= WAIT_S
            return self._is_due
        try:
            self._received = self._connection.recv(_READ)
        except (TimeoutError, BlockingIOError):
            return False
        except OSError:
            self._received = b""
        if not self._received:
            self._drop()
        return bool(self._received)

    def _accept(self) -> None:
        try:
            connection, _ = self._socket.accept()
        except OSError:
            return
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        wait_in_kernel(connection, WAIT_S)
        self._connection = connection
        self.end.greet()
        self.boots += 1

    def step(self, until_us: int | None = None, answers: int = 1) -> None:
        """Process the answer and step; or step without one, where that is due.

        With more ``answers`` it may wait for those that follow, and step for each of them up to the same time.
        """
        if self._connection is None:
            return
        data, self._received = self._received, b""
        is_due, self._is_due = self._is_due, False
        before = self.end.ticks
        if data:
            out = self.end.feed(data)
        elif is_due:
            out = self.end.go_on()
        else:
            return
        if self.end.ticks != before and self.end.is_starting:
            self._due = max(self._due + 1e-6 * TICK_US, self._wall())
        if out:
            try:
                self._connection.sendall(out)
                if answers > 1 and until_us is not None and self._ticks.is_quick:
                    self._received = self._ticks.go_on(self._connection, until_us, answers - 1)
            except OSError:
                self._drop()

    def _drop(self) -> None:
        if self._connection is not None:
            with contextlib.suppress(OSError):
                self._connection.close()
        self._connection = None

    def close(self) -> None:
        """Close the sockets; the plant stays open."""
        self._drop()
        self._socket.close()
