# SPDX-License-Identifier: BSD-3-Clause
"""Metres and degrees, and the earth's field against the gradient of its potential."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import lpmv

from sitl.core import earth_field, geodesy
from sitl.core.earth_field import field_ned


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


@pytest.mark.parametrize("lat", [900000000.0, -900000000.0])
def test_a_place_beyond_a_pole_is_on_this_side(lat: float) -> None:
    inside = geodesy.add_offset(lat, 100.0, -lat / 900000000.0 * 50.0, 0.0)
    beyond = geodesy.add_offset(lat, 100.0, lat / 900000000.0 * 50.0, 0.0)
    assert inside == pytest.approx(beyond) and abs(beyond.lat) < 900000000.0


def _potential(r: float, theta: float, lon: float) -> float:
    """The scalar potential [nT km] with scipy's Legendre functions, made Schmidt semi-normalised."""
    total = 0.0
    for n in range(1, earth_field.DEGREE + 1):
        for m in range(n + 1):
            norm = (-1) ** m * math.sqrt((2 if m else 1) * math.factorial(n - m) / math.factorial(n + m))
            p = norm * lpmv(m, n, math.cos(theta))
            wave = earth_field._G[n - 1, m] * math.cos(m * lon) + earth_field._H[n - 1, m] * math.sin(m * lon)
            total += 6371.2 * (6371.2 / r) ** (n + 1) * wave * p
    return total


@given(st.floats(-85, 85), st.floats(-180, 180))
def test_is_the_gradient_of_the_potential(lat: float, lon: float) -> None:
    a, e2, f, s = 6378.137, 6.69437999014e-3, math.radians(lat), math.sin(math.radians(lat))
    normal = a / math.sqrt(1 - e2 * s * s)
    point = np.array([normal * math.cos(f), 0.0, normal * (1 - e2) * s])
    north = np.array([-math.sin(f), 0.0, math.cos(f)])
    down = np.array([-math.cos(f), 0.0, -math.sin(f)])
    east = np.array([0.0, 1.0, 0.0])

    def at(x: np.ndarray) -> float:
        return _potential(
            float(np.linalg.norm(x)), math.acos(x[2] / np.linalg.norm(x)), math.radians(lon) + math.atan2(x[1], x[0])
        )

    h = 0.5
    expected = [-1e-5 * (at(point + h * d) - at(point - h * d)) / (2 * h) for d in (north, east, down)]
    assert field_ned(lat, lon) == pytest.approx(expected, abs=2e-6)


def test_declination_where_the_recordings_were_made() -> None:
    n, e, d = field_ned(-35.363262, 149.165237)
    assert math.atan2(e, n) == pytest.approx(0.2234, abs=0.01)  # COMPASS_DEC in its parameters
    assert d < 0  # southern hemisphere: up
    assert 0.55 < math.hypot(n, e, d) < 0.6


@pytest.mark.parametrize("lat", [-90.0, 90.0])
def test_is_finite_at_the_poles(lat: float) -> None:
    assert all(math.isfinite(x) for x in field_ned(lat, 0.0))
