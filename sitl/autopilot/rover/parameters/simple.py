# SPDX-License-Identifier: BSD-3-Clause
"""SIMPLE."""

from __future__ import annotations

from ...params.parameter import INT8, Parameter

PARAMETERS = (Parameter("SIMPLE_TYPE", 0, 0, 1, "", "Stick forwards: 0 the heading when armed, 1 north", INT8),)
