# SPDX-License-Identifier: BSD-3-Clause
"""Power-on of a rover that stands at its home."""

from __future__ import annotations

from ....vehicles import RoverAirframe
from ..power_on import Home, clear, place, wake
from ..records import Vehicle
from .prepare import prepare
from .state import Physics


def init(v: Vehicle[Physics], airframe: RoverAirframe, home: Home, seed: int) -> None:
    """Set physics, sensors, clock and random numbers of a vehicle to power-on; the wind's settings stay.

    Args:
        v: a view of one vehicle (``Record.of``).
        airframe: what it is.
        home: where it stands; altitude is that of the ground.
        seed: of all sensor errors; any integer.
    """
    clear(v, airframe, seed)
    prepare(v.physics.airframe, v.physics.derived)
    place(v.physics, home)
    wake(v)
