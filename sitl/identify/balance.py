# SPDX-License-Identifier: BSD-3-Clause
"""Where the centre of mass is, from the mean difference of the motors in a hover.

Motors that differ in strength look the same: what is found is what the controllers have to hold against.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..autopilot.copter.control.frames import FRAMES
from ..logs.dataflash import motors
from .estimate import NORMAL_95, Estimate, Sought
from .hover import hovers, mean
from .log_streams import FlightLog

Array = np.ndarray[Any, Any]

FORWARD = Sought(
    "balance_forward", "", "thrust's centre before the middle of the motors, by the farthest motor's distance"
)
RIGHT = Sought("balance_right", "", "the same to the right")
_LEAST = 20
"""Windows of 0.5 s."""
SYSTEMATIC, LEANS = 0.01, 0.08
"""Half of the interval, and by the lean [rad]: wind on the rotors turns the vehicle, too."""


def balance(logs: Sequence[FlightLog]) -> list[Estimate]:
    """Both properties."""
    parts = [(log, part) for log in logs for part in hovers(log)]
    count = sum(len(part.output) for _, part in parts)
    if count < _LEAST:
        reason = f"{0.5 * count:.0f} s of hover; {0.5 * _LEAST:.0f} s are needed"
        return [FORWARD.hidden(reason), RIGHT.hidden(reason)]
    rows, groups = [], []
    for k, (log, part) in enumerate(parts):
        pair = motors.frame(log.columns)
        frame = FRAMES.get(pair)
        if frame is None or len(frame) != part.motors.shape[1]:
            reason = f"FRAME_CLASS/FRAME_TYPE {pair[0]}/{pair[1]} with {part.motors.shape[1]} motor outputs is unknown"
            return [FORWARD.hidden(reason), RIGHT.hidden(reason)]
        low, high = log.parameter("MOT_SPIN_MIN", default=0.15), log.parameter("MOT_SPIN_MAX", default=0.95)
        expo = log.parameter("MOT_THST_EXPO", default=0.65)
        c = np.clip((part.motors - low) / (high - low), 0.0, 1.0)
        thrust = c * (1.0 - expo + expo * c)
        positions = np.array([[motor.forward, motor.right] for motor in frame])
        positions = (positions - positions.mean(0)) / np.hypot(*(positions - positions.mean(0)).T).max()
        rows.append(thrust @ positions / thrust.sum(1)[:, None])
        groups.append(np.full(len(rows[-1]), k))
    values, group = np.vstack(rows), np.concatenate(groups)
    lean = float(np.mean(np.concatenate([part.rows[:, 4] for _, part in parts])))
    found = []
    for k, sought in enumerate((FORWARD, RIGHT)):
        column = values[:, k]
        fit = mean(column, group)
        error = float(np.hypot(fit.error[0], (SYSTEMATIC + LEANS * lean) / NORMAL_95))
        found.append(sought.found(float(fit.value[0]), error, f"{0.5 * count:.0f} s of hover: RCOU"))
    return found
