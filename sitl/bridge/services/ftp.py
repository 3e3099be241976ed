# SPDX-License-Identifier: BSD-3-Clause
"""MAVLink FTP (https://mavlink.io/en/services/ftp.html): lists and reads the files of ``served_files.py``, gives
their CRC-32, takes missions as files, and keeps files and folders of clients (``client_files.py``).

Everything else is refused by its own error.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any, NamedTuple

from ...core.constants import NEVER
from ..channel import Channel
from ..dialect import message
from ..host import Host
from ..listener import Sender
from ..metadata import file_crc
from . import served_files
from .client_files import ClientFiles
from .service import Handler, Service

KIND = message("FILE_TRANSFER_PROTOCOL")
HEADER = struct.Struct("<HBBBBBBI")
"""sequence, session, opcode, size, request opcode, burst complete, padding, offset"""
DATA_BYTES = 239
NONE, TERMINATE, RESET, LIST, OPEN_READ, READ, CREATE, WRITE, REMOVE, MAKE_FOLDER, REMOVE_FOLDER = range(11)
OPEN_WRITE, RENAME, CRC, BURST_READ = 11, 13, 14, 15
ACK, NAK = 128, 129
FAIL, INVALID_DATA_SIZE, INVALID_SESSION, END_OF_FILE, UNKNOWN_COMMAND, FILE_NOT_FOUND = 1, 3, 4, 6, 7, 10
MOST_WRITTEN = 1 << 20
"""Bytes of a file that is written."""
COPY_US, COPIES = 1_000_000, 16
"""A copy of a request comes at most so late, and behind at most so many others."""
_OF_SESSIONS = (TERMINATE, RESET, OPEN_READ, CREATE, REMOVE, MAKE_FOLDER, REMOVE_FOLDER, OPEN_WRITE, RENAME)
BURST_EVERY_US = 10_000
BURST_AT_ONCE = 10
"""Packets every 10 ms of simulated time."""


class _Request(NamedTuple):
    """What a client asks, and where the answer goes."""

    channel: Channel
    sender: Sender
    sequence: int
    session: int
    opcode: int
    offset: int = 0
    size: int = 0
    data: bytes = b""


class _Answered(NamedTuple):
    """The last request of a client that was carried out, and when."""

    request: _Request
    reply: bytes
    time_us: int


class _Session:
    """The one file that a client has open."""

    def __init__(self, data: bytes | served_files.Log, sender: Sender, number: int, written: str = "") -> None:
        self.data, self.sender, self.number = data, sender, number
        self.written = written
        """Path of a file that is being written; "": it is read."""
        self.burst: _Request | None = None
        """The next packet of the burst under way."""


class FtpService(Service):
    """MAVLink FTP: one session for each channel, under the number that the client gives it, as in ArduPilot."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._sessions: dict[Channel, _Session] = {}
        self._answered: dict[Channel, _Answered] = {}
        self._clients = ClientFiles()
        self._summed: tuple[Any, int] = (None, 0)
        """The file whose checksum was worked out last, and that."""
        self._operations: dict[int, Callable[[_Request], None]] = {
            NONE: lambda request: self._reply(request, b""),
            LIST: self._list,
            REMOVE: lambda request: self._change(request, self._clients.remove),
            MAKE_FOLDER: lambda request: self._change(request, self._clients.make_folder),
            REMOVE_FOLDER: lambda request: self._change(request, self._clients.remove_folder),
            RENAME: self._rename,
            CRC: self._crc,
            OPEN_READ: self._open,
            CREATE: self._create,
            OPEN_WRITE: self._open_to_write,
            WRITE: self._write,
            READ: self._read,
            BURST_READ: self._burst,
            TERMINATE: self._end,
            RESET: self._end,
        }

    def handlers(self) -> dict[str, Handler]:
        return {"FILE_TRANSFER_PROTOCOL": self._take}

    def channel_removed(self, channel: Channel) -> None:
        self._sessions.pop(channel, None)
        self._answered.pop(channel, None)

    def _take(self, channel: Channel, m: Any, sender: Sender) -> None:
        payload = bytes(m.payload)
        sequence, session, opcode, size, _, _, _, offset = HEADER.unpack_from(payload)
        data = payload[HEADER.size : HEADER.size + size]
        request = _Request(channel, sender, sequence, session, opcode, offset, size, data)
        if opcode in (ACK, NAK):
            return
        if self._is_copy(request):
            return
        if size > DATA_BYTES:
            self._refuse(request, INVALID_DATA_SIZE)
        elif opcode in self._operations:
            self._operations[opcode](request)
        else:
            self._refuse(request, UNKNOWN_COMMAND)

    def _is_copy(self, request: _Request) -> bool:
        """Whether a request has been carried out already, and must not be again.

        The answer to the last one is sent again, since it may have been lost. One that opens or closes a file and comes
        after later ones is a copy that a bad link brings late.
        """
        last = self._answered.get(request.channel)
        if last is None or request.sender != last.request.sender or self.bridge.now_us - last.time_us > COPY_US:
            return False
        if request == last.request and request.opcode != BURST_READ:
            request.channel.send(KIND, last.reply)
            return True
        behind = (last.request.sequence - request.sequence) & 0xFFFF
        return request.opcode in _OF_SESSIONS and 0 < behind <= COPIES

    def _reply(self, to: _Request, data: bytes, offset: int = 0, result: int = ACK, complete: bool = False) -> None:
        sequence = (to.sequence + 1) & 0xFFFF
        head = HEADER.pack(sequence, to.session, result, len(data), to.opcode, complete, 0, offset)
        body = (head + data).ljust(251, b"\0")
        fields = {"target_system": to.sender[0], "target_component": to.sender[1], "payload": tuple(body)}
        payload = KIND.payload(**fields)
        to.channel.send(KIND, payload)
        if to.opcode != BURST_READ or result == NAK:
            self._answered[to.channel] = _Answered(to, payload, self.bridge.now_us)

    def _refuse(self, request: _Request, error: int) -> None:
        self._reply(request, bytes((error,)), result=NAK)

    def _end(self, request: _Request) -> None:
        """TERMINATE, RESET."""
        found = self._sessions.get(request.channel)
        if found is not None and (request.opcode == RESET or found.number == request.session):
            del self._sessions[request.channel]
            if found.written in served_files.MISSIONS and request.opcode == TERMINATE:
                if not served_files.write(self.bridge, found.written, found.data[:]):
                    self._refuse(request, FAIL)
                    return
        self._reply(request, b"", request.offset)

    def _open(self, request: _Request) -> None:
        data = self._file(request)
        if data is not None:
            self._sessions[request.channel] = _Session(data, request.sender, request.session)
            self._reply(request, struct.pack("<I", len(data)))

    def _create(self, request: _Request) -> None:
        path = self._path(request)
        error = 0 if path in served_files.MISSIONS else self._clients.create(path)
        self._begin_to_write(request, path, b"", error if request.data else INVALID_DATA_SIZE)

    def _open_to_write(self, request: _Request) -> None:
        path = self._path(request)
        data = self._clients.read(path)
        self._begin_to_write(request, path, data or b"", FILE_NOT_FOUND if data is None else 0)

    def _begin_to_write(self, request: _Request, path: str, data: bytes, error: int) -> None:
        if error:
            self._refuse(request, error)
            return
        self._sessions[request.channel] = _Session(data, request.sender, request.session, path)
        self._reply(request, b"")

    def _change(self, request: _Request, change: Callable[[str], int]) -> None:
        """Make or remove what one path names."""
        error = change(self._path(request)) if request.data else INVALID_DATA_SIZE
        if error:
            self._refuse(request, error)
        else:
            self._reply(request, b"")

    def _rename(self, request: _Request) -> None:
        """Two paths with a zero between them."""
        old, between, _ = request.data.partition(b"\0")
        new = request._replace(data=request.data[len(old) + 1 :])
        if not (old and between and self._path(new)):
            self._refuse(request, INVALID_DATA_SIZE)
        else:
            self._change(request, lambda path: self._clients.rename(path, self._path(new)))

    def _write(self, request: _Request) -> None:
        found = self._session(request)
        if found is None:
            return
        end = request.offset + len(request.data)
        if not found.written or end > MOST_WRITTEN:
            self._refuse(request, FAIL)
            return
        data = bytes(found.data[: request.offset]).ljust(request.offset, b"\0") + request.data + found.data[end:]
        error = 0 if found.written in served_files.MISSIONS else self._clients.write(found.written, data)
        if error:
            self._refuse(request, error)
            return
        found.data = data
        self._reply(request, struct.pack("<I", len(request.data)), request.offset)

    def _crc(self, request: _Request) -> None:
        data = self._file(request)
        if data is None:
            return
        key = data.key if isinstance(data, served_files.Log) else data
        if self._summed[0] is not key and self._summed[0] != key:
            self._summed = (key, data.crc() if isinstance(data, served_files.Log) else file_crc(data))
        self._reply(request, struct.pack("<I", self._summed[1]))

    def _path(self, request: _Request) -> str:
        """Without slashes before and behind it."""
        return request.data.split(b"\0", 1)[0].decode("ascii", "replace").strip("/")

    def _file(self, request: _Request) -> bytes | served_files.Log | None:
        """What is in the file that is asked for; None when there is none; the client gets the error."""
        path, _, query = self._path(request).partition("?")
        data = served_files.read(self.bridge, self._clients, path, query.split("&"))
        if data is None:
            self._refuse(request, FILE_NOT_FOUND)
        return data

    def _list(self, request: _Request) -> None:
        """Entries of a folder from number ``offset`` on, as many as go into a packet."""
        if not request.data:
            self._refuse(request, INVALID_DATA_SIZE)
            return
        entries = served_files.listing(self.bridge, self._clients, self._path(request))
        if entries is None:
            self._refuse(request, FILE_NOT_FOUND)
            return
        listing = b""
        for entry in entries[request.offset :]:
            more = entry.encode("ascii", "replace") + b"\0"
            if len(listing) + len(more) > DATA_BYTES:
                break
            listing += more
        if listing:
            self._reply(request, listing, request.offset)
        else:
            self._refuse(request, END_OF_FILE)

    def _session(self, request: _Request) -> _Session | None:
        """The client's open session; None when it has another one or none; it gets the error."""
        found = self._sessions.get(request.channel)
        if found is None or request.session != found.number or found.sender != request.sender:
            self._refuse(request, INVALID_SESSION)
            return None
        return found

    def _read(self, request: _Request) -> None:
        found = self._session(request)
        if found is None:
            return
        piece = found.data[request.offset : request.offset + (request.size or DATA_BYTES)]
        if piece:
            self._reply(request, piece, request.offset)
        else:
            self._refuse(request, END_OF_FILE)

    def _burst(self, request: _Request) -> None:
        found = self._session(request)
        if found is None:
            return
        if request.offset >= len(found.data):
            self._refuse(request, END_OF_FILE)
            return
        found.burst = request._replace(size=request.size or DATA_BYTES, data=b"")
        self.due_us = min(self.due_us, self.bridge.now_us)

    def snapshot(self) -> Any:
        sessions = tuple(
            (channel.number, (s.data, s.sender, s.number, s.written), s.burst and s.burst[1:])
            for channel, s in self._sessions.items()
        )
        answered = tuple((c.number, a.request[1:], a.reply, a.time_us) for c, a in self._answered.items())
        return (sessions, answered, self.due_us, self._clients.state())

    def restore(self, state: Any) -> None:
        sessions, answered, self.due_us, made = state
        self._clients.restore(made)
        channels = {channel.number: channel for channel in self.bridge.channels} if answered else {}
        self._answered = {
            channels[number]: _Answered(_Request(channels[number], *request), reply, time_us)
            for number, request, reply, time_us in answered
            if number in channels
        }
        self._sessions = {}
        for number, session, burst in sessions:
            for channel in self.bridge.channels:
                if channel.number == number:
                    found = self._sessions[channel] = _Session(*session)
                    found.burst = burst and _Request(channel, *burst)

    def service(self, now_us: int) -> None:
        for channel, session in self._sessions.items():
            for _ in range(0 if channel.congested else BURST_AT_ONCE):
                if session.burst is not None:
                    session.burst = self._send_next(session, session.burst)
        running = any(session.burst is not None for session in self._sessions.values())
        self.due_us = now_us + BURST_EVERY_US if running else NEVER

    def _send_next(self, session: _Session, burst: _Request) -> _Request | None:
        """Send a packet of a burst; gives the next one, None after the last."""
        piece = session.data[burst.offset : burst.offset + burst.size]
        end = burst.offset + len(piece)
        is_last = end >= len(session.data) or not piece  # a log that was erased meanwhile
        self._reply(burst, piece, burst.offset, complete=is_last)
        return None if is_last else burst._replace(offset=end, sequence=(burst.sequence + 1) & 0xFFFF)
