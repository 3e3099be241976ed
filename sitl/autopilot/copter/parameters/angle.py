# SPDX-License-Identifier: BSD-3-Clause
"""Greatest lean."""

from __future__ import annotations

from ...params.parameter import INT16, Parameter

PARAMETERS = (Parameter("ANGLE_MAX", 3000, 500, 8000, "cdeg", "Greatest lean in all modes", INT16),)
