# SPDX-License-Identifier: BSD-3-Clause
"""Pulses that come from the radio and go to motors and servos."""

from __future__ import annotations

from ...core.kernels import law
from ...core.records import Ints
from ...vehicle.record import Vehicle
from ..wire.message import Message, consecutive
from .units import boot_ms, uint16

CHANNELS, MORE_CHANNELS = 8, 16
"""chancount of a receiver, without and with pulses on more than eight channels."""
UNKNOWN = 255
"""rssi"""


class RcChannels(Message, name="RC_CHANNELS"):
    time_boot_ms: int
    pulses: Ints = consecutive(*(f"chan{k}_raw" for k in range(1, 19)))
    chancount: int
    rssi: int


@law
def rc_channels(m: RcChannels, v: Vehicle, receiver_timeout: float) -> bool:
    """RC_CHANNELS of a firmware for which the receiver is lost after a silence of ``receiver_timeout`` [s]."""
    pulses = v.autopilot.rc.channels
    m.time_boot_ms = boot_ms(v.time_us)
    for k in range(len(pulses)):
        m.pulses[k] = uint16(pulses[k])
    if v.time_us - v.autopilot.rc.receiver_us < receiver_timeout * 1e6:
        for k in range(len(pulses)):
            if pulses[k] != 0:
                m.chancount = CHANNELS if k < CHANNELS and m.chancount != MORE_CHANNELS else MORE_CHANNELS
    m.rssi = UNKNOWN
    return True


class ServoOutputRaw(Message, name="SERVO_OUTPUT_RAW"):
    time_usec: int
    pulses: Ints = consecutive(*(f"servo{k}_raw" for k in range(1, 9)))
    more_pulses: Ints = consecutive(*(f"servo{k}_raw" for k in range(9, 17)))


@law
def servo_output_raw(m: ServoOutputRaw, v: Vehicle) -> bool:
    """SERVO_OUTPUT_RAW: pulses to motors and servos [us]."""
    pulses = v.actuators.pwm
    m.time_usec = v.time_us & 0xFFFFFFFF
    for k in range(8):
        m.pulses[k] = uint16(pulses[k])
        m.more_pulses[k] = uint16(pulses[8 + k])
    return True


MESSAGES = (servo_output_raw,)
