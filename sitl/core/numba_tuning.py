# SPDX-License-Identifier: BSD-3-Clause
"""Makes Numba compile a unit without work that is thrown away; what the unit does is the same, to the last bit.

Numba is built for functions that Python calls one by one: of every law that a unit contains it makes machine code and
wrappers for Python and for C. Of a unit only the entry is ever called. What is switched off here reaches into Numba's
internals, so a patch is made only in a Numba of the versions that were tried that has every name which the patch uses
(``numba_internals``); else compilation is slower, and nothing else changes. ``summary`` says which it is.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import Any

from .numba_internals import REPLACED, fits, why_not

_NO_WRAPPERS = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}


TRUST = "laws do not fail"
"""Machine code made with ``trust_laws`` depends on it."""

COMMON: dict[str, Any] = {"error_model": "numpy", "_nrt": False}
"""Compiler options of laws and kernels: IEEE division instead of Python's exception, and no counts of references to
arrays. Laws do not allocate, and the shell holds all arrays; a count is an atomic instruction."""


def law_options(inline: bool = False) -> dict[str, Any]:
    """Compiler options of laws: ``COMMON``, and no wrappers.

    Without a word on inlining, a law would take it from the law inside which it is compiled first.
    """
    return {**COMMON, **_NO_WRAPPERS, "forceinline": inline}


def summary() -> str:
    """How units are compiled with the Numba at hand, in words."""
    import numba

    reasons = dict.fromkeys(reason for patch in REPLACED if (reason := why_not(patch)))
    if not reasons:
        return f"Numba {numba.__version__}: all that speeds up compiling is on"
    return f"compiling takes longer, and results are the same: {'; '.join(reasons)}"


@contextlib.contextmanager
def quick(entry: str) -> Iterator[None]:
    """While it lasts, only code of libraries whose name contains ``entry`` is optimised as a whole and becomes machine
    code.

    All that an entry calls is linked into it and optimised there, so that what Numba does for each law beforehand, for
    the sake of calls from Python, is done twice; of a law that calls others, as many times as there are callers above.
    """
    restore = _skip_inner_work(entry) if fits("quick") else None
    try:
        yield
    finally:
        if restore is not None:
            restore()


def _skip_inner_work(entry: str) -> Callable[[], None]:
    from numba.core.codegen import CPUCodeLibrary
    from numba.core.cpu import CPUContext

    optimise, finalize = CPUCodeLibrary._optimize_final_module, CPUCodeLibrary._finalize_final_module
    executable = CPUContext.get_executable

    def optimise_entry_only(self: Any) -> None:
        if entry in self.name:
            optimise(self)

    def finalize_entry_only(self: Any) -> None:
        if entry in self.name:
            finalize(self)
        else:  # IR is all that the caller links
            self._finalize_dynamic_globals()
            self._finalized = True

    def executable_of_entry_only(self: Any, library: Any, fndesc: Any, env: Any) -> Any:
        if entry in library.name:
            return executable(self, library, fndesc, env)
        return [].append  # Numba keeps laws by their callables: it must be built in, and another one each time

    CPUCodeLibrary._optimize_final_module = optimise_entry_only
    CPUCodeLibrary._finalize_final_module = finalize_entry_only
    CPUContext.get_executable = executable_of_entry_only

    def restore() -> None:
        CPUCodeLibrary._optimize_final_module = optimise
        CPUCodeLibrary._finalize_final_module = finalize
        CPUContext.get_executable = executable

    return restore


@contextlib.contextmanager
def trust_laws() -> Iterator[None]:
    """While it lasts, a call of a law is compiled without the check whether it raised something, and without clearing
    the memory for its result beforehand.

    Laws raise nothing, and in the core this was a fiftieth of all instructions.
    """
    restore = _compile_unchecked_calls() if fits("trust_laws") else None
    try:
        yield
    finally:
        if restore is not None:
            restore()


def _compile_unchecked_calls() -> Callable[[], None]:
    from llvmlite import ir
    from numba.core import types
    from numba.core.callconv import RETCODE_OK, CPUCallConv

    original = CPUCallConv.call_function

    def call(self: Any, builder: Any, callee: Any, result: Any, kinds: Any, args: Any, attrs: Any = None) -> Any:
        caller, optional = builder.function, isinstance(result, types.Optional)  # type: ignore[attr-defined]
        # Whether an optional result is None is said in what is not looked at here.
        if optional or callee.name.startswith("_ZN5numba") or not caller.name.startswith(("_ZN", "cfunc.")):
            return original(self, builder, callee, result, kinds, args, attrs)
        to_result, to_failure = callee.function_type.args[:2]
        with builder.goto_entry_block():
            address = builder.alloca(to_result.pointee)
            is_entry = caller.name.startswith("cfunc.")
            failure = builder.alloca(to_failure.pointee) if is_entry else self._get_excinfo_argument(caller)
        given = self._get_arg_packer(kinds).as_arguments(builder, args)
        builder.call(callee, [address, failure, *given], attrs=() if attrs is None else attrs)
        status = self._get_return_status(builder, RETCODE_OK, ir.Constant(to_failure.pointee, None))
        value = ir.Constant(to_result.pointee, None) if result is types.none else builder.load(address)
        return status, self.context.get_returned_value(builder, result, value)

    CPUCallConv.call_function = call
    return lambda: setattr(CPUCallConv, "call_function", original)
