# SPDX-License-Identifier: BSD-3-Clause
"""Which internals of Numba and llvmlite the patches of ``numba_tuning`` need, and whether the Numba at hand has them.

Another release may rename an internal or give it another argument. Then the patch that uses it is left out: units are
compiled slower, and do the same.
"""

from __future__ import annotations

import importlib
import inspect
from typing import Any

OLDEST, NEXT = (0, 60), (0, 69)
"""Versions of Numba from the first on, before the second, are tried; pyproject.toml has the same."""

REPLACED = {
    "quick": {
        "numba.core.codegen:CPUCodeLibrary.finalize": 1,
        "numba.core.cpu:CPUContext.get_executable": 4,
        "numba.core.event:start_event": 2,
        "numba.core.event:end_event": 3,
    },
    "trust_laws": {"numba.core.callconv:CPUCallConv.call_function": 7},
}
"""Patch -> each method or function that it replaces, as module:name -> how many arguments Numba gives it, self
included."""

USED = {
    "quick": {
        "numba.core.codegen:CPUCodeLibrary._final_module": None,
        "numba.core.codegen:CPUCodeLibrary._finalize_dynamic_globals": 1,
        "numba.core.codegen:CPUCodeLibrary._get_module_for_linking": 1,
        "numba.core.codegen:CPUCodeLibrary._linking_libraries": None,
        "numba.core.codegen:CPUCodeLibrary._shared_module": None,
        "numba.core.codegen:CodeLibrary._finalized": None,
        "numba.core.codegen:CodeLibrary._raise_if_finalized": 1,
        "numba.core.codegen:CodeLibrary.name": None,
    },
    "trust_laws": {
        "numba.core.callconv:RETCODE_OK": None,
        "numba.core.callconv:BaseCallConv.context": None,
        "numba.core.callconv:CPUCallConv._get_excinfo_argument": 2,
        "numba.core.callconv:BaseCallConv._get_arg_packer": 2,
        "numba.core.callconv:CPUCallConv._get_return_status": 4,
        "numba.core.base:BaseContext.get_returned_value": 4,
        "numba.core.datamodel:ArgPacker.as_arguments": 3,
        "numba.core.types:Optional": None,
        "numba.core.types:none": None,
        "llvmlite.ir:Constant": 2,
        "llvmlite.ir:IRBuilder.goto_entry_block": 1,
        "llvmlite.ir:IRBuilder.alloca": 2,
        "llvmlite.ir:IRBuilder.load": 2,
        "llvmlite.ir:IRBuilder.call": 3,
        "llvmlite.ir:IRBuilder.function": None,
    },
}
"""Patch -> every name besides that it uses, where it is defined -> how many arguments it is given; None: it is no
function."""


def is_tried(version: str) -> bool:
    """Whether the patches were tried with this version of Numba."""
    parts = version.split(".")
    return (
        len(parts) > 1 and all(part.isdigit() for part in parts[:2]) and OLDEST <= (int(parts[0]), int(parts[1])) < NEXT
    )


def why_not(patch: str) -> str:
    """Why a patch cannot be made in the Numba at hand: an untried version, or what is missing; empty when it can."""
    import numba

    if not is_tried(numba.__version__):
        oldest, newest = f"{OLDEST[0]}.{OLDEST[1]}", f"{NEXT[0]}.{NEXT[1] - 1}"
        return f"Numba {numba.__version__} is not one of the tried versions, {oldest} to {newest}"
    for name, count in REPLACED[patch].items():
        if not _is_there(name, count, exactly=True):
            return f"Numba {numba.__version__} has no {name} of {count} arguments"
    for name, number in USED[patch].items():
        if not _is_there(name, number):
            return f"Numba {numba.__version__} has no {name}" + (f" of {number} arguments" if number else "")
    if patch == "trust_laws" and not _pointers_have_types():
        return "parameters of functions of llvmlite do not say what they point to"
    return ""


def fits(patch: str) -> bool:
    """Whether the Numba at hand was tried and has all that a patch uses."""
    return not why_not(patch)


def _is_there(name: str, count: int | None, exactly: bool = False) -> bool:
    """Whether a name is defined where it is expected, and takes ``count`` arguments, or ``exactly`` so many."""
    module, _, path = name.partition(":")
    try:
        found: Any = importlib.import_module(module)
        for part in path.split("."):
            if part not in vars(found) and part in vars(found)["__init__"].__code__.co_names:
                return True  # an attribute that each object gets when it is made
            found = vars(found)[part]
        if count is None:
            return True
        signature = inspect.signature(found)
        found_count = len(signature.parameters)
        signature.bind(*[None] * count)
    except (ImportError, KeyError, AttributeError, TypeError, ValueError):
        return False
    return found_count == count or not exactly


def _pointers_have_types() -> bool:
    """Whether the parameters of a function in LLVM's IR say what they point to."""
    from llvmlite import ir

    byte = ir.IntType(8)
    function = ir.Function(ir.Module(), ir.FunctionType(ir.VoidType(), [ir.PointerType(byte)]), "f")
    try:
        return bool(function.function_type.args[0].pointee == byte)  # attributes that each object gets when it is made
    except AttributeError:
        return False
