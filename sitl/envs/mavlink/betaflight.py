# SPDX-License-Identifier: BSD-3-Clause
"""Betaflight's ways: it has no set-points but sticks and rates, so a pilot brings it into the air before an episode."""

from __future__ import annotations

import math
from collections.abc import Sequence

from sitl.client.connection import Connection
from sitl.core.constants import GRAVITY
from sitl.core.elementary import cos, sin
from sitl.core.mavlink import MavModeFlag, MavResult
from sitl.errors import NotReadyError
from sitl.foreign.betaflight.receiver import ACRO as _ACRO
from sitl.foreign.betaflight.receiver import MODES

from .last_messages import StepTelemetry
from .preparation import INTERVAL_US, ORIGIN, check_reports, set_intervals, until
from .target_messages import COPTER, RATES_ONLY, TARGET, Encode

ACRO, ANGLE = _ACRO.number, MODES[1].number
SETPOINTS: dict[str, Encode] = {name: COPTER[name] for name in ("rates", "rc")}
"""Kind of set-point -> its message."""
STEP_US = 20_000
_TENTH = 100_000
_READY_S, _CLIMB_S = 30, 20


class Hold:
    """A pilot who holds a position by rates and thrust: position -> velocity -> lean -> rates.

    Args:
        position: north, east, down [m].
        heading: [rad].
        hover: thrust that is tried first, 0 .. 1.
    """

    def __init__(self, position: Sequence[float], heading: float, hover: float = 0.45) -> None:
        self.position, self.heading, self._hover = position, heading, hover

    def act(self, inbox: StepTelemetry, seconds: float) -> tuple[float, float, float, float]:
        """Roll, pitch and yaw rate, forward right down [rad/s], and thrust, 0 .. 1, for the next so many seconds."""
        roll, pitch, yaw = inbox.attitude[1:4]
        errors = [goal - now for goal, now in zip(self.position, inbox.position[1:4])]
        speeds = [min(max(1.2 * error, -1.5), 1.5) for error in errors]
        north, east, down = (2.0 * (speed - now) for speed, now in zip(speeds, inbox.position[4:7]))
        c, s = cos(yaw), sin(yaw)
        forward, right = north * c + east * s, east * c - north * s
        lean = [min(max(push / GRAVITY, -0.35), 0.35) for push in (right, -forward)]
        turn = math.remainder(self.heading - yaw, 2.0 * math.pi)
        self._hover = min(max(self._hover - 0.03 * errors[2] * seconds, 0.05), 0.95)
        thrust = self._hover * (1.0 - down / GRAVITY) / max(cos(roll) * cos(pitch), 0.5)
        return 5.0 * (lean[0] - roll), 5.0 * (lean[1] - pitch), 1.5 * turn, min(max(thrust, 0.0), 1.0)


def prepare(link: Connection, take_off: float) -> None:
    """From power-on until it hovers in ACRO.

    Args:
        link: to a Betaflight that has just been started.
        take_off: height above where it stands [m].

    Raises:
        NotReadyError: it does not get there; the message says what the vehicle said.
    """
    inbox = link.inbox
    link.endpoint.send("REQUEST_DATA_STREAM", target_system=inbox.system, target_component=1)  # stop all
    set_intervals(link, STEP_US)
    if link.command("DO_SET_MODE", MavModeFlag.CUSTOM_MODE_ENABLED, ACRO) != MavResult.ACCEPTED:
        raise NotReadyError(f"{link.name}: the vehicle refuses ACRO")

    def arms() -> bool:
        return link.command("COMPONENT_ARM_DISARM", arm=1) == MavResult.ACCEPTED

    until(link, arms, _TENTH, "does not arm", _READY_S)
    north, east, down = inbox.position[1:4]
    hold = Hold((north, east, down - take_off), inbox.attitude[3])

    def fly() -> None:
        roll, pitch, yaw, thrust = hold.act(inbox, 1e-6 * STEP_US)
        payload = TARGET.payload(
            target_system=inbox.system, type_mask=RATES_ONLY, q=(1.0, 0.0, 0.0, 0.0), body_roll_rate=roll,
            body_pitch_rate=pitch, body_yaw_rate=yaw, thrust=thrust,
        )  # fmt: skip
        link.endpoint.send_payload(TARGET, payload)

    still = [0]

    def hovers() -> bool:
        far = abs(inbox.position[3] - down + take_off) < 0.1
        at_rest = all(abs(speed) < 0.1 for speed in (*inbox.position[4:7], *inbox.attitude[4:7]))
        still[0] = still[0] + 1 if far and at_rest else 0
        return still[0] >= _STILL

    until(link, hovers, STEP_US, f"does not climb to {take_off:g} m", _CLIMB_S, fly)
    link.command("REQUEST_MESSAGE", ORIGIN.id)
    if inbox.origin is None:
        raise NotReadyError(f"{link.name}: the vehicle does not send GPS_GLOBAL_ORIGIN")
    fly()
    set_intervals(link, INTERVAL_US)
    for _ in range(_TENTH // STEP_US):
        fly()
        link.run(STEP_US)
    check_reports(link)


_STILL = 10
"""So many looks in a row must find it at rest."""
