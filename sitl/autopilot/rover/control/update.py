# SPDX-License-Identifier: BSD-3-Clause
"""The last step of the firmware's period of 20 ms: motors and actuators."""

from __future__ import annotations

from ....core.kernels import unit
from . import forward_speed, motors, outputs


@unit
def update(fleet, i):
    """Carry out what the mode of vehicle ``i`` asked for and write its actuators."""
    v = fleet[i]
    ap = v.autopilot
    forward_speed.sense(v)
    motors.update(ap)
    outputs.write_actuators(ap, v.actuators)
    ap.control.tick += 1
