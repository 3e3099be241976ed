# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of the sensor that sees a dock."""

from __future__ import annotations

from ...params import precision_landing
from ...params.parameter import INT8, param


class PrecisionLanding(precision_landing.PrecisionLanding):
    """PLND_: with the way that the sensor looks."""

    ORIENT: float = param(0, 0, 43, "", "Where the sensor looks: 0 ahead, 2 right, 4 back, 6 left, 25 down", INT8)
