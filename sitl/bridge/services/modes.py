# SPDX-License-Identifier: BSD-3-Clause
"""AVAILABLE_MODES.

The flight modes by number and name (https://mavlink.io/en/services/standard_modes.html).
"""

from __future__ import annotations

from ..channel import Channel
from ..dialect import message

KIND = message("AVAILABLE_MODES")
AUTOMATIC = 4
"""MAV_MODE_PROPERTY_AUTO_MODE: flies without the pilot's sticks."""

MODES = (
    (0, "STABILIZE", 0, 0),
    (2, "ALT_HOLD", 4, 0),
    (3, "AUTO", 6, AUTOMATIC),
    (4, "GUIDED", 0, AUTOMATIC),
    (5, "LOITER", 1, 0),
    (6, "RTL", 5, AUTOMATIC),
    (9, "LAND", 7, AUTOMATIC),
    (17, "BRAKE", 0, AUTOMATIC),
)
"""(custom mode, name, MAV_STANDARD_MODE, MAV_MODE_PROPERTY bits)"""


def send_modes(channel: Channel, index: int) -> bool:
    """Send mode ``index`` (from 1), or all for 0; False when there is no such mode."""
    if not 0 <= index <= len(MODES):
        return False
    for k, (number, name, standard, properties) in enumerate(MODES, start=1):
        if index in (0, k):
            channel.send(KIND, KIND.pack(number, properties, len(MODES), k, standard, name.encode()))
    return True
