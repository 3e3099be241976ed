# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import struct
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from sitl.core import elementary, elementary_arrays, elementary_kernels

SPECIAL = [0.0, -0.0, 1.0, -1.0, 0.5, 1e-310, 1e300, math.inf, -math.inf, math.nan, math.pi, 1e22]
ONE = ("sin", "cos", "asin", "acos")
TWO = ("atan2", "hypot", "pow")


def _bits(values: Any) -> list[bytes]:
    return [b"nan" if value != value else struct.pack("<d", value) for value in np.ravel(values).tolist()]


def _numbers(count: int) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    rng = np.random.default_rng(1)
    pairs = np.array([(a, b) for a in SPECIAL for b in SPECIAL] + rng.uniform(-3.0, 3.0, (count, 2)).tolist())
    return pairs[:, 0], pairs[:, 1]


@pytest.mark.parametrize("name", [*ONE, *TWO])
@pytest.mark.parametrize("loaded", [True, False])
def test_an_array_has_the_bits_of_the_law(name: str, loaded: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    if not loaded:
        monkeypatch.setattr(elementary_arrays, "is_by_law", lambda kernel, count: True)
    law, function = getattr(elementary, name), getattr(elementary_arrays, name)
    x, y = _numbers(300)
    arguments = (x, y) if name in TWO else (x,)
    wanted = [law(*numbers) for numbers in zip(*(column.tolist() for column in arguments))]
    assert _bits(function(*arguments)) == _bits(wanted)


def test_few_numbers_need_no_machine_code(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse() -> Callable[..., Any]:
        raise AssertionError("loaded")

    monkeypatch.setattr(elementary_kernels.sines, "_entry", None)
    monkeypatch.setattr(elementary_kernels.sines, "unchecked", refuse)
    assert elementary_arrays.sin([0.5]).tolist() == [elementary.sin(0.5)]


def test_shapes_and_precision_are_those_that_were_given() -> None:
    table = np.arange(12.0).reshape(3, 4)
    assert elementary_arrays.sin(table).shape == (3, 4)
    turned = table.T[::2]
    assert elementary_arrays.sin(turned).tolist() == [[elementary.sin(x) for x in row] for row in turned.tolist()]
    assert elementary_arrays.hypot(table, table[0]).shape == (3, 4)
    assert elementary_arrays.hypot(table[:, :1], 2.0).tolist() == [[elementary.hypot(x, 2.0)] for x in (0.0, 4.0, 8.0)]
    assert elementary_arrays.cos(np.zeros((0, 3))).shape == (0, 3)
    number = elementary_arrays.cos(1.0)
    assert isinstance(number, float) and number == elementary.cos(1.0)
    narrow = elementary_arrays.cos(np.array([1.0, 2.0], np.float32))
    assert narrow.dtype == np.float32 and narrow.tolist() == [float(np.float32(elementary.cos(x))) for x in (1.0, 2.0)]
    assert elementary_arrays.cos(np.array([1, 2])).dtype == np.float64
