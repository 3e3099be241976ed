# SPDX-License-Identifier: BSD-3-Clause
"""PX4's ways: flight by set-points in its mode OFFBOARD, which it enters and keeps only while they come."""

from __future__ import annotations

from collections.abc import Sequence

from sitl.bridge.services.setpoints import (
    ACCELERATION_IGNORED,
    LOCAL_NED,
    POSITION_IGNORED,
    VELOCITY_IGNORED,
    YAW_IGNORED,
    YAW_RATE_IGNORED,
)
from sitl.client.connection import Connection
from sitl.client.endpoint import ACCEPTED
from sitl.core.elementary import cos, sin
from sitl.errors import NotReadyError

from .preparation import CUSTOM_MODE_ENABLED, INTERVAL_US, ORIGIN, check_reports, set_intervals, until
from .setpoints import LOCAL, Encode, Message, position
from .telemetry import ESTIMATOR, StepTelemetry

OFFBOARD = 6
"""Main mode of PX4's, in param2 of DO_SET_MODE with MAV_MODE_FLAG_CUSTOM_MODE_ENABLED in param1."""
_VELOCITY_AND_TURN = POSITION_IGNORED | ACCELERATION_IGNORED | YAW_IGNORED
_PLACE_AND_YAW = VELOCITY_IGNORED | ACCELERATION_IGNORED | YAW_RATE_IGNORED
_TENTH = 100_000
_BEFORE = 10
"""Set-points that come before the mode is asked for."""
_READY_S, _CLIMB_S = 90, 30
_VALID = 1 | 2 | 4 | 16 | 32
"""ESTIMATOR_STATUS_FLAGS: attitude, velocity, position on the earth, height. Before, PX4 tells a position, too, and a
heading that knows no declination, or none at all."""


def velocity(row: Sequence[float], inbox: StepTelemetry, origin: Sequence[float]) -> Message:
    """SET_POSITION_TARGET_LOCAL_NED: velocities [m/s] turned from the heading to north and east, turn rate [rad/s].

    PX4 takes them in the local frame on all its versions, in the body's on some.
    """
    forward, left, up, turn = row
    c, s = cos(inbox.attitude[3]), sin(inbox.attitude[3])
    motion = {"vx": forward * c + left * s, "vy": forward * s - left * c, "vz": -up, "yaw_rate": -turn}
    return LOCAL, LOCAL.payload(
        target_system=inbox.system, target_component=1, coordinate_frame=LOCAL_NED, type_mask=_VELOCITY_AND_TURN,
        **motion,
    )  # fmt: skip


COPTER: dict[str, Encode] = {"velocity": velocity, "position": position}
"""Kind of set-point -> its message."""


def prepare(link: Connection, take_off: float) -> None:
    """From power-on until it hovers in OFFBOARD.

    Args:
        link: to a PX4 that has just been started.
        take_off: height above where it stands [m].

    Raises:
        NotReadyError: it does not get there; the message says what the vehicle said.
    """
    inbox = link.inbox
    set_intervals(link, INTERVAL_US)
    link.command("SET_MESSAGE_INTERVAL", ESTIMATOR.id, INTERVAL_US)
    until(link, lambda: inbox.estimator & _VALID == _VALID, _TENTH, "does not hold its position for valid", _READY_S)
    before = inbox.time_ms
    until(link, lambda: inbox.time_ms > before, _TENTH, "sends no LOCAL_POSITION_NED and ATTITUDE", _READY_S)
    north, east, down = inbox.position[1:4]
    heading = inbox.attitude[3]

    def hold() -> None:
        """A place above where it stands."""
        place = {"x": north, "y": east, "z": down - take_off, "yaw": heading}
        target = LOCAL.payload(
            target_system=inbox.system,
            target_component=1,
            coordinate_frame=LOCAL_NED,
            type_mask=_PLACE_AND_YAW,
            **place,
        )
        link.endpoint.send_payload(LOCAL, target)

    for _ in range(_BEFORE):
        hold()
        link.run(_TENTH)

    def offboard() -> bool:
        return link.command("DO_SET_MODE", CUSTOM_MODE_ENABLED, OFFBOARD) == ACCEPTED

    def arms() -> bool:
        return offboard() and link.command("COMPONENT_ARM_DISARM", arm=1) == ACCEPTED

    until(link, arms, _TENTH, "does not arm in OFFBOARD", _READY_S, hold)
    until(
        link, lambda: abs(inbox.position[3] - down + take_off) < 0.15 and abs(inbox.position[6]) < 0.15, _TENTH,
        f"does not climb to {take_off:g} m", _CLIMB_S, hold,
    )  # fmt: skip
    for _ in range(3):
        if inbox.origin is None:
            hold()
            link.command("REQUEST_MESSAGE", ORIGIN.id)
    if inbox.origin is None:
        raise NotReadyError(f"{link.name}: the vehicle does not send GPS_GLOBAL_ORIGIN")
    scans = inbox.scans
    for _ in range(3):
        hold()
        link.run(_TENTH)
    if inbox.scans == scans:
        raise NotReadyError(f"{link.name}: the physics sends no scan")
    check_reports(link)
