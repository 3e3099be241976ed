# SPDX-License-Identifier: BSD-3-Clause
"""GUIDED."""

from __future__ import annotations

from ...params.parameter import INT32, Parameter

PARAMETERS = (
    Parameter(
        "GUID_OPTIONS", 0, 0, 64, "", "64: positions are driven to along planned legs; else the target is shaped", INT32
    ),
)
