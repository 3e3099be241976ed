# SPDX-License-Identifier: BSD-3-Clause
"""Fingerprints are the same in every process, or machine code would be made again by each."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from enum import IntEnum
from pathlib import Path
from typing import Any

import pytest

from sitl.core.constant_tables import constant_table
from sitl.core.fingerprint import Reached, fingerprint
from sitl.core.kernels import UNITS, Unit
from sitl.core.records import Record
from sitl.core.shipped.identity import identity

SHOW = """
import sys
from sitl.core.fingerprint import _code
def law(x):
    return {"within": x in {"a", "b", "c", "d"}, "later": lambda y: y + 2.5}
print(_code(law.__code__))
"""


def test_code_within_code_and_sets_are_written_alike_in_every_process() -> None:
    texts = set()
    for seed in ("1", "2", "3"):
        environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(Path(__file__).parents[2])}
        command = [sys.executable, "-c", f"pad = [object()] * {seed}000\n{SHOW}"]
        texts.add(subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout)
    assert len(texts) == 1
    assert "2.5" in texts.pop()


def test_the_numbers_of_a_table_count() -> None:
    def looks_up(*numbers: float) -> list[str]:
        return Reached(constant_table(*numbers)).lines

    assert looks_up(1.0, 2.0) == looks_up(1.0, 2.0) != looks_up(1.0, 2.5)


def test_the_numbers_of_choices_count_where_they_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def looks_up(**numbers: int) -> list[str]:
        monkeypatch.setitem(globals(), "Choice", IntEnum("Choice", numbers))
        return Reached(_is_on).lines

    assert looks_up(ON=1, OFF=0) == looks_up(ON=1, OFF=2) != looks_up(ON=3, OFF=0)
    monkeypatch.setitem(globals(), "Choice", IntEnum("Other", {"ON": 1}).ON)
    assert "Choice = 1" in Reached(_is_on).lines, "a member by itself, without the name that Python gives it"


def _is_on(number: int) -> bool:
    return number == Choice.ON  # type: ignore[name-defined]  # noqa: F821  the test puts it there


def test_every_kernel_has_one_fingerprint_in_all_processes() -> None:
    show = (
        "from importlib import import_module\n"
        "from sitl.cli.cache import KERNEL_MODULES\n"
        "from sitl.core import array_kernels as k\n"
        "for name in {order}(KERNEL_MODULES): import_module(name)\n"
        "print(*sorted(k._folder(x, k._signature(x.law)).name for x in k.KERNELS.values()), sep='\\n')"
    )
    printed = set()
    for order in ("sorted", "reversed"):
        environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
        command = [sys.executable, "-c", show.format(order=order)]
        printed.add(subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout)
    (names,) = printed
    assert len(names.split()) > 30


def test_names_within_code_and_in_texts_count_as_mentioned() -> None:
    def uses(v: Any) -> Any:
        return [row.deep for row in v.rows], getattr(v, "by_text"), v.plain  # noqa: B009

    assert {"deep", "rows", "by_text", "plain"} <= Reached(uses).names


class Part(Record):
    a: float
    b: float


class Whole(Record):
    first: Part
    second: Part
    third: float


def test_a_layout_has_the_fields_that_are_named_with_the_size_of_each_record() -> None:
    assert Whole.layout(("second", "b", "elsewhere")) == "64{second:16:16{b:8:f8()float}()}"
    assert Whole.layout(("first",)) == "64{first:0:16{}()}"
    part = "16{a:0:f8()float,b:8:f8()float}()"
    assert Whole.layout() == f"64{{first:0:{part},second:16:{part},third:32:f8()float}}"


@pytest.mark.parametrize(("numbers", "size"), [(4, 32), (5, 64), (8, 64), (9, 128)])
def test_records_that_are_not_small_have_room(numbers: int, size: int) -> None:
    made = type(
        "Made", (Record,), {"__annotations__": {f"f{k}": "float" for k in range(numbers)}, "__module__": __name__}
    )
    assert made.dtype.itemsize == size
    assert [field.offset for field in made.fields.values()] == [8 * k for k in range(numbers)]


def _callee(fleet: Any, index: int) -> None:
    """A unit that another one calls."""


def _caller(fleet: Any, index: int) -> None:
    _callee(fleet, index)


@pytest.mark.parametrize("changed", [{"name": "elsewhere.callee"}, {"integers": 1}])
def test_a_unit_that_is_linked_otherwise_counts(monkeypatch: pytest.MonkeyPatch, changed: dict[str, Any]) -> None:
    """A unit moves to another module, and nothing is edited in its caller: machine code of the caller that asks for
    the old symbol would end the process ("LLVM ERROR: Symbol not found")."""
    caller, callee = Unit("tests.caller", _caller, 0), Unit("tests.callee", _callee, 0)

    def hashes() -> tuple[str, str]:
        return fingerprint(caller, (), ""), identity(caller, "", ())

    monkeypatch.setitem(UNITS, "tests.caller", caller)
    monkeypatch.setitem(UNITS, "tests.callee", callee)
    before = hashes()
    assert before == hashes()
    monkeypatch.setitem(UNITS, "tests.callee", replace(callee, **changed))
    assert all(one != other for one, other in zip(before, hashes(), strict=True))
