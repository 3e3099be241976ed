# SPDX-License-Identifier: BSD-3-Clause
"""MAVLink FTP (https://mavlink.io/en/services/ftp.html): reads of ``@PARAM/param.pck``.

Everything else is refused by its own error.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any

from ..channel import Channel
from ..dialect import message
from ..wire.port import NEVER
from .parameters import ParameterService, pack_parameters
from .service import Handler, Sender, Service

KIND = message("FILE_TRANSFER_PROTOCOL")
HEADER = struct.Struct("<HBBBBBBI")
"""sequence, session, opcode, size, request opcode, burst complete, padding, offset"""
DATA_BYTES = 239
TERMINATE, RESET, OPEN_READ, READ, BURST_READ, ACK, NAK = 1, 2, 4, 5, 15, 128, 129
INVALID_DATA_SIZE, INVALID_SESSION, END_OF_FILE, UNKNOWN_COMMAND, FILE_NOT_FOUND = 3, 4, 6, 7, 10
PARAMETERS = "@PARAM/param.pck"
BURST_EVERY_US = 10_000
BURST_AT_ONCE = 10
"""Packets every 10 ms of simulated time."""


class _Burst:
    def __init__(self, offset: int, size: int, sequence: int) -> None:
        self.offset, self.size, self.sequence = offset, size, sequence


class _Session:
    """The one file that a client has open."""

    def __init__(self, data: bytes, sender: Sender, number: int) -> None:
        self.data, self.sender, self.number = data, sender, number
        self.burst: _Burst | None = None


class FtpService(Service):
    """MAVLink FTP: one session for each channel, under the number that the client gives it, as in ArduPilot."""

    def __init__(self, bridge: Any) -> None:
        super().__init__(bridge)
        self._sessions: dict[Channel, _Session] = {}
        self._operations: dict[int, Callable[[Channel, Sender, int, int, int, int, bytes], None]] = {
            OPEN_READ: self._open,
            READ: self._read,
            BURST_READ: self._burst,
        }

    def handlers(self) -> dict[str, Handler]:
        return {"FILE_TRANSFER_PROTOCOL": self._request}

    def channel_removed(self, channel: Channel) -> None:
        self._sessions.pop(channel, None)

    def _request(self, channel: Channel, m: Any, sender: Sender) -> None:
        payload = bytes(m.payload)
        sequence, session, opcode, size, _, _, _, offset = HEADER.unpack_from(payload)
        if opcode in (ACK, NAK):
            return
        if size > DATA_BYTES:
            self._nak(channel, sender, sequence, session, opcode, INVALID_DATA_SIZE)
            return
        data = payload[HEADER.size : HEADER.size + size]
        if opcode in (TERMINATE, RESET):
            found = self._sessions.get(channel)
            if found is not None and (opcode == RESET or found.number == session):
                del self._sessions[channel]
            self._reply(channel, sender, sequence, session, ACK, opcode, offset, b"")
        elif opcode in self._operations:
            self._operations[opcode](channel, sender, sequence, session, offset, size, data)
        else:
            self._nak(channel, sender, sequence, session, opcode, UNKNOWN_COMMAND)

    def _reply(
        self, channel: Channel, sender: Sender, sequence: int, session: int, opcode: int, request: int,
        offset: int, data: bytes, complete: int = 0,
    ) -> None:  # fmt: skip
        head = HEADER.pack((sequence + 1) & 0xFFFF, session, opcode, len(data), request, complete, 0, offset)
        body = (head + data).ljust(251, b"\0")
        fields = {"target_system": sender[0], "target_component": sender[1], "payload": tuple(body)}
        channel.send(KIND, KIND.payload(**fields))

    def _nak(self, channel: Channel, sender: Sender, sequence: int, session: int, request: int, error: int) -> None:
        self._reply(channel, sender, sequence, session, NAK, request, 0, bytes((error,)))

    def _open(
        self,
        channel: Channel,
        sender: Sender,
        sequence: int,
        session: int,
        offset: int,
        size: int,
        data: bytes,
    ) -> None:
        path, _, query = data.split(b"\0", 1)[0].decode("ascii", "replace").partition("?")
        if path.lstrip("/") != PARAMETERS:
            self._nak(channel, sender, sequence, session, OPEN_READ, FILE_NOT_FOUND)
            return
        value, table = self.bridge.get(ParameterService).value, self.bridge.vehicle.firmware.table
        packed = pack_parameters(
            [(p, value(p.name)) for p in table], with_defaults="withdefaults=1" in query.split("&")
        )
        self._sessions[channel] = _Session(packed, sender, session)
        self._reply(channel, sender, sequence, session, ACK, OPEN_READ, 0, struct.pack("<I", len(packed)))

    def _open_session(
        self, channel: Channel, sender: Sender, sequence: int, session: int, opcode: int
    ) -> _Session | None:
        found = self._sessions.get(channel)
        if found is None or session != found.number or found.sender != sender:
            self._nak(channel, sender, sequence, session, opcode, INVALID_SESSION)
            return None
        return found

    def _read(
        self,
        channel: Channel,
        sender: Sender,
        sequence: int,
        session: int,
        offset: int,
        size: int,
        data: bytes,
    ) -> None:
        found = self._open_session(channel, sender, sequence, session, READ)
        if found is None:
            return
        piece = found.data[offset : offset + (size or DATA_BYTES)]
        if piece:
            self._reply(channel, sender, sequence, session, ACK, READ, offset, piece)
        else:
            self._nak(channel, sender, sequence, session, READ, END_OF_FILE)

    def _burst(
        self,
        channel: Channel,
        sender: Sender,
        sequence: int,
        session: int,
        offset: int,
        size: int,
        data: bytes,
    ) -> None:
        found = self._open_session(channel, sender, sequence, session, BURST_READ)
        if found is None:
            return
        if offset >= len(found.data):
            self._nak(channel, sender, sequence, session, BURST_READ, END_OF_FILE)
            return
        found.burst = _Burst(offset, size or DATA_BYTES, sequence)
        self.due_us = min(self.due_us, self.bridge.now_us)

    def snapshot(self) -> Any:
        sessions = tuple(
            (c.number, (s.data, s.sender, s.number), s.burst and (s.burst.offset, s.burst.size, s.burst.sequence))
            for c, s in self._sessions.items()
        )
        return (sessions, self.due_us)

    def restore(self, state: Any) -> None:
        sessions, self.due_us = state
        self._sessions = {}
        for number, session, burst in sessions:
            for channel in self.bridge.channels:
                if channel.number == number:
                    found = self._sessions[channel] = _Session(*session)
                    found.burst = burst and _Burst(*burst)

    def service(self, now_us: int) -> None:
        running = False
        for channel, session in self._sessions.items():
            burst = session.burst
            if burst is None or channel.peer.congested:
                running = running or burst is not None
                continue
            for _ in range(BURST_AT_ONCE):
                piece = session.data[burst.offset : burst.offset + burst.size]
                last = burst.offset + len(piece) >= len(session.data)
                self._reply(
                    channel,
                    session.sender,
                    burst.sequence,
                    session.number,
                    ACK,
                    BURST_READ,
                    burst.offset,
                    piece,
                    int(last),
                )
                burst.offset += len(piece)
                burst.sequence = (burst.sequence + 1) & 0xFFFF
                if last:
                    session.burst = None
                    break
            running = running or session.burst is not None
        self.due_us = now_us + BURST_EVERY_US if running else NEVER
