# SPDX-License-Identifier: BSD-3-Clause
"""The figures that every vehicle with an autopilot has."""

from __future__ import annotations

from .battery import Battery
from .body import Body, Outline
from .ranging import Ranging
from .sensors import Sensors


class Figures(Body, Battery, Sensors, Outline, Ranging):
    """What all kinds have; each kind has more."""
