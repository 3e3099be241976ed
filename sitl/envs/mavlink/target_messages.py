# SPDX-License-Identifier: BSD-3-Clause
"""Set-points as MAVLink's messages."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from sitl.bridge.dialect import message
from sitl.bridge.services.setpoint_messages import (
    ACCELERATION_IGNORED,
    ATTITUDE_IGNORED,
    BODY_YAW_RATE_IGNORED,
    PITCH_RATE_IGNORED,
    POSITION_IGNORED,
    ROLL_RATE_IGNORED,
    VELOCITY_IGNORED,
    YAW_IGNORED,
    YAW_RATE_IGNORED,
    YAWS_IGNORED,
)
from sitl.core.algebra import quat_from_euler
from sitl.core.mavlink import MavFrame
from sitl.core.vectors import Euler
from sitl.worlds.shapes import to_heading, to_ned

from .last_messages import StepTelemetry

OVERRIDE, LOCAL, TARGET = (
    message(name) for name in ("RC_CHANNELS_OVERRIDE", "SET_POSITION_TARGET_LOCAL_NED", "SET_ATTITUDE_TARGET")
)
VELOCITY_ONLY = POSITION_IGNORED | ACCELERATION_IGNORED | YAW_IGNORED
POSITION_ONLY = VELOCITY_IGNORED | ACCELERATION_IGNORED | YAW_RATE_IGNORED
ACCELERATION_ONLY = POSITION_IGNORED | VELOCITY_IGNORED | YAW_IGNORED
RATES_ONLY = ATTITUDE_IGNORED
ATTITUDE_ALONE = ROLL_RATE_IGNORED | PITCH_RATE_IGNORED | BODY_YAW_RATE_IGNORED
ATTITUDE_AND_RATES = 0
"""To a copter some rates without the others are a reason to stop."""
TURN_AND_LEAN = ROLL_RATE_IGNORED | PITCH_RATE_IGNORED
TURN_AND_SPEED = ROLL_RATE_IGNORED | PITCH_RATE_IGNORED | ATTITUDE_IGNORED

Message = tuple[Any, bytes]
"""Kind, payload."""
Encode = Callable[[Sequence[float], StepTelemetry, Sequence[float]], Message]
"""``encode(row of the set-point, what the vehicle says, NED of its local origin in the world [m])``."""


def override(row: Sequence[float], inbox: StepTelemetry, origin: Sequence[float]) -> Message:
    """RC_CHANNELS_OVERRIDE: eight pulses [us]; 0 releases a channel."""
    return OVERRIDE, OVERRIDE.pack(*(round(pulse) for pulse in row), inbox.system, 1, *(0,) * 10)


def velocity(row: Sequence[float], inbox: StepTelemetry, origin: Sequence[float]) -> Message:
    """SET_POSITION_TARGET_LOCAL_NED: velocities along the body's heading [m/s], turn rate [rad/s]."""
    forward, left, up, turn = row
    motion = {"vx": forward, "vy": -left, "vz": -up, "yaw_rate": -turn}
    return LOCAL, LOCAL.payload(
        target_system=inbox.system, coordinate_frame=MavFrame.BODY_OFFSET_NED, type_mask=VELOCITY_ONLY, **motion
    )


def position(row: Sequence[float], inbox: StepTelemetry, origin: Sequence[float], mask: int = POSITION_ONLY) -> Message:
    """SET_POSITION_TARGET_LOCAL_NED: a position of the world [m], yaw [rad]."""
    north, east, down = to_ned(*row[:3])
    fields = {"x": north - origin[0], "y": east - origin[1], "z": down - origin[2], "yaw": to_heading(row[3])}
    return LOCAL, LOCAL.payload(
        target_system=inbox.system, coordinate_frame=MavFrame.LOCAL_NED, type_mask=mask, **fields
    )


def rover_position(row: Sequence[float], inbox: StepTelemetry, origin: Sequence[float]) -> Message:
    """The same (x, y [m]) without a yaw, which a car cannot take at will."""
    return position(row, inbox, origin, POSITION_ONLY | YAWS_IGNORED)


def leaning(roll: float, pitch: float, inbox: StepTelemetry) -> Any:
    """The attitude with these angles [rad] and the heading that there is, as a quaternion."""
    return quat_from_euler(Euler(roll, pitch, inbox.attitude[3]))


def attitude(row: Sequence[float], inbox: StepTelemetry, origin: Sequence[float]) -> Message:
    """SET_ATTITUDE_TARGET: roll, pitch [rad], turn rate [rad/s], climb -1 .. 1."""
    roll, pitch, turn, climb = row
    q = leaning(roll, pitch, inbox)
    return TARGET, TARGET.payload(
        target_system=inbox.system,
        type_mask=ATTITUDE_AND_RATES,
        q=q,
        body_yaw_rate=-turn,
        thrust=0.5 + 0.5 * climb,
    )


def acceleration(row: Sequence[float], inbox: StepTelemetry, origin: Sequence[float]) -> Message:
    """SET_POSITION_TARGET_LOCAL_NED: accelerations along the body's heading [m/s^2], turn rate [rad/s]."""
    forward, left, up, turn = row
    motion = {"afx": forward, "afy": -left, "afz": -up, "yaw_rate": -turn}
    return LOCAL, LOCAL.payload(
        target_system=inbox.system, coordinate_frame=MavFrame.BODY_OFFSET_NED, type_mask=ACCELERATION_ONLY, **motion
    )


def thrust(row: Sequence[float], inbox: StepTelemetry, origin: Sequence[float]) -> Message:
    """SET_ATTITUDE_TARGET: roll, pitch [rad], turn rate [rad/s], thrust 0 .. 1."""
    roll, pitch, turn, share = row
    q = leaning(roll, pitch, inbox)
    return TARGET, TARGET.payload(
        target_system=inbox.system, type_mask=ATTITUDE_AND_RATES, q=q, body_yaw_rate=-turn, thrust=share
    )


def rates(row: Sequence[float], inbox: StepTelemetry, origin: Sequence[float]) -> Message:
    """SET_ATTITUDE_TARGET: rates of the body [rad/s], thrust 0 .. 1."""
    roll, pitch, turn, share = row
    return TARGET, TARGET.payload(
        target_system=inbox.system, type_mask=RATES_ONLY, q=(1.0, 0.0, 0.0, 0.0), body_roll_rate=roll,
        body_pitch_rate=pitch, body_yaw_rate=-turn, thrust=share,
    )  # fmt: skip


def rover_attitude(row: Sequence[float], inbox: StepTelemetry, origin: Sequence[float]) -> Message:
    """SET_ATTITUDE_TARGET: turn rate [rad/s], throttle -1 .. 1, a share of WP_SPEED."""
    return TARGET, TARGET.payload(
        target_system=inbox.system, type_mask=TURN_AND_SPEED, body_yaw_rate=-row[2], thrust=row[3]
    )


COMMON: dict[str, Encode] = {"rc": override, "velocity": velocity}
COPTER: dict[str, Encode] = {
    **COMMON, "loiter": override, "position": position, "attitude": attitude, "acceleration": acceleration,
    "thrust": thrust, "rates": rates,
}  # fmt: skip
ROVER: dict[str, Encode] = {**COMMON, "position": rover_position, "attitude": rover_attitude}
"""Kind of set-point -> its message."""
