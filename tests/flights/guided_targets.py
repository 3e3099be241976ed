# SPDX-License-Identifier: BSD-3-Clause
"""Set-points for GUIDED, as messages."""

from __future__ import annotations

import numpy as np
from aviator import Aviator

POSITION, VELOCITY, ACCELERATION, POS_VEL, POS_VEL_ACCEL = 0xDF8, 0xDC7, 0xC3F, 0xDC0, 0xC00
POSITION_YAW, POSITION_YAW_RATE, VELOCITY_YAW_RATE = 0x9F8, 0x5F8, 0x5C7


def target(p: Aviator, mask: int, frame: int = 1, **fields: float) -> None:
    """SET_POSITION_TARGET_LOCAL_NED."""
    p.client.send(
        "SET_POSITION_TARGET_LOCAL_NED", target_system=1, target_component=1, coordinate_frame=frame, type_mask=mask,
        **fields,
    )  # fmt: skip


def stream(p: Aviator, seconds: float, mask: int, frame: int = 1, **fields: float) -> None:
    """The same at 10 Hz."""
    for _ in range(round(seconds * 10)):
        target(p, mask, frame, **fields)
        p.fly(0.1)


def estimate(p: Aviator) -> np.ndarray:
    """Estimated position, which set-points refer to."""
    return np.array(p.ap.estimate.pos)
