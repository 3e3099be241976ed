# SPDX-License-Identifier: BSD-3-Clause
"""Crash check."""

from __future__ import annotations

from ...params.parameter import INT8, Parameter

PARAMETERS = (Parameter("CRASH_ANGLE", 0, 0, 60, "deg", "Lean that counts as a crash at once; 0: none does", INT8),)
