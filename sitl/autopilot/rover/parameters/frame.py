# SPDX-License-Identifier: BSD-3-Clause
"""What the vehicle is."""

from __future__ import annotations

from ...params.parameter import INT8, Parameter

PARAMETERS = (Parameter("FRAME_CLASS", 1, 1, 1, "", "1: a wheeled or tracked vehicle", INT8),)
