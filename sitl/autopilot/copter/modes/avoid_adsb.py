# SPDX-License-Identifier: BSD-3-Clause
"""AVOID_ADSB: stops and holds its place, as ArduPilot's does while no aircraft comes near; here none does."""

from __future__ import annotations

from . import guided
from .mode import CopterMode, never_arms

AVOID_ADSB = 19

MODE = CopterMode(
    number=AVOID_ADSB,
    name="AVOID_ADSB",
    start=guided.start,
    run=guided.run,
    needs_position=True,
    autonomous=True,
    may_arm=never_arms,
)
