# SPDX-License-Identifier: BSD-3-Clause
"""Messages of common.xml that pymavlink's ``ardupilotmega`` dialect does not have yet.

Described as it describes its own.
"""

from __future__ import annotations

import struct


class AvailableModes:
    """AVAILABLE_MODES (https://mavlink.io/en/messages/common.html#AVAILABLE_MODES)."""

    id = 435
    msgname = "AVAILABLE_MODES"
    crc_extra = 134
    unpacker = struct.Struct("<IIBBB35s")
    fieldnames = ("number_modes", "mode_index", "standard_mode", "custom_mode", "properties", "mode_name")
    fieldtypes = ("uint8_t", "uint8_t", "uint8_t", "uint32_t", "uint32_t", "char")
    ordered_fieldnames = (
        "custom_mode",
        "properties",
        "number_modes",
        "mode_index",
        "standard_mode",
        "mode_name",
    )
    array_lengths = (0, 0, 0, 0, 0, 35)


NEWER = {AvailableModes.id: AvailableModes}
