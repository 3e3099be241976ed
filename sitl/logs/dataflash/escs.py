# SPDX-License-Identifier: BSD-3-Clause
"""ESC: what speed controllers report of each motor, as ESC_TELEMETRY does (SIM_ESC_TELEM)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ...autopilot.copter.control.state import MOTORS_MAX
from . import bits
from .formats import Field, Message
from .samples import Array

MOTORS = 1 << 17
"""LOG_BITMASK"""
_S, _MOTORS = "sensors.", "sensors.esc_motors"


def _part(path: str) -> Callable[[Any], Array]:
    """An even part of what the battery gives."""
    return lambda s: s(path) / s(_MOTORS).clip(1.0)


def _is_there(k: int) -> Callable[[Any], Array]:
    return lambda s: s.raw(_MOTORS) > k


MESSAGES = tuple(
    Message("ESC", bits.MEDIUM, MOTORS, when=_is_there(k)).of(
        Field("Instance", "B", "#", "-", k),
        Field("RPM", "f", "q", "0", f"{_S}esc_rpm[{k}]"),
        Field("RawRPM", "f", "q", "0", f"{_S}esc_rpm[{k}]"),
        Field("Volt", "f", "v", "-", _S + "battery_voltage"),
        Field("Curr", "f", "A", "-", _part(_S + "battery_current")),
        Field("Temp", "c", "O", "B", _S + "temperature"),
        Field("CTot", "f", "a", "C", _part("autopilot.battery.consumed_mah")),
        Field("MotTemp", "c", "O", "B", _S + "temperature"),
        Field("Err", "f", "%", "-"),
    )
    for k in range(MOTORS_MAX)
)
