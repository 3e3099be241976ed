# SPDX-License-Identifier: BSD-3-Clause
"""First GPS receiver."""

from __future__ import annotations

from ..parameter import INT16, Parameter

PARAMETERS = (Parameter("GPS1_DELAY_MS", 0, 0, 350, "ms", "age of a fix when it arrives; 0: the usual 120 ms", INT16),)
