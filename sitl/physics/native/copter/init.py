# SPDX-License-Identifier: BSD-3-Clause
"""Power-on of a multicopter that stands on the ground at its home."""

from __future__ import annotations

from ....vehicles import CopterAirframe
from ..power_on import Home, clear, place, wake
from ..records import GROUND_STANDING, Vehicle
from .prepare import prepare
from .state import Physics


def init(v: Vehicle[Physics], airframe: CopterAirframe, home: Home, seed: int) -> None:
    """Set physics, sensors, clock and random numbers of a vehicle to power-on; the wind's settings stay.

    Args:
        v: a view of one vehicle (``Record.of``).
        airframe: what it is.
        home: where it stands; altitude is that of the ground.
        seed: of all sensor errors and turbulence; any integer.
    """
    clear(v, airframe, seed)
    p = v.physics
    p.rotors.share[:] = 1.0
    p.ground.state = GROUND_STANDING
    prepare(p.airframe, p.derived)
    place(p, home)
    wake(v)
