# SPDX-License-Identifier: BSD-3-Clause
"""The machine code of units and kernels takes the source's arithmetic: nothing is fused or reordered on any processor.

With one rounding for a product and a sum, or with sums in another order, the last bits of a flight would be those of a
processor. LLVM does neither unless an instruction allows it, and Numba allows it only where a user says ``fastmath``.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import llvmlite.binding as llvm
import numba
import pytest
from numba import float64

from sitl.cli.cache import all_entries, shipped_pieces
from sitl.core import compile as compiler
from sitl.core.array_kernels import KERNELS, Kernel, Line, _folder, _signature, is_shipped
from sitl.core.code_cache import is_built
from sitl.core.kernels import jit_disabled, law
from sitl.core.numba_tuning import law_options
from sitl.core.shipped.build import Piece
from sitl.core.shipped.library import library
from sitl.core.worker import KERNELS_PATH
from sitl.vehicle.kinds import KINDS
from tests.core.machine_code import PROCESSORS, assembly, declared, freedoms, fused, referred

EXACT = {
    "fabs", "copysign", "floor", "ceil", "trunc", "rint", "fmod", "is.fpclass", "masked.load", "masked.store",
    "masked.gather", "masked.scatter", "sqrt", "sqrtf",
}  # fmt: skip
"""Functions whose result is prescribed to the last bit."""
MEMORY = {"memset", "memcpy", "memmove", "bzero"}
OURS = re.compile(r"sitl_|_Z|\.?numba|NRT_|_?Py|__.*_chk$")
"""Other units, Numba's own, and Python's: kernels take their arguments from it and report errors to it."""
QUICK = (
    "autopilot.copter.control.control_step.update",
    "autopilot.estimation.update.run_second",
    "autopilot.estimation.update.step_bank",
    "autopilot.rover.control.control_step.update",
    "physics.native.copter.step.step",
    "physics.native.ranging.measure",
    "vehicle.copter.advance",
)
"""Units whose machine code is looked at in seconds."""
SLOW = (
    "autopilot.copter.modes.decisions.update",
    "autopilot.estimation.update.step",
    "autopilot.rover.modes.decisions.update",
    "bridge.copter.core.receive",
    "bridge.copter.core.transmit",
    "physics.native.rover.step.step",
    "vehicle.copter.move",
)
pytestmark = pytest.mark.skipif(jit_disabled(), reason="nothing is compiled")


def ir_of(library: Any) -> str:
    """LLVM's optimised code of a library of Numba's, compiled now or loaded from the cache."""
    return str(library._get_module_for_linking())


def shipped_code(piece: Piece) -> str | None:
    """LLVM's code of a piece of the library that these tests run with (``sitl cache ship``); None: there is no such
    library, or it holds another version of the piece."""
    if (found := library()) is None or found.identities.get(piece.key) != piece.identity:
        return None
    file = f"objects/*/{piece.symbol}-{piece.identity}-{found.target.name}.bc"
    codes = sorted(found.file.parent.glob(file))
    return str(llvm.parse_bitcode(codes[-1].read_bytes())) if codes else None


@pytest.fixture(scope="module")
def units() -> dict[tuple[str, str], str]:
    """(Name, path of the record type) -> LLVM's code, of all units of both kinds: what is run here."""
    codes = {}
    for piece in shipped_pieces():
        if piece.path != KERNELS_PATH:
            codes[piece.unit.name, piece.path] = shipped_code(piece)
    if None in codes.values():
        for kind in KINDS.values():
            for entry in all_entries(kind):
                compiler.load(entry, kind.record_path)
        compiled = {key: function for key, function in compiler._compiled.items() if key in codes}
        codes |= {key: ir_of(function._library) for key, function in compiled.items() if codes[key] is None}
    return {key: code for key, code in codes.items() if code is not None}


def kernels() -> Iterator[tuple[str, str]]:
    """Those that are built: none is compiled for a look at it."""
    for piece in shipped_pieces():
        if piece.path == KERNELS_PATH and (code := shipped_code(piece)) is not None:
            yield piece.key, code
    for name, kernel in list(KERNELS.items()):
        if name.startswith("toy") or is_shipped(kernel) or not is_built(_folder(kernel, _signature(kernel.law))):
            continue
        function: Any = kernel.function()
        for overload in function.overloads.values():
            yield name, ir_of(overload.library)


def unknown(names: set[str]) -> set[str]:
    """Of functions that are called, those that no list has."""
    return {name for name in names - EXACT - MEMORY if not OURS.match(name)}


def test_no_unit_allows_other_arithmetic(units: dict[tuple[str, str], str]) -> None:
    assert len(units) >= 50
    loose = {key: found for key, code in units.items() if (found := freedoms(code))}
    assert not loose


def test_units_call_what_is_listed(units: dict[tuple[str, str], str]) -> None:
    called = {key: declared(code) for key, code in units.items()}
    assert not {key: names for key, found in called.items() if (names := unknown(found))}


def test_no_kernel_allows_other_arithmetic_or_calls_what_is_not_listed() -> None:
    found = list(kernels())
    assert len(found) > 20 or library() is None, "where nothing was compiled beforehand there may be none"
    for name, ir in found:
        assert (name, freedoms(ir), unknown(declared(ir))) == (name, [], set())


@pytest.mark.parametrize("processor", PROCESSORS)
@pytest.mark.parametrize("name", [*QUICK, *(pytest.param(name, marks=pytest.mark.slow) for name in SLOW)])
def test_machine_code_fuses_nothing(units: dict[tuple[str, str], str], name: str, processor: str) -> None:
    """As this processor's optimiser leaves the unit, and the other one's after it."""
    code = assembly(next(code for (unit, _), code in units.items() if unit == name), processor)
    assert len(re.findall(r"^\s+v?f?mul(?:sd|pd)?\s", code, re.MULTILINE)) > 20, "there is something to fuse"
    assert fused(code) == []
    assert unknown(referred(code, processor)) == set()


def dot(a: Any, b: Any) -> float:
    """A sum of products over arrays: what loops are reordered and fused in."""
    total = 0.0
    for k in range(a.shape[0]):
        total += a[k] * b[k]
    return total


def turned(x: float, y: float, angle: float) -> float:
    """A product and a sum without a loop, and functions of a library."""
    return x * math.cos(angle) - y * (angle % 3.0) + x ** (angle + 1.0)


def compiled(function: Callable[..., float], *kinds: Any, **options: Any) -> str:
    """LLVM's code of a function that is compiled as laws are."""
    made: Any = numba.njit([float64(*kinds)], **law_options(), **options)(function)
    return ir_of(next(iter(made.overloads.values())).library)


@pytest.mark.parametrize("processor", PROCESSORS)
@pytest.mark.parametrize(("function", "kinds"), [(dot, (float64[::1],) * 2), (turned, (float64,) * 3)])
def test_laws_compile_to_the_source_s_arithmetic(
    function: Callable[..., float], kinds: tuple[Any, ...], processor: str
) -> None:
    ir = compiled(function, *kinds)
    assert freedoms(ir) == [] and fused(assembly(ir, processor)) == []


@pytest.mark.parametrize("processor", PROCESSORS)
@pytest.mark.parametrize("fastmath", [True, {"contract"}])
@pytest.mark.parametrize(("function", "kinds"), [(dot, (float64[::1],) * 2), (turned, (float64,) * 3)])
def test_the_look_sees_what_is_fused(
    function: Callable[..., float], kinds: tuple[Any, ...], fastmath: Any, processor: str
) -> None:
    """The same functions, where the compiler may do as it likes."""
    ir = compiled(function, *kinds, fastmath=fastmath)
    assert freedoms(ir) and fused(assembly(ir, processor))


@pytest.mark.parametrize("processor", PROCESSORS)
def test_the_look_sees_what_is_called(processor: str) -> None:
    ir = compiled(turned, float64, float64, float64)
    assert {"cos", "pow"} <= declared(ir)
    assert {"cos", "fmod", "pow"} <= referred(assembly(ir, processor), processor)


@law
def weighed(a: Line, b: Line) -> float:
    """The same sum as a kernel."""
    total = 0.0
    for k in range(a.shape[0]):
        total += a[k] * b[k]
    return total


def test_kernels_are_compiled_without_freedoms(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One made here, however few are in the cache."""
    monkeypatch.setenv("SITL_CACHE_DIR", str(tmp_path))
    kernel = Kernel(weighed)
    del KERNELS[kernel.name]
    function: Any = kernel.function()
    ir = ir_of(next(iter(function.overloads.values())).library)
    assert "fmul" in ir and freedoms(ir) == []
    assert all(fused(assembly(ir, each)) == [] for each in PROCESSORS)
