# SPDX-License-Identifier: BSD-3-Clause
"""The mode switch of the pilot's transmitter: six positions on one channel."""

from __future__ import annotations

from typing import Protocol

from ..core.kernels import law
from .state import Radio

DEBOUNCE_US = 200_000
_ENDS = (1231, 1361, 1491, 1621, 1750)
"""Where a position ends and the next one begins [us]."""


class Switch(Protocol):
    """What a firmware keeps of the switch."""

    switch_position: int
    switch_candidate: int
    switch_us: int


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
