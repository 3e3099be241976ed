# SPDX-License-Identifier: BSD-3-Clause
"""NumPy's files of arrays (.npy, .npz) that anybody may have written: numbers alone, no larger than is allowed.

A header says how large an array is, and NumPy believes it: it asks for the memory before it looks for the data. Here
nothing is allocated that the file does not hold, and of what a .npz unpacks to, no more than is allowed.
https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html
"""

from __future__ import annotations

import ast
import contextlib
import io
import math
import re
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ..errors import SitlError

KINDS = "biuf"
"""Numbers and truth values: ``numpy.dtype.kind`` of what is read."""
RECORDS = "V"
"""The kind of records, whose fields are of any type but objects."""
MOST_AXES = 8
"""Of an array."""
MOST_ARRAYS = 1024
"""Of a .npz."""
MIB = 1 << 20
_MAGIC = b"\x93NUMPY"
_MOST_HEADER = 10_000
"""As NumPy's own limit; headers of arrays of numbers have 118 bytes [bytes]."""
_DTYPE = re.compile(r"[<>|=]?([a-zA-Z])[0-9]{1,5}")
_KEYS = {"descr", "fortran_order", "shape"}
_ENDING = ".npy"


class ArrayFileError(SitlError, ValueError):
    """A file of arrays that cannot be read; the message says what is wrong with it, and not which file it is."""


def read_file(path: Path, most: int) -> bytes:
    """All bytes of a file that is no longer than allowed.

    Args:
        path: of the file.
        most: length that is allowed [bytes].

    Raises:
        OSError: it cannot be read.
        ArrayFileError: it is longer.
    """
    with path.open("rb") as file:
        content = file.read(most + 1)
    if len(content) > most:
        raise ArrayFileError(f"it is longer than {most:,} bytes")
    return content


def read_npy(content: bytes, most: int, kinds: str = KINDS) -> npt.NDArray[Any]:
    """The array of a .npy file.

    Args:
        content: of the file.
        most: memory that the array may take [bytes].
        kinds: of numbers that are taken (``numpy.dtype.kind``).

    Raises:
        ArrayFileError: it is none, is cut, or holds something else.
    """
    dtype, in_columns, shape, at = _header(content, kinds)
    size = math.prod(shape) * dtype.itemsize
    if size > most:
        raise ArrayFileError(f"an array of shape {shape}, {dtype}, of {size:,} bytes; {most:,} are allowed")
    if size > len(content) - at:
        raise ArrayFileError(f"an array of shape {shape}, {dtype}: {size:,} bytes, and {len(content) - at:,} are there")
    try:
        flat = np.frombuffer(content, dtype, math.prod(shape), at)
        return flat.reshape(shape, order="F" if in_columns else "C").copy(order="K")
    except ValueError as error:  # no numbers at all in a shape that no array can have
        raise ArrayFileError(f"an array of shape {shape}, {dtype}: {error}") from None


def read_npz(content: bytes, most: int, kinds: str = KINDS) -> dict[str, npt.NDArray[Any]]:
    """The arrays of a .npz file, by name; see ``each_array``."""
    return dict(each_array(content, most, kinds))


def each_array(content: bytes, most: int, kinds: str = KINDS) -> Iterator[tuple[str, npt.NDArray[Any]]]:
    """The arrays of a .npz file with their names, one after the other: no two need be in memory.

    Args:
        content: of the file.
        most: memory that all of them may take [bytes].
        kinds: of numbers that are taken (``numpy.dtype.kind``).

    Raises:
        ArrayFileError: it is none, is damaged, or holds something else.
    """
    left = most
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            members = archive.infolist()
            if len(members) > MOST_ARRAYS:
                raise ArrayFileError(f"{len(members):,} arrays; {MOST_ARRAYS:,} are allowed")
            for member in members:
                name = member.filename.removesuffix(_ENDING)
                unpacked = unpack(archive, member, left + _MOST_HEADER)
                try:
                    array = read_npy(unpacked, left, kinds)
                except ArrayFileError as error:
                    raise ArrayFileError(f"{name}: {error}") from None
                del unpacked
                left -= array.nbytes
                yield name, array
    except ArrayFileError:
        raise
    except Exception as error:  # zipfile and what unpacks raise many kinds when a file is damaged
        raise ArrayFileError(str(error) or type(error).__name__) from None


def unpack(archive: zipfile.ZipFile, member: zipfile.ZipInfo | str, most: int) -> bytes:
    """What a member of a .zip unpacks to.

    Args:
        archive: the .zip.
        member: of it.
        most: length that is allowed, whatever the member says of itself [bytes].

    Raises:
        KeyError: there is no such member.
        ArrayFileError: it is longer.
    """
    with archive.open(member) as file:
        content = file.read(most + 1)
    if len(content) > most:
        name = member if isinstance(member, str) else member.filename
        raise ArrayFileError(f"{name} unpacks to more than {most:,} bytes, which are allowed")
    return content


def _header(content: bytes, kinds: str) -> tuple[np.dtype[Any], bool, tuple[int, ...], int]:
    """Type, whether columns come first, shape, and where the numbers begin."""
    if content[: len(_MAGIC)] != _MAGIC or len(content) < 10:
        raise ArrayFileError("it is no array of NumPy")
    size = {1: 2, 2: 4, 3: 4}.get(content[6])
    if size is None:
        raise ArrayFileError(f"an array of format {content[6]}; it must be 1, 2 or 3")
    length = int.from_bytes(content[8 : 8 + size], "little")
    at = 8 + size + length
    if length > _MOST_HEADER or at > len(content):
        raise ArrayFileError(f"the header of an array, of {length:,} bytes, is cut or too long")
    try:
        said = ast.literal_eval(content[8 + size : at].decode("latin1").strip())
    except (ValueError, SyntaxError, TypeError, MemoryError, RecursionError):
        said = None
    if not isinstance(said, dict) or said.keys() != _KEYS:
        raise ArrayFileError("the header of an array is damaged")
    return _dtype(said["descr"], kinds), said["fortran_order"] is True, _shape(said["shape"]), at


def _dtype(said: Any, kinds: str) -> np.dtype[Any]:
    is_record = isinstance(said, list) and RECORDS in kinds
    known = _DTYPE.fullmatch(said) if isinstance(said, str) else None
    if is_record or (known is not None and known[1] in kinds):
        with contextlib.suppress(TypeError, ValueError, RecursionError, OverflowError):
            dtype = np.lib.format.descr_to_dtype(said)
            if not dtype.hasobject and dtype.kind in kinds:
                return dtype
    raise ArrayFileError(f"an array of {str(said)[:60]!r}; it must be of {_words(kinds)}")


def _shape(said: Any) -> tuple[int, ...]:
    if (
        not isinstance(said, tuple)
        or len(said) > MOST_AXES
        or not all(type(n) is int and 0 <= n < 1 << 48 for n in said)
    ):
        raise ArrayFileError(f"an array of shape {str(said)[:60]}; it must be up to {MOST_AXES} whole numbers")
    return said


def _words(kinds: str) -> str:
    words = {"b": "truth values", "i": "whole numbers", "u": "whole numbers", "f": "real numbers",
             "S": "bytes", "U": "texts", RECORDS: "records"}  # fmt: skip
    return " or ".join(dict.fromkeys(words[kind] for kind in kinds))
