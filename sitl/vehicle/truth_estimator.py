# SPDX-License-Identifier: BSD-3-Clause
"""``--estimator truth``: the simulator's truth in place of the Kalman filter's output, for work on controllers."""

from __future__ import annotations

from ..core.algebra import euler_of
from ..core.kernels import law
from .record import Vehicle

# EKF_STATUS_FLAGS: attitude, horizontal and vertical velocity, relative and absolute position, vertical position,
# predicted relative and absolute position.
_ALL_WELL = 1 | 2 | 4 | 8 | 16 | 32 | 256 | 512


@law
def observe(v: Vehicle) -> None:
    """Copy attitude, rates, velocity, position and acceleration of the body into the autopilot's estimate."""
    body, place, e = v.physics.body, v.physics.place, v.autopilot.estimate
    e.rates, e.vel, e.pos, e.acc_ned, e.q = body.rates, body.vel, body.pos, body.acc_ned, body.q
    e.euler = euler_of(e.q)
    e.origin_lat, e.origin_lon, e.origin_alt = place.lat, place.lon, place.alt
    e.origin_set = True
    e.attitude_ok = True
    e.position_ok = True
    e.status_flags = _ALL_WELL
