# SPDX-License-Identifier: BSD-3-Clause
"""The end of a mission."""

from __future__ import annotations

from ...params.parameter import INT8, Parameter

PARAMETERS = (
    Parameter("MIS_DONE_BEHAVE", 0, 0, 3, "", "Mission complete: 0 stops, 1 loiters, 2 ACRO, 3 MANUAL", INT8),
)
