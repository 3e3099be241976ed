# SPDX-License-Identifier: BSD-3-Clause
"""``constant_tables`` as Numba compiles them, for processors and GPUs. Importing this module needs Numba."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba.core import types
from numba.extending import lower_builtin, type_callable

from .constant_tables import TABLES

_known: set[Callable[[int], int | float]] = set()
_CONSTANT_SPACE = 4
"""Address space of constants on NVIDIA's GPUs."""


def make_known() -> None:
    """Let Numba compile look-ups in all tables that there are by now."""
    for row, numbers in TABLES.items():
        if row not in _known:
            _known.add(row)
            _register(row, numbers)


def _register(row: Callable[[int], int | float], numbers: tuple[int | float, ...]) -> None:
    kind = types.float64 if isinstance(numbers[0], float) else types.int64
    element = ir.DoubleType() if isinstance(numbers[0], float) else ir.IntType(64)
    array = ir.ArrayType(element, len(numbers))
    name = f"sitl_table_{len(_known)}"

    @type_callable(row)
    def _type(context: Any) -> Any:
        return lambda k: kind if isinstance(k, types.Integer) else None

    @lower_builtin(row, types.Integer)
    def _lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        module = builder.module
        space = _CONSTANT_SPACE if "nvptx" in module.triple else 0
        if name not in module.globals:
            made = ir.GlobalVariable(module, array, name, space)
            made.linkage, made.global_constant, made.unnamed_addr = "internal", True, True
            made.initializer = ir.Constant(array, [element(number) for number in numbers])
        index = context.cast(builder, args[0], sig.args[0], types.int64)
        return builder.load(builder.gep(module.globals[name], [ir.IntType(64)(0), index], inbounds=True))
