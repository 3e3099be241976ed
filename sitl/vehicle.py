# SPDX-License-Identifier: BSD-3-Clause
"""The whole simulated vehicle as one record; a fleet is an array of it."""

from __future__ import annotations

from .autopilot.state import ACTUATORS_DTYPE, AUTOPILOT_DTYPE, SENSORS_DTYPE
from .core.records import record
from .core.rng import RNG_DTYPE
from .physics.native.state import PHYSICS_DTYPE

VEHICLE_DTYPE = record(
    ("time_us", "i8"),  # since boot; only physics advances it
    ("tick", "i8"),  # autopilot ticks since boot
    ("rng", RNG_DTYPE),
    ("physics", PHYSICS_DTYPE),  # airframe figures and truth
    ("sensors", SENSORS_DTYPE),  # border: written by physics, read by the autopilot
    ("actuators", ACTUATORS_DTYPE),  # border: written by the autopilot, read by physics
    ("autopilot", AUTOPILOT_DTYPE),
)
TICK_US = 2500
"""One autopilot and physics tick: 400 Hz."""
