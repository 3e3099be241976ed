# SPDX-License-Identifier: BSD-3-Clause
"""The engine of a kind of vehicle."""

from __future__ import annotations

from ..engine import Engine, EngineError, Seat


def make(seat: Seat) -> Engine:
    """PyBullet for a vehicle.

    Raises:
        EngineError: there is none for its kind.
        sitl.core.extras.MissingExtra: pybullet is not installed.
    """
    if seat.airframe.kind == "copter":
        from .engine import BulletEngine

        return BulletEngine(seat)
    if seat.airframe.kind == "rover":
        from .rover import BulletRover

        return BulletRover(seat)
    raise EngineError(f"pybullet simulates copters and rovers, no {seat.airframe.kind!r}; native physics may")
