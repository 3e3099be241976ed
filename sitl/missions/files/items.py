# SPDX-License-Identifier: BSD-3-Clause
"""Numbers of a file to mission items, checked."""

from __future__ import annotations

import math

from sitl.autopilot.mission import validate
from sitl.autopilot.mission.item import COMMANDS, MissionItem
from sitl.autopilot.mission.validate import HIGHEST, PLACE_FRAMES

from .mistakes import MissionFileError

FRAME_NAMES = {
    0: "global", 2: "mission", 3: "relative", 5: "global int", 6: "relative int", 10: "terrain", 11: "terrain int",
}  # fmt: skip

LARGEST = 3.4028234663852886e38
"""Parameters travel in single precision."""


def has_degrees(command: int) -> bool:
    """Whether parameters 5 and 6 are latitude and longitude."""
    return command not in COMMANDS or COMMANDS[command].has_place


def make(
    command: int, frame: int, values: tuple[float, ...], autocontinue: int, where: str, current: int = 0
) -> MissionItem:
    """An item of its seven parameters (places in degrees).

    Raises:
        MissionFileError: says ``where``, which value, and what is allowed.
    """
    p1, p2, p3, p4, x, y, z = values
    if not (math.isfinite(x) and math.isfinite(y)):
        raise MissionFileError(f"{where}: place {x}, {y} is not a pair of numbers")
    if command not in COMMANDS:
        known = ", ".join(f"{number} {c.name}" for number, c in COMMANDS.items())
        raise MissionFileError(f"{where}: command {command} is not known here; known are {known}")
    for k in (0, 1, 2, 3, 6):
        if math.isfinite(values[k]) and abs(values[k]) > LARGEST:
            raise MissionFileError(
                f"{where}: parameter {k + 1} is {values[k]}: it is within +-{LARGEST:.2g}, MAVLink's single precision"
            )
    scale = 1e7 if COMMANDS[command].has_place else 1.0
    item = MissionItem(command, frame, p1, p2, p3, p4, round(x * scale), round(y * scale), z, autocontinue, current)
    result = validate.check(item)
    if result != validate.ACCEPTED:
        raise MissionFileError(f"{where}: {_reason(result, command, frame, values)}")
    return item


def _reason(result: int, command: int, frame: int, values: tuple[float, ...]) -> str:
    """Reason for the refusal of an item, in words."""
    of = f" (command {command} {COMMANDS[command].name})"
    if result == validate.UNSUPPORTED_FRAME:
        known = ", ".join(f"{number} {FRAME_NAMES[number]}" for number in PLACE_FRAMES)
        return f"frame {frame} is not known for places; known are {known}{of}"
    k = result - validate.INVALID_PARAM1
    value = values[k] if 0 <= k < 7 else math.nan
    if not COMMANDS[command].has_place or k < 4:
        return f"parameter {k + 1} is {value}: a finite number is needed{of}"
    if result == validate.INVALID_PARAM5_X:
        return f"latitude {value} is not within -90 .. 90 degrees{of}"
    if result == validate.INVALID_PARAM6_Y:
        return f"longitude {value} is not within -180 .. 180 degrees{of}"
    return f"altitude {value} is not a number of metres within +-{HIGHEST:g}{of}"


def numbers(item: MissionItem) -> tuple[float, ...]:
    """The seven parameters of an item, places in degrees."""
    if has_degrees(item.command):
        return (item.p1, item.p2, item.p3, item.p4, round(item.x * 1e-7, 8), round(item.y * 1e-7, 8), item.z)
    return (item.p1, item.p2, item.p3, item.p4, item.x, item.y, item.z)
