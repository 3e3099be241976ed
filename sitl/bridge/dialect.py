# SPDX-License-Identifier: BSD-3-Clause
"""The messages of the ``ardupilotmega`` dialect as data.

Layout, checksum seed, and how to pack and unpack them.

Everything is taken from pymavlink's generated dialect. Fields are handled in *wire order* (by size,
extensions last, https://mavlink.io/en/guide/serialization.html#field_reordering), because that is what
``struct`` can do in one call.
"""

from __future__ import annotations

import struct
from collections import namedtuple
from collections.abc import Callable
from functools import cache, partial
from typing import Any, cast

from fastcrc import crc16
from pymavlink.dialects.v20 import ardupilotmega

from .newer_messages import NEWER

crc_mcrf4xx = cast("Callable[..., int]", crc16.mcrf4xx)
"""CRC-16/MCRF4XX of bytes, optionally going on from an earlier value."""

_TYPE_SIZES = {"int8_t": 1, "uint8_t": 1, "char": 1, "int16_t": 2, "uint16_t": 2, "int32_t": 4, "uint32_t": 4}
_TYPE_SIZES |= {"float": 4, "double": 8, "int64_t": 8, "uint64_t": 8}


class UnknownMessageError(KeyError):
    """A message name or number that is not in the dialect."""


def _base_size(cls: Any, types: list[str]) -> int:
    """Payload size without extension fields: all that MAVLink 1 carries.

    The dialect does not say where the extensions begin, but ``crc_extra`` is computed over the name and the
    base fields only, so the right count is the one that reproduces it.
    """
    crc = crc_mcrf4xx(f"{cls.msgname} ".encode(), 0xFFFF)
    size = 0
    found = cls.unpacker.size
    for name, kind, elements in zip(cls.ordered_fieldnames, types, cls.array_lengths, strict=True):
        crc = crc_mcrf4xx(f"{kind} {name} ".encode(), crc)
        if elements:
            crc = crc_mcrf4xx(bytes((elements,)), crc)
        size += _TYPE_SIZES[kind] * max(elements, 1)
        if (crc & 0xFF) ^ (crc >> 8) == cls.crc_extra:
            found = size
    return int(found)


class MessageType:
    """One message of the dialect."""

    __slots__ = (
        "_arrays", "_is_text", "_make", "_zeros",
        "base_size", "crc_extra", "fields", "id", "id_bytes", "name", "pack", "size",
        "tuple_type", "unpack",
    )  # fmt: skip

    def __init__(self, cls: Any) -> None:
        order = cls.ordered_fieldnames
        types = [cls.fieldtypes[cls.fieldnames.index(name)] for name in order]
        types = ["uint8_t" if t == "uint8_t_mavlink_version" else t for t in types]
        self.id: int = cls.id
        self.name: str = cls.msgname
        self.size: int = cls.unpacker.size
        self.base_size = _base_size(cls, types)
        self.crc_extra = bytes((cls.crc_extra,))
        self.id_bytes = self.id.to_bytes(3, "little")
        self.fields: tuple[str, ...] = tuple(order)
        layout = struct.Struct(cls.unpacker.format)
        self.pack: Callable[..., bytes] = layout.pack
        """``pack(*values in wire order)`` -> the full payload; arrays element by element."""
        self.unpack = layout.unpack
        self.tuple_type: Any = namedtuple(self.name, order)  # type: ignore[misc]
        self._make = partial(tuple.__new__, self.tuple_type)  # three times as fast as its own _make
        self._is_text = [t == "char" and n > 0 for t, n in zip(types, cls.array_lengths, strict=True)]
        lengths = [1 if text else max(n, 1) for text, n in zip(self._is_text, cls.array_lengths, strict=True)]
        self._arrays = lengths if any(n > 1 for n in cls.array_lengths) else None
        self._zeros = {name: b"" if text else 0 for name, text in zip(self.fields, self._is_text, strict=True)}

    def decode(self, payload: bytes) -> Any:
        """A named tuple of the fields (names as in MAVLink).

        Missing bytes are zeros, surplus bytes are ignored.

        Texts are bytes up to the first NUL, arrays are tuples.
        """
        short = self.size - len(payload)
        if short > 0:
            payload += bytes(short)
        elif short < 0:
            payload = payload[: self.size]
        values = self.unpack(payload)
        if self._arrays is None:
            return self._make(values)
        out: list[Any] = []
        at = 0
        for length, text in zip(self._arrays, self._is_text, strict=True):
            if text:
                out.append(values[at].split(b"\0", 1)[0])
            else:
                out.append(values[at] if length == 1 else values[at : at + length])
            at += length
        return self._make(out)

    def payload(self, **values: Any) -> bytes:
        """Payload from named fields; those not given are zero."""
        given = {**self._zeros, **values}
        if len(given) != len(self.fields):
            unknown = sorted(values.keys() - self._zeros.keys())
            raise UnknownMessageError(f"{self.name} has no field {unknown}; it has {list(self.fields)}")
        if self._arrays is None:
            return self.pack(*given.values())
        flat: list[Any] = []
        for length, value in zip(self._arrays, given.values(), strict=True):
            if length > 1:
                value = tuple(value) if value else ()
                flat.extend(value + (0,) * (length - len(value)))
            else:
                flat.append(value)
        return self.pack(*flat)

    def __repr__(self) -> str:
        return f"MessageType({self.name}, id {self.id})"


_CLASSES: dict[int, Any] = {**NEWER, **ardupilotmega.mavlink_map}
_BY_NAME: dict[str, int] = {cls.msgname: number for number, cls in _CLASSES.items()}
KNOWN_IDS = frozenset(_CLASSES)


@cache
def message_by_id(number: int) -> MessageType:
    """The message type with this number."""
    if number not in _CLASSES:
        raise UnknownMessageError(f"message {number} is not in the ardupilotmega dialect")
    return MessageType(_CLASSES[number])


def message(name: str) -> MessageType:
    """The message type with this name, for example ``message("ATTITUDE")``."""
    if name not in _BY_NAME:
        raise UnknownMessageError(f"message {name!r} is not in the ardupilotmega dialect")
    return message_by_id(_BY_NAME[name])
