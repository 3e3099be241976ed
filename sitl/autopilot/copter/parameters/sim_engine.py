# SPDX-License-Identifier: BSD-3-Clause
"""SIM_ENGINE_*: failing motors of the simulated copter."""

from __future__ import annotations

from ...params.parameter import INT32, Parameter

PARAMETERS = (
    Parameter("SIM_ENGINE_FAIL", 0, 0, 255, "", "Motors that fail: 1 motor 1, 2 motor 2, 4 motor 3, ...", INT32),
    Parameter("SIM_ENGINE_MUL", 0, 0, 1, "", "Share of their thrust that failing motors keep"),
)
