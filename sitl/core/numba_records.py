# SPDX-License-Identifier: BSD-3-Clause
"""How Numba sees the records of ``records``.

Numba's own record type, with two differences: fields that are values (numbers of any width, booleans, vectors) read as
float64, int64, boolean or a value of ``vectors`` and are narrowed when they are written; and a type is named by its
class, because Numba prints the name of each type into every symbol.
"""

from __future__ import annotations

import math
import sys
import zlib
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, get_type_hints

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.core.compiler import Flags
from numba.core.cpu import CPUContext
from numba.core.datamodel import register_default
from numba.core.datamodel.models import OpaqueModel, RecordModel
from numba.core.errors import NumbaAttributeError
from numba.core.imputils import lower_constant, lower_getattr_generic, lower_setattr_generic
from numba.core.typing.templates import AttributeTemplate, infer_getattr
from numba.extending import intrinsic, lower_builtin, overload, type_callable, typeof_impl
from numba.np.arrayobj import make_array, populate_array, record_getattr, record_setattr
from numba.np.numpy_support import map_layout

from ..errors import did_you_mean
from . import numba_enums  # noqa: F401  members in laws
from .memory import bytes_at, call_unit, fetch_ahead, floats_at, ints_at, record_at, table_at, words_of
from .numba_vectors import TYPES, components, make_value
from .records import Field, Record
from .vectors import Value

_NUMBERS = {
    "f8": types.float64, "f4": types.float32,
    "i8": types.int64, "i4": types.int32, "i2": types.int16, "i1": types.int8,
    "u8": types.uint64, "u4": types.uint32, "u2": types.uint16, "u1": types.uint8,
}  # fmt: skip
_SCALARS: dict[type, Any] = {float: types.float64, int: types.int64, bool: types.boolean}


class RecordType(types.Record):
    """The type of a record class."""

    def __init__(self, cls: type[Record]) -> None:
        self._numpy = cls.dtype
        listed: Any = [(f.name, {"type": _memory_type(f), "offset": f.offset}) for f in cls.fields.values()]
        super().__init__(listed, cls.dtype.itemsize, cls.dtype.isalignedstruct)
        self.values: dict[str, Any] = {f.name: _value_type(f) for f in cls.fields.values() if f.value is not None}
        """Field that reads as a value -> what it reads as."""
        self.properties: dict[str, Any] = cls.properties
        self.name = _name(cls)

    def typeof(self, key: str) -> Any:
        """The type of a field.

        Raises:
            NumbaAttributeError: there is none of this name; Numba adds where in the law that is.
        """
        if key not in self.fields:
            record = self.name.partition("@")[0]
            raise NumbaAttributeError(f"record {record} has no field {key!r}{did_you_mean(key, self.fields)}")
        return super().typeof(key)

    @property
    def dtype(self) -> Any:
        """NumPy's type."""
        return self._numpy

    @property
    def mangling_args(self) -> tuple[str, tuple[Any, ...]]:
        """Its part of a symbol: its name; Numba's own part, a running number, means another type in another process."""
        return self.name, ()

    def __repr__(self) -> str:
        return self.name


def _name(cls: type[Record]) -> str:
    """By which Numba knows the type; also the types in machine code that was kept, of fields at other offsets.

    It takes types of one name for the same: classes that are made by a function, or again, may share theirs.
    """
    found: Any = sys.modules.get(cls.__module__)
    for part in cls.__qualname__.split("."):
        found = getattr(found, part, None)
    alone = f"{cls.__module__}.{cls.__qualname__}"
    return alone if found is cls else f"{alone}@{zlib.crc32(cls.layout().encode()):08x}"


def _memory_type(field: Field) -> Any:
    base = numba_type(field.record) if field.record is not None else _NUMBERS[field.code]
    return types.NestedArray(base, field.shape) if field.shape else base


def _value_type(field: Field) -> Any:
    assert field.value is not None
    return TYPES[field.value] if issubclass(field.value, Value) else _SCALARS[field.value]


@cache
def numba_type(cls: type[Record]) -> RecordType:
    """Numba's type of a record class."""
    kind = RecordType(cls)
    _BY_DTYPE.setdefault(cls.dtype, kind)
    CLASSES[kind.name] = cls
    return kind


CLASSES: dict[str, type[Record]] = {}
"""Name of a type -> its record class."""
_BY_DTYPE: dict[Any, RecordType] = {}
_typeof_ndarray = typeof_impl.dispatch(np.ndarray)


@typeof_impl.register(np.ndarray)
def _typeof(array: Any, context: Any) -> Any:
    """Arrays of a record that kernels are compiled for are arrays of its ``RecordType``."""
    kind = _BY_DTYPE.get(array.dtype) if array.dtype.names is not None else None
    if kind is None:
        return _typeof_ndarray(array, context)
    return types.Array(kind, array.ndim, map_layout(array), readonly=not array.flags.writeable)


register_default(RecordType)(RecordModel)


def _property(kind: RecordType, name: str) -> Any:
    """The signature of a property's law."""
    value = get_type_hints(kind.properties[name])["return"]
    return (TYPES.get(value) or _SCALARS[value])(kind)


@infer_getattr
class _Fields(AttributeTemplate):
    key = RecordType

    def generic_resolve(self, record: RecordType, name: str) -> Any:
        if name in record.properties:
            return _property(record, name).return_type
        if name not in record.fields:
            return None
        return record.values.get(name) or record.typeof(name)


def _address(builder: Any, context: Any, kind: RecordType, memory: Any, name: str) -> tuple[Any, Any, int]:
    """(Pointer to the first number, type of a number, how many) of a field."""
    stored = kind.typeof(name)
    number = stored.dtype if isinstance(stored, types.NestedArray) else stored
    count = math.prod(stored.shape) if isinstance(stored, types.NestedArray) else 1
    return cgutils.get_record_member(builder, memory, kind.offset(name), context.get_data_type(number)), number, count


def _flags(context: Any) -> Any:
    """Of a property's law; None: those of its caller, which are of another target and have the same error model."""
    if not isinstance(context, CPUContext):
        return None
    flags = Flags()
    flags.error_model = "numpy"
    return flags


@lower_getattr_generic(RecordType)
def _read(context: Any, builder: Any, kind: RecordType, memory: Any, name: str) -> Any:
    if name in kind.properties:
        signature, flags = _property(kind, name), _flags(context)
        law = context.compile_subroutine(builder, kind.properties[name], signature, flags=flags)
        return context.call_internal(builder, law.fndesc, signature, [memory])
    value = kind.values.get(name)
    if value is None:
        return record_getattr(context, builder, kind, memory, name)
    address, number, count = _address(builder, context, kind, memory, name)
    if value in (types.float64, types.int64):
        return context.cast(builder, builder.load(address, align=_alignment(kind)), number, value)
    if value is types.boolean:
        return builder.icmp_signed("!=", builder.load(address), context.get_constant(types.int64, 0))
    numbers = [builder.load(cgutils.gep_inbounds(builder, address, k), align=_alignment(kind)) for k in range(count)]
    return make_value(context, builder, value, [context.cast(builder, n, number, types.float64) for n in numbers])


@lower_setattr_generic(RecordType)
def _write(context: Any, builder: Any, sig: Any, args: Any, name: str) -> None:
    kind, given = sig.args
    memory, what = args
    value = kind.values.get(name)
    if value is None:
        record_setattr(context, builder, sig, args, name)
        return
    address, number, _ = _address(builder, context, kind, memory, name)
    if value in TYPES.values():
        for k, part in enumerate(components(builder, value, what)):
            narrow = context.cast(builder, part, types.float64, number)
            builder.store(narrow, cgutils.gep_inbounds(builder, address, k), align=_alignment(kind))
        return
    if value is types.boolean:
        what, given = context.cast(builder, what, given, types.boolean), types.boolean
    builder.store(context.cast(builder, what, given, number), address, align=_alignment(kind))


def _alignment(kind: RecordType) -> int | None:
    """Of a number in memory; None: as the machine likes it."""
    return None if kind.aligned else 1


class RecordClass(types.Opaque):
    """The type of a record class itself, as an argument of ``record_at``."""

    def __init__(self, cls: type[Record]) -> None:
        self.record = numba_type(cls)
        super().__init__(name=f"class {self.record.name}")


@typeof_impl.register(type(Record))
def _typeof_class(cls: Any, context: Any) -> Any:
    return RecordClass(cls)


@lower_constant(RecordClass)
def _constant_class(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    return context.get_dummy_value()


register_default(RecordClass)(OpaqueModel)


@intrinsic
def _as_record(typing_context, cls, address):  # type: ignore[no-untyped-def]
    def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        return builder.inttoptr(args[1], context.get_value_type(sig.return_type))

    return cls.record(cls, types.int64), generate


# No annotations here: Numba compares these signatures with those of the functions.
@overload(record_at)
def _record_at(cls, address):  # type: ignore[no-untyped-def]
    return lambda cls, address: _as_record(cls, address)


def _array(context: Any, builder: Any, kind: Any, address: Any, lengths: Sequence[Any]) -> Any:
    """The array of a type at an address. Made where it is asked for: Numba lets no function return a new array."""
    size = context.get_constant(types.intp, context.get_abi_sizeof(context.get_data_type(kind.dtype)))
    steps = [size]
    for length in lengths[:0:-1]:
        steps.insert(0, builder.mul(steps[0], length))
    array = make_array(kind)(context, builder)
    shape, strides = cgutils.pack_array(builder, lengths), cgutils.pack_array(builder, steps)
    populate_array(array, data=address, shape=shape, strides=strides, itemsize=size, meminfo=None)
    return array._getvalue()


def _numbers_at(function: Callable[..., Any], number: Any) -> None:
    """Let laws call a function of ``memory`` that takes an address and the lengths of the axes."""
    axes = function.__code__.co_argcount - 1
    kind = types.Array(number, axes, "C")

    @type_callable(function)
    def typing(context: Any) -> Any:
        return (lambda address, count: kind) if axes == 1 else (lambda address, rows, columns: kind)

    @lower_builtin(function, types.Integer, *[types.Integer] * axes)
    def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        numbers = [context.cast(builder, *cast, types.intp) for cast in zip(args, sig.args, strict=True)]
        address = builder.inttoptr(numbers[0], context.get_data_type(number).as_pointer())
        return _array(context, builder, kind, address, numbers[1:])


for _function, _number in (
    (bytes_at, types.uint8), (floats_at, types.float64), (table_at, types.float64), (ints_at, types.int64)
):  # fmt: skip
    _numbers_at(_function, _number)


@type_callable(words_of)
def _type_words_of(context: Any) -> Any:
    return lambda record: types.Array(types.int64, 1, "C")


@lower_builtin(words_of, types.Record)
def _words_of(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    address = builder.bitcast(args[0], context.get_data_type(types.int64).as_pointer())
    count = context.get_constant(types.intp, sig.args[0].dtype.itemsize // 8)
    return _array(context, builder, sig.return_type, address, [count])


@intrinsic
def _call(typing_context, address, fleet, count, index, n0, n1, n2):  # type: ignore[no-untyped-def]
    def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        function = ir.FunctionType(ir.VoidType(), [number.type for number in args[1:]]).as_pointer()
        builder.call(builder.inttoptr(args[0], function), args[1:])
        return context.get_dummy_value()

    return types.void(*[types.int64] * 7), generate


@overload(call_unit)
def _call_unit(address, fleet, count, index, n0, n1, n2):  # type: ignore[no-untyped-def]
    return lambda address, fleet, count, index, n0, n1, n2: _call(address, fleet, count, index, n0, n1, n2)


_READ, _SECOND_LEVEL, _DATA = 0, 2, 1
"""Of LLVM's prefetch: it is read, it goes to the second level of the caches, it is no code."""


@intrinsic
def _prefetch(typing_context, record, offset):  # type: ignore[no-untyped-def]
    def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        if not isinstance(context, CPUContext):  # a GPU has other vehicles to go on with while it waits
            return context.get_dummy_value()
        byte, number = ir.IntType(8).as_pointer(), ir.IntType(32)
        function = builder.module.declare_intrinsic(
            "llvm.prefetch", [byte], ir.FunctionType(ir.VoidType(), [byte, number, number, number])
        )
        address = builder.gep(builder.bitcast(args[0], byte), [args[1]])
        builder.call(function, [address, *(number(hint) for hint in (_READ, _SECOND_LEVEL, _DATA))])
        return context.get_dummy_value()

    return types.void(record, types.int64), generate


@overload(fetch_ahead)
def _fetch_ahead(record, offset):  # type: ignore[no-untyped-def]
    return lambda record, offset: _prefetch(record, offset)
