# SPDX-License-Identifier: BSD-3-Clause
"""What the filter takes position, velocity and heading from (EK3_SRC1_* .. EK3_SRC3_*), and changes of that."""

from __future__ import annotations

from ...core.kernels import law
from ..params.without_gps import Sources
from ..state import Autopilot

NONE, BAROMETER, GPS, FLOW, EXTERNAL = 0, 1, 3, 5, 6
COMPASS = 1
SETS = 3


@law
def are_usual(s: Sources) -> bool:
    """Whether these are GPS, barometer and compass."""
    return s.POSXY == GPS and s.VELXY == GPS and s.VELZ == GPS and s.POSZ != EXTERNAL and s.YAW == COMPASS


@law
def aid(s: Sources) -> bool:
    """Whether there is a source of horizontal position or velocity besides GPS."""
    return s.VELXY == FLOW or s.VELXY == EXTERNAL or s.POSXY == EXTERNAL


@law
def choose_set(ap: Autopilot, number: int) -> None:
    """Let both filters take set ``number`` (0 .. 2) from now on."""
    ap.ekf.source_set = ap.second_lane.ekf.source_set = number
