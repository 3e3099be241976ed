# SPDX-License-Identifier: BSD-3-Clause
"""The record of a PID loop (``pid.py``). Zeros are a valid start."""

from __future__ import annotations

from ...core.records import record

PID_DTYPE = record(
    ("started", "i8"),  # 0: the filters take the next input as it is
    ("target", "f8"),  # filtered; the unit of the controlled quantity
    ("error", "f8"),  # filtered
    ("derivative", "f8"),  # of the error, filtered [1/s]
    ("target_derivative", "f8"),  # [1/s]
    ("integrator", "f8"),  # in the unit of the output
)
