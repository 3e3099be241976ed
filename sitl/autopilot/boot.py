# SPDX-License-Identifier: BSD-3-Clause
"""Power-on: everything but the parameters starts from nothing."""

from __future__ import annotations

from typing import Any

import numpy as np

from .control.init import init as init_control
from .modes.copter.init import init as init_modes
from .state import AUTOPILOT_DTYPE


def clear(v: Any) -> None:
    """Zero the whole vehicle record except the parameters (they live in the autopilot's storage)."""
    for name in v.dtype.names:
        if name != "autopilot":
            v[name] = np.zeros((), v.dtype[name])
    for name in AUTOPILOT_DTYPE.names or ():
        if name != "params":
            v.autopilot[name] = np.zeros((), AUTOPILOT_DTYPE[name])


def power_on(v: Any) -> None:
    """Start the rooms of the firmware on a cleared record whose parameters are set."""
    init_control(v.autopilot)
    init_modes(v)
