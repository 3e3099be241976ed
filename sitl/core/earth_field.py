# SPDX-License-Identifier: BSD-3-Clause
"""The earth's magnetic field: IGRF-14 at epoch 2025.0, spherical harmonics to degree 8, at sea level.

Source: International Geomagnetic Reference Field, 14th generation (IAGA Division V,
doi:10.5281/zenodo.14012302); public coefficients, Schmidt semi-normalised, nanotesla. The degrees left out
are worth about 20 nT (0.05 degree of declination).
"""

from __future__ import annotations

import math

import numpy as np

from .elementary import atan2, exp, log, sincos
from .kernels import law
from .vectors import Vec3

DEGREE = 8
_G = np.array(
    [
        [-29350.0, -1410.3, 0, 0, 0, 0, 0, 0, 0],
        [-2556.2, 2950.9, 1648.7, 0, 0, 0, 0, 0, 0],
        [1360.9, -2404.2, 1243.8, 453.4, 0, 0, 0, 0, 0],
        [894.7, 799.6, 55.8, -281.1, 12.0, 0, 0, 0, 0],
        [-232.9, 369.0, 187.2, -138.7, -141.9, 20.9, 0, 0, 0],
        [64.3, 63.8, 76.7, -115.7, -40.9, 14.9, -60.8, 0, 0],
        [79.6, -76.9, -8.8, 59.3, 15.8, 2.5, -11.2, 14.3, 0],
        [23.1, 10.9, -17.5, 2.0, -21.8, 16.9, 14.9, -16.8, 1.0],
    ]
)
"""Cosine coefficients [nT]: degree 1-8 down, order 0-8 across."""
_H = np.array(
    [
        [0, 4545.5, 0, 0, 0, 0, 0, 0, 0],
        [0, -3133.6, -814.2, 0, 0, 0, 0, 0, 0],
        [0, -56.9, 237.6, -549.6, 0, 0, 0, 0, 0],
        [0, 278.6, -134.0, 212.0, -375.4, 0, 0, 0, 0],
        [0, 45.3, 220.0, -122.9, 42.9, 106.2, 0, 0, 0],
        [0, -18.4, 16.8, 48.9, -59.8, 10.9, 72.8, 0, 0],
        [0, -48.9, -14.4, -1.0, 23.5, -7.4, -25.1, -2.2, 0],
        [0, 7.2, -12.6, 11.5, -9.7, 12.7, 0.7, -5.2, 3.9],
    ]
)
"""Sine coefficients [nT]."""
_RADIUS = 6371.2  # reference sphere [km]
_WGS84_A = 6378.137  # [km]
_WGS84_E2 = 6.69437999014e-3
_GAUSS_PER_NT = 1e-5


@law
def field_ned(lat_deg: float, lon_deg: float) -> Vec3:
    """Field NED [gauss] at sea level, at a geodetic latitude and longitude [deg]."""
    lat = math.radians(min(max(lat_deg, -89.999), 89.999))
    lon = math.radians(lon_deg)
    # geodetic to geocentric: colatitude theta, radius r, and the tilt psi between the two verticals
    sin_lat, cos_lat = sincos(lat)
    normal = _WGS84_A / math.sqrt(1.0 - _WGS84_E2 * sin_lat * sin_lat)
    across, along = normal * cos_lat, normal * (1.0 - _WGS84_E2) * sin_lat
    r = math.sqrt(across * across + along * along)
    psi = lat - atan2(along, across)
    c, s = along / r, across / r  # cosine and sine of theta
    radial, south, east = 0.0, 0.0, 0.0
    pmm, dmm = 1.0, 0.0  # P(m, m) and its derivative by theta
    for m in range(DEGREE + 1):
        if m > 0:
            k = 1.0 if m == 1 else math.sqrt((2.0 * m - 1.0) / (2.0 * m))
            pmm, dmm = k * s * pmm, k * (c * pmm + s * dmm)
        sin_m, cos_m = sincos(m * lon)
        p1, d1 = pmm, dmm
        p2, d2 = 0.0, 0.0
        for n in range(m, DEGREE + 1):
            if n > m:
                a = (2.0 * n - 1.0) / math.sqrt(n * n - m * m)
                b = math.sqrt((n - 1.0) * (n - 1.0) - m * m) / math.sqrt(n * n - m * m)
                p0, d0 = a * c * p1 - b * p2, a * (c * d1 - s * p1) - b * d2
                p2, d2, p1, d1 = p1, d1, p0, d0
            if n > 0:
                g, h = float(_G[n - 1, m]), float(_H[n - 1, m])
                scale = _GAUSS_PER_NT * exp((n + 2.0) * log(_RADIUS / r))
                radial += scale * (n + 1.0) * (g * cos_m + h * sin_m) * p1
                south -= scale * (g * cos_m + h * sin_m) * d1
                east += scale * m * (g * sin_m - h * cos_m) * p1 / s
    north_c, down_c = -south, -radial  # geocentric
    sin_psi, cos_psi = sincos(psi)
    return Vec3(
        north_c * cos_psi + down_c * sin_psi,
        east,
        down_c * cos_psi - north_c * sin_psi,
    )
