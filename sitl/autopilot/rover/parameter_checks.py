# SPDX-License-Identifier: BSD-3-Clause
"""The rover's arming checks of parameters: what its outputs do."""

from __future__ import annotations

from collections.abc import Iterable

from ..parameter_checks import ANY, CHECK_RC, OUTPUTS, SHARED, Check, Subject, switches
from ..radio import ROLL, THROTTLE
from ..radio_checks import calibration_texts
from .control import servos

STICKS = {ROLL: "Steer", THROTTLE: "Throttle"}
"""Sticks that must be calibrated, and what texts call them."""


def motors(s: Subject) -> Iterable[str]:
    """The first thing that is wrong with what outputs do."""
    assigned = {int(s.values[f"SERVO{k}_FUNCTION"]) for k in range(1, OUTPUTS + 1)}
    steers, drives = servos.STEERING in assigned, servos.THROTTLE in assigned
    left, right = servos.LEFT in assigned, servos.RIGHT in assigned
    if not (steers or drives or left or right):
        return  # a check of its own
    if left != right:
        yield "check skid steering config"
    elif steers != drives:
        yield "check steering and throttle config"


def radio(s: Subject) -> Iterable[str]:
    """The first stick that is not calibrated; else all that is wrong with channels."""
    found = list(calibration_texts(s.values, s.v.autopilot.params, STICKS))
    return found[:1] if found and " radio " in found[0] else found


CHECKS = (
    Check(ANY, motors), *SHARED,
    Check(CHECK_RC, radio),
    Check(CHECK_RC, lambda s: switches(s, "MODE_CH"), when_arming=True),
)  # fmt: skip
