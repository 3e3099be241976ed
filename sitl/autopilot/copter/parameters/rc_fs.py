# SPDX-License-Identifier: BSD-3-Clause
"""Silence of the receiver."""

from __future__ import annotations

from ...params.parameter import Parameter

PARAMETERS = (Parameter("RC_FS_TIMEOUT", 1.0, 0.5, 10.0, "s", "Silence of the receiver that counts as lost"),)
