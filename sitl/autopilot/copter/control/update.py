# SPDX-License-Identifier: BSD-3-Clause
"""The last step of the firmware's tick: rate loops, motors, actuators."""

from __future__ import annotations

from ....core.kernels import unit
from . import motors, rate, throttle_mix


@unit
def update(fleet, i):
    """Follow ``attitude.rate_target`` of vehicle ``i`` and write its actuators."""
    v = fleet[i]
    ap = v.autopilot
    throttle_mix.update_mix(ap)
    rate.update(ap)
    motors.update(ap, v.time_us)
    motors.write_actuators(ap, v.actuators)
    ap.control.tick += 1
