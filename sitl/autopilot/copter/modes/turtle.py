# SPDX-License-Identifier: BSD-3-Clause
"""TURTLE: would flip an overturned vehicle by reversed motors (DShot); not simulated, always refused.

The simulated motors have no such controllers, as in ArduPilot's own simulator."""

from __future__ import annotations

from ....core.kernels import law
from ...modes import ModeResult
from ..state import Vehicle
from . import stabilize
from .mode import CopterMode, never_arms

TURTLE = 28


@law
def start(v: Vehicle) -> int:
    """It cannot be entered."""
    return ModeResult.INIT_FAILED


@law
def run(v: Vehicle) -> None:
    """It never runs; a mode must fly."""
    stabilize.run(v)


MODE = CopterMode(
    number=TURTLE, name="TURTLE", start=start, run=run, manual_throttle=True, needs_pilot=True, may_arm=never_arms
)
