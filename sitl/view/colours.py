# SPDX-License-Identifier: BSD-3-Clause
"""Colours of modes, speeds and texts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any
from zlib import crc32

import numpy as np
import numpy.typing as npt

Colour = tuple[int, int, int]

_MODES: dict[str, Colour] = {
    "STABILIZE": (127, 140, 141), "MANUAL": (127, 140, 141), "ALT_HOLD": (22, 160, 133), "LOITER": (41, 128, 185),
    "HOLD": (41, 128, 185), "GUIDED": (46, 134, 222), "AUTO": (142, 68, 173), "RTL": (230, 126, 34),
    "SMART_RTL": (211, 84, 0), "LAND": (192, 57, 43), "BRAKE": (44, 62, 80), "ACRO": (243, 156, 18),
}  # fmt: skip
_OTHERS: tuple[Colour, ...] = (
    (39, 174, 96), (26, 188, 156), (155, 89, 182), (52, 73, 94), (241, 196, 15), (231, 76, 60), (52, 152, 219),
    (149, 165, 166),
)  # fmt: skip
_SPEEDS: tuple[Colour, ...] = (
    (49, 54, 149), (69, 117, 180), (116, 173, 209), (254, 224, 144), (244, 109, 67), (165, 0, 38),
)  # fmt: skip
_TOP_SPEED = 15.0
"""From here on the last colour [m/s]."""
_VEHICLES: tuple[Colour, ...] = (
    (46, 134, 222), (230, 126, 34), (39, 174, 96), (142, 68, 173), (241, 196, 15), (22, 160, 133), (233, 30, 140),
    (121, 85, 72), (52, 73, 94), (139, 195, 74),
)  # fmt: skip
_SEVERITIES = ("#c0392b", "#c0392b", "#c0392b", "#d35400", "#d35400", "#2c3e50", "#2c3e50", "#7f8c8d")


def of_mode(name: str) -> Colour:
    """Of a mode by its name: always the same."""
    return _MODES.get(name) or _OTHERS[crc32(name.encode()) % len(_OTHERS)]


def of_vehicle(number: int) -> Colour:
    """Of one of several vehicles, counted from 0: in the scene and beside it. None is the red of what is in front."""
    return _VEHICLES[number % len(_VEHICLES)]


def of_speed(speed: float) -> Colour:
    """Of a speed [m/s], from blue to red."""
    at = min(max(speed, 0.0) / _TOP_SPEED, 1.0) * (len(_SPEEDS) - 1)
    k = min(int(at), len(_SPEEDS) - 2)
    a, b, share = _SPEEDS[k], _SPEEDS[k + 1], at - k
    return (
        round(a[0] + share * (b[0] - a[0])), round(a[1] + share * (b[1] - a[1])), round(a[2] + share * (b[2] - a[2])),
    )  # fmt: skip


def of_severity(severity: int) -> str:
    """Of a text with a MAV_SEVERITY, as CSS."""
    return _SEVERITIES[min(max(severity, 0), 7)]


def css(colour: Colour) -> str:
    """As CSS."""
    return "#{:02x}{:02x}{:02x}".format(*colour)


def of_ends(colours: Sequence[Colour]) -> npt.NDArray[Any]:
    """Colours of the ends of lines and of instances, shape (n, 3): a browser takes these for linear light, all others
    for sRGB."""
    return np.round(255.0 * (np.asarray(colours, float) / 255.0) ** 2.2).astype(np.uint8)
