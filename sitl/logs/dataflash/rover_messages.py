# SPDX-License-Identifier: BSD-3-Clause
"""Messages of the rover."""

from __future__ import annotations

from typing import Any

import numpy as np

from sitl.core import elementary_arrays as arrays

from ...autopilot.rover.modes import auto, guided
from ...autopilot.rover.modes.circle import CIRCLE
from ...autopilot.rover.modes.dock import DOCK
from ...autopilot.rover.modes.loiter import LOITER
from ...autopilot.rover.modes.mode_list import AUTONOMOUS
from ...autopilot.rover.modes.rtl import RTL
from ...autopilot.rover.modes.smart_rtl import SMART_RTL
from .. import plot
from ..kind import KindLogs
from . import bits, board, common, derived
from .derived import DEG
from .formats import Field, Message
from .samples import Array

COMPASS, STEERING, RC = 1 << 11, 1 << 13, 1 << 14
"""LOG_BITMASK"""
A, E, S = "autopilot.", "autopilot.estimate.", "sensors."
C, M = "autopilot.control.", "autopilot.modes."
_STEERING, _SPEED, _POSITION, _MOTORS = C + "steering.", C + "speed.", C + "position.", C + "motors."
_YAW = derived.euler(E + "q", 2)
_PATHS = (RTL, SMART_RTL)
"""Modes that follow paths all the time."""
_RECENT = 25
"""A position controller that last ran longer ago (periods) is not at work."""


def _attitude(fast: bool) -> Message:
    roll, pitch, yaw = (f"@euler[{k}]" if fast else derived.euler(E + "q", k) for k in range(3))
    return Message("ATT", bits.IMU_RATE if fast else bits.MEDIUM, bits.ATTITUDE | bits.ATTITUDE_FAST, ring=fast).of(
        Field("DesRoll", "f", "d", "0"),
        Field("Roll", "f", "d", "0", roll, DEG),
        Field("DesPitch", "f", "d", "0"),
        Field("Pitch", "f", "d", "0", pitch, DEG),
        Field("DesYaw", "f", "h", "0"),
        Field("Yaw", "f", "h", "0", derived.wrapped(yaw)),
        Field("AEKF", "B", source=3),
    )


def _any_of(s: Any, in_mode: tuple[int, ...], in_auto: tuple[int, ...], in_guided: tuple[int, ...] = ()) -> Array:
    """Whether the vehicle is in one of these modes, or does one of these things in AUTO or in GUIDED."""
    mode, of_auto, of_guided = (s.raw(M + name) for name in ("number", "auto.submode", "guided.submode"))
    guiding = (mode == guided.GUIDED) | ((mode == auto.AUTO) & (of_auto == auto.GUIDED_IN_MISSION))
    found = np.isin(mode, in_mode) | ((mode == auto.AUTO) & np.isin(of_auto, in_auto))
    return found | (guiding & np.isin(of_guided, in_guided))


def _drives_itself(s: Any) -> Array:
    return _any_of(s, AUTONOMOUS, ())


def _on_path(s: Any) -> Array:
    """Whether it follows a line to a position."""
    return _any_of(s, _PATHS, (auto.ON_PATH, auto.RETURNING), (guided.POSITION,))


def _holding_position(s: Any) -> Array:
    return _any_of(s, (LOITER,), (auto.LOITERING,))


def _on_circle(s: Any) -> Array:
    return _any_of(s, (CIRCLE,), (auto.CIRCLING,))


def _to_target(s: Any) -> tuple[Array, Array]:
    """Vector from the vehicle to its target: north, east [m]; 0 without a target."""
    targets = (
        (_on_path(s), "nav.target"), (_holding_position(s), "loiter.hold_pos"), (_on_circle(s), "circle.target"),
        (_any_of(s, (DOCK,), ()), "dock.pos"),
    )  # fmt: skip

    def offset(k: int) -> Array:
        here = s(f"{E}pos[{k}]")
        return np.select([where for where, _ in targets], [s(f"{M}{name}[{k}]") for _, name in targets], here) - here

    return offset(0), offset(1)


def _distance(s: Any) -> Array:
    return arrays.hypot(*_to_target(s))


def _bearing(s: Any) -> Array:
    north, east = _to_target(s)
    return np.mod(arrays.atan2(east, north) * DEG, 360.0)


def _heading(s: Any) -> Array:
    """The commanded heading, else the bearing to the target."""
    asked = _any_of(s, (), (), (guided.HEADING_AND_SPEED,))
    turning = _any_of(s, (), (auto.TURNING,))
    headings = [derived.wrapped(f"{M}{name}.heading")(s) for name in ("guided", "auto")]
    return np.select([asked, turning], headings, _bearing(s))


def _beside(s: Any) -> Array:
    return np.where(_on_path(s), s(M + "nav.drive.crosstrack"), 0.0)


def _lateral(s: Any) -> Array:
    """Speed times turn rate [m/s^2]."""
    return s(_SPEED + "forward") * s(E + "rates[2]")


THROTTLE = Message("THR", bits.MEDIUM, bits.CONTROL).of(
    Field("ThrIn", "h", source=M + "pilot.throttle", scale=100.0),
    Field("ThrOut", "f", source=_MOTORS + "throttle", scale=100.0),
    Field("DesSpeed", "f", "n", "0", _SPEED + "desired"),
    Field("Speed", "f", "n", "0", _SPEED + "forward"),
    Field("AccX", "f", "o", "0", S + "acc[0]"),
)
STER = Message("STER", bits.MEDIUM, STEERING).of(
    Field("SteerIn", "h", source=M + "pilot.steering", scale=4500.0),
    Field("SteerOut", "f", source=_MOTORS + "steering", scale=4500.0),
    Field("DesLatAcc", "f", "o", "0", _STEERING + "lat_accel"),
    Field("LatAcc", "f", "o", "0", _lateral),
    Field("DesTurnRate", "f", "k", "0", _STEERING + "turn_rate", DEG),
    Field("TurnRate", "f", "k", "0", E + "rates[2]", DEG),
)
NAVIGATION = Message("NTUN", bits.MEDIUM, bits.NAVIGATION, when=_drives_itself).of(
    Field("WpDist", "f", "m", "0", _distance),
    Field("WpBrg", "f", "h", "0", _bearing),
    Field("DesYaw", "f", "h", "0", _heading),
    Field("Yaw", "H", "h", "B", lambda s: np.mod(_YAW(s) * DEG * 100.0, 36000.0)),
    Field("XTrack", "f", "m", "0", _beside),
)
"""NTUN: where it goes by itself; not in the pilot's modes."""


def _at_work(s: Any) -> Array:
    """The position controller runs."""
    return (s.raw(_POSITION + "last_tick") > 0) & (s.raw(C + "tick") - s.raw(_POSITION + "last_tick") < _RECENT)


def _position(axis: str, k: int) -> Message:
    return common.position_control(axis, k, lambda name: f"{_POSITION}{name}[{k}]", "pos_target", _at_work)


def messages(bitmask: int, boot_unix_us: int, simulated: bool = True) -> tuple[Message, ...]:
    """All that this LOG_BITMASK asks for; ``simulated``: the record holds the truth."""
    every = (
        _attitude(bool(bitmask & bits.ATTITUDE_FAST)),
        *common.SENSORS,
        common.FLOW,
        common.battery(A + "battery.voltage"),
        THROTTLE,
        STER,
        NAVIGATION,
        *(_position(axis, k) for k, axis in enumerate("NE")),
        common.POSITION,
        *common.gps(boot_unix_us),
        common.magnetometer(COMPASS),
        common.pulses_in(RC),
        common.pulses_out(RC),
        Message("WENC", bits.MEDIUM, bits.CONTROL, when=S + "wheel_count").of(
            Field("Dist0", "f", "m", "0", S + "wheel_distance[0]"),
            Field("Qual0", "b", "-", "-", 100),
            Field("Dist1", "f", "m", "0", S + "wheel_distance[1]"),
            Field("Qual1", "b", "-", "-", 100),
        ),
        common.pid("PIDS", _STEERING + "rate", "ATC.STR_RAT.", E + "rates[2]", bits.ATTITUDE | bits.ATTITUDE_FAST),
        common.pid("PIDA", _SPEED + "loop", "ATC.SPEED.", _SPEED + "forward", bits.ATTITUDE | bits.ATTITUDE_FAST),
        common.LANDING_TARGET,
        *common.FILTER,
        common.AHR2,
        board.loop(50, boot_unix_us),
        board.more_pulses_in(RC),
        board.more_pulses_out(RC),
        *((common.TRUTH, common.TRUE_MOTION) if simulated else ()),
    )
    return tuple(m for m in every if m.bits & bitmask)


_MODES = "MANUAL ACRO - STEERING HOLD LOITER FOLLOW SIMPLE DOCK CIRCLE AUTO RTL SMART_RTL - - GUIDED INITIALISING"
"""https://mavlink.io/en/messages/ardupilotmega.html#ROVER_MODE"""

LOGS = KindLogs(
    messages=messages,
    title="ArduRover",
    build_type=1,
    word="Rover",
    mav_types=(10, 11),
    mode_names=tuple(_MODES.split()),
    parameters=("CRUISE_SPEED", "ATC_STR_RAT_P", "SPEED_TURN_GAIN"),
    panels=(plot.speed, plot.heading, plot.outputs),
)
