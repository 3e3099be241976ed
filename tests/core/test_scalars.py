# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import random
from decimal import Decimal, localcontext

import pytest

from sitl.core.scalars import hypotenuse, is_same


@pytest.mark.parametrize(("a", "b", "same"), [
    (0.5, 0.5, True), (0.0, 0.0, True), (-0.0, -0.0, True), (0.0, -0.0, False), (1.0, -1.0, False),
    (math.nan, math.nan, False), (math.inf, math.inf, True),
])  # fmt: skip
def test_zeros_of_other_signs_are_not_the_same(a: float, b: float, same: bool) -> None:
    assert is_same(a, b) == is_same(b, a) == same


def rounded_once(x: float, y: float) -> float:
    """The length of (x, y) to sixty digits, then to a float."""
    with localcontext() as context:
        context.prec = 60
        return float((Decimal(x) ** 2 + Decimal(y) ** 2).sqrt())


@pytest.mark.parametrize("decades", [0, 3, 20])
def test_hypotenuse_is_rounded_once(decades: int) -> None:
    numbers = random.Random(decades)
    for _ in range(2000):
        x, y = (numbers.gauss(0.0, 1.0) * 10.0 ** numbers.uniform(-decades, decades) for _ in range(2))
        assert hypotenuse(x, y) == rounded_once(x, y), (x, y)


@pytest.mark.parametrize(("x", "y", "length"), [
    (0.0, 0.0, 0.0), (3.0, -4.0, 5.0), (-2.0, 0.0, 2.0), (1e-45, 0.0, 1e-45), (math.inf, 1.0, math.inf),
])  # fmt: skip
def test_hypotenuse_of_special_numbers(x: float, y: float, length: float) -> None:
    assert hypotenuse(x, y) == hypotenuse(y, x) == length


def test_hypotenuse_of_no_number() -> None:
    assert math.isnan(hypotenuse(math.nan, 1.0))
