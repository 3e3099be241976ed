# SPDX-License-Identifier: BSD-3-Clause
"""Every law says what it takes and gives; a law that is chosen by a number."""

from __future__ import annotations

import dis
import importlib
import inspect
import pkgutil
import re

import sitl
from sitl.core import fingerprint
from sitl.core.array_kernels import KERNELS
from sitl.core.dispatch import by_number
from sitl.core.kernels import LAWS, UNITS, law
from sitl.errors import MissingExtra


def _import_all() -> None:
    for module in pkgutil.walk_packages(sitl.__path__, "sitl."):
        if not re.search(r"\.(__main__|preload|static|examples\.)", module.name):
            try:
                importlib.import_module(module.name)
            except (MissingExtra, ImportError):  # of an extra that is not installed: it has no laws
                assert not module.name.startswith(("sitl.autopilot", "sitl.core", "sitl.physics.native", "sitl.worlds"))


def test_laws_are_annotated_without_any() -> None:
    _import_all()
    ours = [f for f in (*LAWS, *(u.function for u in UNITS.values())) if f.__module__.startswith("sitl.")]
    written = [
        f for f in ours if not f.__code__.co_filename.startswith("<")
    ]  # made by ``by_number``: it checks its own
    assert len(written) > 800
    loose = []
    for function in written:
        signature = inspect.signature(function)
        kinds = [signature.return_annotation, *(p.annotation for n, p in signature.parameters.items() if n != "self")]
        if any(kind is inspect.Signature.empty or re.search(r"\bAny\b", str(kind)) for kind in kinds):
            loose.append(f"{function.__module__}.{function.__qualname__}{signature}")
    assert not loose


def test_laws_have_few_arguments() -> None:
    _import_all()
    wide = [f"{f.__module__}.{f.__qualname__}" for f in LAWS if f.__code__.co_argcount >= 8]
    assert not wide


def test_laws_raise_nothing() -> None:
    """Compiled, a law does not ask whether one that it calls has raised something (``numba_tuning``)."""
    _import_all()
    reached = (*LAWS, *(unit.function for unit in UNITS.values()), *(kernel.law for kernel in KERNELS.values()))
    ours = [f for f in reached if f.__module__.startswith("sitl.")]
    assert not [f.__qualname__ for f in ours if any("RAISE" in i.opname for i in dis.get_instructions(f))]


@law
def twice(x: float) -> float:
    """2 x"""
    return 2.0 * x


@law
def thrice(x: float) -> float:
    """3 x"""
    return 3.0 * x


@law
def same(x: float) -> float:
    """x"""
    return x


SCALE = by_number("scale", {2: twice, 3: thrice, 4: same}, same)


def test_the_law_of_the_number_is_called_or_the_other_one() -> None:
    assert [SCALE(number, 5.0) for number in (2, 3, 4, -1, 99)] == [10.0, 15.0, 5.0, 5.0, 5.0]


def test_it_is_a_law_and_what_it_calls_belongs_to_its_fingerprint() -> None:
    assert SCALE in LAWS
    reached = fingerprint.Reached(SCALE).lines
    assert {line.split()[1].rsplit(".", 1)[1] for line in reached if line.startswith("def")} == {
        "scale", "twice", "thrice", "same",
    }  # fmt: skip


def test_it_compiles() -> None:
    import numba

    from sitl.core.compile import make_jitable

    make_jitable()
    chosen = SCALE

    @numba.njit
    def compiled(number: int, x: float) -> float:
        return chosen(number, x)

    assert [compiled(number, 5.0) for number in (2, 3, 7)] == [10.0, 15.0, 5.0]
