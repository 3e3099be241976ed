# SPDX-License-Identifier: BSD-3-Clause
"""How Numba compiles ``system_call.call_system``."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic, overload

from .system_call import call_system


@intrinsic
def _call(typing_context, address, n0, n1, n2, n3, n4):  # type: ignore[no-untyped-def]
    def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        function = ir.FunctionType(ir.IntType(32), [number.type for number in args[1:]]).as_pointer()
        result = builder.call(builder.inttoptr(args[0], function), args[1:])
        return builder.sext(result, ir.IntType(64))

    return types.int64(*[types.int64] * 6), generate


@overload(call_system)
def _call_system(address, n0, n1, n2, n3, n4):  # type: ignore[no-untyped-def]
    return lambda address, n0, n1, n2, n3, n4: _call(address, n0, n1, n2, n3, n4)
