# SPDX-License-Identifier: BSD-3-Clause
"""Entries of kernels that Python calls as it calls functions written in C: several times as quick as by ctypes.

They are made with the library, for no version of Python: what they need of it are functions of its stable interface,
whose addresses the library gets when it is loaded (``TABLE``).
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir

from .library import PYTHON, TABLE, call_symbol
from .signature import HEADER, NUMBERS, hints_of, leaves

_WORD, _DOUBLE, _LONG, _BYTE = ir.IntType(64), ir.DoubleType(), ir.IntType(32), ir.IntType(8)


def entry_for_python(symbol: str, law: Any) -> str:
    """LLVM's text of the entry that Python calls.

    Args:
        symbol: of the kernel.
        law: what the kernel is made of.
    """
    arguments, result = hints_of(law)
    kinds: list[Any] = [leaf for hint in arguments for _, leaf in leaves(hint)]
    if result not in (*NUMBERS, type(None)):
        kinds.append("result")
    module = ir.Module(symbol)
    table = ir.GlobalVariable(module, ir.ArrayType(_WORD, len(PYTHON)), TABLE)
    returned = {float: _DOUBLE, int: _WORD, bool: _BYTE}.get(result, ir.VoidType())
    takes = [{float: _DOUBLE, bool: _BYTE}.get(kind, _WORD) for kind in kinds]
    kernel = ir.Function(module, ir.FunctionType(returned, takes), symbol)
    entry = ir.Function(module, ir.FunctionType(_WORD, [_WORD, _WORD.as_pointer(), _WORD]), call_symbol(symbol))
    builder = ir.IRBuilder(entry.append_basic_block())

    def python(name: str, of: Any, *given: Any) -> Any:
        """Call a function of Python's."""
        address = builder.gep(table, [_LONG(0), _LONG(list(PYTHON).index(name))])
        kind = ir.FunctionType(of, [value.type for value in given])
        return builder.call(builder.inttoptr(builder.load(address), kind.as_pointer()), given)

    with builder.if_then(builder.icmp_signed("!=", entry.args[2], _WORD(len(kinds))), likely=False):
        python("PyErr_BadArgument", _LONG)
        builder.ret(_WORD(0))
    values = []
    for k, kind in enumerate(kinds):
        value = builder.load(builder.gep(entry.args[1], [_WORD(k)]))
        if kind is float:
            value = python("PyFloat_AsDouble", _DOUBLE, value)
        elif kind is int:
            value = python("PyLong_AsLongLong", _WORD, value)
        elif kind is bool:
            value = builder.trunc(python("PyObject_IsTrue", _LONG, value), _BYTE)
        elif kind == "result":
            data = builder.inttoptr(builder.add(value, _WORD(HEADER)), _WORD.as_pointer())
            value = builder.load(data)
        values.append(value)
    if any(kind in NUMBERS for kind in kinds if isinstance(kind, type)):
        with builder.if_then(builder.icmp_signed("!=", python("PyErr_Occurred", _WORD), _WORD(0)), likely=False):
            builder.ret(_WORD(0))
    found = builder.call(kernel, values)
    if result is float:
        builder.ret(python("PyFloat_FromDouble", _WORD, found))
    elif result is int:
        builder.ret(python("PyLong_FromLongLong", _WORD, found))
    elif result is bool:
        builder.ret(python("PyBool_FromLong", _WORD, builder.zext(found, _WORD)))
    else:
        nothing = builder.load(builder.gep(table, [_LONG(0), _LONG(len(PYTHON) - 1)]))
        builder.ret(python("Py_BuildValue", _WORD, nothing))
    return str(module)
