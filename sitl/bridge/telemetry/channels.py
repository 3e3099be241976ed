# SPDX-License-Identifier: BSD-3-Clause
"""Pulses in and out: RC_CHANNELS, SERVO_OUTPUT_RAW."""

from __future__ import annotations

import struct

from ..dialect import message
from .builder import Build, Builder, Context
from .units import uint16

CHANNELS = 16
"""chancount of a receiver, as ArduPilot tells it."""


def rc_channels(context: Context) -> Build:
    """RC_CHANNELS: pulses in use [us], 0 where there is none; no channels are counted without receiver or override."""
    read = context.fields("time_us", "autopilot.rc.channels")
    read_heard = context.fields("autopilot.rc.receiver_us")
    timeout = context.profile.receiver_timeout
    read_timeout = context.fields(f"autopilot.params.{timeout}") if isinstance(timeout, str) else lambda: (timeout,)
    pack = message("RC_CHANNELS").pack

    def build() -> bytes:
        t, *pulses = read()
        count = CHANNELS if any(pulses) and t - read_heard()[0] < read_timeout()[0] * 1e6 else 0
        try:
            return pack(t // 1000 & 0xFFFFFFFF, *pulses, count, 255)
        except struct.error:  # not a pulse: rare, so that the usual case need not look at each
            return pack(t // 1000 & 0xFFFFFFFF, *map(uint16, pulses), count, 255)

    return build


def servo_output_raw(context: Context) -> Build:
    """SERVO_OUTPUT_RAW: pulses to motors and servos [us]."""
    read = context.fields("time_us", "actuators.pwm")
    pack = message("SERVO_OUTPUT_RAW").pack

    def build() -> bytes:
        t, *pulses = read()
        try:
            return pack(t & 0xFFFFFFFF, *pulses[:8], 0, *pulses[8:])
        except struct.error:
            pulses = [uint16(p) for p in pulses]
            return pack(t & 0xFFFFFFFF, *pulses[:8], 0, *pulses[8:])

    return build


BUILDERS: dict[str, Builder] = {"RC_CHANNELS": rc_channels, "SERVO_OUTPUT_RAW": servo_output_raw}
