# SPDX-License-Identifier: BSD-3-Clause
"""The whole simulated vehicle as one record, a type for each kind of vehicle; a fleet is an array of it."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..autopilot.copter.state import AUTOPILOT_DTYPE as COPTER_AUTOPILOT
from ..autopilot.rover.state import AUTOPILOT_DTYPE as ROVER_AUTOPILOT
from ..autopilot.state import ACTUATORS_DTYPE, SENSORS_DTYPE
from ..core.records import record
from ..core.rng import RNG_DTYPE
from ..physics.native.copter.state import PHYSICS_DTYPE as COPTER_PHYSICS
from ..physics.native.rover.state import PHYSICS_DTYPE as ROVER_PHYSICS

TICK_US = 2500
"""One autopilot and physics tick: 400 Hz."""


def vehicle_dtype(physics: np.dtype[Any], autopilot: np.dtype[Any]) -> np.dtype[Any]:
    """A vehicle of this physics with this firmware."""
    return record(
        ("time_us", "i8"),  # since boot; only physics advances it
        ("tick", "i8"),  # ticks since boot
        ("rng", RNG_DTYPE),
        ("physics", physics),  # airframe figures and truth
        ("sensors", SENSORS_DTYPE),  # border: written by physics, read by the autopilot
        ("actuators", ACTUATORS_DTYPE),  # border: written by the autopilot, read by physics
        ("autopilot", autopilot),
    )


COPTER_DTYPE = vehicle_dtype(COPTER_PHYSICS, COPTER_AUTOPILOT)
ROVER_DTYPE = vehicle_dtype(ROVER_PHYSICS, ROVER_AUTOPILOT)
