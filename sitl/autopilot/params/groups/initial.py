# SPDX-License-Identifier: BSD-3-Clause
"""Start."""

from __future__ import annotations

from ..parameter import INT8, Parameter

PARAMETERS = (Parameter("INITIAL_MODE", 0, 0, 127, "", "Mode after boot, until the mode channel says another", INT8),)
