# SPDX-License-Identifier: BSD-3-Clause
"""The clock of a program that a simulator gives out step by step (``lockstep/*.c``, a preloaded library).

The program says that it has come to the end of a step, and waits. The simulator answers with the end of the next step
and with the datagrams that the program gets at its beginning; what the program sends meanwhile comes with its next
word. Its threads run one after the other between two steps. So the same datagrams at the same times make the program
do the same, whatever the machine does besides; its UDP ports are not opened, so that several programs can run.

A message, little endian, either way: i64 time [ns], then for each datagram u16 port, u16 size, bytes. The clock starts
at one second. One of the program's TCP ports is served by the simulator through a pair of sockets; the others are
opened on this machine only, from a port on that the simulator chooses.
"""

from __future__ import annotations

import os
import socket
import struct
from collections.abc import Iterable, Mapping

from ..errors import SitlError
from .build import lockstep_library

START_NS = 1_000_000_000
"""Reading of the clock at the beginning [ns]."""
_TIME, _HEAD = struct.Struct("<q"), struct.Struct("<HH")
_MESSAGE = 1 << 16

Datagram = tuple[int, bytes]
"""Port, bytes."""


class ProgramGone(SitlError, RuntimeError):
    """The program has ended, or it has closed its end."""


class HeldClock:
    """The simulator's end of one program.

    Args:
        serial_port: TCP port of the program that ``serial`` is connected to; 0: none.
        first_port: TCP port of the program from which on others are opened, and the port of this machine that the
            first of them becomes; 0: any free ones.

    Raises:
        CannotBuild: the library cannot be compiled here, or this is not Linux.
    """

    def __init__(self, serial_port: int = 0, first_port: tuple[int, int] = (0, 0)) -> None:
        library = lockstep_library()
        self._patience = 0.0
        self._ours, self._theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.serial, self._their_serial = socket.socketpair(socket.AF_UNIX, socket.SOCK_STREAM)
        """What the program's serial port says and hears; it does not block."""
        self.serial.setblocking(False)
        others = [name for name in os.environ.get("LD_PRELOAD", "").split(":") if name]
        self.environment: Mapping[str, str] = {
            "LD_PRELOAD": ":".join([str(library), *others]),
            "SITL_LOCKSTEP_FD": str(self._theirs.fileno()),
            "SITL_LOCKSTEP_SERIAL": str(serial_port),
            "SITL_LOCKSTEP_SERIAL_FD": str(self._their_serial.fileno()),
            "SITL_LOCKSTEP_TCP_FROM": str(first_port[0]),
            "SITL_LOCKSTEP_TCP": str(first_port[1]),
        }
        """What the program's environment has besides ours."""
        self.descriptors = (self._theirs.fileno(), self._their_serial.fileno())
        """What the program inherits."""

    def started(self) -> None:
        """The program has been started: its ends are its alone, so that we notice when it ends."""
        self._theirs.close()
        self._their_serial.close()

    def answer(self, seconds: float) -> list[Datagram] | None:
        """What the program has sent in the step that it has done; None: it has not in so much wall time [s].

        Raises:
            ProgramGone: there is no program any more.
        """
        if seconds != self._patience:  # the kernel waits: a time-out of Python's would take another call each time
            self._patience = seconds
            whole = int(seconds)
            wait = struct.pack("@ll", whole, int(1e6 * (seconds - whole)))
            self._ours.setsockopt(socket.SOL_SOCKET, socket.SO_RCVTIMEO, wait)
        try:
            data = self._ours.recv(_MESSAGE)
        except BlockingIOError:
            return None
        except OSError:
            data = b""
        if len(data) < _TIME.size:
            raise ProgramGone("the program has closed its end of the clock")
        found, at = [], _TIME.size
        while at < len(data):
            port, size = _HEAD.unpack_from(data, at)
            at += _HEAD.size
            found.append((port, data[at : at + size]))
            at += size
        return found

    def grant(self, until_us: int, datagrams: Iterable[Datagram] = ()) -> None:
        """The next step ends at this time since the start [us]; these datagrams come first."""
        parts = [_TIME.pack(START_NS + 1000 * until_us)]
        for port, data in datagrams:
            parts += (_HEAD.pack(port, len(data)), data)
        try:
            self._ours.sendall(b"".join(parts))
        except OSError:
            raise ProgramGone("the program has closed its end of the clock") from None

    def close(self) -> None:
        """Close our ends: the program ends when it asks for the next step."""
        for each in (self._ours, self._theirs, self.serial, self._their_serial):
            each.close()
