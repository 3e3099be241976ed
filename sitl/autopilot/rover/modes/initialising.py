# SPDX-License-Identifier: BSD-3-Clause
"""INITIALISING: when INITIAL_MODE cannot be entered at power-on, until another mode is selected."""

from __future__ import annotations

from ....core.kernels import law
from ..state import Vehicle
from .mode import RoverMode

INITIALISING = 16


@law
def run(v: Vehicle) -> None:
    """Nothing: it cannot be armed."""


MODE = RoverMode(
    number=INITIALISING,
    name="INITIALISING",
    run=run,
    needs_position=True,
    controlled=False,
    armable=False,
    selectable=False,
)
