# SPDX-License-Identifier: BSD-3-Clause
"""One parameter, as data."""

from __future__ import annotations

import math
from numbers import Real
from typing import NamedTuple

FLOAT, INT8, INT16, INT32 = "float", "int8", "int16", "int32"

_INTEGER_LIMITS = {INT8: 127, INT16: 32767, INT32: 2**31 - 1}


class Parameter(NamedTuple):
    """A named number of the firmware, under ArduPilot's name, with ArduPilot's default.

    ``low`` and ``high`` are the values that the firmware accepts (not the range that is advisable).
    """

    name: str
    default: float
    low: float
    high: float
    unit: str
    """ArduPilot's unit of the value as the user sees it ("cm/s", "cdeg", "s", "" for none)."""
    doc: str
    """One line, our own words."""
    kind: str = FLOAT
    read_only: bool = False
    """The firmware's own: users read it."""

    def refusal(self, value: float) -> str | None:
        """Why ``value`` cannot be set, or None when it can."""
        if not isinstance(value, Real):
            return f"{self.name}: {value!r} is not a number"
        if not math.isfinite(value):
            return f"{self.name}: {value} is not a finite number"
        if not self.low <= value <= self.high:
            unit = f" {self.unit}" if self.unit else ""
            return f"{self.name}: {value:g} is outside {self.low:g} .. {self.high:g}{unit}"
        limit = _INTEGER_LIMITS.get(self.kind)
        if limit is not None and abs(value) > limit + 1:
            return f"{self.name}: {value:g} does not fit {self.kind}"
        return None
