# SPDX-License-Identifier: BSD-3-Clause
"""A recording as a file: a mark, then blocks, each with its kind, its length and a checksum.

```
mark     12 bytes: 0x89 "SITLREC" CR LF 0x1A, version (1 byte)
block    kind (1 byte), packing (1 byte: 0 none, 1 zlib, 2 LZMA), length (u32), checksum (u32), packed bytes
```

Numbers are little-endian. The checksum is the CRC-32 of kind, packing, length and packed bytes, continued from the
checksum of the block before: a block that is damaged, missing or out of its place is found where it stands. The last
block is of kind END; a file without one belongs to a run that was killed, or has been cut short.
"""

from __future__ import annotations

import contextlib
import lzma
import struct
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO, NamedTuple

from .entries import RecordingError

MARK = b"\x89SITLREC\r\n\x1a"
VERSION = 1
HEADER, ENTRIES, SECTION, END = b"HESZ"
"""Kinds of blocks: the run (JSON), entries, a named section, how it ended (JSON)."""
PLAIN, ZLIB, LZMA = range(3)
_HEAD = struct.Struct("<BBII")
_BARE = struct.Struct("<BBI")
MOST_BYTES = 1 << 30
"""Of a file."""
LONGEST = 1 << 26
"""Bytes of a block, unpacked: what is longer is no recording of ours."""
SPARE, RATIO = 1 << 24, 100
"""All blocks together have at most so many bytes, unpacked, and so many times the file's."""
_MEMORY = 1 << 26
"""Bytes that unpacking LZMA may take: ours has dictionaries of 4 MiB."""


class Block(NamedTuple):
    """One block, unpacked."""

    kind: int
    data: bytes
    at: int
    """Offset in the file [bytes]."""


def _checksum(kind: int, packing: int, packed: bytes, before: int) -> int:
    return zlib.crc32(packed, zlib.crc32(_BARE.pack(kind, packing, len(packed)), before))


def pack(kind: int, data: bytes, before: int, packing: int = ZLIB) -> tuple[bytes, int]:
    """(Bytes of a block, its checksum); ``before`` is the checksum of the block before."""
    packed = data
    if packing == LZMA:
        dictionary = 1 << min(max(len(data).bit_length(), 12), 22)  # a small one is ready ten times as fast
        packed = lzma.compress(data, lzma.FORMAT_ALONE, filters=[{"id": lzma.FILTER_LZMA1, "dict_size": dictionary}])
    elif packing == ZLIB:
        packed = zlib.compress(data, 6)
    if len(packed) >= len(data):
        packing, packed = PLAIN, data
    checksum = _checksum(kind, packing, packed, before)
    return _HEAD.pack(kind, packing, len(packed), checksum) + packed, checksum


class BlockWriter:
    """Writes a file block by block; each is with the operating system before the call returns.

    Raises:
        RecordingError: the file cannot be written.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._checksum = 0
        with self._named():
            path.parent.mkdir(parents=True, exist_ok=True)
            self._file: BinaryIO = path.open("wb", buffering=0)
            self._file.write(MARK + bytes([VERSION]))

    @contextlib.contextmanager
    def _named(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            raise RecordingError(f"recording {str(self.path)!r} cannot be written: {error.strerror or error}") from None

    def write(self, kind: int, data: bytes, packing: int = ZLIB) -> None:
        """Append one block, whole or not at all."""
        raw, checksum = pack(kind, data, self._checksum, packing)
        with self._named():
            begin = self._file.tell()
            try:
                left = memoryview(raw)
                while left:  # a disk that is nearly full takes a part
                    left = left[self._file.write(left) :]
            except OSError:
                with contextlib.suppress(OSError):
                    self._file.truncate(begin)
                    self._file.seek(begin)
                raise
        self._checksum = checksum

    def close(self) -> None:
        """Close the file."""
        with self._named():
            self._file.close()


def is_recording(path: Path) -> bool:
    """Whether the file begins as a recording does."""
    try:
        with path.open("rb") as file:
            return file.read(len(MARK)) == MARK
    except OSError:
        return False


class BlockReader:
    """Reads blocks up to the end of a file, or to where it is damaged; ``fault`` then says what is wrong, and where.

    Raises:
        RecordingError: the file cannot be read, is no recording, or is of a newer version.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.fault = ""
        self.is_cut = False
        """The fault is that the file ends too early."""
        try:
            with path.open("rb") as file:
                self._data = file.read(MOST_BYTES + 1)
        except OSError as error:
            raise RecordingError(f"recording {str(path)!r} cannot be read: {error.strerror or error}") from None
        start = self._data[: len(MARK) + 1]
        if len(self._data) > MOST_BYTES:
            raise RecordingError(f"recording {str(path)!r} has more than {MOST_BYTES} bytes")
        if not self._data:
            raise RecordingError(f"recording {str(path)!r} is empty")
        if start[: len(MARK)] != MARK:
            raise RecordingError(f"{str(path)!r} is no recording of a run: it begins with {start[:8]!r}")
        if len(start) <= len(MARK):
            raise RecordingError(f"recording {str(path)!r} is cut short: it ends behind its mark")
        if start[-1] != VERSION:
            raise RecordingError(
                f"recording {str(path)!r} is of format {start[-1]}; this program reads format {VERSION}"
            )

    @property
    def size(self) -> int:
        """Bytes of the file."""
        return len(self._data)

    def __iter__(self) -> Iterator[Block]:
        data, at, before = self._data, len(MARK) + 1, 0
        number, left_over = 0, SPARE + RATIO * len(data)
        while True:
            if at + _HEAD.size > len(data):
                left = len(data) - at
                self._cut(f"ends at byte {len(data)} " + ("without its end mark" if not left else "in a block's head"))
                return
            kind, packing, length, checksum = _HEAD.unpack_from(data, at)
            packed = data[at + _HEAD.size : at + _HEAD.size + length]
            where = f"block {number} at byte {at} of {len(data)}"
            if kind not in b"HESZ" or packing > LZMA or length > LONGEST:
                self.fault = f"is corrupted: {where} does not begin as a block does"
                return
            if len(packed) < length:
                self._cut(f"ends at byte {len(data)} in the middle of {where}, which has {length} bytes")
                return
            if _checksum(kind, packing, packed, before) != checksum:
                self.fault = f"is corrupted: {where} does not match its checksum"
                return
            try:
                unpacked = _unpack(packing, packed, min(LONGEST, left_over))
            except (zlib.error, lzma.LZMAError, EOFError) as error:
                self.fault = f"is corrupted: {where} cannot be unpacked: {error}"
                return
            left_over -= len(unpacked)
            yield Block(kind, unpacked, at)
            at, before, number = at + _HEAD.size + length, checksum, number + 1
            if kind == END:
                if at < len(data):
                    self.fault = f"is corrupted: {len(data) - at} bytes follow its end at byte {at}"
                return

    def _cut(self, fault: str) -> None:
        self.fault, self.is_cut = fault, True


def _unpack(packing: int, packed: bytes, most: int) -> bytes:
    if packing == PLAIN:
        return packed
    if packing == ZLIB:
        plain = zlib.decompressobj()
        data = plain.decompress(packed, most + 1)
        if not plain.eof and len(data) <= most:
            raise zlib.error("it is incomplete")
    else:
        data = lzma.LZMADecompressor(lzma.FORMAT_ALONE, memlimit=_MEMORY).decompress(packed, most + 1)
    if len(data) > most:
        raise zlib.error(f"it has more than {most} bytes, and no recording of this size does")
    return data
