# SPDX-License-Identifier: BSD-3-Clause
"""Commands that fly: arming, modes, take-off, landing, speed, heading, places.

Results as ArduCopter gives them.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from ..channel import Channel
from .command import FRAMES_AMSL, GLOBAL_FRAMES, GLOBAL_RELATIVE_ALT, Command, Entry
from .home import HomeService
from .results import ACCEPTED, DENIED, FAILED, UNSUPPORTED, WARNING
from .statustext import StatusTextService

if TYPE_CHECKING:
    from ..bridge import Bridge

FORCE_ARM, FORCE = 2989.0, 21196.0
AUTO, GUIDED, LOITER, RTL, LAND = 3, 4, 5, 6, 9
CHANGE_MODE = 1
"""MAV_DO_REPOSITION_FLAGS_CHANGE_MODE"""


def arm_disarm(bridge: Bridge, channel: Channel, command: Command) -> int:
    """400: p1 1 arms, 0 disarms; p2 2989 or 21196 forces arming, 21196 disarming in the air."""
    if command.p1 == 1.0:
        ok = bridge.autopilot.armed() or bridge.autopilot.arm(command.p2 in (FORCE_ARM, FORCE))
    elif command.p1 == 0.0:
        ok = not bridge.autopilot.armed() or bridge.autopilot.disarm(command.p2 == FORCE)
    else:
        return UNSUPPORTED
    bridge.say_pending()
    return ACCEPTED if ok else FAILED


def set_mode(bridge: Bridge, number: int) -> int:
    """Change to a mode by ArduPilot's number and say why not."""
    ok = bridge.autopilot.set_mode(number)
    bridge.say_pending()
    return ACCEPTED if ok else FAILED


def do_set_mode(bridge: Bridge, channel: Channel, command: Command) -> int:
    """176: p1 must have MAV_MODE_FLAG_CUSTOM_MODE_ENABLED (else DENIED), p2 is the mode's number (else FAILED)."""
    if not 0.0 <= command.p1 < 256.0 or not int(command.p1) & 1:
        return DENIED
    if not (0.0 <= command.p2 < 2.0**32 and command.p2 == int(command.p2)):
        return FAILED
    return set_mode(bridge, int(command.p2))


def loiter(bridge: Bridge, channel: Channel, command: Command) -> int:
    """17: changes to LOITER; FAILED when the mode cannot be entered."""
    return set_mode(bridge, LOITER)


def return_to_launch(bridge: Bridge, channel: Channel, command: Command) -> int:
    """20: changes to RTL; FAILED when the mode cannot be entered."""
    return set_mode(bridge, RTL)


def land(bridge: Bridge, channel: Channel, command: Command) -> int:
    """21: changes to LAND, where the vehicle is; the command's place is not used (as in ArduCopter)."""
    return set_mode(bridge, LAND)


def takeoff(bridge: Bridge, channel: Channel, command: Command) -> int:
    """22: p7 height above home [m]. In GUIDED, LOITER, ALT_HOLD, armed, on the ground or in the climb; else FAILED."""
    if command.frame != GLOBAL_RELATIVE_ALT:
        return DENIED
    return ACCEPTED if bridge.autopilot.takeoff(command.z) else FAILED


PERCENT, PULSE = 0.0, 1.0
"""MOTOR_TEST_THROTTLE_TYPE"""
BOARD_ORDER = 2.0
"""MOTOR_TEST_ORDER: by motor number; the others go clockwise from the front."""


def motor_test(bridge: Bridge, channel: Channel, command: Command) -> int:
    """209: p1 motor, p2 0 percent or 1 pulse, p3 throttle, p4 seconds, p6 order. One motor at a time (p5 0 or 1)."""
    if command.p2 not in (PERCENT, PULSE) or command.p5 not in (0.0, 1.0) or command.p1 != int(command.p1):
        return FAILED
    throttle = command.p3 * 0.01
    if command.p2 == PULSE:
        least, most = bridge.parameter("MOT_PWM_MIN") or 0.0, bridge.parameter("MOT_PWM_MAX") or 0.0
        throttle = (command.p3 - least) / (most - least) if most > least else -1.0
    ok = bridge.autopilot.test_motor(int(command.p1), command.p6 != BOARD_ORDER, throttle, command.p4)
    bridge.say_pending()
    return ACCEPTED if ok else FAILED


def set_servo(bridge: Bridge, channel: Channel, command: Command) -> int:
    """183: p1 output (those of motors are refused), p2 pulse [us]."""
    if command.p1 != int(command.p1) or not 0.0 <= command.p2 <= 3000.0:
        return DENIED
    return ACCEPTED if bridge.autopilot.set_servo(int(command.p1), int(command.p2)) else FAILED


def set_relay(bridge: Bridge, channel: Channel, command: Command) -> int:
    """181: no relay is fitted."""
    return FAILED


def reposition(bridge: Bridge, channel: Channel, command: Command) -> int:
    """192: fly to a place in GUIDED; p1 speed, p2 bit 1 changes to GUIDED first (else DENIED in another mode).

    The place is refused before the mode is changed.
    """
    if command.frame not in GLOBAL_FRAMES:
        bridge.get(StatusTextService).say(WARNING, f"Unknown mavlink coordinate frame {command.frame}")
        return DENIED
    if command.lat == 0 and command.lon == 0:
        return DENIED
    in_guided = bridge.autopilot.mode() == GUIDED
    if not in_guided and not (0.0 <= command.p2 < 2.0**31 and int(command.p2) & CHANGE_MODE):
        return DENIED
    place = bridge.places.ned(command.lat, command.lon, command.z, command.frame)
    if place is None:
        return FAILED
    if not in_guided and set_mode(bridge, GUIDED) != ACCEPTED:
        return FAILED
    if not bridge.autopilot.guided_position(place, None):
        return FAILED
    if command.p1 > 0.0:  # after the target: a new kind of set-point begins with the default speed
        bridge.autopilot.change_speed(1, command.p1)
    return ACCEPTED


def change_speed(bridge: Bridge, channel: Channel, command: Command) -> int:
    """178: p1 0 or 1 horizontal, 2 climb, 3 descent; p2 speed [m/s]."""
    if command.p2 <= 0.0 or command.p1 not in (0.0, 1.0, 2.0, 3.0):
        return DENIED
    return ACCEPTED if bridge.autopilot.change_speed(int(command.p1), command.p2) else FAILED


def condition_yaw(bridge: Bridge, channel: Channel, command: Command) -> int:
    """115: p1 angle [deg], p2 rate [deg/s] (0: default), p3 direction -1, 0, 1, p4 0 absolute, 1 relative."""
    if not 0.0 <= command.p1 <= 360.0 or command.p4 not in (0.0, 1.0):
        return FAILED
    direction = (command.p3 > 0.0) - (command.p3 < 0.0)
    angle, rate = math.radians(command.p1), math.radians(max(command.p2, 0.0))
    return ACCEPTED if bridge.autopilot.condition_yaw(angle, rate, direction, command.p4 == 1.0) else FAILED


def pause_continue(bridge: Bridge, channel: Channel, command: Command) -> int:
    """193: p1 0 pause, 1 continue."""
    if command.p1 not in (0.0, 1.0):
        return DENIED
    return ACCEPTED if bridge.autopilot.pause(command.p1 == 0.0) else FAILED


def set_roi(bridge: Bridge, channel: Channel, command: Command) -> int:
    """195, 201: point the nose at a place; all zero ends it."""
    if command.frame not in GLOBAL_FRAMES:
        return DENIED
    if command.lat == 0 and command.lon == 0 and command.z == 0.0:
        bridge.autopilot.set_roi(None)
        return ACCEPTED
    place = bridge.places.ned(command.lat, command.lon, command.z, command.frame)
    if place is None:
        return FAILED
    bridge.autopilot.set_roi(place)
    return ACCEPTED


def no_roi(bridge: Bridge, channel: Channel, command: Command) -> int:
    """197: look ahead again."""
    bridge.autopilot.set_roi(None)
    return ACCEPTED


def set_home(bridge: Bridge, channel: Channel, command: Command) -> int:
    """179: p1 1 (or latitude and longitude zero): here; else the place given."""
    if command.p1 == 1.0 or (command.lat == 0 and command.lon == 0):
        return _home_result(bridge, bridge.autopilot.set_home_here())
    if command.p1 != 0.0 or command.frame not in GLOBAL_FRAMES:
        return DENIED
    alt = command.z if command.frame in FRAMES_AMSL else bridge.places.home_alt() + command.z
    return _home_result(bridge, bridge.autopilot.set_home(command.lat, command.lon, alt))


def _home_result(bridge: Bridge, ok: bool) -> int:
    if ok:
        bridge.get(HomeService).tell_changes()
    return ACCEPTED if ok else FAILED


def mission_start(bridge: Bridge, channel: Channel, command: Command) -> int:
    """300: AUTO from the beginning; p1, p2 (first and last item) must be zero."""
    if command.p1 != 0.0 or command.p2 != 0.0:
        return DENIED
    ok = bridge.autopilot.start_mission()
    bridge.say_pending()
    return ACCEPTED if ok else FAILED


def set_mission_current(bridge: Bridge, channel: Channel, command: Command) -> int:
    """224: p1 number of the item (-1: keep), p2 1 resets the mission first."""
    if command.p1 != int(command.p1) or command.p2 not in (0.0, 1.0):
        return DENIED
    ok = bridge.autopilot.set_current_item(int(command.p1), command.p2 == 1.0)
    bridge.say_pending()
    return ACCEPTED if ok else DENIED


def terminate(bridge: Bridge, channel: Channel, command: Command) -> int:
    """185: p1 above 0.5 stops the motors, in flight too."""
    if command.p1 <= 0.5:
        return FAILED
    bridge.autopilot.terminate()
    bridge.say_pending()
    return ACCEPTED


COMMANDS: dict[int, Entry] = {
    17: Entry(loiter),
    20: Entry(return_to_launch),
    21: Entry(land),
    22: Entry(takeoff, required=(7,)),
    115: Entry(condition_yaw, required=(1,)),
    176: Entry(do_set_mode, required=(1, 2)),
    178: Entry(change_speed, required=(1, 2)),
    179: Entry(set_home, required=(5, 6, 7), place=True, long_frame=0),
    181: Entry(set_relay, required=(1, 2)),
    183: Entry(set_servo, required=(1, 2)),
    185: Entry(terminate, required=(1,)),
    192: Entry(reposition, required=(5, 6, 7), place=True, int_only=True),
    193: Entry(pause_continue, required=(1,)),
    195: Entry(set_roi, required=(5, 6, 7), place=True),
    197: Entry(no_roi),
    201: Entry(set_roi, required=(5, 6, 7), place=True),
    209: Entry(motor_test, required=(1, 2, 3, 4)),
    224: Entry(set_mission_current, required=(1,)),
    300: Entry(mission_start),
    400: Entry(arm_disarm, required=(1,)),
}
