# SPDX-License-Identifier: BSD-3-Clause
"""Every message of the dialect as rows of numbers, for laws that cut frames out of bytes and close them."""

from __future__ import annotations

import numpy as np

from ...core.kernels import law
from ..dialect import KNOWN_IDS, layout_of

_ROWS = sorted(layout_of(number) for number in KNOWN_IDS)
NUMBERS = np.array([row.id for row in _ROWS])
SIZES = np.array([row.size for row in _ROWS])
"""Of the payload with all its extensions [bytes]."""
BASE_SIZES = np.array([row.base_size for row in _ROWS])
"""Without extensions: all that MAVLink 1 carries."""
CRC_EXTRAS = np.array([row.crc_extra for row in _ROWS])
PAYLOAD_MAX = 255
COUNT = len(_ROWS)


@law
def row_of(number: int) -> int:
    """Row of the message with this number, -1 when the dialect has none."""
    low, high = 0, COUNT
    while low < high:
        middle = (low + high) // 2
        if NUMBERS[middle] < number:
            low = middle + 1
        else:
            high = middle
    return low if low < COUNT and NUMBERS[low] == number else -1
