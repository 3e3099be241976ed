# SPDX-License-Identifier: BSD-3-Clause
"""Logs of rovers."""

from __future__ import annotations

from . import plot
from .dataflash.rover import messages
from .kind import KindLogs

_MODES = "MANUAL ACRO - STEERING HOLD LOITER FOLLOW SIMPLE DOCK CIRCLE AUTO RTL SMART_RTL - - GUIDED INITIALISING"
"""https://mavlink.io/en/messages/ardupilotmega.html#ROVER_MODE"""

LOGS = KindLogs(
    messages=messages,
    title="ArduRover",
    build_type=1,
    word="Rover",
    mav_types=(10, 11),
    mode_names=tuple(_MODES.split()),
    panels=(plot.speed, plot.heading, plot.outputs),
)
