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
_EACH_CALL_OF_LLVM = "numba:llvm_lock"
"""An event that Numba tells, at each call of LLVM, to the timers of all laws that are being compiled."""


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
def quick(entry: str, machine_code: bool = True) -> Iterator[None]:
    """While it lasts, only libraries whose name contains ``entry`` are put together, optimised and become machine code.

    All that an entry calls is linked into it and optimised there, so that what Numba does for each law beforehand, for
    the sake of calls from Python, is done twice; of a law that calls others, as many times as there are callers above.

    Args:
        entry: part of a name.
        machine_code: without it, the entry's library holds all that it calls, as it was written.
    """
    restore = _skip_inner_work(entry, machine_code) if fits("quick") else None
    try:
        yield
    finally:
        if restore is not None:
            restore()


def _skip_inner_work(entry: str, machine_code: bool) -> Callable[[], None]:
    from numba.core import event
    from numba.core.codegen import CPUCodeLibrary
    from numba.core.cpu import CPUContext

    own_module = CPUCodeLibrary._get_module_for_linking
    finalize, executable = CPUCodeLibrary.finalize, CPUContext.get_executable
    start, end = event.start_event, event.end_event

    def finalize_entry_only(self: Any) -> None:
        self._raise_if_finalized()
        if entry in self.name:
            _link_all(self, own_module)
            if machine_code:
                self._linking_libraries = []
                finalize(self)
                return
        else:  # a caller that is compiled later takes all from it, as ever

            def whole() -> Any:
                del self._get_module_for_linking
                _link_all(self, own_module)
                self._shared_module = None
                return self._get_module_for_linking()

            self._get_module_for_linking = whole
        self._finalize_dynamic_globals()
        self._finalized = True

    def executable_of_entry_only(self: Any, library: Any, fndesc: Any, env: Any) -> Any:
        if machine_code and entry in library.name:
            return executable(self, library, fndesc, env)
        return [].append  # Numba keeps laws by their callables: it must be built in, and another one each time

    def start_if_asked(kind: Any, data: Any = None) -> None:
        if kind != _EACH_CALL_OF_LLVM:
            start(kind, data)

    def end_if_asked(kind: Any, data: Any = None, exc_details: Any = None) -> None:
        if kind != _EACH_CALL_OF_LLVM:
            end(kind, data, exc_details)

    CPUCodeLibrary.finalize, CPUContext.get_executable = finalize_entry_only, executable_of_entry_only
    event.start_event, event.end_event = start_if_asked, end_if_asked

    def restore() -> None:
        CPUCodeLibrary.finalize, CPUContext.get_executable = finalize, executable
        event.start_event, event.end_event = start, end

    return restore


def _link_all(library: Any, own_module: Callable[[Any], Any]) -> None:
    """Link what a library calls, and what that calls: each behind all that call it, because LLVM takes from a module
    what was asked for before."""
    found: set[int] = set()
    backwards: list[Any] = []

    def visit(called: Any) -> None:
        if id(called) not in found:
            found.add(id(called))
            for further in called._linking_libraries:
                visit(further)
            backwards.append(called)

    for called in library._linking_libraries:
        visit(called)
    for called in reversed(backwards):
        if hasattr(called, "_reload_init"):  # from Numba 0.63 on
            library._reload_init.update(called._reload_init)
        library._final_module.link_in(own_module(called), preserve=True)


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
