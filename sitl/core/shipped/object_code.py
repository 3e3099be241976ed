# SPDX-License-Identifier: BSD-3-Clause
"""Units and kernels as object code for any target, by Numba's compiler and LLVM.

Numba translates an entry with all its laws once; LLVM then optimises that for each target. Importing this module needs
Numba.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from typing import Any

import llvmlite
import llvmlite.binding as llvm
import numba
from llvmlite import ir
from numba import types
from numba.core import config
from numba.core.ccallback import CFunc
from numba.core.codegen import _parse_refprune_flags
from numba.core.compiler_lock import global_compiler_lock
from numba.core.llvm_bindings import create_pass_builder
from numba.extending import intrinsic
from numba.np.arrayobj import make_array, populate_array

from ..array_kernels import KERNELS, Kernel, kernel_identity, numba_type_of
from ..code_cache import ENTRY
from ..compile import ENTRY_OPTIONS, entry_of, make_jitable, symbol, unit_identity
from ..kernels import UNITS, Unit
from ..numba_tuning import COMMON, quick, trust_laws
from ..order import KERNELS_PATH
from .library import PYTHON, SLOT, TABLE, call_symbol, kernel_symbol, own_symbol
from .objects import Objects
from .python_calls import entry_for_python
from .signature import HEADER, NUMBERS, hints_of, leaves, put_together
from .target_machines import Target

_OPTIMISE = 3
_NUMBERS = {float: types.float64, int: types.int64, bool: types.boolean}


class Translated:
    """An entry and all its laws in LLVM's language, not optimised yet."""

    def __init__(self, symbol: str, code: str, text: str, entry: str) -> None:
        self.symbol = symbol
        """By which others call it."""
        self._code, self._text, self._entry = code, text, entry

    def compiled(self, target: Target) -> tuple[bytes, bytes]:
        """Its object file for a target, and LLVM's code (bitcode) that it was made from."""
        machine = machine_of(target)
        module = llvm.parse_assembly(self._text)
        module.name = self._code
        module.triple, module.data_layout = target.triple, str(machine.target_data)
        for part in (*module.functions, *module.global_variables):
            if part.is_declaration:
                continue
            if part.name == self._entry:
                part.linkage, part.name = llvm.Linkage.external, self._code
            else:
                part.linkage = llvm.Linkage.internal
        for cost in ("cheap", "full"):
            _optimise(module, machine, cost)
        module.verify()
        return bytes(machine.emit_object(module)), bytes(module.as_bitcode())


def machine_of(target: Target) -> Any:
    """LLVM's description of a target."""
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    found = llvm.Target.from_triple(target.triple)
    return found.create_target_machine(cpu=target.cpu, features="", opt=_OPTIMISE, reloc="pic", codemodel="default")


def _optimise(module: Any, machine: Any, cost: str) -> None:
    """As Numba does: first with little effort, so that much is compiled into its callers."""
    cheap = cost == "cheap"
    level = {"opt": 0} if cheap else {"opt": _OPTIMISE, "loop_vectorize": True, "slp_vectorize": config.SLP_VECTORIZE}
    builder = create_pass_builder(machine, **level)
    passes = builder.getModulePassManager()
    if cheap:
        passes.add_loop_rotate_pass()
        passes.add_instruction_combine_pass()
        passes.add_jump_threading_pass()
    if config.LLVM_REFPRUNE_PASS:
        passes.add_refprune_pass(_parse_refprune_flags())
    passes.run(module, builder)


def translate_unit(unit: Unit, path: str) -> Translated:
    """A unit for the record type at ``path``."""
    source, names, signature = entry_of(unit, path)
    name = symbol(unit, path)
    made: Translated = _translate(name, own_symbol(name), source, names, signature, ENTRY_OPTIONS)
    return made


def translate_kernel(kernel: Kernel[..., Any]) -> Translated:
    """A kernel, with an entry that takes its arguments as ``signature.py`` says."""
    make_jitable()
    arguments, result = hints_of(kernel.law)
    names: dict[str, Any] = {"law": kernel.law, "int64": types.int64}
    given: list[str] = []
    kinds: list[Any] = []
    expressions: list[str] = []
    for hint in arguments:
        mine: list[str] = []
        for (_, leaf), kind in zip(leaves(hint), _array_kinds(hint), strict=True):
            name = f"a{len(given)}"
            given.append(name)
            if leaf in NUMBERS:
                kinds.append(_NUMBERS[leaf])  # type: ignore[index]
                mine.append(name)
            else:
                names[f"array_{name}"] = _array_of(kind)
                kinds.append(types.int64)
                mine.append(f"array_{name}({name})")
        expressions.append(put_together(hint, iter(mine), names))
    call = f"law({', '.join(expressions)})"
    body, returned = f"return {call}", types.void
    if result in NUMBERS:
        returned = _NUMBERS[result]
    elif result is not type(None):
        given.append("result")
        kinds.append(types.CPointer(types.float64))
        stores = [f"result[{k}] = found{part}" for k, (part, _) in enumerate(leaves(result))]
        body = "\n    ".join((f"found = {call}", *stores))
    else:
        body = call
    source = f"def {ENTRY}({', '.join(given)}):\n    {body}\n"
    options = {**COMMON, "forceinline": True}
    name = kernel_symbol(kernel.name)
    made: Translated = _translate(name, name, source, names, returned(*kinds), options)
    return made


def _array_kinds(hint: Any) -> Iterator[Any]:
    """Numba's types of the leaves of a value; None for numbers."""
    kind = numba_type_of(hint)

    def inside(kind: Any) -> Iterator[Any]:
        if isinstance(kind, types.Array):
            yield kind
        elif isinstance(kind, types.BaseTuple):
            for part in kind.types:
                yield from inside(part)
        else:
            yield from [None] * len(getattr(kind, "names", (None,)))

    return inside(kind)


def _array_of(kind: Any) -> Any:
    """What makes the address of NumPy's object the array that laws know; its fields are where NumPy's macros for
    C find them, in every version: address of the data, number of axes, address of the shape, of the strides."""

    @intrinsic
    def array_of(typing_context, address):  # type: ignore[no-untyped-def]
        def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
            word = ir.IntType(64)
            fields = builder.inttoptr(builder.add(args[0], word(HEADER)), word.as_pointer())

            def numbers(field: int) -> list[Any]:
                start = builder.inttoptr(builder.load(builder.gep(fields, [word(field)])), word.as_pointer())
                return [builder.load(builder.gep(start, [word(k)])) for k in range(kind.ndim)]

            array = make_array(kind)(context, builder)
            data = builder.inttoptr(builder.load(fields), array.data.type)
            size = context.get_abi_sizeof(context.get_data_type(kind.dtype))
            populate_array(
                array, data=data, shape=numbers(2), strides=numbers(3),
                itemsize=context.get_constant(types.intp, size), meminfo=None,
            )  # fmt: skip
            return array._getvalue()

        return kind(types.int64), generate

    return array_of


@global_compiler_lock
def _translate(
    name: str, code: str, source: str, names: dict[str, Any], signature: Any, options: dict[str, Any]
) -> Translated:
    space = {"__name__": name, **names}
    exec(compile(source, f"<{name}>", "exec"), space)
    made: Any = CFunc(space[ENTRY], (signature.args, signature.return_type), {}, options)
    with quick(ENTRY, machine_code=False), trust_laws():
        result = made._compile_uncached()
        if not result.library._finalized:
            result.library.finalize()
    text = str(result.library._final_module)
    return Translated(name, code, text, result.fndesc.llvm_cfunc_wrapper_name)


def switch(unit_symbol: str, integers: int, target: Target) -> bytes:
    """Object code of the function that other units call: it goes on to the unit itself, or to another one that was
    compiled since, whose address was written into its slot."""
    arguments = ", ".join(f"i64 %a{k}" for k in range(3 + integers))
    text = f"""
        declare void @"{own_symbol(unit_symbol)}"({arguments})
        @"{unit_symbol}{SLOT}" = global ptr @"{own_symbol(unit_symbol)}"
        define void @"{unit_symbol}"({arguments}) {{
            %to = load ptr, ptr @"{unit_symbol}{SLOT}"
            tail call void %to({arguments})
            ret void
        }}"""
    return _assembled(text, unit_symbol, target)


def call_from_python(kernel: Kernel[..., Any], target: Target) -> bytes:
    """Object code of the entry of a kernel that Python calls."""
    name = kernel_symbol(kernel.name)
    return _assembled(entry_for_python(name, kernel.law), call_symbol(name), target)


def table_for_python(target: Target) -> bytes:
    """Object code of the table that such entries need."""
    return _assembled(f"@{TABLE} = global [{len(PYTHON)} x i64] zeroinitializer", TABLE, target)


def constant(name: str, content: bytes, target: Target) -> bytes:
    """Object code that holds bytes, ended by a zero, under a name."""
    written = "".join(f"\\{byte:02x}" for byte in content + b"\0")
    return _assembled(f'@"{name}" = constant [{len(content) + 1} x i8] c"{written}"', name, target)


def _assembled(text: str, name: str, target: Target) -> bytes:
    machine = machine_of(target)
    module = llvm.parse_assembly(text)
    module.name, module.triple, module.data_layout = name, target.triple, str(machine.target_data)
    module.verify()
    return bytes(machine.emit_object(module))


def stub(names: Iterable[str], target: Target) -> bytes:
    """Object code that has functions of these names, which do nothing."""
    return _assembled("\n".join(f"define void @{name}() {{ ret void }}" for name in names), "stub", target)


_ROUNDING = """
    define double @{name}(double %x) {{
        %size = call double @llvm.fabs.f64(double %x)
        %small = fcmp olt double %size, 0x4330000000000000 ; 2^52: from there on, and if it is no number, x itself
        br i1 %small, label %round, label %same
      round:
        {steps}
        %signed = call double @llvm.copysign.f64(double %right, double %x)
        ret double %signed
      same:
        ret double %x
    }}
    declare double @llvm.fabs.f64(double)
    declare double @llvm.copysign.f64(double, double)
"""
_CUT = """
        %whole = fptosi double %x to i64
        %towards = sitofp i64 %whole to double
        %over = fcmp {beyond} double %towards, %x
        %one = select i1 %over, double {step}, double 0.0
        %right = fadd double %towards, %one
"""
_TO_EVEN = """
        %big = call double @llvm.copysign.f64(double 0x4330000000000000, double %x)
        %sum = fadd double %x, %big
        %right = fsub double %sum, %big
"""
_ROUNDED = {
    "floor": _CUT.format(beyond="ogt", step="-1.0"),
    "ceil": _CUT.format(beyond="olt", step="1.0"),
    "trunc": _CUT.format(beyond="false", step="0.0"),
    "rint": _TO_EVEN,
    "nearbyint": _TO_EVEN,
}
"""Name in C -> how it is calculated of a number below 2^52."""


def rounding(target: Target) -> dict[str, bytes]:
    """Name -> object code of functions that LLVM calls where a processor has no instruction for it."""
    return {
        name: _assembled(_ROUNDING.format(name=name, steps=steps), name, target) for name, steps in _ROUNDED.items()
    }


def made_with() -> str:
    """Versions of the compilers; other versions may make other bytes, and flights that are the same."""
    return (
        f"Numba {numba.__version__}, llvmlite {llvmlite.__version__}, LLVM {'.'.join(map(str, llvm.llvm_version_info))}"
    )


def write(path: str, name: str, objects: Objects) -> None:
    """Write the object files of a unit for the record type at ``path``, or of a kernel.

    Args:
        path: as workers take it.
        name: of the unit or kernel.
        objects: where they go.
    """
    if path == KERNELS_PATH:
        kernel = KERNELS[name]
        made, identity = translate_kernel(kernel), kernel_identity(kernel)
    else:
        unit = UNITS[name]
        made, identity = translate_unit(unit, path), unit_identity(unit, path)
    for target in objects.targets:
        file = objects.file(made.symbol, identity, target)
        for code, whole in zip(reversed(made.compiled(target)), (file.with_suffix(".bc"), file), strict=True):
            scratch = file.with_suffix(f".{os.getpid()}")
            scratch.write_bytes(code)
            scratch.replace(whole)
