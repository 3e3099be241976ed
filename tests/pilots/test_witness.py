# SPDX-License-Identifier: BSD-3-Clause
"""What no number is found, wherever in a record it is."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.pilots.witness import is_finite

INNER = np.dtype([("count", "i4"), ("narrow", "f4"), ("rows", "f8", (2, 3))])
OUTER = np.dtype([("first", "f8"), ("one", INNER), ("many", INNER, (2,)), ("whole", "i8"), ("last", "f4")])
PLACES = [
    ("first",),
    ("one", "narrow"),
    ("one", "rows", (1, 2)),
    ("many", 1, "narrow"),
    ("many", 0, "rows", (0, 0)),
    ("last",),
]


@pytest.mark.parametrize("number", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("place", PLACES, ids=str)
def test_what_is_not_finite_is_found_in_nested_records_and_arrays(place: tuple, number: float) -> None:
    record = np.zeros(1, OUTER)
    record["whole"] = record["one"]["count"] = -1  # all bits set, which no float may have
    assert is_finite(record[0])
    at = record[0]
    for step in place[:-1]:
        at = at[step]
    at[place[-1]] = number
    assert not is_finite(record[0])


def test_a_field_that_is_an_array_or_a_row_of_records_is_looked_at_as_a_whole() -> None:
    record = np.zeros(1, OUTER)
    assert is_finite(record[0]["one"]["rows"]) and is_finite(record[0]["whole"]) and is_finite(record[0]["many"])
    record["one"]["rows"][0, 1, 1] = record["many"][0, 1]["narrow"] = math.nan
    assert not is_finite(record[0]["one"]["rows"]) and not is_finite(record[0]["many"])
