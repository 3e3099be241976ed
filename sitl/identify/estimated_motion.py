# SPDX-License-Identifier: BSD-3-Clause
"""How a vehicle moved and leaned, as its estimator knew it, on common times."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from .log_streams import FlightLog
from .signals import means

Array = np.ndarray[Any, Any]


class Motion(NamedTuple):
    """Means over the windows between edges."""

    roll: Array
    """[rad]"""
    pitch: Array
    yaw: Array
    velocity: Array
    """North, east, down [m/s] (n, 3)."""
    height: Array
    """Over the origin [m]."""

    def along_body(self, velocity: Array) -> Array:
        """Velocity (n, 3) NED in the body's frame (n, 3): forward, right, down."""
        north, east, down = velocity.T
        sr, cr, sp, cp = np.sin(self.roll), np.cos(self.roll), np.sin(self.pitch), np.cos(self.pitch)
        ahead = np.cos(self.yaw) * north + np.sin(self.yaw) * east
        right = np.cos(self.yaw) * east - np.sin(self.yaw) * north
        return np.stack(
            [
                cp * ahead - sp * down,
                sr * sp * ahead + cr * right + sr * cp * down,
                cr * sp * ahead - sr * right + cr * cp * down,
            ],
            -1,
        )


def motion(log: FlightLog, edges: Array) -> Motion:
    """Of a log with ATT and XKF1."""
    attitude, estimate = log.stream("ATT"), log.estimate()
    roll, pitch = (np.radians(means(attitude.time, attitude[name], edges)) for name in ("Roll", "Pitch"))
    yaw = means(attitude.time, np.unwrap(np.radians(attitude["Yaw"])), edges)
    moved = means(estimate.time, np.stack([estimate[name] for name in ("VN", "VE", "VD", "PD")], -1), edges)
    return Motion(roll, pitch, yaw, moved[:, :3], -moved[:, 3])
