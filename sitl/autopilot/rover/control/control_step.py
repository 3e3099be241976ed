# SPDX-License-Identifier: BSD-3-Clause
"""The controllers' part of the firmware: once at boot, and the last step of every period of 20 ms."""

from __future__ import annotations

from ....core.kernels import inline_unit
from ....core.records import Records
from ..parameters import Parameters
from ..state import Vehicle
from . import motors, position, servos
from .speed import decel_max
from .state import Control
from .steering import lat_accel_max


def init(control: Control, params: Parameters) -> None:
    """Limits of the position controller to sane starts (gains are read live from the parameters).

    Harmless when called again.
    """
    if control.position.speed_max <= 0.0:
        decel = decel_max(params.ATC)
        position.set_limits(control.position, params.CRUISE.SPEED, decel, lat_accel_max(params.ATC), decel)


@inline_unit
def update(fleet: Records[Vehicle], i: int) -> None:
    """Carry out what the mode of vehicle ``i`` asked for and write its actuators; its speed has been sensed
    (``modes.update``)."""
    v = fleet[i]
    ap = v.autopilot
    armed = ap.arming.armed and not ap.arming.emergency_stop
    motors.drive_motors(ap.control, armed, ap.params)
    servos.write_actuators(ap.control.motors, v.actuators, ap.rc, armed, ap.params)
    ap.control.tick += 1
