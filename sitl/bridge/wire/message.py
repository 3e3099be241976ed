# SPDX-License-Identifier: BSD-3-Clause
"""A message's payload as a record, so that laws fill it in and read it as they do any other record::

    class Attitude(Message, name="ATTITUDE"):
        time_boot_ms: int
        roll: float  # [rad]
        ...

Offsets and types are the dialect's (``dialect.py``): a class names the fields that its users need and says which of
them are whole numbers, numbers or arrays. Fields that a class does not name stay zero. Fields of one type that follow
each other on the wire may be one vector, or one array::

    euler: Euler = consecutive("roll", "pitch", "yaw")
"""

from __future__ import annotations

import math
import struct
from ctypes import c_float
from dataclasses import dataclass
from typing import Any, ClassVar, Self, get_origin, get_type_hints

import numpy as np

from ...core.records import Field, Floats, Ints, Record
from ...core.vectors import Value
from ..dialect import MessageType, message

_NUMPY = {"b": "i1", "B": "u1", "h": "i2", "H": "u2", "i": "i4", "I": "u4", "q": "i8", "Q": "u8", "f": "f4", "d": "f8"}
"""Code of ``struct`` -> NumPy's."""
_FIELD_TYPES = {(False, False): int, (True, False): float, (False, True): Ints, (True, True): Floats}
"""(Not whole numbers, an array) -> what a class says of the field."""


@dataclass(frozen=True)
class _Consecutive:
    names: tuple[str, ...]


def consecutive(*names: str) -> Any:
    """Declares a vector or an array of fields of the dialect that are of one type and follow each other on the wire."""
    return _Consecutive(names)


class Message(Record):
    """Base of all messages: the payload in wire order, at full length.

    A subclass of a message has its base's fields, at the offsets of its own kind.
    """

    kind: ClassVar[MessageType]
    parts: ClassVar[tuple[str, ...]] = ()
    """The dialect's fields that it has, those of vectors and arrays one by one."""
    _vectors: ClassVar[dict[str, tuple[str, ...]]] = {}
    """Name -> the dialect's fields that it consists of."""

    @classmethod
    def of_payload(cls, payload: bytes) -> Self:
        """The message with a payload's bytes; bytes that are missing at its end are zeros, as in MAVLink 2."""
        return cls(memoryview(bytearray(payload[: cls.kind.size].ljust(cls.kind.size, b"\0"))))

    def __init_subclass__(cls, name: str) -> None:
        """Take the layout from the dialect.

        Args:
            name: of the message, as MAVLink has it.

        Raises:
            TypeError: a field that the message does not have, or that is of another type there; fields of one vector
                that do not follow each other.
        """
        cls.kind = message(name)
        cls._vectors = cls._vectors | {n: d.names for n, d in vars(cls).items() if isinstance(d, _Consecutive)}
        hints = get_type_hints(cls)
        own = [n for n, hint in hints.items() if not n.startswith("_") and get_origin(hint) is not ClassVar]
        fields = [_field(cls, field, hints[field]) for field in own]
        cls.parts = tuple(part for name in own for part in cls._vectors.get(name, (name,)))
        cls.fields = {f.name: f for f in sorted(fields, key=lambda f: f.offset)}
        cls.dtype = np.dtype(
            {
                "names": list(cls.fields),
                "formats": [f.numpy for f in cls.fields.values()],
                "offsets": [f.offset for f in cls.fields.values()],
                "itemsize": cls.kind.size,
            }
        )
        cls.lay_out([f for f in cls.fields.values() if f.value is None])
        for f in cls.fields.values():
            if f.value is not None:
                setattr(cls, f.name, _access(f, f.value))


def _field(cls: type[Message], name: str, hint: Any) -> Field:
    """The field that a class declares under a name, where the dialect has it."""
    kind, parts = cls.kind, cls._vectors.get(name, (name,))
    missing = [part for part in parts if part not in kind.fields]
    if missing:
        raise TypeError(f"{cls.__name__}: {kind.name} has no fields {missing}; it has {kind.fields}")
    first = kind.fields.index(parts[0])
    code, length = kind.codes[first]
    number = "u1" if code.endswith("s") else _NUMPY[code]
    if name in cls._vectors:
        if kind.fields[first : first + len(parts)] != parts or len(set(kind.codes[first : first + len(parts)])) > 1:
            raise TypeError(f"{cls.__name__}.{name}: {parts} are not fields of one type in a row of {kind.fields}")
        length = len(parts)
        if isinstance(hint, type) and issubclass(hint, Value) and len(hint.NAMES) == length:
            return Field(name, kind.offset_of(parts[0]), number, (length,), hint)
    expected = _FIELD_TYPES[number[0] == "f", length > 0]
    if hint is not expected:
        raise TypeError(f"{cls.__name__}.{name}: {kind.name} has {expected.__name__} there, not {hint}")
    return Field(name, kind.offset_of(parts[0]), number, (length,) if length else (), None if length else expected)


def _access(field: Field, value: type) -> property:
    letter = next(code for code, numpy in _NUMPY.items() if numpy == field.code)
    layout = struct.Struct(f"<{math.prod(field.shape)}{letter}")
    offset, unpack, pack = field.offset, layout.unpack_from, layout.pack_into
    # As the core does: what single precision cannot hold is infinite, and a vector's numbers are cut to whole ones.
    narrow: Any = (lambda number: c_float(number).value) if field.code == "f4" else int if field.shape else lambda n: n

    if not field.shape:
        return property(
            lambda self: unpack(self._bytes, offset)[0], lambda self, new: pack(self._bytes, offset, narrow(new))
        )
    return property(
        lambda self: value(*unpack(self._bytes, offset)),
        lambda self, new: pack(self._bytes, offset, *map(narrow, new)),
    )
