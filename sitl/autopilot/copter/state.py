# SPDX-License-Identifier: BSD-3-Clause
"""The copter firmware's record."""

from __future__ import annotations

from ..state import autopilot_dtype
from .control.state import CONTROL_DTYPE
from .modes.state import MODES_DTYPE
from .table import TABLE

AUTOPILOT_DTYPE = autopilot_dtype(TABLE.dtype, MODES_DTYPE, CONTROL_DTYPE)
