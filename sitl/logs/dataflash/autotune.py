# SPDX-License-Identifier: BSD-3-Clause
"""ATUN: what AUTOTUNE's twitches measure, with the gains that follow from it; and its events that EV tells of."""

from __future__ import annotations

import math
from typing import Any

from ...autopilot import events
from ...autopilot.copter.modes import autotune_gains as gains
from ...autopilot.copter.modes import autotune_rules as rules
from .system_id import Row

EV_NUMBERS = {
    gains.STARTED: 30, gains.STOPPED: 31, gains.SUCCESS: 33, gains.FAILURE: 34, gains.D_LIMIT: 35, gains.TRIES: 36,
    gains.SAVED: 37,
}  # fmt: skip
"""What it did -> ArduPilot's number of the event."""


def rows(v: Any, code: int, a: float) -> list[Row]:
    """The message of an event that has just come, as the vehicle's record ``v`` is."""
    if code != events.AUTOTUNE_DID:
        return []
    t = v.autopilot.modes.autotune
    if a == gains.MEASURED:
        g = gains.found(t, t.axis)
        least, most = (t.rate_min, t.rate_max) if t.step <= rules.RATE_P_UP else (t.angle_min, t.angle_max)
        measured = [math.degrees(x) for x in (t.target, least, most)]
        return [
            ("ATUN", (t.axis, t.step, *measured, g.rate_p, rules.get_d(t, g), g.angle_p, math.degrees(100.0 * t.accel)))
        ]
    return [("EV", (EV_NUMBERS[int(a)],))] if a in EV_NUMBERS else []
