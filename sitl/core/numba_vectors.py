# SPDX-License-Identifier: BSD-3-Clause
"""How Numba sees the values of ``vectors``: a structure of doubles, with their operators as plain instructions.

Importing this module needs Numba; only ``compile`` does so, when something is compiled.
"""

from __future__ import annotations

import operator
from typing import Any

from llvmlite import ir
from numba.core import types
from numba.core.imputils import lower_constant
from numba.core.typing.templates import AbstractTemplate, infer, infer_global, signature
from numba.extending import (
    NativeValue,
    box,
    lower_builtin,
    make_attribute_wrapper,
    models,
    register_model,
    type_callable,
    typeof_impl,
    unbox,
)

from .vectors import VALUES, Value


class VectorType(types.Type):
    """Base of the Numba types of the values; each has a class of its own, which attribute access is bound to."""

    names: tuple[str, ...]
    cls: type[Value]

    def __init__(self) -> None:
        super().__init__(name=self.cls.__name__)


class VectorModel(models.StructModel):
    """One double a component."""

    def __init__(self, dmm: Any, fe_type: VectorType) -> None:
        super().__init__(dmm, fe_type, [(name, types.float64) for name in fe_type.names])


def _make(context: Any, builder: Any, kind: VectorType, numbers: list[Any]) -> Any:
    value = ir.Constant(context.get_value_type(kind), ir.Undefined)
    for k, number in enumerate(numbers):
        value = builder.insert_value(value, number, k)
    return value


def components(builder: Any, kind: VectorType, value: Any) -> list[Any]:
    """The doubles of a value, as instructions."""
    return [builder.extract_value(value, k) for k in range(len(kind.names))]


make_value = _make


def _register(cls: type[Value]) -> VectorType:
    kind = type(f"{cls.__name__}Type", (VectorType,), {"cls": cls, "names": cls.NAMES, "__module__": __name__})
    globals()[kind.__name__] = kind  # Numba pickles types by name
    register_model(kind)(VectorModel)
    for name in cls.NAMES:
        make_attribute_wrapper(kind, name, name)
    instance: VectorType = kind()
    count = len(cls.NAMES)

    def construct(context: Any) -> Any:
        def typer(*args: Any) -> Any:
            numbers = all(isinstance(a, types.Number | types.Boolean) for a in args)
            return instance if len(args) == count and numbers else None

        # Numba looks at the number of parameters of a typer.
        parameters = ", ".join(cls.NAMES)
        space = {"typer": typer}
        exec(f"def exact({parameters}):\n    return typer({parameters})", space)
        return space["exact"]

    type_callable(cls)(construct)

    def make(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        doubles = [context.cast(builder, a, t, types.float64) for a, t in zip(args, sig.args, strict=True)]
        return _make(context, builder, instance, doubles)

    lower_builtin(cls, *[types.Any] * count)(make)
    return instance


TYPES: dict[type[Value], VectorType] = {cls: _register(cls) for cls in VALUES}
"""Class of a value -> its Numba type."""


@typeof_impl.register(Value)
def _typeof(value: Any, context: Any) -> Any:
    return TYPES[type(value)]


@lower_constant(VectorType)
def _constant(context: Any, builder: Any, kind: VectorType, value: Any) -> Any:
    return _make(context, builder, kind, [context.get_constant(types.float64, number) for number in value])


@unbox(VectorType)
def _unbox(kind: VectorType, value: Any, c: Any) -> NativeValue:
    numbers = [c.pyapi.float_as_double(c.pyapi.tuple_getitem(value, k)) for k in range(len(kind.names))]
    return NativeValue(_make(c.context, c.builder, kind, numbers), is_error=c.pyapi.c_api_error())


@box(VectorType)
def _box(kind: VectorType, value: Any, c: Any) -> Any:
    cls = c.pyapi.unserialize(c.pyapi.serialize_object(kind.cls))
    numbers = [c.pyapi.float_from_double(part) for part in components(c.builder, kind, value)]
    boxed = c.pyapi.call_function_objargs(cls, numbers)
    for number in (cls, *numbers):
        c.pyapi.decref(number)
    return boxed


def _by_component(instruction: str) -> Any:
    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        kind = sig.return_type
        a, b = components(builder, kind, args[0]), components(builder, kind, args[1])
        return _make(context, builder, kind, [getattr(builder, instruction)(p, q) for p, q in zip(a, b, strict=True)])

    return lower


def _by_number(instruction: str, number_first: bool) -> Any:
    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        kind = sig.return_type
        number, vector = (0, 1) if number_first else (1, 0)
        k = context.cast(builder, args[number], sig.args[number], types.float64)
        parts = components(builder, kind, args[vector])
        apply = getattr(builder, instruction)
        return _make(context, builder, kind, [apply(k, p) if number_first else apply(p, k) for p in parts])

    return lower


class _SameKinds(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        if len(args) == 2 and isinstance(args[0], VectorType) and args[0] == args[1]:
            return signature(args[0], *args)
        return None


class _KindAndNumber(AbstractTemplate):
    number_may_be_first = False

    def generic(self, args: Any, kws: Any) -> Any:
        if len(args) != 2:
            return None
        a, b = args
        if isinstance(a, VectorType) and isinstance(b, types.Number):
            return signature(a, a, b)
        if self.number_may_be_first and isinstance(a, types.Number) and isinstance(b, VectorType):
            return signature(b, a, b)
        return None


class _Multiply(_KindAndNumber):
    number_may_be_first = True


class _Negate(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        return signature(args[0], *args) if isinstance(args[0], VectorType) else None


def _template(base: type, key: Any) -> None:
    infer_global(key)(type(f"{base.__name__}_{key.__name__}", (base,), {}))


_SUMS = ((operator.add, "fadd"), (operator.iadd, "fadd"), (operator.sub, "fsub"), (operator.isub, "fsub"))
for _key, _name in _SUMS:
    _template(_SameKinds, _key)
    lower_builtin(_key, VectorType, VectorType)(_by_component(_name))
_template(_Multiply, operator.mul)
lower_builtin(operator.mul, types.Number, VectorType)(_by_number("fmul", True))
for _key in (operator.imul, operator.truediv, operator.itruediv):
    _template(_KindAndNumber, _key)
for _key, _name in (
    (operator.mul, "fmul"), (operator.imul, "fmul"), (operator.truediv, "fdiv"), (operator.itruediv, "fdiv")
):  # fmt: skip
    lower_builtin(_key, VectorType, types.Number)(_by_number(_name, False))
_template(_Negate, operator.neg)


@lower_builtin(operator.neg, VectorType)
def _negate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    kind = sig.return_type
    return _make(context, builder, kind, [builder.fneg(p) for p in components(builder, kind, args[0])])


@infer
class _Component(AbstractTemplate):
    key = "static_getitem"

    def generic(self, args: Any, kws: Any) -> Any:
        value, index = args
        if isinstance(value, VectorType) and isinstance(index, int) and 0 <= index < len(value.names):
            return signature(types.float64, *args)
        return None


@lower_builtin("static_getitem", VectorType, types.Any)
def _component(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    return builder.extract_value(args[0], args[1])
