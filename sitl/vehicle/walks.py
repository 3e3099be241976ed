# SPDX-License-Identifier: BSD-3-Clause
"""Another slow error of the receiver, as if it had walked there.

All that the autopilot has measured stays as it is, and so does the filter with its covariance: it is the vehicle that
is elsewhere. A move then brings it back, and takes the estimate along. Of a walk (Gauss-Markov) that ends elsewhere by
D, the value of t seconds ago is elsewhere by D exp(-t / correlation time); the filter, which forgets within some
seconds, has followed by a share of D a little below 1.

The barometer has no such thing: heights count from what it showed at the start, so only the change since then is an
error of the estimate.
"""

from __future__ import annotations

from typing import Any

from ..autopilot.estimation.noise import GPS_POSITION
from ..autopilot.estimation.state import POS
from ..core.constants import TICK_S
from ..core.vectors import Vec3


def share(v: Any) -> float:
    """How far the filter follows a receiver that walks, 0 .. 1."""
    time, sigma = v.physics.airframe.gps_drift_time, GPS_POSITION * v.autopilot.params.EK3.POSNE_M_NSE
    variance = float(v.autopilot.ekf.P[POS, POS])
    if not (time > 0.0 and variance > 0.0):
        return 1.0
    memory = v.physics.derived.gps_period * TICK_S * (variance + sigma * sigma) / variance
    return float(time / (time + memory))


def walk(v: Any, walks: tuple[float, float]) -> None:
    """Put the body where what was measured is true with this error.

    Args:
        v: record of a vehicle.
        walks: north, east, in standard deviations.
    """
    properties, receiver, here = v.physics.airframe, v.physics.sensors.gps[0], v.physics.body.pos
    north, east = walks
    before = receiver.drift
    receiver.drift = Vec3(north, east, before.z)
    size = share(v) * properties.noise_scale * properties.gps_drift_horizontal
    v.physics.body.pos = Vec3(here.x - size * (north - before.x), here.y - size * (east - before.y), here.z)
