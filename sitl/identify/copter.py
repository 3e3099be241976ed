# SPDX-License-Identifier: BSD-3-Clause
"""Figures of a copter from its logs. Each is a function of the logs; what a log cannot tell is said with the reason."""

from __future__ import annotations

from collections.abc import Sequence

from .balance import balance
from .board import CAPACITY, resistance, vibration
from .drag import drag
from .figure import Figure
from .flight import FlightLog
from .hover import hover
from .rates import rates
from .sensors import sensors
from .thrust import thrust_expo


def figures(logs: Sequence[FlightLog]) -> list[Figure]:
    """All figures of a copter that these logs tell, and the others with the reason."""
    hovering = hover(logs)
    return [
        *hovering,
        *rates(logs),
        thrust_expo(logs, hovering[0]),
        *balance(logs),
        resistance(logs),
        CAPACITY.hidden("a flight does not empty the battery"),
        *drag(logs),
        vibration(logs),
        *sensors(logs),
    ]
