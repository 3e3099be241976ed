# SPDX-License-Identifier: BSD-3-Clause
"""Arrays at an address: the same memory in plain Python and compiled."""

from __future__ import annotations

from collections.abc import Callable
from ctypes import CFUNCTYPE, c_int64, c_void_p, cast
from importlib import import_module

import numba
import numpy as np
import pytest

from sitl.core.compile import make_jitable
from sitl.core.kernels import law
from sitl.core.memory import call_unit, floats_at, ints_at, record_at, table_at, words_of
from sitl.core.records import Record


@law
def work(table: int, floats: int, ints: int) -> int:
    """Write into arrays of shapes (2, 3), (2,) and (4,)."""
    rows, line, numbers = table_at(table, 2, 3), floats_at(floats, 2), ints_at(ints, 4)
    rows[1, 0] = line[1] + rows[0, 2]
    line[0] = float(numbers[3])
    numbers[0] = len(line) + rows.shape[0] + rows.shape[1]
    return numbers[0]


def compiled() -> Callable[[int, int, int], int]:
    import_module("sitl.core.numba_records")  # tells Numba of them
    make_jitable()

    @numba.njit
    def call(table: int, floats: int, ints: int) -> int:
        return work(table, floats, ints)

    return call  # type: ignore[no-any-return]


@pytest.mark.parametrize("make", [lambda: work, compiled])
def test_arrays_at_an_address(make: Callable[[], Callable[[int, int, int], int]]) -> None:
    table, floats, ints = np.arange(6.0).reshape(2, 3), np.array([0.0, 0.5]), np.array([7, 7, 7, 1 << 40])
    assert make()(table.ctypes.data, floats.ctypes.data, ints.ctypes.data) == 7
    assert table.tolist() == [[0.0, 1.0, 2.0], [2.5, 4.0, 5.0]]
    assert floats.tolist() == [float(1 << 40), 0.5]
    assert ints.tolist() == [7, 7, 7, 1 << 40]


def test_an_address_may_be_a_number_of_numpys() -> None:
    numbers = np.array([3, 4])
    address = np.array([numbers.ctypes.data])[0]  # as a loop over rows of an array calculates it in plain Python
    assert ints_at(address, 2).tolist() == [3, 4]


class Inner(Record):
    number: int
    share: float


class Outer(Record):
    first: Inner
    second: Inner


@law
def copy_second(address: int) -> int:
    """Copy the second record at an address into the first, word by word; how many there are."""
    v = record_at(Outer, address)
    to, source = words_of(v.first), words_of(v.second)
    for k in range(len(to)):
        to[k] = source[k]
    return len(to)


@pytest.mark.parametrize("is_compiled", [False, True])
def test_words_of_a_record_in_a_record(is_compiled: bool) -> None:
    fleet = Outer.fleet(2)
    v, other = Outer.of(fleet, 0), Outer.of(fleet, 1)
    v.second.number, v.second.share, other.first.number = -5, 0.1, 3
    copy = copy_second
    if is_compiled:
        import_module("sitl.core.numba_records")
        make_jitable()

        @numba.njit
        def copy(address: int) -> int:
            return copy_second(address)

    assert copy(fleet.ctypes.data) == 2
    assert (v.first.number, v.first.share) == (-5, 0.1)
    assert (v.second.number, other.first.number) == (-5, 3)


def test_nothing_is_at_an_address_too() -> None:
    numbers = np.zeros(1)
    assert len(floats_at(numbers.ctypes.data, 0)) == 0
    assert table_at(numbers.ctypes.data, 0, 9).shape == (0, 9)


@law
def call(address: int) -> None:
    """Call a function of six numbers."""
    call_unit(address, 1, 2, 3, 4, 5, 6)


def compiled_call() -> Callable[[int], None]:
    import_module("sitl.core.numba_records")
    make_jitable()

    @numba.njit
    def run(address: int) -> None:
        call(address)

    return run  # type: ignore[no-any-return]


@pytest.mark.parametrize("make", [lambda: call, compiled_call])
def test_a_unit_is_called_at_its_address(make: Callable[[], Callable[[int], None]]) -> None:
    got: list[tuple[int, ...]] = []
    unit = CFUNCTYPE(None, *[c_int64] * 6)(lambda *numbers: got.append(numbers))
    make()(cast(unit, c_void_p).value or 0)
    assert got == [(1, 2, 3, 4, 5, 6)]
