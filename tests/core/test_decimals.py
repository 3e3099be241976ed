# SPDX-License-Identifier: BSD-3-Clause
"""Numbers as text, beside Python's own."""

from __future__ import annotations

import random

import pytest

from sitl.core import decimals


def written(value: float) -> str:
    text = bytearray(decimals.MOST)
    return text[: decimals.write_number(text, 0, value)].decode()


NUMBERS = random.Random(1)
SPREAD = [NUMBERS.uniform(-1.0, 1.0) * 10.0 ** NUMBERS.randint(-12, 8) for _ in range(3000)]
EDGES = [1.0, -1.0, 0.1, 10.0, 99.99999999, 0.99999999951, 1e8, 123456789.0, 0.0001, 0.00001, 1.5e-7, 1e-13, 9.80665]


@pytest.mark.parametrize("value", EDGES)
def test_it_is_the_number_to_nine_digits_as_short_as_can_be(value):
    assert float(written(value)) == float(f"{value:.9g}")
    assert len(written(value)) <= len(f"{value:.9g}")


def test_numbers_of_all_sizes_are_as_python_writes_them():
    for value in SPREAD:
        text = written(value)
        assert float(text) == pytest.approx(value, rel=5.1e-9) and float(f"{value:.9g}") == pytest.approx(
            float(text), rel=1.1e-9
        )
        assert len(text) <= decimals.MOST


@pytest.mark.parametrize(
    ("value", "text"), [(0.0, "0"), (-0.0, "0"), (1e-14, "0"), (float("nan"), "0"), (3e12, "999999999")]
)
def test_what_a_vehicle_never_has_is_still_json(value, text):
    assert written(value) == text


def test_whole_numbers():
    text = bytearray(20)
    for number in (0, 7, 10, 99, 100, 1234567890123):
        assert text[: decimals.write_whole(text, 0, number)] == str(number).encode()
