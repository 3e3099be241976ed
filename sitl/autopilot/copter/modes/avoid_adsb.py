# SPDX-License-Identifier: BSD-3-Clause
"""AVOID_ADSB: stops and holds its position, as ArduPilot does while no aircraft is near; no traffic is simulated."""

from __future__ import annotations

from ....core.kernels import law
from ..state import Vehicle
from . import guided
from .mode import CopterMode, never_arms

AVOID_ADSB = 19


@law
def run(v: Vehicle) -> None:
    """One tick: GUIDED without set-points."""
    guided.run(v)


MODE = CopterMode(
    number=AVOID_ADSB,
    name="AVOID_ADSB",
    start=guided.start,
    run=run,
    needs_position=True,
    autonomous=True,
    may_arm=never_arms,
)
