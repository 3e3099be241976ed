# SPDX-License-Identifier: BSD-3-Clause
"""Commands about the autopilot itself: messages, version, calibration, checks, reboot."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..channel import Channel
from ..dialect import message
from .command import Command, Entry
from .results import ACCEPTED, DENIED, FAILED, INFO, NOTICE, TEMPORARILY_REJECTED, UNSUPPORTED
from .statustext import StatusTextService
from .streams import StreamService

if TYPE_CHECKING:
    from ..bridge import Bridge

HOME_POSITION, AUTOPILOT_VERSION = message("HOME_POSITION").id, message("AUTOPILOT_VERSION").id


def set_interval(bridge: Bridge, channel: Channel, command: Command) -> int:
    """511: p1 message, p2 interval [us]: -1 stops, 0 default. DENIED with a text: unknown, or above SCHED_LOOP_RATE."""
    return int(bridge.get(StreamService).set_interval(channel, command))


def get_interval(bridge: Bridge, channel: Channel, command: Command) -> int:
    """510: answers MESSAGE_INTERVAL for message p1."""
    return int(bridge.get(StreamService).get_interval(channel, command))


def request_message(bridge: Bridge, channel: Channel, command: Command) -> int:
    """512: sends message p1 once; FAILED when there is none."""
    return int(bridge.get(StreamService).request_message(channel, command))


def get_home(bridge: Bridge, channel: Channel, command: Command) -> int:
    """410 (old): answers HOME_POSITION."""
    if not bridge.vehicle.v.autopilot.home.is_set:
        return FAILED
    bridge.send_now(channel, HOME_POSITION)
    return ACCEPTED


def request_version(bridge: Bridge, channel: Channel, command: Command) -> int:
    """520 (old): p1 must be 1; answers AUTOPILOT_VERSION."""
    if command.p1 != 1.0:
        return UNSUPPORTED
    bridge.send_now(channel, AUTOPILOT_VERSION)
    return ACCEPTED


def prearm_checks(bridge: Bridge, channel: Channel, command: Command) -> int:
    """401: the checks that fail now, as texts."""
    if bridge.autopilot.armed():
        return TEMPORARILY_REJECTED
    bridge.autopilot.run_prearm_checks()
    bridge.say_pending()
    return ACCEPTED


def reboot(bridge: Bridge, channel: Channel, command: Command) -> int:
    """246: p1 1 or 3 reboots the autopilot, when disarmed."""
    if command.p1 not in (1.0, 3.0):
        return UNSUPPORTED
    if bridge.autopilot.armed():
        return FAILED
    bridge.vehicle.request_reboot()
    return ACCEPTED


def calibrate(bridge: Bridge, channel: Channel, command: Command) -> int:
    """241: the simulated sensors need none; what a ground station waits for is said."""
    say = bridge.get(StatusTextService).say
    if bridge.autopilot.armed():
        say(NOTICE, "Disarm to allow calibration")
        return FAILED
    if command.p1 == 1.0 or command.p5 == 2.0:
        say(INFO, "Initialising ArduPilot")
        return ACCEPTED
    if command.p3 == 1.0:
        say(INFO, "Updating barometer calibration")
        say(INFO, "Barometer calibration complete")
        return ACCEPTED
    return TEMPORARILY_REJECTED if command.p5 == 4.0 else UNSUPPORTED


def storage(bridge: Bridge, channel: Channel, command: Command) -> int:
    """245: parameters and missions live as long as the process.

    There is no storage to read, write or reset.
    """
    return DENIED


COMMANDS: dict[int, Entry] = {
    241: Entry(calibrate),
    245: Entry(storage),
    246: Entry(reboot, required=(1,)),
    401: Entry(prearm_checks),
    410: Entry(get_home),
    510: Entry(get_interval, required=(1,)),
    511: Entry(set_interval, required=(1, 2)),
    512: Entry(request_message, required=(1,)),
    520: Entry(request_version, required=(1,)),
}
