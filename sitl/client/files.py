# SPDX-License-Identifier: BSD-3-Clause
"""Files by MAVLink FTP and on-board logs, also over links that lose, delay and double frames.

Sources: https://mavlink.io/en/services/ftp.html, https://mavlink.io/en/messages/common.html#LOG_REQUEST_DATA.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from ..bridge.services.ftp import (
    ACK,
    DATA_BYTES,
    END_OF_FILE,
    HEADER,
    LIST,
    NAK,
    OPEN_READ,
    READ,
    TERMINATE,
)
from ..bridge.services.log_download import PIECE
from .errors import FileRefusedError, WaitTimeoutError
from .missions import Missions
from .session import LIMIT_S, SILENCE_S

__tracebackhide__ = True

AT_ONCE = 40
"""As many pieces of a file are asked for together."""
GAPS = 120
"""As many gaps of a log are; the vehicle keeps 128 requests waiting."""


class Log(NamedTuple):
    """An on-board log."""

    number: int
    time_utc: int
    """When it began [s, Unix]."""
    size: int
    """[bytes]"""


class Files(Missions):
    """A vehicle with files and logs."""

    _ftp_sequence = 0

    # ------------------------------------------------------------------ MAVLink FTP

    def read_file(self, path: str) -> bytes:
        """Content of a file of the vehicle ("@PARAM/param.pck").

        Raises:
            FileRefusedError: the vehicle does not give it.
            WaitTimeoutError: no answer.
        """
        size = int.from_bytes(self._ask_ftp(OPEN_READ, path.encode(), what=f"file {path}"), "little")
        found: dict[int, bytes] = {}
        asked: dict[int, int] = {}
        """Number of an answer -> offset that was asked for: another client may read another file."""

        def ask(missing: list[int] | None) -> int:
            for at in (missing or ())[:AT_ONCE]:
                asked[self._send_ftp(READ, b"", at, DATA_BYTES) + 1 & 0xFFFF] = at
            return min(len(missing or ()), AT_ONCE)

        def take(m: Any) -> None:
            head, data = _unpack(m)
            if head[2] == ACK and head[4] == READ and asked.get(head[0]) == head[7]:
                found[head[7]] = data

        offsets = range(0, size, DATA_BYTES)
        missing = lambda: [at for at in offsets if at not in found]  # noqa: E731
        self.collect("FILE_TRANSFER_PROTOCOL", missing, ask, take, f"file {path}")
        self._ask_ftp(TERMINATE, b"", what=f"file {path}")
        return b"".join(found[at] for at in offsets)

    def list_folder(self, path: str) -> list[str]:
        """Names in a folder of the vehicle; those of folders end with "/".

        Raises:
            FileRefusedError, WaitTimeoutError: as for ``read_file``.
        """
        names: list[str] = []
        while True:
            try:
                data = self._ask_ftp(LIST, path.encode(), len(names), what=f"folder {path}")
            except FileRefusedError as error:
                if error.number == END_OF_FILE:
                    return [name[1:].split("\t")[0] + ("/" if name[0] == "D" else "") for name in names]
                raise
            names += data.decode("ascii", "replace").rstrip("\0").split("\0")

    def _send_ftp(self, opcode: int, data: bytes, offset: int, size: int) -> int:
        """Send a request; gives its number."""
        self._ftp_sequence = (self._ftp_sequence + 2) & 0xFFFF  # the answer's is one more
        head = HEADER.pack(self._ftp_sequence, 0, opcode, size, 0, 0, 0, offset)
        self.send("FILE_TRANSFER_PROTOCOL", payload=tuple((head + data).ljust(251, b"\0")))
        return self._ftp_sequence

    def _ask_ftp(self, opcode: int, data: bytes, offset: int = 0, *, what: str) -> bytes:
        """Send a request again and again until it is answered; gives the answer's data."""
        begin = self.now
        with self.messages("FILE_TRANSFER_PROTOCOL") as seen:
            number = self._send_ftp(opcode, data, offset, len(data)) + 1 & 0xFFFF
            while True:
                self.passes(lambda: any(_unpack(m)[0][0] == number for m in seen), SILENCE_S)
                for m in seen:
                    head, answer = _unpack(m)
                    if head[0] == number and head[2] == ACK:
                        return answer
                    if head[0] == number and head[2] == NAK:
                        self.raise_error(FileRefusedError(what, answer[0] if answer else 0, begin))
                if self.now - begin >= LIMIT_S:
                    self.raise_error(WaitTimeoutError(what, LIMIT_S, "", begin))
                self._ftp_sequence = (number - 3) & 0xFFFF  # under the same number: it is carried out once
                self._send_ftp(opcode, data, offset, len(data))

    # ------------------------------------------------------------------ logs

    def logs(self) -> list[Log]:
        """On-board logs of the vehicle.

        Raises:
            WaitTimeoutError: no answer.
        """
        found: dict[int, Log] = {}
        count: list[int] = []

        def missing() -> list[int] | None:
            return list(range(count[0] - len(found))) if count else None

        def ask(_: list[int] | None) -> int:
            self.send("LOG_REQUEST_LIST", start=0, end=0xFFFF)
            return count[0] if count else 0xFFFF

        def take(m: Any) -> None:
            count[:] = [m.num_logs]
            if m.num_logs:
                found[m.id] = Log(m.id, m.time_utc, m.size)

        self.collect("LOG_ENTRY", missing, ask, take, "the list of logs")
        return [log for _, log in sorted(found.items())]

    def download_log(self, log: Log | int) -> bytes:
        """Content of an on-board log, up to its size when it was listed.

        Raises:
            FileRefusedError: there is no such log.
            WaitTimeoutError: nothing of what was missing came for ``LIMIT_S``.
        """
        number = log if isinstance(log, int) else log.number
        listed = next((one for one in self.logs() if one.number == number), None)
        if listed is None:
            self.raise_error(FileRefusedError(f"log {number}", 0, self.now))
        size = min(listed.size, log.size) if isinstance(log, Log) else listed.size
        found: dict[int, bytes] = {}

        def ask(missing: list[int] | None) -> int:
            runs: list[list[int]] = []
            for at in missing or ():
                if runs and at == runs[-1][1]:
                    runs[-1][1] += PIECE
                else:
                    runs.append([at, at + PIECE])
            for begin, end in runs[:GAPS]:
                self.send("LOG_REQUEST_DATA", id=number, ofs=begin, count=end - begin)
            return sum((end - begin) // PIECE for begin, end in runs[:GAPS])

        def take(m: Any) -> None:
            if m.id == number and m.count:
                found[m.ofs] = bytes(m.data[: m.count])

        offsets = range(0, size, PIECE)
        self.collect("LOG_DATA", lambda: [at for at in offsets if at not in found], ask, take, f"log {number}")
        self.send("LOG_REQUEST_END")
        return b"".join(found[at] for at in offsets)[:size]


def _unpack(m: Any) -> tuple[tuple[int, ...], bytes]:
    """Header and data of a FILE_TRANSFER_PROTOCOL."""
    raw = bytes(m.payload)
    head: tuple[int, ...] = HEADER.unpack_from(raw)
    return head, raw[HEADER.size : HEADER.size + head[3]]
