# SPDX-License-Identifier: BSD-3-Clause
"""From the simulator's axes to the scene's, and back: x north, y west, z up, as in world files (``worlds.shapes``)."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ..core.vectors import Quat, Vec3

Floats = npt.NDArray[np.float64]
FLIP = np.array([1.0, -1.0, -1.0])
"""NED to the scene's axes, FRD to a shape's (forward, left, up), and back."""


def to_scene(ned: Vec3) -> tuple[float, float, float]:
    """A position or a velocity in the scene's axes."""
    return (ned.x, -ned.y, -ned.z)


def turn(q: Quat) -> tuple[float, float, float, float]:
    """A body's attitude as the scene's quaternion of its shape."""
    return (q.w, q.x, -q.y, -q.z)


def all_to_scene(ned: Floats) -> Floats:
    """Many positions, shape (n, 3)."""
    return ned * FLIP


def turns(q: Floats) -> Floats:
    """Many attitudes, shape (n, 4)."""
    return q * (1.0, 1.0, -1.0, -1.0)


def about(axis: int, angle: float) -> tuple[float, float, float, float]:
    """Quaternion of a turn [rad] about axis 0, 1 or 2."""
    q = [float(np.cos(0.5 * angle)), 0.0, 0.0, 0.0]
    q[1 + axis] = float(np.sin(0.5 * angle))
    return (q[0], q[1], q[2], q[3])
