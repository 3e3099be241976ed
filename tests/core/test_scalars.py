# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

import pytest

from sitl.core.scalars import is_same


@pytest.mark.parametrize(("a", "b", "same"), [
    (0.5, 0.5, True), (0.0, 0.0, True), (-0.0, -0.0, True), (0.0, -0.0, False), (1.0, -1.0, False),
    (math.nan, math.nan, False), (math.inf, math.inf, True),
])  # fmt: skip
def test_zeros_of_other_signs_are_not_the_same(a: float, b: float, same: bool) -> None:
    assert is_same(a, b) == is_same(b, a) == same
