# SPDX-License-Identifier: BSD-3-Clause
"""HOLD: motors off, wheels straight; the vehicle rolls out."""

from __future__ import annotations

from ....core.kernels import law
from ..control import motors


@law
def run(v):
    """One period."""
    motors.set_throttle(v.autopilot, 0.0)
    motors.set_steering(v.autopilot, 0.0)
