# SPDX-License-Identifier: BSD-3-Clause
"""Set-points for GUIDED, as messages."""

from __future__ import annotations

import numpy as np

from tests.flights.aviator import Aviator

POSITION, VELOCITY, ACCELERATION, POS_VEL, POS_VEL_ACCEL = 0xDF8, 0xDC7, 0xC3F, 0xDC0, 0xC00
POSITION_YAW, POSITION_YAW_RATE, VELOCITY_YAW_RATE = 0x9F8, 0x5F8, 0x5C7


target, stream = Aviator.target, Aviator.stream
"""One set-point, and the same at 10 Hz: ``target(p, mask, frame, **fields)``."""


def estimate(p: Aviator) -> np.ndarray:
    """Estimated position, which set-points refer to."""
    return np.array(p.ap.estimate.pos)
