# SPDX-License-Identifier: BSD-3-Clause
"""From the frame of world files (x forward, y left, z up) to the simulator's NED, and back.

North is x, east is -y, down is -z, heading is -yaw: as in the original, where simulated x was north and y west. Signs
change and nothing else, so no bit is lost on the way.
"""

from __future__ import annotations


def to_ned(x: float, y: float, z: float) -> tuple[float, float, float]:
    """North, east, down [m] of a point of a world file [m]."""
    return x, 0.0 - y, 0.0 - z


def from_ned(north: float, east: float, down: float) -> tuple[float, float, float]:
    """x, y, z [m] of a point in the simulator's frame [m]."""
    return north, 0.0 - east, 0.0 - down


def to_heading(yaw: float) -> float:
    """Heading [rad], clockwise from north, of a yaw [rad], counter-clockwise from x."""
    return 0.0 - yaw


def from_heading(heading: float) -> float:
    """Yaw [rad], counter-clockwise from x, of a heading [rad], clockwise from north."""
    return 0.0 - heading
