# SPDX-License-Identifier: BSD-3-Clause
"""Compiles units for NVIDIA GPUs, from the same laws: one thread advances one vehicle of an array of records.

No GPU is needed to compile: Numba translates laws to NVVM's language, NVVM makes PTX of it, and ``ptxas`` machine code.
All of them come with the extra ``cuda``. Products and sums are not fused to one rounding, so that arithmetic and square
roots have the bits of the CPU, and so have the sine and its like, which are made of these (``elementary``).
"""

from __future__ import annotations

import importlib.util
import re
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

from sitl.core.code_cache import BuildError
from sitl.core.compile import make_jitable, record_class
from sitl.core.kernels import UNITS
from sitl.core.numba_tuning import law_options
from sitl.core.records import Record
from sitl.core.vectors import Value
from sitl.errors import MissingExtra

Generation = tuple[int, int]
"""Compute capability of a GPU: (8, 0) A100, (9, 0) H100 and H200."""
CALLED_FROM = 60
"""Lines of NVVM's language from which on a law stays a call. If all were inlined, machine code would be five times as
long, and ``ptxas`` would work on it for more than ten minutes."""
_FNEG = re.compile(r"= fneg (float|double) ")
"""A word that NVVM's language does not have; the same number is what minus zero is without it."""
_known: set[Callable[..., None]] = set()
"""Units that device code can call."""


class Ptx(NamedTuple):
    """A kernel as PTX."""

    name: str
    """Of its entry."""
    text: str
    generation: Generation


class MachineCode(NamedTuple):
    """A kernel as machine code."""

    name: str
    cubin: bytes
    registers: int
    """Of a thread."""
    stack: int
    """Local memory of a thread [bytes]."""
    instructions: int
    """Length of the code, a 16 bytes each."""


def require() -> None:
    """numba-cuda is needed.

    Raises:
        MissingExtra: it is not installed.
    """
    if importlib.util.find_spec("numba_cuda") is None:
        raise MissingExtra("code for GPUs needs numba-cuda: pip install 'gym-sitl[cuda]'")


def modules_of(unit: Callable[..., None], path: str, generation: Generation = (9, 0)) -> tuple[str, list[str]]:
    """Name of the kernel's entry, and its modules in LLVM's language, the entry's first.

    Args:
        unit: takes ``(fleet, index, ticks)``.
        path: of the record type, ``package.module.NAME``.
        generation: of the GPU.

    Raises:
        MissingExtra: numba-cuda is not installed.
    """
    require()
    from numba import types
    from numba.cuda.compiler import compile_cuda, kernel_fixup

    from sitl.core.numba_records import numba_type

    from .gpu_kernel import kernel

    _make_known(unit)
    arguments = (types.Array(numba_type(record_class(path)), 1, "C"), types.int64)
    with _without_gpu(generation):
        made = compile_cuda(kernel(unit), types.void, arguments, nvvm_options={"opt": 3}, cc=generation)
        name = made.fndesc.llvm_func_name
        kernel_fixup(made.library.get_function(name), False)
        return name, [str(module) for module in made.library.modules]


def ptx_of(unit: Callable[..., None], path: str, generation: Generation = (9, 0)) -> Ptx:
    """The kernel of a unit as PTX; arguments and errors as of ``modules_of``."""
    name, modules = modules_of(unit, path, generation)
    from numba.cuda.cudadrv import nvvm

    major, minor = generation
    given = [_FNEG.sub(r"= fsub \1 -0.0, ", _with_calls(module, name)) for module in modules]
    text = nvvm.compile_ir(given, opt=3, fma=False, arch=f"compute_{major}{minor}")
    return Ptx(name, text.decode().strip("\x00").strip(), generation)


def assemble(ptx: Ptx) -> MachineCode:
    """Machine code of PTX.

    Raises:
        MissingExtra: there is no ``ptxas``.
        BuildError: it does not take this.
    """
    program = _ptxas()
    with tempfile.TemporaryDirectory(prefix="sitl-") as folder:
        source, out = Path(folder, "kernel.ptx"), Path(folder, "kernel.cubin")
        source.write_text(ptx.text)
        major, minor = ptx.generation
        command = [program, "-v", f"-arch=sm_{major}{minor}", "-o", str(out), str(source)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            raise BuildError(f"ptxas failed:\n{done.stderr[-2000:]}")
        cubin = out.read_bytes()
    registers, stack = re.search(r"Used (\d+) registers", done.stderr), re.search(r"(\d+) bytes cumul", done.stderr)
    return MachineCode(
        ptx.name, cubin, int(registers[1]) if registers else 0, int(stack[1]) if stack else 0, _code_length(cubin)
    )


def _code_length(cubin: bytes) -> int:
    """Instructions in the executable sections of an ELF file of 64 bits."""
    number = int.from_bytes
    table, size, count = number(cubin[40:48], "little"), number(cubin[58:60], "little"), number(cubin[60:62], "little")
    heads = [cubin[table + k * size : table + (k + 1) * size] for k in range(count)]
    return sum(number(head[32:40], "little") for head in heads if number(head[8:16], "little") & 4) // 16


def _ptxas() -> str:
    """Path of ``ptxas``: of the wheel that the extra brings, else of an installed CUDA toolkit."""
    spec = importlib.util.find_spec("nvidia")
    folders = list(spec.submodule_search_locations or ()) if spec is not None else []
    found = [str(path) for folder in folders for path in Path(folder).glob("*/bin/ptxas")]
    program = found[0] if found else shutil.which("ptxas")
    if program is None:
        raise MissingExtra("machine code for GPUs needs ptxas: pip install 'gym-sitl[cuda]', or NVIDIA's CUDA toolkit")
    return program


def _make_known(unit: Callable[..., None]) -> None:
    """Let device code use laws, vectors and units: on a device a unit is a law, there are no symbols to link to."""
    from numba.cuda.extending import typeof_impl
    from numba.cuda.typing.enumdecl import EnumClassAttribute
    from numba.extending import overload

    make_jitable()
    from sitl.core.numba_enums import _Members
    from sitl.core.numba_records import _typeof_class
    from sitl.core.numba_vectors import _typeof

    if not _known:
        typeof_impl.register(Value)(_typeof)
        EnumClassAttribute.generic_resolve = _Members.generic_resolve  # numba-cuda has templates of its own
        typeof_impl.register(type(Record))(_typeof_class)
    for function in {*(known.function for known in UNITS.values()), unit} - _known:
        _known.add(function)
        overload(function, jit_options=law_options(), strict=False, target="cuda")(_giving(function))


def _giving(function: Callable[..., None]) -> Any:
    """What Numba asks, with types, for the function to compile."""

    def given(*types: Any) -> Callable[..., None]:
        return function

    return given


def _with_calls(module: str, kernel: str) -> str:
    """A module whose long function, but for the kernel, is not inlined."""
    start = module.find("\ndefine ")
    end = module.find("\n}", start)
    line_end = module.find("\n", start + 1)
    head = module[start:line_end]
    if start < 0 or kernel in head or "alwaysinline" in head or module.count("\n", start, end) < CALLED_FROM:
        return module
    return module[:line_end] + " noinline" + module[line_end:]


@contextmanager
def _without_gpu(generation: Generation) -> Iterator[None]:
    """numba-cuda compiles for a GPU of this generation, whether there is one or not, and takes each module once: left
    alone it takes a module as often as ways lead to it, thousands of times."""
    from numba.cuda import dispatcher
    from numba.cuda.codegen import CUDACodeLibrary

    def modules(self: Any) -> list[Any]:
        todo, found = [self], {}
        while todo:
            library = todo.pop()
            if id(library) not in found:
                found[id(library)] = library._module
                todo.extend(library._linking_libraries)
        return list(found.values())

    before = dispatcher.get_current_device, CUDACodeLibrary.modules
    dispatcher.get_current_device = lambda: SimpleNamespace(compute_capability=generation)
    CUDACodeLibrary.modules = property(modules)
    try:
        yield
    finally:
        dispatcher.get_current_device, CUDACodeLibrary.modules = before
