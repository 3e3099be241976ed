# SPDX-License-Identifier: BSD-3-Clause
"""What is said of the landing target: ArduPilot's status texts with their severities (shell side)."""

from __future__ import annotations

from .state import (
    SAID_FAILED,
    SAID_FAILSAFE,
    SAID_FOUND,
    SAID_LOST,
    SAID_NO_BEACON,
    SAID_NO_FRAME,
    SAID_READY,
    SAID_RETRIED,
    SAID_RETRY,
)

_CRITICAL, _INFO = 2, 6
TEXTS = {
    SAID_FOUND: (_INFO, "PrecLand: Target Found"),
    SAID_READY: (_INFO, "PrecLand: Init Complete"),
    SAID_FAILED: (_CRITICAL, "PrecLand: Init Failed"),
    SAID_LOST: (_CRITICAL, "PrecLand: Target Lost"),
    SAID_RETRY: (_INFO, "PrecLand: Retrying"),
    SAID_RETRIED: (_INFO, "PrecLand: Retry Completed"),
    SAID_FAILSAFE: (_INFO, "PrecLand: Failsafe Measures"),
    SAID_NO_BEACON: (_INFO, "Set SIM_PLD_LAT, SIM_PLD_LON and SIM_PLD_ALT"),
    SAID_NO_FRAME: (_INFO, "Plnd: Frame not supported"),
}
"""What LANDING_TARGET_DID says -> MAV_SEVERITY and text."""
