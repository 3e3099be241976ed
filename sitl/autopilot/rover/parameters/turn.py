# SPDX-License-Identifier: BSD-3-Clause
"""How tightly the vehicle turns."""

from __future__ import annotations

from ...params.parameter import Parameter

PARAMETERS = (Parameter("TURN_RADIUS", 0.9, 0.0, 100.0, "m", "Turning radius at low speed and full steering"),)
