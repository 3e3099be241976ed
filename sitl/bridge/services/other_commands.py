# SPDX-License-Identifier: BSD-3-Clause
"""Commands to parts that a simulated vehicle does not have: answered as ArduPilot answers where the part is missing.

A command to a part that no such vehicle can have is UNSUPPORTED; these are about parts that are only not connected.
"""

from __future__ import annotations

import math

from ...core.mavlink import MavResult
from ..channel import Channel
from ..host import Host
from ..locations import FRAMES_AMSL
from .command import Command, Entry


def follow(bridge: Host, channel: Channel, command: Command) -> int:
    """32: p1 system id of the vehicle that FOLLOW follows, 1 .. 255."""
    if not 0.0 < command.p1 <= 255.0:
        return MavResult.DENIED
    bridge.vehicle.parameters["FOLL_SYSID"] = float(int(command.p1))
    return MavResult.ACCEPTED


def pair_receiver(bridge: Host, channel: Channel, command: Command) -> int:
    """500: the receiver is paired already."""
    return MavResult.ACCEPTED


def move_landing_gear(bridge: Host, channel: Channel, command: Command) -> int:
    """2520: the landing gear, which is fixed, stays as it is."""
    return MavResult.ACCEPTED


def identify(bridge: Host, channel: Channel, command: Command) -> int:
    """10001: there is no ADS-B transmitter."""
    return MavResult.FAILED


def forward_can(bridge: Host, channel: Channel, command: Command) -> int:
    """32000: p1 0 forwards no CAN bus to this link; others: there is none."""
    return MavResult.ACCEPTED if int(command.p1) == 0 else MavResult.FAILED


def trap(bridge: Host, channel: Channel, command: Command) -> int:
    """42700: no debugger is called."""
    return MavResult.DENIED


STOP_SCRIPTS, RESTART_SCRIPTS = 2, 3
"""SCRIPTING_CMD; 0 and 1 are of an interpreter on the link."""


def script(bridge: Host, channel: Channel, command: Command) -> int:
    """42701: p1 2 stops, 3 restarts scripts on board, of which there are none."""
    number = int(command.p1)
    if number in (STOP_SCRIPTS, RESTART_SCRIPTS):
        return MavResult.ACCEPTED
    return MavResult.DENIED if number in (0, 1) else MavResult.UNSUPPORTED


DANGEROUS, SAFE = 1, 0
"""SAFETY_SWITCH_STATE"""


def switch_safety(bridge: Host, channel: Channel, command: Command) -> int:
    """5300: p1 1: there is no safety switch that keeps the outputs off, 0 FAILED."""
    number = int(command.p1)
    if number == DANGEROUS:
        return MavResult.ACCEPTED
    return MavResult.FAILED if number == SAFE else MavResult.DENIED


FOCUS_TYPES = (1, 2, 4, 5, 6)
"""SET_FOCUS_TYPE: continuous, range, automatic ones"""


def focus(bridge: Host, channel: Channel, command: Command) -> int:
    """532: p1 SET_FOCUS_TYPE; no camera here has a focus."""
    return MavResult.FAILED if int(command.p1) in FOCUS_TYPES else MavResult.DENIED


def choose_camera_source(bridge: Host, channel: Channel, command: Command) -> int:
    """534: no camera here has several sources."""
    return MavResult.DENIED


def record_video(bridge: Host, channel: Channel, command: Command) -> int:
    """2500, 2501: no camera here records videos."""
    return MavResult.FAILED


def external_position(bridge: Host, channel: Channel, command: Command) -> int:
    """43003: in a frame without altitude (p7 NaN); the estimator, which has a receiver, does not take it."""
    if command.frame not in FRAMES_AMSL or not math.isnan(command.z):
        return MavResult.DENIED
    return MavResult.FAILED


COMMANDS: dict[int, Entry] = {
    32: Entry(follow),
    500: Entry(pair_receiver),
    532: Entry(focus),
    534: Entry(choose_camera_source),
    2500: Entry(record_video),
    2501: Entry(record_video),
    5300: Entry(switch_safety),
    10001: Entry(identify),
    32000: Entry(forward_can),
    42700: Entry(trap),
    42701: Entry(script),
    43003: Entry(external_position, has_location=True, int_only=True, takes_nan=True),
}
