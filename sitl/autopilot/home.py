# SPDX-License-Identifier: BSD-3-Clause
"""Home: set once the estimator has an origin, moved to where the vehicle is armed unless it is locked."""

from __future__ import annotations

from ..core.algebra import with_down
from ..core.geodesy import add_offset, offset_ne
from ..core.kernels import law
from ..core.scalars import finite
from .state import Estimate, HomeState


@law
def _nearest(x: float) -> int:
    return int(x + 0.5) if x >= 0.0 else int(x - 0.5)


def set_text(home: HomeState) -> str:
    """What the rover says of a new home."""
    return f"Set HOME to {home.lat * 1e-7:.7g} {home.lon * 1e-7:.7g} at {home.alt:.2f}m"


@law
def set_here(home: HomeState, est: Estimate) -> bool:
    """Home is where the vehicle is; False without an origin."""
    if not est.origin_set:
        return False
    location = add_offset(est.origin_lat, est.origin_lon, est.pos.x, est.pos.y)
    home.lat, home.lon = _nearest(location.lat), _nearest(location.lon)
    home.alt = est.origin_alt - est.pos.z
    home.pos = est.pos
    home.is_set = True
    return True


@law
def set_location(home: HomeState, est: Estimate, lat: int, lon: int, alt: float) -> bool:
    """Home at ``lat``, ``lon`` [degE7], ``alt`` above mean sea level [m], from where arming does not move it.

    False without an origin or for a location that is not on the globe (home stays as it was).
    """
    if not est.origin_set or not finite(alt) or abs(lat) > 900000000 or abs(lon) > 1800000000:
        return False
    home.lat, home.lon, home.alt = lat, lon, alt
    home.pos = with_down(offset_ne(est.origin_lat, est.origin_lon, lat, lon), est.origin_alt - alt)
    home.is_set = True
    home.locked = True
    return True


@law
def set_first(home: HomeState, est: Estimate) -> None:
    """Set home for the first time."""
    if not home.is_set:
        set_here(home, est)
