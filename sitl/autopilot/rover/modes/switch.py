# SPDX-License-Identifier: BSD-3-Clause
"""Arming and disarming with the steering stick of the pilot's transmitter (ARMING_RUDDER)."""

from __future__ import annotations

from ....core.kernels import law
from .state import PilotState
from .table import allows_arming_by_stick

HELD_US = 2_000_000
"""The steering stick arms (right) or disarms (left) when held for so long with the throttle at rest."""
FULL_STICK = 4000.0 / 4500.0


@law
def rudder_command(pilot: PilotState, mode: int, armed: bool, moving: bool, enabled: float) -> int:
    """What the steering stick asks for: 1 to arm, -1 to disarm, 0 nothing.

    ``moving``: the motors turn; ``enabled``: ARMING_RUDDER, 1 arms only.
    """
    if enabled < 1.0 or pilot.throttle != 0.0 or pilot.lost or not allows_arming_by_stick(mode):
        return 0
    if pilot.steering > FULL_STICK and not armed:
        return 1
    return -1 if pilot.steering < -FULL_STICK and armed and enabled >= 2.0 and not moving else 0


@law
def held(pilot: PilotState, wanted: int, time_us: int) -> int:
    """``wanted``, of every frame of the receiver, once the stick has asked for it long enough; else 0."""
    if wanted == 0:
        pilot.rudder_us = 0
    elif pilot.rudder_us == 0:
        pilot.rudder_us = time_us
    elif time_us - pilot.rudder_us >= HELD_US:
        pilot.rudder_us = 0
        return wanted
    return 0
