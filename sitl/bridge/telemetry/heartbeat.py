# SPDX-License-Identifier: BSD-3-Clause
"""HEARTBEAT: who is there. What a vehicle of this type says is its firmware's."""

from __future__ import annotations

from ...autopilot.modes import shown
from ...core.kernels import law
from ...core.mavlink import MavAutopilot
from ...vehicle.record import Vehicle
from ..wire.message import Message

MAVLINK_VERSION = 3


class Heartbeat(Message, name="HEARTBEAT"):
    custom_mode: int
    type: int
    autopilot: int
    base_mode: int
    system_status: int
    mavlink_version: int


@law
def fill_heartbeat(m: Heartbeat, v: Vehicle, mav_type: int, base_mode: int, state: int) -> bool:
    """HEARTBEAT of a vehicle of this MAV_TYPE."""
    m.custom_mode = shown(v.autopilot.modes) & 0xFFFFFFFF
    m.type = mav_type
    m.autopilot = MavAutopilot.ARDUPILOTMEGA
    m.base_mode = base_mode
    m.system_status = state
    m.mavlink_version = MAVLINK_VERSION
    return True
