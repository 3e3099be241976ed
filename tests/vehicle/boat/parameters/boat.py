# SPDX-License-Identifier: BSD-3-Clause
"""BOAT_*: the boat's own parameters."""

from __future__ import annotations

from sitl.autopilot.params.parameter import Parameter

PARAMETERS = (Parameter("BOAT_THROTTLE", 0.5, 0.0, 1.0, "", "Throttle while it is armed"),)
