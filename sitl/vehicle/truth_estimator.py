# SPDX-License-Identifier: BSD-3-Clause
"""``--estimator truth``: the simulator's truth in place of the Kalman filter's output, for work on controllers."""

from __future__ import annotations

from ..core.kernels import law
from ..core.rotations import quat_to_euler

# EKF_STATUS_FLAGS: attitude, horizontal and vertical velocity, relative and absolute position, vertical position,
# predicted relative and absolute position.
_ALL_WELL = 1 | 2 | 4 | 8 | 16 | 32 | 256 | 512


@law
def observe(v):
    """Copy attitude, rates, velocity, position and acceleration of the body into the autopilot's estimate."""
    body, place, e = v.physics.body, v.physics.place, v.autopilot.estimate
    for k in range(3):
        e.rates[k] = body.rates[k]
        e.vel[k] = body.vel[k]
        e.pos[k] = body.pos[k]
        e.acc_ned[k] = body.acc_ned[k]
    for k in range(4):
        e.q[k] = body.q[k]
    e.euler[0], e.euler[1], e.euler[2] = quat_to_euler(body.q[0], body.q[1], body.q[2], body.q[3])
    e.origin_lat, e.origin_lon, e.origin_alt = place.lat, place.lon, place.alt
    e.origin_set = 1
    e.attitude_ok = 1
    e.position_ok = 1
    e.status_flags = _ALL_WELL
