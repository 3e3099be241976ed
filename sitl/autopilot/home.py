# SPDX-License-Identifier: BSD-3-Clause
"""Home: set once the estimator has an origin, moved to where the vehicle is armed unless it is locked."""

from __future__ import annotations

from ..core.algebra import with_down
from ..core.geodesy import add_offset, offset_ne
from ..core.kernels import law


@law
def set_here(v):
    """Home is where the vehicle is. Returns 1, or 0 without an origin."""
    ap = v.autopilot
    est = ap.estimate
    if est.origin_set == 0:
        return 0
    lat, lon = add_offset(est.origin_lat, est.origin_lon, est.pos.x, est.pos.y)
    ap.home.lat = int(lat + 0.5) if lat >= 0.0 else int(lat - 0.5)
    ap.home.lon = int(lon + 0.5) if lon >= 0.0 else int(lon - 0.5)
    ap.home.alt = est.origin_alt - est.pos.z
    ap.home.pos = est.pos
    ap.home.is_set = 1
    return 1


@law
def set_place(v, lat, lon, alt, lock):
    """Home at ``lat``, ``lon`` [degE7], ``alt`` above mean sea level [m]; ``lock``: arming does not move it.

    Returns 1, or 0 without an origin or for a place that is not on the globe (home stays as it was).
    """
    ap = v.autopilot
    est = ap.estimate
    if est.origin_set == 0 or alt - alt != 0.0:
        return 0
    if lat < -900000000 or lat > 900000000 or lon < -1800000000 or lon > 1800000000:
        return 0
    place = offset_ne(est.origin_lat, est.origin_lon, lat, lon)
    ap.home.lat = lat
    ap.home.lon = lon
    ap.home.alt = alt
    ap.home.pos = with_down(place, est.origin_alt - alt)
    ap.home.is_set = 1
    ap.home.locked = 1 if lock != 0 else 0
    return 1


@law
def update(v):
    """Set home for the first time."""
    if v.autopilot.home.is_set == 0:
        set_here(v)
