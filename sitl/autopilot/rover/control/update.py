# SPDX-License-Identifier: BSD-3-Clause
"""The controllers' part of the firmware: once at boot, and the last step of every period of 20 ms."""

from __future__ import annotations

from ....core.kernels import inline_unit, law
from ....core.records import Records
from ..state import Autopilot, Vehicle
from . import forward_speed, motors, position, servos
from .speed import decel_max
from .steering import lat_accel_max


@law
def init(ap: Autopilot) -> None:
    """Limits of the position controller to sane starts (gains are read live from the parameters).

    Harmless when called again.
    """
    p = ap.params
    if ap.control.position.speed_max <= 0.0:
        decel = decel_max(p.ATC)
        position.set_limits(ap.control.position, p.CRUISE.SPEED, decel, lat_accel_max(p.ATC), decel)


@inline_unit
def update(fleet: Records[Vehicle], i: int) -> None:
    """Carry out what the mode of vehicle ``i`` asked for and write its actuators."""
    v = fleet[i]
    ap = v.autopilot
    forward_speed.sense(v)
    motors.drive_motors(ap)
    servos.write_actuators(ap, v.actuators)
    ap.control.tick += 1
