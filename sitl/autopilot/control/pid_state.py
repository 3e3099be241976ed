# SPDX-License-Identifier: BSD-3-Clause
"""The record of a PID loop (``pid.py``). Zeros are a valid start."""

from __future__ import annotations

from ...core.records import Record


class Pid(Record):
    """What a PID loop keeps between periods."""

    started: int  # 0: the filters take the next input as it is
    target: float  # filtered; the unit of the controlled quantity
    error: float  # filtered
    derivative: float  # of the error, filtered [1/s]
    target_derivative: float  # [1/s]
    integrator: float  # in the unit of the output
