# SPDX-License-Identifier: BSD-3-Clause
"""Where a joystick's axes go on the copter."""

from __future__ import annotations

from ...core.kernels import law
from ...vehicle.copter import Copter
from ..services.rc import FULL, ManualControl, is_driver, move_stick, note_ground_station


@law
def manual_control(m: ManualControl, v: Copter, sender: int) -> None:
    """MANUAL_CONTROL: right is roll, forward is nose down, up is throttle from 0 on, turn is yaw."""
    if not is_driver(m, v, sender):
        return
    channels = v.autopilot.params.RCMAP
    move_stick(v, channels.ROLL, 1, m.y, -FULL, False)
    move_stick(v, channels.PITCH, 2, m.x, -FULL, True)
    move_stick(v, channels.THROTTLE, 3, m.z, 0, False)
    move_stick(v, channels.YAW, 4, m.r, -FULL, False)
    note_ground_station(v)
