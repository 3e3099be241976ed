# SPDX-License-Identifier: BSD-3-Clause
"""PX4's ways: flight by set-points in its mode OFFBOARD, or by sticks; each is kept only while it comes."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from sitl.bridge.dialect import message
from sitl.bridge.services.setpoint_messages import (
    ACCELERATION_IGNORED,
    POSITION_IGNORED,
    VELOCITY_IGNORED,
    YAW_IGNORED,
    YAW_RATE_IGNORED,
)
from sitl.client.connection import Connection
from sitl.core.elementary import cos, sin
from sitl.core.mavlink import MavFrame, MavResult
from sitl.errors import NotReadyError

from .last_messages import ESTIMATOR, StepTelemetry
from .preparation import (
    INTERVAL_US,
    ORIGIN,
    check_reports,
    last_texts,
    mode_parameters,
    not_ready,
    set_intervals,
    set_mode,
    until,
)
from .target_messages import LOCAL, RATES_ONLY, TARGET, TURN_AND_LEAN, Encode, Message, leaning, position

ALTCTL, POSCTL, OFFBOARD = 2 << 16, 3 << 16, 6 << 16
"""Modes of PX4's, as HEARTBEAT reports them: a main mode in the third byte, one below it in the fourth. The first two
are flown by sticks, which lean it: one holds its height, the other its position, too."""
HOLD = 4 << 16 | 3 << 24
MODES = {"HOLD": HOLD, "RTL": 4 << 16 | 5 << 24, "LAND": 4 << 16 | 6 << 24, "ALTCTL": ALTCTL, "POSCTL": POSCTL}
"""Modes that may take over from OFFBOARD."""
REPEAT_US = 200_000
"""Set-points and sticks are sent again after so long: without new ones PX4 leaves the mode after COM_OF_LOSS_T, 1 s, or
COM_RC_LOSS_T, 0.5 s, of its own time [us]."""
PARAMETERS = {"COM_RC_IN_MODE": 1.0, "COM_RCL_EXCEPT": 4.0}
"""Of a PX4 in an environment: sticks are MANUAL_CONTROL, and OFFBOARD needs none."""
_STICKS = message("MANUAL_CONTROL")
_ASKED, _SWITCH_US = message("ATTITUDE_TARGET"), 600_000
_MIDDLE, _FULL = 1500.0, 400.0
"""Pulse of a stick at rest, and how far from it the stick is at its end [us]."""
_VELOCITY_AND_TURN = POSITION_IGNORED | ACCELERATION_IGNORED | YAW_IGNORED
_ACCELERATION_AND_TURN = POSITION_IGNORED | VELOCITY_IGNORED | YAW_IGNORED
_POSITION_AND_YAW = VELOCITY_IGNORED | ACCELERATION_IGNORED | YAW_RATE_IGNORED
_TENTH = 100_000
_BEFORE = 10
"""Set-points that come before the mode is asked for."""
_READY_S, _CLIMB_S = 90, 30
_VALID = 1 | 2 | 4 | 16 | 32
"""ESTIMATOR_STATUS_FLAGS: attitude, velocity, position on the earth, height. Before, PX4 reports a position, too, and a
heading that knows no declination, or none at all."""


def velocity(row: Sequence[float], inbox: StepTelemetry, origin: Sequence[float]) -> Message:
    """SET_POSITION_TARGET_LOCAL_NED: velocities [m/s] turned from the heading to north and east, turn rate [rad/s].

    PX4 takes them in the local frame on all its versions, in the body's on some.
    """
    north, east, down, turn = _in_local_frame(row, inbox)
    return LOCAL, LOCAL.payload(
        target_system=inbox.system, target_component=1, coordinate_frame=MavFrame.LOCAL_NED,
        type_mask=_VELOCITY_AND_TURN,
        vx=north, vy=east, vz=down, yaw_rate=turn,
    )  # fmt: skip


def acceleration(row: Sequence[float], inbox: StepTelemetry, origin: Sequence[float]) -> Message:
    """SET_POSITION_TARGET_LOCAL_NED: accelerations turned likewise [m/s^2], turn rate [rad/s].

    In the body's frame PX4 would turn them by roll and pitch, too.
    """
    north, east, down, turn = _in_local_frame(row, inbox)
    return LOCAL, LOCAL.payload(
        target_system=inbox.system, target_component=1, coordinate_frame=MavFrame.LOCAL_NED,
        type_mask=_ACCELERATION_AND_TURN, afx=north, afy=east, afz=down, yaw_rate=turn,
    )  # fmt: skip


def _in_local_frame(row: Sequence[float], inbox: StepTelemetry) -> tuple[float, float, float, float]:
    """Forward, left, up of the heading and the turn rate as north, east, down and the turn rate clockwise."""
    forward, left, up, turn = row
    c, s = cos(inbox.attitude[3]), sin(inbox.attitude[3])
    return forward * c + left * s, forward * s - left * c, -up, -turn


def thrust(row: Sequence[float], inbox: StepTelemetry, origin: Sequence[float]) -> Message:
    """SET_ATTITUDE_TARGET: roll, pitch [rad], turn rate [rad/s], thrust 0 .. 1.

    Where rates of roll and pitch come with an attitude, PX4 takes them for set-points besides.
    """
    roll, pitch, turn, share = row
    return TARGET, TARGET.payload(
        target_system=inbox.system, target_component=1, type_mask=TURN_AND_LEAN,
        q=leaning(roll, pitch, inbox), body_yaw_rate=-turn, thrust=share,
    )  # fmt: skip


def rates(row: Sequence[float], inbox: StepTelemetry, origin: Sequence[float]) -> Message:
    """SET_ATTITUDE_TARGET: rates of the body [rad/s], thrust 0 .. 1."""
    roll, pitch, turn, share = row
    return TARGET, TARGET.payload(
        target_system=inbox.system, target_component=1, type_mask=RATES_ONLY, q=(1.0, 0.0, 0.0, 0.0),
        body_roll_rate=roll, body_pitch_rate=pitch, body_yaw_rate=-turn, thrust=share,
    )  # fmt: skip


def sticks(row: Sequence[float], inbox: StepTelemetry, origin: Sequence[float]) -> Message:
    """MANUAL_CONTROL: the first four of eight pulses [us] as sticks; one that is released, 0, is at rest."""
    roll, pitch, climb, turn = (min(max((pulse - _MIDDLE) / _FULL, -1.0), 1.0) if pulse else 0.0 for pulse in row[:4])
    return _STICKS, _STICKS.payload(
        target=inbox.system, x=round(-1000.0 * pitch), y=round(1000.0 * roll), z=round(500.0 + 500.0 * climb),
        r=round(1000.0 * turn),
    )  # fmt: skip


def show_sticks(link: Connection) -> None:
    """Before a mode that is flown by sticks: PX4 refuses it while there are none."""
    at_rest = sticks(4 * (_MIDDLE,), link.inbox, ())
    for _ in range(_BEFORE):
        link.endpoint.send_payload(*at_rest)
        link.run(_TENTH // 2)
    link.endpoint.send_payload(*at_rest)


def _thrust_of(link: Connection) -> float:
    """The thrust that its own loops ask for now, 0 .. 1.

    Raises:
        NotReadyError: it does not report it.
    """
    thrusts: list[float] = []
    link.inbox.witness = lambda kind, fields: thrusts.append(float(fields.thrust)) if kind is _ASKED else None
    try:
        for _ in range(_BEFORE):
            link.command("REQUEST_MESSAGE", _ASKED.id)
            link.run(_TENTH // 2)
            if thrusts:
                return thrusts[-1]
    finally:
        link.inbox.witness = None
    raise NotReadyError(f"{link.name}: the vehicle does not send {_ASKED.name}")


def switch(encode: Encode) -> Callable[[Connection], None]:
    """Before set-points of another kind in OFFBOARD: PX4 notices within half a second, and flies by the last of
    the other kind until then. It hovers meanwhile.

    Args:
        encode: of the kind; its last number at rest is the thrust.
    """

    def hover(link: Connection) -> None:
        share = 0.0 if encode is acceleration else _thrust_of(link)
        at_rest = (0.0, 0.0, 0.0, share)
        for _ in range(_SWITCH_US // _TENTH):
            link.endpoint.send_payload(*encode(at_rest, link.inbox, ()))
            link.run(_TENTH)

    return hover


COPTER: dict[str, Encode] = {
    "velocity": velocity, "rc": sticks, "loiter": sticks, "position": position, "acceleration": acceleration,
    "thrust": thrust, "rates": rates,
}  # fmt: skip
"""Kind of set-point -> its message. An attitude with a climb rate is none of PX4's."""


def send_position(link: Connection, north: float, east: float, down: float, heading: float) -> None:
    """Send a position set-point in the vehicle's local frame [m], [rad]."""
    fields = {"x": north, "y": east, "z": down, "yaw": heading}
    link.endpoint.send_payload(
        LOCAL,
        LOCAL.payload(
            target_system=link.inbox.system, target_component=1, coordinate_frame=MavFrame.LOCAL_NED,
            type_mask=_POSITION_AND_YAW, **fields,
        ),
    )  # fmt: skip


def join(link: Connection, seconds: float) -> None:
    """Wait until somebody has brought the vehicle into the air, armed, in Hold, almost at rest; then take it over into
    OFFBOARD, where it stays on the spot. One that is in OFFBOARD already is ours.

    Raises:
        NotReadyError: it is not there in time, or refuses; the message says what is missing.
    """
    inbox = link.inbox
    set_intervals(link, INTERVAL_US)
    link.command("REQUEST_MESSAGE", ORIGIN.id)

    def missing() -> str:
        if inbox.mode not in (HOLD, OFFBOARD):
            return f"it is in mode {mode_parameters(max(inbox.mode, 0))[1:]}, not in Hold (4, 3) or OFFBOARD (6, 0)"
        return not_ready(link, flies=True)

    spot: tuple[float, ...] = ()

    def stay() -> None:
        """What OFFBOARD needs before it is asked for, and all the time."""
        nonlocal spot
        spot = spot or (*inbox.position[1:4], inbox.attitude[3])
        send_position(link, *spot)

    for _ in range(max(round(seconds * 1e6 / _TENTH), 1)):
        if inbox.mode == OFFBOARD:
            stay()
        link.pause(_TENTH)
        if not missing():
            break
    else:
        raise NotReadyError(f"{link.name}: no episode can begin within {seconds:g} s: {missing()}; {last_texts(link)}")
    for _ in range(_BEFORE):
        stay()
        link.pause(_TENTH)
    if inbox.mode != OFFBOARD:
        set_mode(link, OFFBOARD)
    for _ in range(_BEFORE):
        stay()
        link.pause(_TENTH)
        if inbox.mode == OFFBOARD:
            check_reports(link)
            return
    raise NotReadyError(f"{link.name}: the vehicle accepts OFFBOARD and is not in it; {last_texts(link)}")


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
        """A position above where it stands."""
        send_position(link, north, east, down - take_off, heading)

    for _ in range(_BEFORE):
        hold()
        link.run(_TENTH)

    def offboard() -> bool:
        return link.command("DO_SET_MODE", *mode_parameters(OFFBOARD)) == MavResult.ACCEPTED

    def arms() -> bool:
        return offboard() and link.command("COMPONENT_ARM_DISARM", arm=1) == MavResult.ACCEPTED

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
