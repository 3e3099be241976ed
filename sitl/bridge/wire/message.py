# SPDX-License-Identifier: BSD-3-Clause
"""A message's payload as a record, so that laws fill it in and read it as they do any other record::

    class Attitude(Message, name="ATTITUDE"):
        time_boot_ms: int
        roll: float  # [rad]
        ...

Places and types are the dialect's (``dialect.py``): a class names the fields that its users need and says which of
them are whole numbers, numbers or arrays. Fields that a class does not name stay zero.
"""

from __future__ import annotations

import struct
from ctypes import c_float
from typing import Any, ClassVar, get_type_hints

import numpy as np

from ...core.records import Field, Floats, Ints, Record
from ..dialect import MessageType, message

_NUMPY = {"b": "i1", "B": "u1", "h": "i2", "H": "u2", "i": "i4", "I": "u4", "q": "i8", "Q": "u8", "f": "f4", "d": "f8"}
"""Code of ``struct`` -> NumPy's."""
_SORTS = {(False, False): int, (True, False): float, (False, True): Ints, (True, True): Floats}
"""(Not whole numbers, an array) -> what a class says of the field."""


class Message(Record):
    """Base of all messages: the payload in wire order, at full length."""

    kind: ClassVar[MessageType]

    def __init_subclass__(cls, name: str) -> None:
        """Take the layout from the dialect.

        Args:
            name: of the message, as MAVLink has it.

        Raises:
            TypeError: a field that the message does not have, or that is of another type there.
        """
        cls.kind = message(name)
        hints = {field: hint for field, hint in get_type_hints(cls).items() if field in cls.__annotations__}
        cls.fields = {}
        for field, (code, length) in zip(cls.kind.fields, cls.kind.codes, strict=True):
            hint = hints.pop(field, None)
            if hint is None:
                continue
            text = code.endswith("s")
            number = "u1" if text else _NUMPY[code]
            expected = _SORTS[number[0] == "f", length > 0]
            if hint is not expected:
                raise TypeError(f"{cls.__name__}.{field}: {name} has {expected.__name__} there, not {hint}")
            shape, value = ((length,), None) if length else ((), expected)
            cls.fields[field] = Field(field, cls.kind.offset_of(field), number, shape, value)
        if hints:
            raise TypeError(f"{cls.__name__}: {name} has no fields {sorted(hints)}; it has {cls.kind.fields}")
        cls.dtype = np.dtype(
            {
                "names": list(cls.fields),
                "formats": [f.numpy for f in cls.fields.values()],
                "offsets": [f.offset for f in cls.fields.values()],
                "itemsize": cls.kind.size,
            }
        )
        arrays = [f for f in cls.fields.values() if f.shape]
        cls.lay_out(arrays)
        for f in cls.fields.values():
            if not f.shape:
                setattr(cls, f.name, _number(f))


def _number(field: Field) -> property:
    layout = struct.Struct("<" + next(code for code, numpy in _NUMPY.items() if numpy == field.code))
    offset, narrow = field.offset, field.code == "f4"
    unpack, pack = layout.unpack_from, layout.pack_into

    def read(self: Any) -> Any:
        return unpack(self._bytes, offset)[0]

    def write(self: Any, value: Any) -> None:
        # As the core does: what single precision cannot hold is infinite.
        pack(self._bytes, offset, c_float(value).value if narrow else value)

    return property(read, write)
