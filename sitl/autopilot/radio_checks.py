# SPDX-License-Identifier: BSD-3-Clause
"""Arming checks of the radio: its throttle, the calibration of its channels, and sticks at rest.

What is wrong with which channel is asked of the parameters again when the texts are made: the bits of failed checks
say only that something is.
"""

from __future__ import annotations

from collections.abc import Mapping

from ..core.border import RC_INPUTS
from ..core.kernels import law
from . import radio
from .params.parameters import Parameters
from .params.radio import RcChannel, RcMap
from .radio import PITCH, ROLL, THROTTLE, YAW
from .state import Radio

# Bits of failed checks, among those of arming_checks.py
RC_MISSING = 2048
THROTTLE_FAILSAFE = 4096
OFF_CENTRE = {ROLL: 1 << 25, PITCH: 1 << 56, THROTTLE: 1 << 24, YAW: 1 << 57}
"""A stick that is not at rest."""
CALIBRATION = 1 << 58
PARAMETERS = 1 << 59
"""Parameters of any kind: their texts are those of ``parameter_checks``."""

STICK_NAMES = {ROLL: "Roll", PITCH: "Pitch", THROTTLE: "Throttle", YAW: "Yaw"}
HIGHEST_MIN, LOWEST_MAX = 1300.0, 1700.0
"""Calibrated sticks reach these pulses at least [us]."""


@law
def receiver(rc: Radio, rcmap: RcMap, throttle_min: float) -> int:
    """Failed checks of the receiver, which is lost when the throttle is below ``throttle_min`` [us]."""
    if not rc.receiver_ok:
        return RC_MISSING if rc.receiver_us == 0 else 0  # one that was there and is lost is a failsafe
    return THROTTLE_FAILSAFE if radio.stick_pulse(rc, rcmap, THROTTLE) < throttle_min else 0


@law
def is_outside(channel: RcChannel) -> bool:
    """Whether a channel's rest is not between its least and its greatest pulse."""
    return channel.MIN > channel.TRIM or channel.MAX < channel.TRIM


@law
def is_short(channel: RcChannel) -> bool:
    """Whether a stick's calibrated way is so short that it cannot have been moved to its ends."""
    return channel.MIN > HIGHEST_MIN or channel.MAX < LOWEST_MAX


@law
def channels(params: Parameters, sticks: int) -> int:
    """Failed checks of the channels' parameters; ``sticks``: bits 1 << ROLL ... of those that must be calibrated."""
    failed = 0
    for stick in range(4):
        if sticks >> stick & 1 and is_short(params.RC[radio.stick_channel(params.RCMAP, stick)]):
            failed |= CALIBRATION
    for k in range(RC_INPUTS):
        if is_outside(params.RC[k]):
            failed |= CALIBRATION
    return failed


@law
def off_centre(rc: Radio, params: Parameters, stick: int, bit: int) -> int:
    """``bit`` when a stick that springs to the middle is not there."""
    return bit if radio.stick_position(rc, params, stick) != 0.0 else 0


def texts(failed: int, params: Parameters, sticks: Mapping[int, str]) -> list[str]:
    """Status texts of failed checks; ``sticks``: how the firmware calls the sticks that must be calibrated."""
    said = []
    if failed & CALIBRATION:
        for stick, name in sticks.items():
            channel = params.RC[radio.stick_channel(params.RCMAP, stick)]
            said += [f"{name} radio min too high"] if channel.MIN > HIGHEST_MIN else []
            said += [f"{name} radio max too low"] if channel.MAX < LOWEST_MAX else []
        for number in range(1, RC_INPUTS + 1):
            channel = params.RC[number - 1]
            said += [f"RC{number}_MIN is greater than RC{number}_TRIM"] if channel.MIN > channel.TRIM else []
            said += [f"RC{number}_MAX is less than RC{number}_TRIM"] if channel.MAX < channel.TRIM else []
    for stick, bit in OFF_CENTRE.items():
        if failed & bit:
            said.append(f"{STICK_NAMES[stick]} (RC{radio.stick_channel(params.RCMAP, stick) + 1}) is not neutral")
    return said
