# SPDX-License-Identifier: BSD-3-Clause
"""What the pilot's transmitter commands: the mode switch (six positions on one channel), arming with the yaw stick."""

from __future__ import annotations

from typing import Protocol

from ..core.kernels import law
from .state import Radio

DEBOUNCE_US = 200_000
_ENDS = (1231, 1361, 1491, 1621, 1750)
"""Where a position ends and the next one begins [us]."""
RUDDER_US = 2_000_000
"""The yaw (steering) stick arms or disarms when it is held over for so long."""
_FULL_STICK = 4000.0 / 4500.0


class Switch(Protocol):
    """What a firmware keeps of the switch."""

    switch_position: int
    switch_candidate: int
    switch_us: int


class RudderStick(Protocol):
    """What a firmware keeps of arming with the yaw stick."""

    rudder_us: int


@law
def position(pulse: int) -> int:
    """Position 0 .. 5 of the mode channel, -1 for a pulse [us] that means nothing."""
    if pulse <= 900 or pulse >= 2200:
        return -1
    for k in range(5):
        if pulse < _ENDS[k]:
            return k
    return 5


@law
def moved_to(switch: Switch, rc: Radio, channel: int, time_us: int) -> int:
    """After each frame of the receiver: the position 0 .. 5 that ``channel`` (1 .. 18) was moved to and stayed at.

    -1 when nothing new is there: an old position changes nothing.
    """
    if channel < 1 or channel > 18 or not rc.receiver_ok:
        return -1
    now = position(rc.channels[channel - 1])
    if now < 0:
        return -1
    if now != switch.switch_candidate:
        switch.switch_candidate = now
        switch.switch_us = time_us
    elif now != switch.switch_position and time_us - switch.switch_us >= DEBOUNCE_US:
        switch.switch_position = now
        return now
    return -1


@law
def rudder_command(stick: float, armed: bool, permission: float) -> int:
    """What the yaw stick, -1 .. 1, asks for: 1 to arm, -1 to disarm, 0 nothing; ``permission``: ARMING_RUDDER."""
    if stick > _FULL_STICK and not armed and permission >= 1.0:
        return 1
    return -1 if stick < -_FULL_STICK and armed and permission >= 2.0 else 0


@law
def is_rudder_held(pilot: RudderStick, command: int, time_us: int) -> bool:
    """After each frame: whether the stick has asked for something (``command`` not 0) for RUDDER_US."""
    if command == 0:
        pilot.rudder_us = 0
    elif pilot.rudder_us == 0:
        pilot.rudder_us = time_us
    return command != 0 and time_us - pilot.rudder_us >= RUDDER_US
