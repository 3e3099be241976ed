# SPDX-License-Identifier: BSD-3-Clause
"""Commands that only the rover knows, or in its own way: speed, reverse, motors.

Results as ArduRover gives them; what is the copter's (take-off, landing, yaw, pause, termination) is UNSUPPORTED.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from ...autopilot.rover.motor_test import PULSE_MAX
from ...core.mavlink import MavResult, MavSeverity, MotorTestThrottleType
from ..channel import Channel
from ..host import Host
from ..services import command_table
from ..services.command import Command, Entry, answered, result
from ..services.statustext import StatusTextService

if TYPE_CHECKING:
    from .autopilot import RoverAutopilot


def _rover(bridge: Host) -> RoverAutopilot:
    return cast("RoverAutopilot", bridge.autopilot)


UP_AND_DOWN = (2, 3, 4)
"""SPEED_TYPE of climb and descent, and its end."""


def change_speed(bridge: Host, channel: Channel, command: Command) -> int:
    """178: p1 0 or 1 (DENIED: climb, descent), p2 speed [m/s]; FAILED in a mode without a speed target."""
    if int(command.p1) in UP_AND_DOWN:
        return MavResult.DENIED
    return result(bridge.autopilot.change_speed(int(command.p1), command.p2))


def set_reverse(bridge: Host, channel: Channel, command: Command) -> int:
    """194: p1 1 drives paths backwards until the mode changes, 0 forwards."""
    _rover(bridge).set_reversed(command.p1 == 1.0)
    return MavResult.ACCEPTED


LAST_MOTOR = 4


def motor_test(bridge: Host, channel: Channel, command: Command) -> int:
    """209: p1 1 throttle, 2 steering, 3 left, 4 right, p2 0 percent, 1 pulse, 2 stick, p3 how much, p4 seconds (to 30).

    Arms.
    """
    motor, kind = int(command.p1), int(command.p2)
    why = _why_no_test(motor, kind, command.p3)
    if why:
        bridge.get(StatusTextService).say(MavSeverity.CRITICAL, f"Motor Test: {why}")
        return MavResult.FAILED
    rover = _rover(bridge)
    throttle, pulse = 0.0, 0
    if kind == MotorTestThrottleType.PILOT:
        throttle = rover.stick(motor)
    elif kind == MotorTestThrottleType.PERCENT:
        throttle = max(command.p3 * 0.01, -1.0)
    else:
        pulse = int(command.p3)
    return answered(bridge, rover.test_motor(motor, throttle, pulse, command.p4))


def _why_no_test(motor: int, kind: int, how_much: float) -> str:
    if not 0 <= motor <= LAST_MOTOR:
        return f"invalid motor ({motor})"
    if kind not in (MotorTestThrottleType.PERCENT, MotorTestThrottleType.PWM, MotorTestThrottleType.PILOT):
        return f"invalid throttle type: {kind}"
    if kind == MotorTestThrottleType.PWM and how_much > PULSE_MAX:
        return f"pwm ({how_much:.0f}) too high"
    return f"percentage ({how_much:.0f}) too high" if kind == MotorTestThrottleType.PERCENT and how_much > 100.0 else ""


def aux_function(bridge: Host, channel: Channel, command: Command) -> int:
    """218: p1 function of a switch (0 none), p2 0 low, 1 middle, 2 high."""
    if int(command.p1) == 0:
        return MavResult.ACCEPTED if command.p2 <= 2.0 else MavResult.DENIED
    return command_table.aux_function(bridge, channel, command)


COMMANDS: dict[int, Entry] = {
    **command_table.COMMANDS,
    178: Entry(change_speed, required=(1, 2)),
    194: Entry(set_reverse, required=(1,)),
    209: Entry(motor_test, required=(1, 2, 3, 4)),
    218: Entry(aux_function, required=(1, 2)),
}
