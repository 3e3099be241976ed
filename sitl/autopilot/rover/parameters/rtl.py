# SPDX-License-Identifier: BSD-3-Clause
"""RTL and SMART_RTL."""

from __future__ import annotations

from ...params.parameter import Parameter

PARAMETERS = (Parameter("RTL_SPEED", 0.0, 0.0, 100.0, "m/s", "Speed of the way home; 0: WP_SPEED"),)
