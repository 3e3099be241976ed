# SPDX-License-Identifier: BSD-3-Clause
"""Where a joystick's axes go on the rover."""

from __future__ import annotations

from ...core.kernels import law
from ...vehicle.rover import Rover
from ..services.rc import FULL, ManualControl, is_driver, move_stick, note_ground_station


@law
def manual_control(m: ManualControl, v: Rover, sender: int) -> None:
    """MANUAL_CONTROL: right is steering, up is throttle."""
    if not is_driver(m, v, sender):
        return
    channels = v.autopilot.params.RCMAP
    move_stick(v, channels.ROLL, 1, m.y, -FULL, False)
    move_stick(v, channels.THROTTLE, 3, m.z, -FULL, False)
    note_ground_station(v)
