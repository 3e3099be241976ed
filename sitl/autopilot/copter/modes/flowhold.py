# SPDX-License-Identifier: BSD-3-Clause
"""FLOWHOLD: would hold the place by an optical flow sensor; always refused, as no vehicle has one."""

from __future__ import annotations

from ....core.kernels import law
from ...modes import INIT_FAILED
from ..state import Vehicle
from . import stabilize
from .mode import CopterMode, never_arms

FLOWHOLD = 22


@law
def start(v: Vehicle) -> int:
    """It cannot be entered."""
    return INIT_FAILED


@law
def run(v: Vehicle) -> None:
    """It never runs; a mode must fly."""
    stabilize.run(v)


MODE = CopterMode(number=FLOWHOLD, name="FLOWHOLD", start=start, run=run, manual_throttle=False, may_arm=never_arms)
