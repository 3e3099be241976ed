# SPDX-License-Identifier: BSD-3-Clause
"""Spool states: how far the motors have come between standing and full thrust (ArduPilot's names and numbers)."""

from __future__ import annotations

from enum import IntEnum


class DesiredSpoolState(IntEnum):
    """What a mode wants of the motors."""

    SHUT_DOWN = 0
    GROUND_IDLE = 1
    THROTTLE_UNLIMITED = 2


class SpoolState(IntEnum):
    """What the motors do."""

    SHUT_DOWN = 0
    GROUND_IDLE = 1
    SPOOLING_UP = 2
    THROTTLE_UNLIMITED = 3
    SPOOLING_DOWN = 4
