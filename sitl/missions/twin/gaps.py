# SPDX-License-Identifier: BSD-3-Clause
"""What a flight had and its log lacks: messages that were dropped while the card was busy, and the start of a mission
among them, or in logs of before MAVC.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from sitl.core.mavlink import MavCmd
from sitl.logs.kind import mode_name

from .flight_log import FlightLog

Array = np.ndarray[Any, Any]

_AUTO = "AUTO"
_LIFTED_M = 0.5
_SOON_S = 60.0
"""A mission that begins with a take-off does so within this time of AUTO."""
_RAISED_US = 50.0
"""A throttle that is so far above its lowest pulse starts a mission by itself."""
_THROTTLE = 2
"""Its position among the channels (RCMAP_THROTTLE 3)."""


def dropped(log: FlightLog) -> int:
    """How many messages the vehicle could not write in the flight (DSF.Dp counts them since boot)."""
    if not log.has("DSF", "Dp"):
        return 0
    table = log.table("DSF")
    time = log.since_arming(table)
    inside = time <= log.span.length
    if not inside.any():
        return 0
    return round(float(table["Dp"][inside][-1]) - float(log.at_arming(time, table["Dp"])))


def uncommanded_start(
    log: FlightLog,
    modes: Sequence[tuple[float, str]],
    commands: Sequence[tuple[float, int]],
    sticks: tuple[Array, Array] | None,
) -> float | None:
    """When a copter took off by its mission without a start that the log shows; None: it did not.

    On the ground AUTO waits for MISSION_START or for the throttle stick.

    Args:
        log: the flight.
        modes: (time since arming [s], name of the mode), in the order of time.
        commands: (time since arming [s], number) of those that clients gave.
        sticks: times, and pulses (n, channels) [us].
    """
    if log.kind != "copter":
        return None
    table = log.estimate()
    time = log.since_arming(table)
    height = log.at_arming(time, table["PD"]) - table["PD"]
    lifted = time[(time >= 0.0) & (height > _LIFTED_M)]
    if not len(lifted):
        return None
    begins = [(at, mode) for at, mode in modes if at <= lifted[0]]
    if not begins or begins[-1][1].upper() != _AUTO:
        return None
    auto = begins[-1][0]
    commanded = any(number == MavCmd.MISSION_START and at <= lifted[0] for at, number in commands)
    if commanded or lifted[0] - max(auto, 0.0) > _SOON_S or _raised(sticks, float(lifted[0])):
        return None
    return max(auto, 0.0)


def _raised(sticks: tuple[Array, Array] | None, until: float) -> bool:
    """Whether the throttle stick was raised by then."""
    if sticks is None or sticks[1].shape[1] <= _THROTTLE:
        return False
    time, pulses = sticks
    throttle = pulses[time <= until, _THROTTLE]
    return bool(len(throttle)) and float(throttle.max()) > float(pulses[:, _THROTTLE].min()) + _RAISED_US


def mode_names(kind: str, modes: Sequence[tuple[float, int, bool]]) -> list[tuple[float, str]]:
    """(Time, name) of changes of mode."""
    return [(time, mode_name(kind, number)) for time, number, _ in modes]
