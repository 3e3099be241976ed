# SPDX-License-Identifier: BSD-3-Clause
"""The messages of the ``ardupilotmega`` dialect as data.

Layout, checksum seed, and how to pack and unpack them.

Everything is taken from pymavlink's generated dialect. Fields are handled in *wire order* (by size,
extensions last, https://mavlink.io/en/guide/serialization.html#field_reordering), because that is what
``struct`` can do in one call.

Messages of common.xml that pymavlink's ``ardupilotmega`` dialect does not have yet.

Described as it describes its own.
"""

from __future__ import annotations

import struct
from collections import namedtuple
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple, cast

from fastcrc import crc16
from pymavlink.dialects.v20 import ardupilotmega

from ..errors import SitlError, did_you_mean


class AvailableModes:
    """AVAILABLE_MODES (https://mavlink.io/en/messages/common.html#AVAILABLE_MODES)."""

    id = 435
    msgname = "AVAILABLE_MODES"
    crc_extra = 134
    unpacker = struct.Struct("<IIBBB35s")
    fieldnames = ("number_modes", "mode_index", "standard_mode", "custom_mode", "properties", "mode_name")
    fieldtypes = ("uint8_t", "uint8_t", "uint8_t", "uint32_t", "uint32_t", "char")
    ordered_fieldnames = (
        "custom_mode",
        "properties",
        "number_modes",
        "mode_index",
        "standard_mode",
        "mode_name",
    )
    array_lengths = (0, 0, 0, 0, 0, 35)


class ComponentMetadata:
    """COMPONENT_METADATA (https://mavlink.io/en/messages/common.html#COMPONENT_METADATA)."""

    id = 397
    msgname = "COMPONENT_METADATA"
    crc_extra = 182
    unpacker = struct.Struct("<II100s")
    fieldnames = ("time_boot_ms", "file_crc", "uri")
    fieldtypes = ("uint32_t", "uint32_t", "char")
    ordered_fieldnames = fieldnames
    array_lengths = (0, 0, 100)


class AvailableModesMonitor:
    """AVAILABLE_MODES_MONITOR (https://mavlink.io/en/messages/common.html#AVAILABLE_MODES_MONITOR)."""

    id = 437
    msgname = "AVAILABLE_MODES_MONITOR"
    crc_extra = 30
    unpacker = struct.Struct("<B")
    fieldnames = ("seq",)
    fieldtypes = ("uint8_t",)
    ordered_fieldnames = fieldnames
    array_lengths = (0,)


NEWER = {kind.id: kind for kind in (AvailableModes, ComponentMetadata, AvailableModesMonitor)}


crc_mcrf4xx = cast("Callable[..., int]", crc16.mcrf4xx)
"""CRC-16/MCRF4XX of bytes, optionally going on from an earlier value."""

_TYPE_SIZES = {"int8_t": 1, "uint8_t": 1, "char": 1, "int16_t": 2, "uint16_t": 2, "int32_t": 4, "uint32_t": 4}
_TYPE_SIZES |= {"float": 4, "double": 8, "int64_t": 8, "uint64_t": 8}


_CODES = {"int8_t": "b", "uint8_t": "B", "char": "c", "int16_t": "h", "uint16_t": "H", "int32_t": "i", "uint32_t": "I"}
_CODES |= {"float": "f", "double": "d", "int64_t": "q", "uint64_t": "Q"}
_INTEGER_BITS = {"b": 8, "h": 16, "i": 32, "q": 64}
"""By struct code in lower case."""


class FieldError(SitlError, ValueError):
    """A value that a field of a message cannot carry."""

    def __init__(self, message: str, field: str, value: Any, allowed: str) -> None:
        super().__init__(f"{message}.{field} cannot be {value!r}; allowed: {allowed}")
        self.message, self.field, self.value, self.allowed = message, field, value, allowed


class UnknownMessageError(SitlError, KeyError):
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


class PayloadLayout(NamedTuple):
    """What frames of a message depend on."""

    id: int
    size: int
    base_size: int
    crc_extra: int


def layout_of(number: int) -> PayloadLayout:
    """Sizes and checksum seed of a message of the dialect."""
    cls = _CLASSES[number]
    return PayloadLayout(cls.id, cls.unpacker.size, _base_size(cls, _wire_types(cls)), cls.crc_extra)


def _wire_types(cls: Any) -> list[str]:
    """Types of the fields in wire order."""
    types = [cls.fieldtypes[cls.fieldnames.index(name)] for name in cls.ordered_fieldnames]
    return ["uint8_t" if t == "uint8_t_mavlink_version" else t for t in types]


def _allowed(code: str, length: int) -> str:
    """What a field of this struct code takes, in words; ``length`` 0 is no array."""
    bits = _INTEGER_BITS.get(code.lower())
    if code.endswith("s"):
        return f"bytes (b'...'), at most {code[:-1]}"
    if bits is None:
        one = f"numbers in {'single' if code == 'f' else 'double'} precision"
    else:
        low, high = (-(1 << bits - 1), (1 << bits - 1) - 1) if code.islower() else (0, (1 << bits) - 1)
        one = f"whole numbers {low} .. {high}"
    return f"a sequence of at most {length} {one}" if length else one


class MessageType:
    """One message of the dialect."""

    __slots__ = (
        "_arrays", "_is_text", "_make", "_zeros",
        "base_size", "codes", "crc_extra", "fields", "id", "name", "pack", "size",
        "tuple_type", "unpack_from", "wire_id",
    )  # fmt: skip

    def __init__(self, cls: Any) -> None:
        order = cls.ordered_fieldnames
        types = _wire_types(cls)
        self.id: int = cls.id
        self.wire_id = self.id.to_bytes(3, "little")
        """As MAVLink 2 frames carry it."""
        self.name: str = cls.msgname
        self.size: int = cls.unpacker.size
        self.base_size = _base_size(cls, types)
        self.crc_extra = bytes((cls.crc_extra,))
        self.fields: tuple[str, ...] = tuple(order)
        layout = struct.Struct(cls.unpacker.format)
        self.pack: Callable[..., bytes] = layout.pack
        """``pack(*values in wire order)`` -> the full payload; arrays element by element."""
        self.unpack_from = layout.unpack_from
        self.tuple_type: Any = namedtuple(self.name, order)  # type: ignore[misc]
        self._make = partial(tuple.__new__, self.tuple_type)  # three times as fast as its own _make
        self._is_text = [t == "char" and n > 0 for t, n in zip(types, cls.array_lengths, strict=True)]
        lengths = [1 if text else max(n, 1) for text, n in zip(self._is_text, cls.array_lengths, strict=True)]
        self._arrays = lengths if any(n > 1 for n in cls.array_lengths) else None
        self.codes = [
            (f"{n}s" if text else _CODES[t], n)
            for t, text, n in zip(types, self._is_text, cls.array_lengths, strict=True)
        ]
        """Of each field: (``struct`` code of one number, or of the whole text; length of the array, 0 for none)."""
        self._zeros = {name: b"" if text else 0 for name, text in zip(self.fields, self._is_text, strict=True)}

    def decode(self, payload: bytes) -> Any:
        """A named tuple of the fields (names as in MAVLink).

        Missing bytes are zeros, surplus bytes are ignored.

        Texts are bytes up to the first NUL, arrays are tuples.
        """
        values = self.unpack_from(payload.ljust(self.size, b"\0"))
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

    def offset_of(self, field: str) -> int:
        """Where a field begins in the payload [bytes]."""
        sizes = [struct.calcsize("<" + code) * (1 if code.endswith("s") else max(n, 1)) for code, n in self.codes]
        return sum(sizes[: self.fields.index(field)])

    def payload(self, **values: Any) -> bytes:
        """Payload from named fields; those not given are zero.

        Raises:
            UnknownMessageError: a name that is none of its fields.
            FieldError: a value that its field cannot carry.
        """
        given = {**self._zeros, **values}
        if len(given) != len(self.fields):
            unknown = sorted(values.keys() - self._zeros.keys())
            raise UnknownMessageError(f"{self.name} has no field {unknown}; it has {list(self.fields)}")
        try:
            return self.pack(*(given.values() if self._arrays is None else self._flat(given)))
        except (struct.error, OverflowError, TypeError, ValueError) as error:
            raise self._culprit(given) from error

    def _flat(self, given: dict[str, Any]) -> list[Any]:
        flat: list[Any] = []
        for length, value in zip(self._arrays or (), given.values(), strict=True):
            if length > 1:
                value = tuple(value) if value else ()
                flat.extend(value + (0,) * (length - len(value)))
            else:
                flat.append(value)
        return flat

    def _culprit(self, given: dict[str, Any]) -> FieldError:
        """The first field whose value does not pack, for the error message."""
        for (name, value), (code, length) in zip(given.items(), self.codes, strict=True):
            is_array = length > 1 and not code.endswith("s")
            try:
                values = (tuple(value) if value else ()) if is_array else (value,)
                for element in values:
                    struct.pack("<" + code, element)
                if len(values) <= max(length, 1):
                    continue
            except (struct.error, OverflowError, TypeError, ValueError):
                pass
            return FieldError(self.name, name, value, _allowed(code, length if is_array else 0))
        raise AssertionError(f"{self.name}: every field packs alone, but not all together")

    def __repr__(self) -> str:
        return f"MessageType({self.name}, id {self.id})"


_CLASSES: dict[int, Any] = {**NEWER, **ardupilotmega.mavlink_map}
_BY_NAME: dict[str, int] = {cls.msgname: number for number, cls in _CLASSES.items()}
KNOWN_IDS = frozenset(_CLASSES)


class _Types(dict[int, MessageType]):
    """Message types by number, each made when it is first asked for."""

    def __missing__(self, number: int) -> MessageType | None:
        if number in KNOWN_IDS:
            self[number] = MessageType(_CLASSES[number])
        return self.get(number)


_TYPES = _Types()
find_message: Callable[[int], MessageType | None] = _TYPES.__getitem__
"""The message type with this number, None when there is none."""


def message_by_id(number: int) -> MessageType:
    """The message type with this number."""
    found = find_message(number)
    if found is None:
        raise UnknownMessageError(f"message {number} is not in the ardupilotmega dialect")
    return found


def message(name: str) -> MessageType:
    """The message type with this name, for example ``message("ATTITUDE")``."""
    if name not in _BY_NAME:
        raise UnknownMessageError(f"message {name!r} is not in the ardupilotmega dialect{did_you_mean(name, _BY_NAME)}")
    return message_by_id(_BY_NAME[name])
