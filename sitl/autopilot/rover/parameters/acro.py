# SPDX-License-Identifier: BSD-3-Clause
"""ACRO and pivot turns of STEERING."""

from __future__ import annotations

from ...params.parameter import Parameter

PARAMETERS = (Parameter("ACRO_TURN_RATE", 180.0, 0.0, 360.0, "deg/s", "Turn rate of a full steering stick"),)
