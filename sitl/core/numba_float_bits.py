# SPDX-License-Identifier: BSD-3-Clause
"""``float_bits`` as Numba compiles it, for processors and GPUs. Importing this module needs Numba."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba.core import types
from numba.extending import lower_builtin, type_callable

from .float_bits import bits_float, float_bits


@type_callable(float_bits)
def _type_of_bits(context: Any) -> Any:
    return lambda value: types.int64 if value == types.float64 else None


@type_callable(bits_float)
def _type_of_float(context: Any) -> Any:
    return lambda bits: types.float64 if isinstance(bits, types.Integer) else None


@lower_builtin(float_bits, types.float64)
def _lower_bits(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    return builder.bitcast(args[0], ir.IntType(64))


@lower_builtin(bits_float, types.Integer)
def _lower_float(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    return builder.bitcast(context.cast(builder, args[0], sig.args[0], types.int64), ir.DoubleType())
