# SPDX-License-Identifier: BSD-3-Clause
"""Metres and degrees."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.core import geodesy


@given(st.floats(-80e7, 80e7), st.floats(-180e7, 180e7), st.floats(-20e3, 20e3), st.floats(-20e3, 20e3))
def test_offset_and_back(lat: float, lon: float, north: float, east: float) -> None:
    there = geodesy.add_offset(lat, lon, north, east)
    assert geodesy.offset_ne(lat, lon, *there) == pytest.approx((north, east), abs=1e-3)


def test_the_recorded_square_is_30_m() -> None:
    north, east = geodesy.offset_ne(-353632621, 1491652371, -353629926, 1491655676)
    assert (north, east) == pytest.approx((30.0, 30.0), abs=0.02)


def test_across_the_date_line() -> None:
    north, east = geodesy.offset_ne(0, 1799999000, 0, -1799999000)
    assert north == 0.0
    assert east == pytest.approx(2000 * geodesy.METRES_PER_DEGE7)


def test_a_place_across_the_date_line_has_a_longitude_of_its_own_side() -> None:
    assert geodesy.add_offset(0.0, 1799999000.0, 0.0, 2000 * geodesy.METRES_PER_DEGE7)[1] == pytest.approx(-1799999000)
    assert geodesy.add_offset(0.0, -1799999000.0, 0.0, -2000 * geodesy.METRES_PER_DEGE7)[1] == pytest.approx(1799999000)
