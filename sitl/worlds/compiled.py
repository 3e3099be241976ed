# SPDX-License-Identifier: BSD-3-Clause
"""Compiles functions on arrays, and keeps their machine code in the same folder as the core's.

A kernel is a law on arrays with a signature. Its machine code lies in a folder named after the fingerprint of all that
it reaches (``sitl.core.fingerprint``), so stale code cannot be loaded. With ``NUMBA_DISABLE_JIT=1`` it runs as plain
Python.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from types import ModuleType
from typing import Any

from ..core import compile as compiler
from ..core.fingerprint import fingerprint
from ..core.kernels import Unit, jit_disabled
from ..core.numba_tuning import quick

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
    key = fingerprint(unit, "", f"{compiler.toolchain()} {signature}")
    folder = compiler.cache_folder() / f"{wanted.name}-{key}"
    compiler.make_jitable()
    count = wanted.law.__code__.co_argcount
    names = ", ".join(f"a{k}" for k in range(count))
    try:
        folder.mkdir(parents=True, exist_ok=True)
        source = folder / "unit.py"
        if not source.exists():
            temporary = folder / f"unit.{os.getpid()}"
            temporary.write_text(
                f"# The entry of kernel {wanted.name}.\ndef {compiler.ENTRY}({names}):\n    return law({names})\n"
            )
            os.utime(temporary, (0, 0))
            os.replace(temporary, source)
    except OSError as error:
        raise compiler.BuildError(
            f"{folder}: {error.strerror}. Set SITL_CACHE_DIR to a folder that can be written"
        ) from None
    module = ModuleType("sitl_kernel_" + wanted.name.replace(".", "_"))
    sys.modules[module.__name__] = module  # Numba's cache looks the entry's module up by name
    vars(module)["law"] = wanted.law
    exec(compile(source.read_text(), str(source), "exec"), vars(module))
    before, numba.config.CACHE_DIR = numba.config.CACHE_DIR, str(folder)
    try:
        with quick(compiler.ENTRY):
            function = numba.njit([signature], cache=True, error_model="numpy")(vars(module)[compiler.ENTRY])
    finally:
        numba.config.CACHE_DIR = before
    (folder / "built").touch()
    return function  # type: ignore[no-any-return]
