# SPDX-License-Identifier: BSD-3-Clause
"""Compiles functions on arrays, and keeps their machine code in the same folder as the core's.

A kernel is a law on arrays; it is compiled for the types of its annotations. Its machine code lies in a folder named
after the fingerprint of all that it reaches (``sitl.core.fingerprint``), so stale code cannot be loaded. With
``NUMBA_DISABLE_JIT=1`` it runs as plain Python.
"""

from __future__ import annotations

import importlib
import time
from collections.abc import Callable, Iterable, Iterator
from functools import cached_property, partial
from pathlib import Path
from typing import Annotated, Any, Generic, NamedTuple, ParamSpec, TypeVar, get_args, get_origin, get_type_hints

from .code_cache import ENTRY, build_lock, cache_folder, is_built, load_entry
from .compile import Progress, compile_tasks, make_jitable, toolchain
from .fingerprint import fingerprint
from .kernels import Unit, jit_disabled
from .numba_tuning import COMMON
from .order import KERNELS_PATH, Order
from .records import FloatRows, Floats, IntRows, Ints, Record, Records
from .shipped import library as shipped
from .shipped.calls import Calls
from .shipped.identity import identity
from .shipped.signature import described, records_of
from .vectors import Value

KERNELS: dict[str, Kernel[..., Any]] = {}
P = ParamSpec("P")
R = TypeVar("R")


class Layout(NamedTuple):
    """How an array of numbers lies in memory."""

    code: str
    """NumPy's code of one number."""
    axes: int
    order: str = "C"
    """"C": in one piece, row by row; "A": any."""


Line = Annotated[Floats, Layout("f8", 1)]
"""Floats, shape (n,)."""
Table = Annotated[FloatRows, Layout("f8", 2)]
"""Floats, shape (m, n)."""
NarrowLine = Annotated[Floats, Layout("f4", 1)]
"""Floats at float32 precision, shape (n,)."""
NarrowTable = Annotated[FloatRows, Layout("f4", 2)]
"""Floats at float32 precision, shape (m, n)."""
ByteLine = Annotated[Ints, Layout("u1", 1)]
"""Bytes, shape (n,)."""
IntLine = Annotated[Ints, Layout("i8", 1)]
"""Integers, shape (n,)."""
IntTable = Annotated[IntRows, Layout("i8", 2)]
"""Integers, shape (m, n)."""
IntColumn = Annotated[Ints, Layout("i8", 1, "A")]
"""Integers, shape (n,), of every record of a fleet."""
Flags = Annotated[Ints, Layout("b1", 1)]
"""Booleans, shape (n,)."""


class Kernel(Generic[P, R]):
    """A law on arrays that the shell calls; compiled, or loaded from the cache, when it is called first.

    Args:
        law: on arrays and numbers.
        lets_others_run: it takes long: other threads of Python run meanwhile.
    """

    def __init__(self, law: Callable[P, R], lets_others_run: bool = False) -> None:
        self.law, self.lets_others_run = law, lets_others_run
        self.name = law.__module__.removeprefix("sitl.") + "." + law.__name__
        self._loaded: Callable[P, R] | None = None
        self._entry: Callable[P, R] | None = None
        KERNELS[self.name] = self

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        return (self._loaded or self.function())(*args, **kwargs)

    def function(self) -> Callable[P, R]:
        """The compiled function itself, which is a little quicker to call."""
        if self._loaded is None:
            if jit_disabled():
                self._loaded = self.law
            else:
                self._loaded = _load(self) if self._shipped is None else self._shipped.checked
        return self._loaded

    def unchecked(self) -> Callable[P, R]:
        """The same, without a look at the types of the arguments, which must be those of the signature: the quickest to
        call."""
        if self._entry is None:
            function: Any = self.function()
            if jit_disabled():
                self._entry = function
            elif self._shipped is not None:
                self._entry = self._shipped.unchecked
            else:
                self._entry = next(iter(function.overloads.values())).entry_point
        assert self._entry is not None
        return self._entry

    @property
    def is_loaded(self) -> bool:
        """Whether a call runs at once: nothing is compiled or loaded first."""
        return self._entry is not None

    def bind(self, *arguments: Any) -> Callable[..., R]:
        """The compiled function with its first arguments, which stay in place: their types are looked at once, so that
        a call is quick. The types of arguments that a call adds are not looked at.

        Raises:
            TypeError: the types are not those of the signature.
        """
        function: Any = self.function()
        if not jit_disabled():
            if self._shipped is not None:
                return self._shipped.bind(*arguments)
            from numba import typeof

            types, given = function.signatures[0], tuple(map(typeof, arguments))
            if not all(map(_fits, given, types)):
                raise TypeError(f"{self.name} takes {types}, not {given}")
        call: Any = self.unchecked()
        return partial(call, *arguments)

    @cached_property
    def _shipped(self) -> Calls | None:
        """The machine code that came with the package; None: there is none of this source."""
        library = shipped.library()
        if library is None or not is_shipped(self):
            return None
        return Calls(library, self.name, self.law, self.lets_others_run)


def _fits(given: Any, wanted: Any) -> bool:
    """Whether a value of Numba's type ``given`` may be handed over as one of type ``wanted`` without a conversion."""
    if hasattr(wanted, "types") and hasattr(given, "types"):
        return len(given.types) == len(wanted.types) and all(map(_fits, given.types, wanted.types))
    if getattr(wanted, "layout", "") == "A":
        given = given.copy(layout="A") if hasattr(given, "layout") else given
    return bool(given == wanted)


def _signature(law: Callable[..., Any]) -> Any:
    """Numba's signature of a law's annotations."""
    hints = get_type_hints(law, include_extras=True)
    result = hints.pop("return")
    return numba_type_of(result)(*map(numba_type_of, hints.values()))


def numba_type_of(hint: Any) -> Any:
    """Numba's type of an annotation."""
    from numba import types

    from .numba_records import numba_type
    from .numba_vectors import TYPES

    numbers = {float: types.float64, int: types.int64, bool: types.boolean, type(None): types.void}
    if hint in numbers:
        return numbers[hint]
    if get_origin(hint) is Annotated:
        _, layout = get_args(hint)
        codes = {"f8": types.float64, "f4": types.float32, "i8": types.int64, "b1": types.boolean, "u1": types.uint8}
        return types.Array(codes[layout.code], layout.axes, layout.order)
    if get_origin(hint) is Records:
        return types.Array(numba_type(get_args(hint)[0]), 1, "C")
    if issubclass(hint, Value):
        return TYPES[hint]
    return types.BaseTuple.from_types(
        [numba_type_of(part) for part in get_type_hints(hint, include_extras=True).values()], hint
    )


def _records(types: Any) -> Iterator[type[Record]]:
    """Of the arrays in a signature."""
    from .numba_records import CLASSES

    for kind in types:
        if hasattr(kind, "instance_class"):
            yield from _records(kind.types)
        elif (name := getattr(getattr(kind, "dtype", None), "name", None)) in CLASSES:
            yield CLASSES[name]


def _folder(kernel: Kernel[..., Any], signature: Any) -> Path:
    """Where the kernel's current machine code is or will be."""
    made_by = f"{toolchain()} {signature} {kernel.lets_others_run}"
    key = fingerprint(unit_of(kernel), _records(signature.args), made_by)
    return cache_folder() / f"{kernel.name}-{key}"


def unit_of(kernel: Kernel[..., Any]) -> Unit:
    return Unit(kernel.name, kernel.law, 0)


def kernel_identity(kernel: Kernel[..., Any]) -> str:
    """Hash of the kernel's sources; the same on every machine."""
    return identity(unit_of(kernel), described(kernel.law), records_of(kernel.law))


def is_shipped(kernel: Kernel[..., Any]) -> bool:
    """Whether the machine code of the kernel's present source came with the package."""
    return shipped.is_shipped(kernel.name, lambda: kernel_identity(kernel))


def kernels_of(modules: Iterable[str]) -> dict[str, Kernel[..., Any]]:
    """ "MODULE:NAME" -> a kernel that one of these modules makes, or takes from elsewhere: once each."""
    found: dict[Kernel[..., Any], str] = {}
    for module in modules:
        for made in vars(importlib.import_module(module)).values():
            if isinstance(made, Kernel):
                found.setdefault(made, f"{module}:{made.name}")
    return {task: kernel for kernel, task in found.items()}


def missing_kernels(modules: Iterable[str]) -> dict[str, Kernel[..., Any]]:
    """ "MODULE:NAME" -> a kernel that one of these modules makes, and whose present source has no machine code."""
    return {
        task: kernel
        for task, kernel in kernels_of(modules).items()
        if not is_shipped(kernel) and not is_built(_folder(kernel, _signature(kernel.law)))
    }


def build_kernels(modules: Iterable[str], progress: Progress | None = None) -> float:
    """Compile the kernels of these modules that miss in the cache, side by side; returns the seconds.

    A kernel compiles itself when it is called first; this is for doing it beforehand.

    Raises:
        BuildError: one failed to compile.
    """
    start = time.monotonic()
    with build_lock():
        units = {task: unit_of(kernel) for task, kernel in missing_kernels(modules).items()}
        compile_tasks(units, Order(KERNELS_PATH), progress)
    return time.monotonic() - start


def _load(wanted: Kernel[..., Any]) -> Callable[..., Any]:
    import numba

    signature = _signature(wanted.law)
    folder = _folder(wanted, signature)
    make_jitable()
    names = ", ".join(f"a{k}" for k in range(wanted.law.__code__.co_argcount))
    source = f"# The entry of kernel {wanted.name}.\ndef {ENTRY}({names}):\n    return law({names})\n"
    module_name = "sitl_kernel_" + wanted.name.replace(".", "_")
    compile_entry = numba.njit([signature], cache=True, nogil=wanted.lets_others_run, **COMMON)
    return load_entry(folder, module_name, source, {"law": wanted.law}, compile_entry)  # type: ignore[no-any-return]
