# SPDX-License-Identifier: BSD-3-Clause
"""Power-on: everything but the parameters starts from nothing."""

from __future__ import annotations

from typing import Any

import numpy as np


def clear(v: Any) -> None:
    """Zero the whole vehicle record except the parameters (they live in the autopilot's storage)."""
    for name in v.dtype.names:
        if name != "autopilot":
            v[name] = np.zeros((), v.dtype[name])
    autopilot = v.dtype["autopilot"]
    for name in autopilot.names:
        if name != "params":
            v.autopilot[name] = np.zeros((), autopilot[name])
