# SPDX-License-Identifier: BSD-3-Clause
"""The core's entry: physics and autopilot, tick by tick, for as long as nothing needs Python."""

from __future__ import annotations

from .autopilot import firmware
from .autopilot.events import HIT_GROUND, emit
from .core.kernels import unit
from .physics.native.step import step
from .truth_estimator import observe


@unit
def advance(fleet, index, ticks):
    """Advance one vehicle by up to ``ticks`` ticks of 2500 us.

    Returns early, at the end of a tick in which something happened (``autopilot.events``). The border is crossed
    once a tick: physics writes ``sensors``, the autopilot reads them and writes ``actuators``.
    """
    vehicle = fleet[index]
    events = vehicle.autopilot.events
    told = events.count
    for _ in range(ticks):
        step(fleet, index)
        ground = vehicle.physics.ground
        if ground.hit_count > 0 and ground.hit_time_us == vehicle.time_us:
            emit(vehicle.autopilot.events, vehicle.time_us, HIT_GROUND, ground.hit_speed, 0.0)
        if vehicle.autopilot.ekf.use_external != 0:
            observe(vehicle)
        firmware.update(fleet, index)
        if events.attention != 0 or events.count != told:
            break
