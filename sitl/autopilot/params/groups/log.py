# SPDX-License-Identifier: BSD-3-Clause
"""On-board log (``sitl.logs.dataflash``): the core does not read these."""

from __future__ import annotations

from ..parameter import INT8, INT32, Parameter

PARAMETERS = (
    Parameter("LOG_BACKEND_TYPE", 1, 0, 1, "", "Where the on-board log goes: 0 nowhere, 1 into a file", INT8),
    Parameter("LOG_BITMASK", 180222, 0, 2147483647, "", "What is logged: a bit for each group of messages", INT32),
    Parameter("LOG_DISARMED", 0, 0, 3, "", "0 log while armed, 1 and 2 always, 3 always, but keep only flights", INT8),
)
