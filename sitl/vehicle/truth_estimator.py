# SPDX-License-Identifier: BSD-3-Clause
"""``--estimator truth``: the simulator's truth in place of the Kalman filter's output, for work on controllers."""

from __future__ import annotations

from ..core.algebra import euler_of
from ..core.kernels import law
from ..core.vectors import Quat, Vec3

# EKF_STATUS_FLAGS: attitude, horizontal and vertical velocity, relative and absolute position, vertical position,
# predicted relative and absolute position.
_ALL_WELL = 1 | 2 | 4 | 8 | 16 | 32 | 256 | 512


@law
def observe(v):
    """Copy attitude, rates, velocity, position and acceleration of the body into the autopilot's estimate."""
    body, place, e = v.physics.body, v.physics.place, v.autopilot.estimate
    e.rates = Vec3(body.rates[0], body.rates[1], body.rates[2])
    e.vel = Vec3(body.vel[0], body.vel[1], body.vel[2])
    e.pos = Vec3(body.pos[0], body.pos[1], body.pos[2])
    e.acc_ned = Vec3(body.acc_ned[0], body.acc_ned[1], body.acc_ned[2])
    e.q = Quat(body.q[0], body.q[1], body.q[2], body.q[3])
    e.euler = euler_of(e.q)
    e.origin_lat, e.origin_lon, e.origin_alt = place.lat, place.lon, place.alt
    e.origin_set = 1
    e.attitude_ok = 1
    e.position_ok = 1
    e.status_flags = _ALL_WELL
