# SPDX-License-Identifier: BSD-3-Clause
"""Items as ArduPilot's mission storage keeps them, and as they are read back.

A parameter that does not fit is dropped, a whole number loses its fraction and wraps at its width, an altitude is whole
centimetres, and an item without a location has frame 0. All of it was measured:
``tests/conformance/kept/items-*.json``.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ...core.mavlink import MavCmd, MavFrame
from .item import COMMANDS, MissionItem, home_item

Keep = Callable[[float], float]
_SAME_FRAME: dict[int, int] = {
    MavFrame.MISSION: MavFrame.GLOBAL,
    MavFrame.GLOBAL_INT: MavFrame.GLOBAL,
    MavFrame.GLOBAL_RELATIVE_ALT_INT: MavFrame.GLOBAL_RELATIVE_ALT,
    MavFrame.GLOBAL_TERRAIN_ALT_INT: MavFrame.GLOBAL_TERRAIN_ALT,
}
_CENTI, _HUNDRED = np.float32(0.01), np.float32(100.0)
_RANGE = 1 << 31
FINE_MAX, TURNS_MAX = 255.0, 255.0
"""Circles of LOITER_TURNS: greatest radius to the metre [m]; most turns."""
MAVLINK_TARGETING = 2.0
"""MAV_MOUNT_MODE of every stored DO_MOUNT_CONTROL."""
ALLOWS_START_DISARMED = 1
"""ENGINE_CONTROL_OPTIONS"""


def whole(value: float) -> int:
    """As a processor of SITL's makes a whole number of it: towards zero; what does not fit becomes the least one."""
    return int(value) if -_RANGE - 1 < value < _RANGE else -_RANGE


def _unsigned(bits: int) -> Keep:
    return lambda value: float(whole(value) % (1 << bits))


def _signed(bits: int) -> Keep:
    most = 1 << (bits - 1)
    return lambda value: float((whole(value) + most) % (2 * most) - most)


u8, u16, i8, i16 = _unsigned(8), _unsigned(16), _signed(8), _signed(16)


def real(value: float) -> float:
    """A number of 32 bits, as it comes."""
    return value


def half(value: float) -> float:
    """A number of 16 bits."""
    with np.errstate(over="ignore"):
        return float(np.float16(value))


def dropped(value: float) -> float:
    """There is no space for it."""
    return 0.0


def flag(value: float) -> float:
    """Greater than zero or not."""
    return float(value > 0.0)


def sign(value: float) -> float:
    """Only the direction of a circle: 1 clockwise, -1."""
    return -1.0 if value < 0.0 else 1.0


def sized(value: float) -> float:
    """A whole size with a direction."""
    size = u16(abs(value))
    return -size if value < 0.0 and size else size


def centimetres(value: float) -> float:
    """Whole centimetres [m], as a length that is never negative."""
    return float(np.float32(u16(float(np.float32(value) * _HUNDRED))) * _CENTI)


def altitude(value: float) -> float:
    """Whole centimetres, cut off towards zero [m]."""
    return float(np.float32(whole(float(np.float32(value) * _HUNDRED))) * _CENTI)


def within(least: float, most: float) -> Keep:
    """A whole angle [deg]; zero for one that is out of its limits."""
    return lambda value: i16(value) if least <= value <= most else 0.0


class Kept(NamedTuple):
    """What is kept of a command's parameters; of those behind the fourth only where it has no location."""

    p1: Keep = dropped
    p2: Keep = dropped
    p3: Keep = dropped
    p4: Keep = dropped
    x: Keep = dropped
    y: Keep = dropped
    z: Keep = dropped


KEPT: dict[int, Kept] = {
    MavCmd.NAV_WAYPOINT: Kept(u16),
    MavCmd.NAV_LOITER_UNLIM: Kept(p3=sized),
    MavCmd.NAV_LOITER_TURNS: Kept(real, p3=real, p4=flag),  # ``_circle`` does the rest
    MavCmd.NAV_LOITER_TIME: Kept(u16, p3=sign, p4=flag),
    MavCmd.NAV_LAND: Kept(u16, p4=sign),
    MavCmd.NAV_TAKEOFF: Kept(u16),
    MavCmd.NAV_CONTINUE_AND_CHANGE_ALT: Kept(u16),
    MavCmd.NAV_LOITER_TO_ALT: Kept(p2=sized, p4=flag),
    MavCmd.NAV_ARC_WAYPOINT: Kept(sized),
    MavCmd.NAV_SPLINE_WAYPOINT: Kept(u16),
    MavCmd.NAV_ALTITUDE_WAIT: Kept(real, real, u8),
    MavCmd.NAV_VTOL_LAND: Kept(u16),
    MavCmd.NAV_GUIDED_ENABLE: Kept(u16),
    MavCmd.NAV_DELAY: Kept(real, i8, i8, i8),
    MavCmd.NAV_PAYLOAD_PLACE: Kept(centimetres),
    MavCmd.NAV_SET_YAW_SPEED: Kept(real, real, u8),
    MavCmd.NAV_SCRIPT_TIME: Kept(u8, u8, half, half, i16, i16),
    MavCmd.NAV_ATTITUDE_TIME: Kept(
        lambda v: u16(min(max(v, 0.0), 65535.0)),
        within(-180.0, 180.0),
        within(-90.0, 90.0),
        within(-180.0, 360.0),
        i16,
    ),
    MavCmd.CONDITION_DELAY: Kept(real),
    MavCmd.CONDITION_DISTANCE: Kept(real),
    MavCmd.CONDITION_YAW: Kept(real, real, i8, u8),
    MavCmd.DO_JUMP: Kept(u16, i16),
    MavCmd.DO_JUMP_TAG: Kept(u16, i16),
    MavCmd.JUMP_TAG: Kept(u16),
    MavCmd.DO_CHANGE_SPEED: Kept(u8, real, real),
    MavCmd.DO_SET_HOME: Kept(u16),
    MavCmd.DO_SET_RELAY: Kept(u8, u8),
    MavCmd.DO_REPEAT_RELAY: Kept(u8, i16, real),
    MavCmd.DO_SET_SERVO: Kept(u8, u16),
    MavCmd.DO_REPEAT_SERVO: Kept(u8, u16, i16, real),
    MavCmd.DO_AUTOTUNE_ENABLE: Kept(u16),
    MavCmd.DO_PAUSE_CONTINUE: Kept(u16),
    MavCmd.DO_SET_REVERSE: Kept(u16),
    MavCmd.DO_SET_ROI_LOCATION: Kept(u16),
    MavCmd.DO_SET_ROI_NONE: Kept(u16),
    MavCmd.DO_SET_ROI: Kept(u16),
    MavCmd.DO_DIGICAM_CONFIGURE: Kept(u8, u16, u8, u16, u8, u8, real),
    MavCmd.DO_DIGICAM_CONTROL: Kept(u8, u8, i8, u8, u8, u8),
    MavCmd.DO_MOUNT_CONTROL: Kept(real, real, real, z=lambda _: MAVLINK_TARGETING),
    MavCmd.DO_SET_CAM_TRIGG_DIST: Kept(real, p3=u8),
    MavCmd.DO_FENCE_ENABLE: Kept(u16),
    MavCmd.DO_PARACHUTE: Kept(u16),
    MavCmd.DO_INVERTED_FLIGHT: Kept(u16),
    MavCmd.DO_GRIPPER: Kept(u8, u8),
    MavCmd.DO_SET_RESUME_REPEAT_DIST: Kept(u16),
    MavCmd.DO_SPRAYER: Kept(u16),
    MavCmd.DO_SEND_SCRIPT_MESSAGE: Kept(u16, real, real, real),
    MavCmd.DO_AUX_FUNCTION: Kept(u16, u8),
    MavCmd.DO_GUIDED_LIMITS: Kept(u16, real, real, real),
    MavCmd.DO_ENGINE_CONTROL: Kept(flag, flag, centimetres, lambda v: float(whole(v) & ALLOWS_START_DISARMED)),
    MavCmd.SET_CAMERA_ZOOM: Kept(u8, real),
    MavCmd.SET_CAMERA_FOCUS: Kept(u8, real),
    MavCmd.SET_CAMERA_SOURCE: Kept(u8, u8, u8),
    MavCmd.DO_GIMBAL_MANAGER_PITCHYAW: Kept(i8, i16, i8, i8, u8, z=u8),
    MavCmd.IMAGE_START_CAPTURE: Kept(u8, real, u16, u16),
    MavCmd.IMAGE_STOP_CAPTURE: Kept(u16),
    MavCmd.VIDEO_START_CAPTURE: Kept(u8),
    MavCmd.VIDEO_STOP_CAPTURE: Kept(u8),
    MavCmd.DO_VTOL_TRANSITION: Kept(u8),
    MavCmd.DO_WINCH: Kept(u8, u8, real, real),
}
"""By command. Of one that is not here, as RTL, nothing is kept but its location."""


def stored(item: MissionItem) -> MissionItem:
    """A valid item of a mission as it is kept and read back.

    Keeping that again changes nothing but, as in ArduPilot, the last centimetre of a few heights (327.36 to 327.35 m).
    """
    kept = KEPT.get(item.command, Kept())
    p1, p2, p3, p4 = (
        0.0 if math.isnan(value) and keep is not sign else keep(value)
        for keep, value in zip(kept[:4], (item.p1, item.p2, item.p3, item.p4), strict=True)
    )
    if item.command == MavCmd.NAV_LOITER_TURNS:
        p1, p3 = _circle(item.p1, item.p3)
    if COMMANDS[item.command].has_location:
        frame = _SAME_FRAME.get(item.frame, item.frame)
        return MissionItem(item.command, frame, p1, p2, p3, p4, item.x, item.y, altitude(item.z))
    x, y = int(kept.x(item.x)), int(kept.y(item.y))
    z = 0.0 if kept.z is dropped else kept.z(item.z)
    return MissionItem(item.command, MavFrame.GLOBAL, p1, p2, p3, p4, x, y, z)


def stored_home(lat: int, lon: int, alt: float) -> MissionItem:
    """Item 0: home [degE7, m above mean sea level], to the nearest centimetre."""
    return home_item(lat, lon, float(np.float32(round(alt * 100.0)) * _CENTI))


def _circle(turns: float, radius: float) -> tuple[float, float]:
    """Turns in 8 bits, parts of one in 256ths; radius in 8 bits, beyond 255 m in tens of metres. They share 16 bits:
    less than no turns also fills those of the radius."""
    count = int(turns * 256.0) if 0.0 < turns < 1.0 else whole(min(TURNS_MAX, turns)) % (1 << 16)
    share = 1.0 / 256.0 if 0.0 < turns < 1.0 else 1.0
    size = abs(radius)
    step = 1.0 if size <= FINE_MAX else 10.0
    bits = count | whole(size if step == 1.0 else min(FINE_MAX, 0.1 * size)) % 256 << 8
    around = float(bits >> 8) * step
    return float(bits % 256) * share, -around if radius < 0.0 else around
