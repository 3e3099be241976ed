# SPDX-License-Identifier: BSD-3-Clause
"""What a log has of the board: its main loop, further channels, and the commands that clients sent."""

from __future__ import annotations

import math
from typing import Any

from . import bits
from .formats import Field, Message

PM_RATE = 0.1
"""[Hz]"""
_LOST = 2.0**31 - 1.0
"""Greatest number of MAVC's X and Y."""
MEMORY = 524288
"""Free memory that ArduPilot's simulator tells [bytes]."""

COMMANDS = Message("MAVC").of(
    *(Field(label, "B") for label in ("TS", "TC", "SS", "SC", "Fr")),
    Field("Cmd", "H"),
    *(Field(f"P{k}", "f") for k in range(1, 5)),
    Field("X", "i"),
    Field("Y", "i"),
    Field("Z", "f"),
    Field("Res", "B"),
    Field("WL", "B"),
)
"""MAVC: a COMMAND_INT or COMMAND_LONG (WL) from SS, SC to TS, TC, and its MAV_RESULT."""


def command(fields: Any, frame: int, is_location: bool, sender: tuple[int, int], result: int) -> tuple[Any, ...]:
    """Numbers of MAVC.

    Args:
        fields: of COMMAND_LONG or COMMAND_INT.
        frame, is_location: of a COMMAND_LONG, which has none: its MAV_FRAME, and whether p5 and p6 are in degrees.
        sender: its system and component.
        result: MAV_RESULT.
    """
    is_long = not hasattr(fields, "x")
    if is_long:
        scale, z = (1e7 if is_location else 1.0), fields.param7
        x, y = (_whole(p * scale) for p in (fields.param5, fields.param6))
    else:
        frame, x, y, z = fields.frame, fields.x, fields.y, fields.z
    head = (fields.target_system, fields.target_component, *sender, frame & 255, fields.command & 0xFFFF)
    return (*head, fields.param1, fields.param2, fields.param3, fields.param4, x, y, z, result, int(is_long))


def _whole(x: float) -> int:
    return int(min(max(x, -_LOST), _LOST)) if math.isfinite(x) else 0


def loop(loop_rate_hz: int, boot_unix_us: int) -> Message:
    """PM: each ten seconds, the loops of the firmware: none is late, none waits for another program."""
    return Message("PM", PM_RATE, bits.PERFORMANCE).of(
        Field("LR", "H", "z", "-", loop_rate_hz),
        Field("NLon", "H"),
        Field("NL", "H", source=loop_rate_hz / PM_RATE),
        Field("MaxT", "I", source=1e6 / loop_rate_hz),
        Field("Mem", "I", "b", "0", MEMORY),
        Field("Load", "H", "%", "A"),
        *(Field(label, "H" if label == "ErrL" else "I") for label in ("ErrL", "InE", "ErC", "SPIC", "I2CC")),
        Field("I2CI", "I"),
        Field("Ex", "I", "s", "F"),
        Field("R", "Q", "s", "F", lambda s: s.raw("time_us") + boot_unix_us),
    )


def more_pulses_in(bit: int) -> Message:
    """RCI2: channels 15 and 16 [us]."""
    channels = (Field(f"C{k + 1}", "H", "Y", "-", f"autopilot.rc.channels[{k}]") for k in (14, 15))
    return Message("RCI2", bits.MEDIUM, bit).of(*channels, Field("OMask", "H"), Field("Flags", "B", source=1))


def more_pulses_out(bit: int) -> Message:
    """RCO2: outputs 15 and 16 [us]; there are no more."""
    pulses = (Field(f"C{k + 1}", "H", "Y", "-", f"actuators.pwm[{k}]" if k < 16 else 0) for k in range(14, 18))
    return Message("RCO2", bits.MEDIUM, bit).of(*pulses)
