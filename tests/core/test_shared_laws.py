# SPDX-License-Identifier: BSD-3-Clause
"""Laws that many units contain are compiled once, for the copies of a process that compile as usual."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from sitl.core import worker
from sitl.core.kernels import UNITS, Unit
from sitl.core.order import KERNELS_PATH, Order
from sitl.core.shared_laws import ENOUGH

COUNTS = """
import sys
import numba
import numba.core.compiler as compiler
from sitl.core import algebra, compile, elementary, numba_tuning, shared_laws
from sitl.core.array_kernels import numba_type_of
from sitl.core.vectors import Quat, Vec3

names, original = [], compiler.compile_extra
def counted(typing, target, function, *rest, **more):
    names.append(function.__name__)
    return original(typing, target, function, *rest, **more)
compiler.compile_extra = counted

if sys.argv[1] == "shared":
    shared_laws.compile_once()
    names.clear()
compile.make_jitable()

def unit(q, v, x):
    w = algebra.rotate(q, v)
    return elementary.atan2(w.x, x) + elementary.cbrt(w.y)

with numba_tuning.quick("no library"), numba_tuning.trust_laws():
    compiled = numba.njit(**numba_tuning.law_options())(unit)
    compiled.compile(tuple(map(numba_type_of, (Quat, Vec3, float))))
print(" ".join(sorted(set(names))))
compiler.compile_extra = original

entry = numba.njit(**numba_tuning.COMMON)(lambda a, b, c: compiled(Quat(a, b, c, a), Vec3(b, c, a), c))
print(entry(0.5, -0.25, 1.5).hex(), unit(Quat(0.5, -0.25, 1.5, 0.5), Vec3(-0.25, 1.5, 0.5), 1.5).hex())
"""


def counts(how: str) -> tuple[set[str], list[str]]:
    """Names of the functions that are compiled for a unit, and its result, compiled and in Python."""
    done = subprocess.run(
        [sys.executable, "-c", COUNTS, how], capture_output=True, text=True, check=True,
        env=os.environ | {"PYTHONPATH": str(Path(__file__).parents[2])},
    )  # fmt: skip
    names, results = done.stdout.splitlines()
    return set(names.split()), results.split()


def test_what_is_shared_is_not_compiled_again_and_gives_the_same_bits() -> None:
    alone, value = counts("alone")
    with_shared, same = counts("shared")
    assert {"unit", "rotate", "atan2", "cbrt"} <= alone
    assert "unit" in with_shared and "cbrt" in with_shared, "what nobody shares is compiled"
    assert not {"rotate", "atan2", "sincos"} & with_shared
    assert value == same and len(set(value)) == 1


def started(tasks: list[str], path: str, jobs: int, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What a worker does for some tasks, in order; copies of it end in the order in which they were made."""
    steps: list[str] = []
    running: list[int] = []

    def fork(order: Order, name: str) -> int:
        steps.append(name)
        running.append(len(steps))
        return running[-1]

    monkeypatch.setattr(worker, "FORKS", True)
    monkeypatch.setattr(worker, "fork", fork)
    monkeypatch.setattr(worker.gc, "freeze", lambda: None)
    monkeypatch.setattr(worker, "compile_once", lambda: steps.append("(shared laws)"))
    monkeypatch.setattr(worker.os, "wait", lambda: (running.pop(0), 0))
    assert worker.compile_all(Order(path), jobs, tasks) == 0
    return steps


@pytest.fixture
def units(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Tasks: enough for sharing, and after them two units that inline everything."""

    def nothing(fleet: Any, index: int) -> None: ...

    names = [f"plain{k}" for k in range(ENOUGH)] + ["inline0", "inline1"]
    for name in names:
        monkeypatch.setitem(UNITS, name, Unit(name, nothing, 0, name.startswith("inline")))
    return [f"math:{name}" for name in names]


@pytest.mark.parametrize("jobs", [1, 2, 16])
def test_units_that_inline_everything_come_before_what_is_shared(
    units: list[str], jobs: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    plain = [f"plain{k}" for k in range(ENOUGH)]
    assert started(units, "a.Record", jobs, monkeypatch) == ["inline0", "inline1", "(shared laws)", *plain]


def test_for_a_few_units_nothing_is_shared(units: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """A contributor who has changed a law waits for its units alone."""
    assert "(shared laws)" not in started(units[1:], "a.Record", 2, monkeypatch)


def test_kernels_share_them_too(monkeypatch: pytest.MonkeyPatch) -> None:
    tasks = [f"math:kernel{k}" for k in range(ENOUGH)]
    assert started(tasks, KERNELS_PATH, 2, monkeypatch) == ["(shared laws)", *(f"kernel{k}" for k in range(ENOUGH))]


def test_where_a_process_cannot_be_copied_each_unit_has_one_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    """The process that starts them has loaded no unit, and compiles nothing."""
    steps: list[str] = []
    monkeypatch.setattr(worker, "FORKS", False)
    monkeypatch.setattr(worker, "spawn", lambda order, task: steps.append(task) or len(steps))
    monkeypatch.setattr(worker, "compile_once", lambda: steps.append("(shared laws)"))
    monkeypatch.setattr(worker.os, "wait", lambda: (len(steps), 0))
    tasks = [f"no_such_module:unit{k}" for k in range(ENOUGH)]
    assert worker.compile_all(Order("a.Record"), 1, tasks) == 0 and steps == tasks


def test_processes_that_end_at_the_same_time_are_all_heard_of(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """``subprocess`` would take the end of some for itself as it starts others, and the last would be waited for in
    vain."""
    ends_at_once = tmp_path / "python"
    ends_at_once.write_text("#!/bin/sh\n")
    ends_at_once.chmod(0o755)
    monkeypatch.setattr(worker, "FORKS", False)
    monkeypatch.setattr("sys.executable", str(ends_at_once))
    assert worker.compile_all(Order("a.Record"), 16, [f"no_such_module:unit{k}" for k in range(300)]) == 0
