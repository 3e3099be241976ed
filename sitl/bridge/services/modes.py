# SPDX-License-Identifier: BSD-3-Clause
"""AVAILABLE_MODES.

The flight modes by number and name (https://mavlink.io/en/services/standard_modes.html).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..channel import Channel
from ..dialect import message

if TYPE_CHECKING:
    from ..profile import Mode

KIND = message("AVAILABLE_MODES")


def send_modes(channel: Channel, modes: Sequence[Mode], index: int) -> bool:
    """Send mode ``index`` (from 1), or all for 0; False when there is no such mode."""
    if not 0 <= index <= len(modes):
        return False
    for k, (number, name, standard, properties) in enumerate(modes, start=1):
        if index in (0, k):
            channel.send(KIND, KIND.pack(number, properties, len(modes), k, standard, name.encode()))
    return True
