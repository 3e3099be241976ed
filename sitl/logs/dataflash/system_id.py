# SPDX-License-Identifier: BSD-3-Clause
"""SIDS and SIDD: what SYSTEMID puts in and what the vehicle answers, at its events."""

from __future__ import annotations

import math
from typing import Any

from ...autopilot import events
from ...autopilot.copter.modes import systemid

Row = tuple[str, tuple[float, ...]]
"""A message's name, and its values behind TimeUS."""


def rows(v: Any, code: int, a: float) -> list[Row]:
    """The message of an event that has just come, as the vehicle's record ``v`` is."""
    if code == events.SYSTEM_ID_DID and a == systemid.STARTED:
        p = v.autopilot.params.SID
        settings = (p.MAGNITUDE, p.F_START_HZ, p.F_STOP_HZ, p.T_FADE_IN, systemid.chirp_of(p).constant)
        return [("SIDS", (int(p.AXIS), *settings, p.T_REC, p.T_FADE_OUT))]
    if code == events.SYSTEM_ID_SAMPLE:
        state, rates, acc = v.autopilot.modes.systemid, v.autopilot.estimate.rates, v.sensors.acc
        chirp = (state.time, state.value, state.frequency / (2.0 * math.pi))
        return [("SIDD", (*chirp, *(math.degrees(x) for x in rates), *acc))]
    return []
