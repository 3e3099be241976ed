# SPDX-License-Identifier: BSD-3-Clause
"""Sticks in autopilot modes."""

from __future__ import annotations

from ...params.parameter import INT8, Parameter

PARAMETERS = (Parameter("STICK_MIXING", 0, 0, 1, "", "1: the steering stick adds to the autopilot's steering", INT8),)
