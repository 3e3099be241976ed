# SPDX-License-Identifier: BSD-3-Clause
"""Arming checks of the radio: its throttle, the calibration of its channels, and sticks at rest.

The calibration is among the checks of parameters (``parameter_checks``), made in Python.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from ..core.kernels import law
from . import radio
from .params.firmware_parameters import Parameters
from .params.radio import RcMap
from .params.table import Values
from .radio import PITCH, ROLL, THROTTLE, YAW
from .state import Radio

# Bits of failed checks, among those of arming_checks.py
RC_MISSING = 2048
THROTTLE_FAILSAFE = 4096
OFF_CENTRE = {ROLL: 1 << 25, PITCH: 1 << 56, THROTTLE: 1 << 24, YAW: 1 << 57}
"""A stick that is not at rest."""
PARAMETERS = 1 << 59
"""Parameters of any kind: their texts are those of ``parameter_checks``."""

STICK_NAMES = {ROLL: "Roll", PITCH: "Pitch", THROTTLE: "Throttle", YAW: "Yaw"}
WORD = 65536.0
HIGHEST_MIN, LOWEST_MAX = 1300.0, 1700.0
"""Calibrated sticks reach these pulses at least [us]."""
RECEIVED = 8
"""Channels of the receiver; ArduPilot does not check others."""


@law
def receiver(rc: Radio, rcmap: RcMap, throttle_min: float) -> int:
    """Failed checks of the receiver, which is lost when the throttle is below ``throttle_min`` [us]."""
    if not rc.receiver_ok:
        return RC_MISSING if rc.receiver_us == 0 else 0  # one that was there and is lost is a failsafe
    return THROTTLE_FAILSAFE if radio.stick_pulse(rc, rcmap, THROTTLE) < throttle_min else 0


@law
def off_centre(rc: Radio, params: Parameters, stick: int, bit: int) -> int:
    """``bit`` when a stick that springs to the middle is not there."""
    return bit if radio.stick_position(rc, params, stick) != 0.0 else 0


def calibration_texts(values: Values, params: Parameters, sticks: Mapping[int, str]) -> Iterable[str]:
    """What is wrong with the channels; ``sticks``: those that must be calibrated, and what the firmware calls them."""
    for stick, name in sticks.items():
        channel = radio.stick_channel(params.RCMAP, stick) + 1
        if values[f"RC{channel}_MIN"] > HIGHEST_MIN:
            yield f"{name} radio min too high"
        if values[f"RC{channel}_MAX"] < LOWEST_MAX:
            yield f"{name} radio max too low"
    for number in range(1, RECEIVED + 1):
        rest = values[f"RC{number}_TRIM"] % WORD  # ArduPilot reads it without its sign
        if values[f"RC{number}_MIN"] > rest:
            yield f"RC{number}_MIN is greater than RC{number}_TRIM"
        if values[f"RC{number}_MAX"] < rest:
            yield f"RC{number}_MAX is less than RC{number}_TRIM"


def texts(failed: int, params: Parameters) -> list[str]:
    """Status texts of sticks that are not at rest."""
    said = []
    for stick, bit in OFF_CENTRE.items():
        if failed & bit:
            said.append(f"{STICK_NAMES[stick]} (RC{radio.stick_channel(params.RCMAP, stick) + 1}) is not neutral")
    return said
