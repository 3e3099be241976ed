# SPDX-License-Identifier: BSD-3-Clause
"""AVAILABLE_MODES.

The flight modes by number and name (https://mavlink.io/en/services/standard_modes.html).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...autopilot.modes import Mode
from ..channel import Channel
from ..dialect import message

KIND = message("AVAILABLE_MODES")
AUTOMATIC = 4
"""MAV_MODE_PROPERTY_AUTO_MODE: moves without the pilot's sticks."""
NOT_SELECTABLE = 2
"""MAV_MODE_PROPERTY_NOT_USER_SELECTABLE"""


def send_modes(channel: Channel, modes: Sequence[Mode[Any]], index: int) -> bool:
    """Send mode ``index`` (from 1), or all for 0; False when there is no such mode."""
    if not 0 <= index <= len(modes):
        return False
    for k, mode in enumerate(modes, start=1):
        if index in (0, k):
            properties = (AUTOMATIC if mode.autonomous else 0) | (0 if mode.selectable else NOT_SELECTABLE)
            name = mode.name.encode()
            channel.send(KIND, KIND.pack(mode.number, properties, len(modes), k, mode.standard_mode, name))
    return True
