# SPDX-License-Identifier: BSD-3-Clause
"""The mode switch of the pilot's transmitter: six positions on one channel."""

from __future__ import annotations

from ..core.kernels import law

DEBOUNCE_US = 200_000


@law
def position(pulse):
    """Position 0 .. 5 of the mode channel, -1 for a pulse that means nothing."""
    if pulse <= 900 or pulse >= 2200:
        return -1
    if pulse < 1231:
        return 0
    if pulse < 1361:
        return 1
    if pulse < 1491:
        return 2
    if pulse < 1621:
        return 3
    if pulse < 1750:
        return 4
    return 5


@law
def moved_to(v, channel):
    """After each frame of the receiver: the position 0 .. 5 that ``channel`` (1 .. 18) was moved to and stayed at.

    -1 when nothing new is there: an old position changes nothing.
    """
    ap = v.autopilot
    pilot = ap.modes.pilot
    if channel < 1 or channel > 18 or ap.rc.receiver_ok == 0 or ap.modes.failsafe.radio != 0:
        return -1
    now = position(int(ap.rc.channels[channel - 1]))
    if now < 0:
        return -1
    if now != pilot.switch_candidate:
        pilot.switch_candidate = now
        pilot.switch_us = v.time_us
    elif now != pilot.switch_position and v.time_us - pilot.switch_us >= DEBOUNCE_US:
        pilot.switch_position = now
        return now
    return -1


@law
def chosen(k, mode1, mode2, mode3, mode4, mode5, mode6):
    """The mode of position ``k`` (0 .. 5), of the six that the firmware's parameters name."""
    if k == 0:
        return int(mode1)
    if k == 1:
        return int(mode2)
    if k == 2:
        return int(mode3)
    if k == 3:
        return int(mode4)
    if k == 4:
        return int(mode5)
    return int(mode6)
