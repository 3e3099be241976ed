# SPDX-License-Identifier: BSD-3-Clause
"""Messages that each firmware fills in by laws of its own."""

from __future__ import annotations

from ..wire.message import Message


class ExtendedSysState(Message, name="EXTENDED_SYS_STATE"):
    """MAV_LANDED_STATE: 0 unknown, 1 on the ground, 2 in the air, 3 taking off, 4 landing; MAV_VTOL_STATE."""

    landed_state: int
    vtol_state: int


class NavControllerOutput(Message, name="NAV_CONTROLLER_OUTPUT"):
    """Lean targets and bearings [deg], distance to the target, beside the track and in height [m]."""

    nav_roll: float
    nav_pitch: float
    alt_error: float
    xtrack_error: float
    nav_bearing: int
    target_bearing: int
    wp_dist: int


class PositionTargetGlobalInt(Message, name="POSITION_TARGET_GLOBAL_INT"):
    """Where it goes [degE7], [m] above sea level."""

    time_boot_ms: int
    lat_int: int
    lon_int: int
    alt: float
    type_mask: int


class Wind(Message, name="WIND"):
    """Where it comes from [deg], speed, and downwards [m/s]."""

    direction: float
    speed: float
    speed_z: float
