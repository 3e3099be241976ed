# SPDX-License-Identifier: BSD-3-Clause
"""Compiles functions on arrays, and keeps their machine code in the same folder as the core's.

A kernel is a law on arrays with a signature. Its machine code lies in a folder named after the fingerprint of all that
it reaches (``sitl.core.fingerprint``), so stale code cannot be loaded. With ``NUMBA_DISABLE_JIT=1`` it runs as plain
Python.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from .code_cache import ENTRY, cache_folder, load_entry
from .compile import make_jitable, toolchain
from .fingerprint import fingerprint
from .kernels import Unit, jit_disabled

KERNELS: dict[str, Kernel] = {}
Signature = str | Callable[[], Any]
"""Numba's text, or a function that makes Numba's signature: for arrays of records."""


class Kernel:
    """A law on arrays that the shell calls; compiled, or loaded from the cache, when it is called first."""

    def __init__(self, law: Callable[..., Any], signature: Signature) -> None:
        self.law = law
        self.name = law.__module__.removeprefix("sitl.") + "." + law.__name__
        self.signature = signature
        self._loaded: Callable[..., Any] | None = None
        KERNELS[self.name] = self

    def __call__(self, *arguments: Any) -> Any:
        return self.function()(*arguments)

    def function(self) -> Callable[..., Any]:
        """The compiled function itself, which is a little quicker to call."""
        if self._loaded is None:
            self._loaded = self.law if jit_disabled() else _load(self)
        return self._loaded


def kernel(signature: Signature) -> Callable[[Callable[..., Any]], Kernel]:
    """Mark a law on arrays as a kernel. ``signature``: as "void(f8[:,::1], f8[::1])", or a function that makes it."""
    return lambda law: Kernel(law, signature)


def _load(wanted: Kernel) -> Callable[..., Any]:
    import numba

    unit = Unit(wanted.name, wanted.law, 0)
    signature = wanted.signature if isinstance(wanted.signature, str) else wanted.signature()
    key = fingerprint(unit, "", f"{toolchain()} {signature}")
    folder = cache_folder() / f"{wanted.name}-{key}"
    make_jitable()
    names = ", ".join(f"a{k}" for k in range(wanted.law.__code__.co_argcount))
    source = f"# The entry of kernel {wanted.name}.\ndef {ENTRY}({names}):\n    return law({names})\n"
    module_name = "sitl_kernel_" + wanted.name.replace(".", "_")
    compile_entry = numba.njit([signature], cache=True, error_model="numpy")
    return load_entry(folder, module_name, source, {"law": wanted.law}, compile_entry)  # type: ignore[no-any-return]
