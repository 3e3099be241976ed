# SPDX-License-Identifier: BSD-3-Clause
"""Take-off."""

from __future__ import annotations

from ...params.parameter import Parameter

PARAMETERS = (
    Parameter("TKOFF_SLEW_TIME", 2.0, 0.25, 5.0, "s", "From zero to full throttle on the ground"),
    Parameter("TKOFF_THR_MAX", 0.9, 0.0, 0.9, "", "Throttle at which it is taken to fly"),
)
