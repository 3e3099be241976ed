# SPDX-License-Identifier: BSD-3-Clause
"""Lines of JSON as another simulator may write them, and ArduPilot's way to read one."""

from __future__ import annotations

from collections.abc import Sequence

_LINE = (
    '\n{"timestamp":%r,"imu":{"gyro":[%r,%r,%r],"accel_body":[%r,%r,%r]},"position":[%r,%r,%r],'
    '"quaternion":[%r,%r,%r,%r],"velocity":[%r,%r,%r]'
)


def encode(motion: Sequence[float], extras: str = "") -> bytes:
    """A line, with all the digits that its numbers have.

    Args:
        motion: timestamp, gyro, accel, position, attitude (w x y z), velocity: 17 numbers.
        extras: more members, each with its comma before it (``extra``).
    """
    return (_LINE % tuple(motion) + extras + "}\n").encode()


def extra(
    reading: float | None = None,
    battery: tuple[float, float] | None = None,
    wind: tuple[float, float] | None = None,
) -> str:
    """Members that a line may have beside the motion.

    Args:
        reading: of a range-finder [m].
        battery: voltage [V], current [A].
        wind: that a vane on the vehicle meets: where it comes from, clockwise from the nose [rad], and speed [m/s].
    """
    text = ""
    if reading is not None:
        text += f',"rng_1":{reading!r}'
    if wind is not None:
        text += f',"windvane":{{"direction":{wind[0]!r},"speed":{wind[1]!r}}}'
    if battery is not None:
        text += f',"battery":{{"voltage":{battery[0]!r},"current":{battery[1]!r}}}'
    return text


def found_by_text(line: str, section: str, key: str) -> str:
    """What follows a key where ArduPilot looks: the first text of that name behind the section's, and two bytes on."""
    at = line.index(section) + len(section) + 1
    at = line.index(key, at) + len(key) + 2
    return line[at:]
