# SPDX-License-Identifier: BSD-3-Clause
"""The origin of the estimate's NED frame: from the first good GPS fixes, or given by a ground station."""

from __future__ import annotations

from ...core.kernels import law
from .. import events
from .magnetometer import learn_field


@law
def place_origin(ap, lat_e7, lon_e7, alt, now_us):
    """Set the origin: alt [m] is the height above mean sea level of pos[2] = 0."""
    estimate = ap.estimate
    estimate.origin_lat, estimate.origin_lon, estimate.origin_alt = lat_e7, lon_e7, alt
    estimate.origin_set = 1
    learn_field(ap, lat_e7, lon_e7)
    events.emit(ap.events, now_us, events.EKF_ORIGIN_SET, 0.0, 0.0)


@law
def set_origin(ap, lat_e7, lon_e7, alt_m):
    """Origin given by a ground station (SET_GPS_GLOBAL_ORIGIN); returns 1, or 0 when there is one already."""
    if ap.estimate.origin_set != 0:
        return 0
    if abs(lat_e7) > 900000000 or abs(lon_e7) > 1800000000 or not abs(alt_m) < 1e5:
        return 0
    place_origin(ap, int(lat_e7), int(lon_e7), float(alt_m), ap.ekf.now_us)
    return 1
