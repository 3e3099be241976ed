# SPDX-License-Identifier: BSD-3-Clause
"""Records: classes whose fields lie in one block of memory, side by side.

A record is declared once. From its annotations come NumPy's dtype (fleets are arrays of it), Numba's type (the core
reads and writes it as plain loads and stores) and, in plain Python, attribute access on the same memory; editors and
mypy know the fields::

    class RateLoop(Record):
        target: Vec3  # body rates [rad/s]
        gain: float  # [1/s]
        samples: int
        saturated: bool
        history: Floats = array(8, 3)
        narrow: Float32  # at the precision of the wire
        filter: LowPass  # a record in the record
        channels: Records[Channel] = repeat(Channel, 16)

    loop = RateLoop()  # zeros, in memory of its own
    v = Copter.of(fleet, 0)  # a vehicle in a fleet's memory

Numbers, booleans, vectors, quaternions and Euler angles read and write as values; arrays and nested records are
references to the record's memory. A subclass goes on with the fields of its base, whose offsets it keeps; those of
several bases follow each other, where a field of two of them is at its offset in the later one.

A property that is a law is read like a field, in laws too, and worked out at each read::

    @property
    @law
    def yaw(self) -> float:
        return yaw_of(self.q)
"""

from __future__ import annotations

import inspect
import struct
import sys
from collections.abc import Container, Iterator
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import Annotated, Any, ClassVar, Protocol, Self, TypeVar, get_args, get_origin, overload

import numpy as np

from .vectors import Value

R_co = TypeVar("R_co", covariant=True)
Index = int | tuple[int, ...]


class Floats(Protocol):
    """An array of floats in a record: by index in laws; in plain Python a ``numpy`` view."""

    @overload
    def __getitem__(self, index: Index, /) -> float: ...
    @overload
    def __getitem__(self, index: slice, /) -> np.ndarray[Any, Any]: ...
    def __setitem__(self, index: Index | slice, value: Any, /) -> None: ...
    def __iter__(self) -> Iterator[float]: ...
    def __len__(self) -> int: ...
    def tolist(self) -> list[Any]: ...
    @property
    def shape(self) -> tuple[int, ...]: ...


class FloatRows(Protocol):
    """An array of floats of two axes: by row and column, or a row by its number."""

    @overload
    def __getitem__(self, index: int, /) -> Floats: ...
    @overload
    def __getitem__(self, index: tuple[int, int], /) -> float: ...
    def __setitem__(self, index: Index | slice, value: Any, /) -> None: ...
    def __len__(self) -> int: ...
    @property
    def shape(self) -> tuple[int, ...]: ...


class Ints(Protocol):
    """An array of integers in a record."""

    @overload
    def __getitem__(self, index: Index, /) -> int: ...
    @overload
    def __getitem__(self, index: slice, /) -> np.ndarray[Any, Any]: ...
    def __setitem__(self, index: Index | slice, value: Any, /) -> None: ...
    def __iter__(self) -> Iterator[int]: ...
    def __len__(self) -> int: ...
    def tolist(self) -> list[Any]: ...
    @property
    def shape(self) -> tuple[int, ...]: ...


class IntRows(Protocol):
    """An array of integers of two axes: by row and column, or a row by its number."""

    @overload
    def __getitem__(self, index: int, /) -> Ints: ...
    @overload
    def __getitem__(self, index: tuple[int, int], /) -> int: ...
    def __setitem__(self, index: Index | slice, value: Any, /) -> None: ...
    def __len__(self) -> int: ...
    @property
    def shape(self) -> tuple[int, ...]: ...


class Records(Protocol[R_co]):
    """A row of records in a record."""

    def __getitem__(self, index: int, /) -> R_co: ...
    def __len__(self) -> int: ...


@dataclass(frozen=True)
class Stored:
    """How a field lies in memory, where its type does not say so."""

    code: str
    """NumPy's code of one number: "f8", "i8", "f4", "i4"; of arrays "i2", "u2", too."""
    shape: tuple[int, ...] = ()


Float32 = Annotated[float, Stored("f4")]
"""A number at float32 precision, as some protocols carry it."""
Int32 = Annotated[int, Stored("i4")]
"""An integer of four bytes, as some protocols carry it."""


def array(*shape: int, stored: str = "f8") -> Any:
    """Declares an array: ``covariance: Floats = array(18, 18)``, ``channels: Ints = array(18, stored="i8")``."""
    return Stored(stored, shape)


@dataclass(frozen=True)
class _Repeat:
    record: type[Record]
    count: int


@dataclass(frozen=True)
class _Noted:
    note: Any
    stored: Stored | _Repeat | None


def noted(note: Any, stored: Any = None) -> Any:
    """Declares a field that carries a note (``Field.note``), such as the limits of a parameter.

    Args:
        note: anything.
        stored: ``array(...)`` or ``repeat(...)`` where the annotation needs one.
    """
    return _Noted(note, stored)


def repeat(record: type[Record], count: int) -> Any:
    """Declares a row of records: ``channels: Records[Channel] = repeat(Channel, 16)``."""
    return _Repeat(record, count)


@dataclass(frozen=True)
class Field:
    """One field of a record."""

    name: str
    offset: int
    """From the beginning of the record [bytes]."""
    code: str = ""
    """NumPy's code of one number, "" for records."""
    shape: tuple[int, ...] = ()
    """Of an array in memory; a vector's is its length."""
    value: type | None = None
    """What it reads as: float, int, bool or a class of ``vectors``; None: as a reference."""
    record: type[Record] | None = None
    """The nested record, or what is repeated ``shape`` times."""
    note: Any = None
    """What ``noted`` says of it; a subclass that declares the field again without a note keeps its base's."""

    @property
    def numpy(self) -> Any:
        """NumPy's type of the field."""
        base = np.dtype(self.code) if self.record is None else self.record.dtype
        return (base, self.shape) if self.shape else base

    def layout(self, names: Container[str] | None = None) -> str:
        """What machine code depends on, as text (``Record.layout``)."""
        inner = self.code if self.record is None else self.record.layout(names)
        return f"{self.name}:{self.offset}:{inner}{self.shape}{self.value.__name__ if self.value else ''}"


_CODES = {float: "f8", int: "i8", bool: "i8"}


def _own_hints(cls: type) -> dict[str, Any]:
    """Name -> type, of the fields that a class itself declares.

    ``typing.get_type_hints`` would look at those of its bases, too, anew for every record: a tenth of the start.
    """
    module, found = vars(sys.modules[cls.__module__]), {}
    for name, hint in inspect.get_annotations(cls).items():
        if name.startswith("_"):
            continue
        value = eval(hint, module, dict(vars(cls))) if isinstance(hint, str) else hint
        if value is not ClassVar and get_origin(value) is not ClassVar:
            found[name] = value
    return found


def _declared(name: str, hint: Any, default: Any, inherited: Field | None) -> Field:
    """The field that an annotation, with its default, declares (its offset is worked out later)."""
    note = inherited.note if inherited is not None else None
    if isinstance(default, _Noted):
        note, default = default.note, default.stored
    stored = default if isinstance(default, Stored | _Repeat) else None
    if get_origin(hint) is Annotated:
        hint, *more = get_args(hint)
        stored = stored or next((n for n in more if isinstance(n, Stored)), None)
    if isinstance(stored, _Repeat):
        return Field(name, 0, shape=(stored.count,), record=stored.record, note=note)
    if isinstance(hint, type) and issubclass(hint, Record):
        return Field(name, 0, record=hint, note=note)
    if isinstance(hint, type) and issubclass(hint, Value):
        return Field(name, 0, stored.code if stored else "f8", (len(hint.NAMES),), hint, note=note)
    if stored is not None and stored.shape:
        return Field(name, 0, stored.code, stored.shape, note=note)
    if hint in _CODES:
        return Field(name, 0, stored.code if stored else _CODES[hint], (), hint, note=note)
    if inherited is not None and (inherited.shape or inherited.record):  # an array or a row, as the base has it
        return replace(inherited, note=note)
    raise TypeError(
        f"field {name!r} is a {hint!r}; a record holds float, int, bool, {', '.join(c.__name__ for c in _values())}, "
        "Float32, Int32, records, and arrays declared with array(...) or repeat(...)"
    )


def _values() -> tuple[type[Value], ...]:
    from .vectors import VALUES

    return VALUES


PROPERTIES: dict[str, list[Any]] = {}
"""Name of a property -> the laws of that name, of all records."""
_REFERENCES = tuple(f"_reference_{k}" for k in range(64))
"""Where a record keeps its arrays, records and rows of records, in the order of its fields."""


_NARROW, _WIDE = 32, 64
"""Records that are not small have a multiple of so many bytes; of more than one of these, a multiple of so many."""


def _padded(close: np.dtype[Any], least: int) -> np.dtype[Any]:
    """The type with unused memory at its end: of ``least`` bytes or more."""
    size = max(close.itemsize, least)
    step = _NARROW if size <= _NARROW else _WIDE
    fields: Any = close.fields
    described: Any = {
        "names": close.names,
        "formats": [fields[name][0] for name in close.names or ()],
        "offsets": [fields[name][1] for name in close.names or ()],
        "itemsize": -(-size // step) * step,
    }
    made: np.dtype[Any] = np.dtype(described, align=True)
    return made


class _RecordMeta(type):
    """Gives record classes no dictionary, so that a misspelt field is an error."""

    def __new__(mcs, name: str, bases: tuple[type, ...], space: dict[str, Any], /, **options: Any) -> Any:
        return super().__new__(mcs, name, bases, {"__slots__": (), **space}, **options)


class Record(metaclass=_RecordMeta):
    """Base of all records (see the module)."""

    __slots__ = ("_bytes", "_f4", "_f8", "_i4", "_i8", *_REFERENCES)
    dtype: ClassVar[np.dtype[Any]]
    """NumPy's type of the record, aligned as C does it."""
    fields: ClassVar[dict[str, Field]] = {}
    """Name -> field, in the order of memory."""
    properties: ClassVar[dict[str, Any]] = {}
    """Name -> law, of properties."""
    _references: ClassVar[tuple[tuple[str, Field], ...]] = ()
    _stores: ClassVar[tuple[tuple[str, str], ...]] = ()
    """Views of the memory as numbers of one size: (attribute, letter of the numbers)."""
    keeps_offsets: ClassVar[bool] = True
    """Whether a field that a subclass declares again stays where the base has it; else it goes where it is declared."""
    _small: ClassVar[int] = 32
    """Records of no more bytes have no unused memory at their end. The others mostly have some, so that a new field
    there moves no other record, and units that do not mention it are not compiled again."""
    _least: ClassVar[int] = 0
    """Bytes that it has at least."""
    _bytes: Any
    _f8: Any
    _i8: Any
    _f4: Any
    _i4: Any

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        own = _own_hints(cls)
        inherited_fields: dict[str, Field] = {}
        for base in cls.__bases__:
            fields = getattr(base, "fields", {})
            inherited_fields = {n: f for n, f in inherited_fields.items() if n not in fields} | fields
        order = [name for name in inherited_fields if cls.keeps_offsets or name not in own]
        declared = []
        for name in dict.fromkeys((*order, *own)):
            inherited = inherited_fields.get(name)
            if inherited is not None and name not in own:
                declared.append(inherited)
            else:
                declared.append(_declared(name, own[name], cls.__dict__.get(name), inherited))
        taken = [f.name for f in declared if hasattr(np.void, f.name) or hasattr(Record, f.name)]
        if taken:
            raise TypeError(f"{cls.__name__}: fields {taken} are attributes of records themselves; choose other names")
        close = np.dtype([(f.name, f.numpy) for f in declared], align=True)
        offsets: Any = close.fields or {}
        cls.dtype = close if max(close.itemsize, cls._least) <= cls._small else _padded(close, cls._least)
        cls.fields = {f.name: replace(f, offset=offsets[f.name][1]) for f in declared}
        own_laws = {name: p.fget for name, p in vars(cls).items() if isinstance(p, property)}
        cls.properties = cls.properties | own_laws
        for name, law in own_laws.items():
            PROPERTIES.setdefault(name, []).append(law)
        cls.lay_out([f for f in cls.fields.values() if f.value is None])
        values = [field for field in cls.fields.values() if field.value is not None]
        codes = {field.code for field in values}
        cls._stores = tuple((store, _LETTERS[code]) for code, (store, _) in _STORES.items() if code in codes)
        for field in values:
            setattr(cls, field.name, _access(field))

    @classmethod
    def lay_out(cls, references: list[Field]) -> None:
        """Give each array, record and row of records an attribute of its own in the object."""
        if len(references) > len(_REFERENCES):
            raise TypeError(f"{cls.__name__}: {len(references)} arrays and records; at most {len(_REFERENCES)}")
        cls._references = tuple(zip(_REFERENCES, references))
        for attribute, field in cls._references:
            setattr(cls, field.name, _reference_access(attribute))

    def __init__(self, memory: Any = None) -> None:
        """A record on ``memory`` (a memoryview of its size), or of zeros in memory of its own."""
        if memory is None:
            memory = memoryview(bytearray(self.dtype.itemsize))
        self._bytes = memory
        for store, letter in self._stores:
            setattr(self, store, memory.cast(letter))
        for attribute, f in self._references:
            setattr(self, attribute, _reference(f, memory[f.offset :]))

    @classmethod
    def of(cls, fleet: np.ndarray[Any, Any], index: int) -> Self:
        """Record ``index`` of an array of them; writes go to the array, whose memory must stay where it is.

        Raises:
            ValueError: the array is not one block of memory.
            TypeError: it is of another record.
        """
        if not fleet.flags.c_contiguous:
            raise ValueError("the fleet must be one block of memory")
        if fleet.dtype != cls.dtype:
            raise TypeError(f"an array of {fleet.dtype.names} holds no {cls.__name__}")
        at = range(len(fleet))[index] * cls.dtype.itemsize
        return cls(np.frombuffer(fleet.data, "u1").data[at : at + cls.dtype.itemsize])

    @classmethod
    def fleet(cls, count: int) -> np.ndarray[Any, Any]:
        """An array of ``count`` records of zeros."""
        return np.zeros(count, cls.dtype)

    @classmethod
    def layout(cls, names: Container[str] | None = None) -> str:
        """The size of the record, and names, types and offsets of its fields as text: machine code depends on it.

        Args:
            names: fields of other names, and what is in them, are left out: the code mentions none of them.
        """
        fields = [field.layout(names) for name, field in cls.fields.items() if names is None or name in names]
        return f"{cls.dtype.itemsize}{{{','.join(fields)}}}"

    def zero(self, *names: str) -> None:
        """Set the fields named, or all, to zero."""
        for field in (self.fields[name] for name in names) if names else self.fields.values():
            size = np.dtype(field.numpy).itemsize
            self._bytes[field.offset : field.offset + size] = bytes(size)

    def assign(self, value: Any) -> None:
        """Copy a whole record of the same type (a Record, or ``numpy``'s) into this one's memory.

        Raises:
            TypeError: it is of another type.
        """
        self._bytes[:] = as_bytes(value, self.dtype)

    def __getitem__(self, name: str) -> Any:
        return getattr(self, name)

    def __setitem__(self, name: str, value: Any) -> None:
        setattr(self, name, value)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}={getattr(self, name)!r}' for name in self.fields)})"


def as_bytes(value: Any, dtype: np.dtype[Any]) -> Any:
    """The bytes of a record; TypeError when it is of another type."""
    if getattr(value, "dtype", None) != dtype:
        raise TypeError(f"a record of {dtype.names} cannot become one of {getattr(value, 'dtype', type(value))}")
    return value._bytes if isinstance(value, Record) else np.asarray(value, dtype).tobytes()


def _reference(field: Field, memory: Any) -> Any:
    """The array, the nested record or the row of records at the beginning of ``memory``."""
    if field.record is None:
        return np.ndarray(field.shape, field.code, memory)
    size = field.record.dtype.itemsize
    if not field.shape:
        return field.record(memory[:size])
    return tuple(field.record(memory[k * size : (k + 1) * size]) for k in range(field.shape[0]))


_STORES = {"f8": ("_f8", 8), "i8": ("_i8", 8), "f4": ("_f4", 4), "i4": ("_i4", 4)}


_LETTERS = {"f8": "d", "i8": "q", "f4": "f", "i4": "i"}
"""NumPy's code of a number -> that of ``struct``."""


def _access(field: Field) -> property:
    if field.value is not None and issubclass(field.value, Value):
        return _value_access(field.value, field)
    store, size = _STORES[field.code]
    return _number_access(field, store, field.offset // size)


def _number_access(field: Field, store: str, k: int) -> property:
    # Four readers and writers instead of one with getattr: they are called ten thousands of times a simulated second.
    if field.value is bool:
        return property(lambda self: self._i8[k] != 0, lambda self, value: self._i8.__setitem__(k, int(bool(value))))

    def write_f8(self: Any, value: Any) -> None:
        self._f8[k] = value

    def write_i8(self: Any, value: Any) -> None:
        try:
            self._i8[k] = value
        except TypeError:  # its fraction is cut off, as in the core
            self._i8[k] = int(value)

    def write_narrow(self: Any, value: Any) -> None:
        getattr(self, store)[k] = int(value) if store == "_i4" else value

    reads: dict[str, Any] = {
        "_f8": lambda self: self._f8[k],
        "_i8": lambda self: self._i8[k],
        "_f4": lambda self: self._f4[k],
        "_i4": lambda self: self._i4[k],
    }
    writes = {"_f8": write_f8, "_i8": write_i8}
    return property(reads[store], writes.get(store, write_narrow))


def _value_access(cls: type[Value], field: Field) -> property:
    count, offset, new = len(cls.NAMES), field.offset, tuple.__new__
    layout = struct.Struct(f"<{count}{_LETTERS[field.code]}")
    unpack, pack = layout.unpack_from, layout.pack_into
    whole = field.code in ("i8", "i4")

    def read(self: Any) -> Any:
        numbers = unpack(self._bytes, offset)
        return new(cls, map(float, numbers) if whole else numbers)

    def write(self: Any, value: Any) -> None:
        numbers = value if isinstance(value, tuple) else np.asarray(value, float).tolist()
        if len(numbers) != count:
            raise TypeError(f"{value!r} does not have the {count} components of a {cls.__name__}")
        pack(self._bytes, offset, *(map(int, numbers) if whole else numbers))

    return property(read, write)


def _reference_access(attribute: str) -> property:
    read = attrgetter(attribute)  # no Python frame for a read

    def write(self: Any, value: Any) -> None:
        held = read(self)
        if isinstance(held, Record):
            held.assign(value)
        elif isinstance(held, tuple):
            for record, new in zip(held, value, strict=True):
                record.assign(new)
        else:
            held[...] = value

    return property(read, write)


def as_dict(value: Any) -> Any:
    """A record as nested dictionaries and lists, for printing and comparing."""
    if isinstance(value, Record):
        return {name: as_dict(value[name]) for name in value.fields}
    if isinstance(value, np.void) and value.dtype.names:
        return {name: as_dict(value[name]) for name in value.dtype.names}
    if isinstance(value, np.ndarray | tuple):
        return [as_dict(v) for v in value]
    return value.item() if isinstance(value, np.generic) else value


def first_difference(a: Any, b: Any, path: str = "") -> str | None:
    """Name of the first field in which two records (``numpy``'s) differ bit for bit, or None when they are equal."""
    if isinstance(a, np.void) and a.dtype.names:
        for name in a.dtype.names:
            found = first_difference(a[name], b[name], f"{path}.{name}" if path else name)
            if found:
                return found
        return None
    if isinstance(a, np.ndarray) and a.dtype.names:
        for k in range(a.shape[0]):
            found = first_difference(a[k], b[k], f"{path}[{k}]")
            if found:
                return found
        return None
    same = np.asarray(a).tobytes() == np.asarray(b).tobytes()
    return None if same else f"{path}: {a!r} != {b!r}"


__all__ = [
    "Field", "Float32", "FloatRows", "Floats", "Int32", "IntRows", "Ints", "Record", "Records", "Stored",
    "array", "as_bytes", "as_dict", "first_difference", "noted", "repeat",
]  # fmt: skip
