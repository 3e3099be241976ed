# SPDX-License-Identifier: BSD-3-Clause
"""Commands that only the copter knows, or in its own way: take-off, landing, heading, speeds, motors.

Results as ArduCopter gives them.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, cast

from ...autopilot.copter.modes.land import LAND
from ...autopilot.copter.modes.loiter import LOITER
from ...autopilot.navigation.state import BY_LANDING, BY_PATH
from ...core.mavlink import MavFrame, MavResult, MotorTestThrottleType
from ..channel import Channel
from ..host import Host
from ..locations import GLOBAL_FRAMES
from ..services import command_table
from ..services.command import Command, Entry, answered, is_on_earth, result
from ..services.command_table import set_mode
from ..services.motor_test import MotorTestService
from ..services.mount import MountService
from ..services.other_commands import move_landing_gear
from ..services.parachute import ParachuteService
from ..services.winch import WinchService

if TYPE_CHECKING:
    from .autopilot import CopterAutopilot


def _copter(bridge: Host) -> CopterAutopilot:
    return cast("CopterAutopilot", bridge.autopilot)


def loiter(bridge: Host, channel: Channel, command: Command) -> int:
    """17: changes to LOITER; FAILED when the mode cannot be entered."""
    return set_mode(bridge, LOITER)


def land(bridge: Host, channel: Channel, command: Command) -> int:
    """21, 85: changes to LAND, where the vehicle is; the command's location is not used (as in ArduCopter)."""
    return set_mode(bridge, LAND)


def takeoff(bridge: Host, channel: Channel, command: Command) -> int:
    """22, 84: p7 height above home [m]. Armed in GUIDED, LOITER, ALT_HOLD, POSHOLD, landed or climbing; else FAILED."""
    if command.frame != MavFrame.GLOBAL_RELATIVE_ALT:
        return MavResult.DENIED
    return result(_copter(bridge).takeoff(command.z))


ROUNDING = 1e-4
"""Pulses are whole, and a percentage comes in single precision: 90.1 % is 1901 us."""
BOARD_ORDER = 2.0
"""MOTOR_TEST_ORDER: by motor number; the others go clockwise from the front."""


def motor_test(bridge: Host, channel: Channel, command: Command) -> int:
    """209: p1 motor, p2 0 percent, 1 pulse, 2 stick, p3 throttle, p4 seconds, p5 motors in turn, p6 order."""
    kind = int(command.p2)
    throttle, (least, most) = -1.0, (bridge.parameter(f"MOT_PWM_{end}") or 0.0 for end in ("MIN", "MAX"))
    if kind in (MotorTestThrottleType.PERCENT, MotorTestThrottleType.PWM, MotorTestThrottleType.PILOT) and most > least:
        pulse = _copter(bridge).throttle_pulse() if kind == MotorTestThrottleType.PILOT else command.p3
        if kind == MotorTestThrottleType.PERCENT:
            pulse = math.floor(least + (most - least) * command.p3 * 0.01 + ROUNDING)
        throttle = (pulse - least) / (most - least)
    tests = bridge.get(MotorTestService)
    return int(tests.begin(int(command.p1), int(command.p5), command.p6 != BOARD_ORDER, throttle, command.p4))


KINDS_OF_SPEED = 4
"""SPEED_TYPE's end."""


def change_speed(bridge: Host, channel: Channel, command: Command) -> int:
    """178: p1 0 or 1 horizontal, 2 climb, 3 descent; p2 speed [m/s]."""
    if command.p2 <= 0.0 or int(command.p1) == KINDS_OF_SPEED:
        return MavResult.DENIED
    return result(bridge.autopilot.change_speed(int(command.p1), command.p2))


def condition_yaw(bridge: Host, channel: Channel, command: Command) -> int:
    """115: p1 angle [deg], p2 rate [deg/s] (0: default), p3 direction -1, 0, 1, p4 1 relative. Taken in any mode."""
    if not 0.0 <= command.p1 <= 360.0 or command.p4 not in (0.0, 1.0):
        return MavResult.FAILED
    direction = (command.p3 > 0.0) - (command.p3 < 0.0)
    angle, rate = math.radians(command.p1), math.radians(max(command.p2, 0.0))
    return result(_copter(bridge).condition_yaw(angle, rate, direction, command.p4 == 1.0))


def pause_continue(bridge: Host, channel: Channel, command: Command) -> int:
    """193: p1 0 pause, 1 continue, in GUIDED and AUTO; FAILED, with a text, in other modes and where AUTO has none."""
    if int(command.p1) not in (0, 1):
        return MavResult.DENIED
    return answered(bridge, _copter(bridge).pause(int(command.p1) == 0))


def set_roi(bridge: Host, channel: Channel, command: Command) -> int:
    """195, 201: point the nose at a location, or the gimbal if it has a yaw axis; all zero ends it."""
    if command.frame not in GLOBAL_FRAMES:
        return MavResult.DENIED
    if not is_on_earth(command.lat, command.lon):
        return MavResult.FAILED
    mount: MountService = bridge.get(MountService)
    if mount.turns_by_itself:
        return command_table.look_at(bridge, channel, command)
    if command.lat == 0 and command.lon == 0 and command.z == 0.0:
        _copter(bridge).set_roi(None)
        return command_table.look_at(bridge, channel, command)
    position = bridge.locations.ned(command.lat, command.lon, command.z, command.frame)
    if position is None:
        return MavResult.FAILED
    _copter(bridge).set_roi(position)
    return command_table.look_at(bridge, channel, command)


def no_roi(bridge: Host, channel: Channel, command: Command) -> int:
    """197: look ahead again."""
    _copter(bridge).set_roi(None)
    return command_table.look_ahead(bridge, channel, command)


def winch(bridge: Host, channel: Channel, command: Command) -> int:
    """42600: p2 0 lets the line go, 1 lowers by p3 [m] (below 0 raises), 2 winds at p4 [m/s]; FAILED without winch."""
    return int(bridge.get(WinchService).act(command.p2, command.p3, command.p4))


def terminate(bridge: Host, channel: Channel, command: Command) -> int:
    """185: p1 above 0.5 stops the motors, in flight too."""
    if command.p1 <= 0.5:
        return MavResult.FAILED
    _copter(bridge).terminate()
    bridge.say_pending()
    return MavResult.ACCEPTED


def release_parachute(bridge: Host, channel: Channel, command: Command) -> int:
    """208: p1 0 disables the parachute, 1 enables it, 2 releases it: in flight and above CHUTE_ALT_MIN, else a text."""
    answer = bridge.get(ParachuteService).act(command.p1)
    bridge.say_pending()
    return int(answer)


def return_path(bridge: Host, channel: Channel, command: Command) -> int:
    """188: AUTO_RTL by the mission's return path that is nearest."""
    return _go_back(bridge, BY_PATH)


def landing_sequence(bridge: Host, channel: Channel, command: Command) -> int:
    """189: AUTO_RTL by the mission's landing sequence that is nearest."""
    return _go_back(bridge, BY_LANDING)


def _go_back(bridge: Host, how: int) -> int:
    return answered(bridge, _copter(bridge).go_back(how))


COMMANDS: dict[int, Entry] = {
    **command_table.COMMANDS,
    17: Entry(loiter),
    21: Entry(land),
    22: Entry(takeoff, required=(7,)),
    84: Entry(takeoff, required=(7,)),
    85: Entry(land),
    115: Entry(condition_yaw, required=(1,)),
    178: Entry(change_speed, required=(1, 2)),
    185: Entry(terminate, required=(1,)),
    188: Entry(return_path),
    189: Entry(landing_sequence),
    193: Entry(pause_continue, required=(1,)),
    195: Entry(set_roi, required=(5, 6, 7), has_location=True, off_earth=True),
    197: Entry(no_roi),
    201: Entry(set_roi, required=(5, 6, 7), has_location=True, off_earth=True),
    208: Entry(release_parachute, required=(1,)),
    209: Entry(motor_test, required=(1, 2, 3, 4)),
    2520: Entry(move_landing_gear),
    42600: Entry(winch),
}
