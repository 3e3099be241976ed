# SPDX-License-Identifier: BSD-3-Clause
"""Logs of copters."""

from __future__ import annotations

from . import plot
from .dataflash.copter import messages
from .kind import KindLogs

_MODES = (
    "STABILIZE ACRO ALT_HOLD AUTO GUIDED LOITER RTL CIRCLE - LAND - DRIFT - SPORT FLIP AUTOTUNE POSHOLD BRAKE THROW "
    "AVOID_ADSB GUIDED_NOGPS SMART_RTL FLOWHOLD FOLLOW ZIGZAG SYSTEMID AUTOROTATE AUTO_RTL TURTLE"
)
"""https://mavlink.io/en/messages/ardupilotmega.html#COPTER_MODE"""

LOGS = KindLogs(
    messages=messages,
    title="ArduCopter",
    build_type=2,
    word="Copter",
    mav_types=(2, 3, 4, 13, 14, 15, 29),
    mode_names=tuple(_MODES.split()),
    panels=(plot.altitude, plot.attitude, plot.motors),
)
