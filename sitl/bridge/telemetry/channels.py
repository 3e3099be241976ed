# SPDX-License-Identifier: BSD-3-Clause
"""Pulses that come from the radio and go to motors and servos."""

from __future__ import annotations

from ...core.kernels import law
from ...vehicle.record import Vehicle
from ..wire.message import Message
from .units import boot_ms, uint16

CHANNELS, MORE_CHANNELS = 8, 16
"""chancount of a receiver, without and with pulses on more than eight channels."""
UNKNOWN = 255
"""rssi"""


class RcChannels(Message, name="RC_CHANNELS"):
    time_boot_ms: int
    chan1_raw: int
    chan2_raw: int
    chan3_raw: int
    chan4_raw: int
    chan5_raw: int
    chan6_raw: int
    chan7_raw: int
    chan8_raw: int
    chan9_raw: int
    chan10_raw: int
    chan11_raw: int
    chan12_raw: int
    chan13_raw: int
    chan14_raw: int
    chan15_raw: int
    chan16_raw: int
    chan17_raw: int
    chan18_raw: int
    chancount: int
    rssi: int


@law
def rc_channels(m: RcChannels, v: Vehicle, receiver_timeout: float) -> bool:
    """RC_CHANNELS of a firmware for which the receiver is lost after a silence of ``receiver_timeout`` [s]."""
    pulses = v.autopilot.rc.channels
    m.time_boot_ms = boot_ms(v.time_us)
    m.chan1_raw = uint16(pulses[0])
    m.chan2_raw = uint16(pulses[1])
    m.chan3_raw = uint16(pulses[2])
    m.chan4_raw = uint16(pulses[3])
    m.chan5_raw = uint16(pulses[4])
    m.chan6_raw = uint16(pulses[5])
    m.chan7_raw = uint16(pulses[6])
    m.chan8_raw = uint16(pulses[7])
    m.chan9_raw = uint16(pulses[8])
    m.chan10_raw = uint16(pulses[9])
    m.chan11_raw = uint16(pulses[10])
    m.chan12_raw = uint16(pulses[11])
    m.chan13_raw = uint16(pulses[12])
    m.chan14_raw = uint16(pulses[13])
    m.chan15_raw = uint16(pulses[14])
    m.chan16_raw = uint16(pulses[15])
    m.chan17_raw = uint16(pulses[16])
    m.chan18_raw = uint16(pulses[17])
    if v.time_us - v.autopilot.rc.receiver_us < receiver_timeout * 1e6:
        for k in range(len(pulses)):
            if pulses[k] != 0:
                m.chancount = CHANNELS if k < CHANNELS and m.chancount != MORE_CHANNELS else MORE_CHANNELS
    m.rssi = UNKNOWN
    return True


class ServoOutputRaw(Message, name="SERVO_OUTPUT_RAW"):
    time_usec: int
    servo1_raw: int
    servo2_raw: int
    servo3_raw: int
    servo4_raw: int
    servo5_raw: int
    servo6_raw: int
    servo7_raw: int
    servo8_raw: int
    servo9_raw: int
    servo10_raw: int
    servo11_raw: int
    servo12_raw: int
    servo13_raw: int
    servo14_raw: int
    servo15_raw: int
    servo16_raw: int


@law
def servo_output_raw(m: ServoOutputRaw, v: Vehicle) -> bool:
    """SERVO_OUTPUT_RAW: pulses to motors and servos [us]."""
    pulses = v.actuators.pwm
    m.time_usec = v.time_us & 0xFFFFFFFF
    m.servo1_raw = uint16(pulses[0])
    m.servo2_raw = uint16(pulses[1])
    m.servo3_raw = uint16(pulses[2])
    m.servo4_raw = uint16(pulses[3])
    m.servo5_raw = uint16(pulses[4])
    m.servo6_raw = uint16(pulses[5])
    m.servo7_raw = uint16(pulses[6])
    m.servo8_raw = uint16(pulses[7])
    m.servo9_raw = uint16(pulses[8])
    m.servo10_raw = uint16(pulses[9])
    m.servo11_raw = uint16(pulses[10])
    m.servo12_raw = uint16(pulses[11])
    m.servo13_raw = uint16(pulses[12])
    m.servo14_raw = uint16(pulses[13])
    m.servo15_raw = uint16(pulses[14])
    m.servo16_raw = uint16(pulses[15])
    return True


MESSAGES = (servo_output_raw,)
