# SPDX-License-Identifier: BSD-3-Clause
"""Properties of a copter from its logs. Each is a function of the logs; what a log cannot show has the reason."""

from __future__ import annotations

from collections.abc import Sequence

from .balance import balance
from .board import CAPACITY, resistance, vibration
from .drag import drag
from .estimate import Begins, Estimate, silent
from .hover import hover
from .log_streams import FlightLog
from .rates import rates
from .sensors import sensors
from .thrust import thrust_expo


def estimates(logs: Sequence[FlightLog], begins: Begins = silent) -> list[Estimate]:
    """All properties of a copter that these logs show, and the others with the reason.

    Args:
        logs: of one vehicle.
        begins: called with what is worked on, which takes longest where rates are fast and flights long.
    """
    begins("hover")
    hovering = hover(logs)
    turned = rates(logs, begins)
    begins("thrust, balance, battery, drag, sensors")
    return [
        *hovering,
        *turned,
        thrust_expo(logs, hovering[0]),
        *balance(logs),
        resistance(logs),
        CAPACITY.hidden("a flight does not empty the battery"),
        *drag(logs),
        vibration(logs),
        *sensors(logs),
    ]
