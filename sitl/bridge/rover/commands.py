# SPDX-License-Identifier: BSD-3-Clause
"""Commands that only the rover knows, or in its own way: speed, reverse, headings, motors.

Results as ArduRover gives them; what is the copter's (take-off, landing, yaw, pause, termination) is UNSUPPORTED.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, cast

from ..channel import Channel
from ..services import command_table
from ..services.command import Command, Entry
from ..services.service import ACCEPTED, DENIED, FAILED

if TYPE_CHECKING:
    from ..bridge import Bridge
    from .autopilot import RoverAutopilot


def _rover(bridge: Bridge) -> RoverAutopilot:
    return cast("RoverAutopilot", bridge.autopilot)


def change_speed(bridge: Bridge, channel: Channel, command: Command) -> int:
    """178: p1 0 or 1 (else DENIED), p2 speed [m/s]; FAILED in a mode without a speed target."""
    if command.p1 not in (0.0, 1.0):
        return DENIED
    return ACCEPTED if bridge.autopilot.change_speed(int(command.p1), command.p2) else FAILED


def set_reverse(bridge: Bridge, channel: Channel, command: Command) -> int:
    """194: p1 1 drives paths backwards until the mode changes, 0 forwards."""
    _rover(bridge).set_reversed(command.p1 == 1.0)
    return ACCEPTED


PERCENT, PULSE = 0.0, 1.0
"""MOTOR_TEST_THROTTLE_TYPE"""


def motor_test(bridge: Bridge, channel: Channel, command: Command) -> int:
    """209: p1 1 throttle, 2 steering, 3 left, 4 right, p2 0 percent, 1 pulse, p3 how much, p4 seconds (to 30). Arms."""
    if command.p2 not in (PERCENT, PULSE) or command.p1 != int(command.p1) or abs(command.p3) > 10_000.0:
        return FAILED
    throttle, pulse = (command.p3 * 0.01, 0) if command.p2 == PERCENT else (0.0, int(command.p3))
    ok = _rover(bridge).test_motor(int(command.p1), throttle, pulse, command.p4)
    bridge.say_pending()
    return ACCEPTED if ok else FAILED


def yaw_speed(bridge: Bridge, channel: Channel, command: Command) -> int:
    """213: in GUIDED (else FAILED): p1 heading [deg], p2 speed [m/s], p3 1 adds p1 to the last target heading."""
    turn = _rover(bridge).guided_heading_change if command.p3 > 0.0 else _rover(bridge).guided_heading
    return ACCEPTED if turn(math.radians(command.p1), command.p2) else FAILED


COMMANDS: dict[int, Entry] = {
    **command_table.COMMANDS,
    178: Entry(change_speed, required=(1, 2)),
    194: Entry(set_reverse, required=(1,)),
    209: Entry(motor_test, required=(1, 2, 3, 4)),
    213: Entry(yaw_speed, required=(1, 2)),
}
