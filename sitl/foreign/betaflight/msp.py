# SPDX-License-Identifier: BSD-3-Clause
"""MultiWii Serial Protocol, version 1, as Betaflight speaks it: requests, answers, and what its status says.

Source: https://betaflight.com/docs/development/API/MSP-Extensions, and what the program answers.
"""

from __future__ import annotations

import functools
import operator
import struct
from typing import NamedTuple

RC_TUNING, STATUS_EX, API_VERSION, FC_VERSION = 111, 150, 1, 3

ARMING = (
    "NOGYRO", "FAILSAFE", "RXLOSS", "NOT_DISARMED", "BOXFAILSAFE", "RUNAWAY", "CRASH", "THROTTLE", "ANGLE",
    "BOOTGRACE", "NOPREARM", "LOAD", "CALIB", "CLI", "CMS", "BST", "MSP", "PARALYZE", "GPS", "RESCUE_SW", "DSHOT_TELEM",
    "REBOOT_REQD", "DSHOT_BBANG", "NO_ACC_CAL", "MOTOR_PROTO", "FLIP_SWITCH", "ALT_HOLD_SW", "POS_HOLD_SW",
    "ARM_SWITCH",
)  # fmt: skip
"""Arming flags by their bits, named as its command line names them."""
_START, _ASK, _ANSWER, _ERROR = b"$M", b"<", b">", b"!"


def _checksum(body: bytes) -> int:
    return functools.reduce(operator.xor, body, 0)


def request(number: int, payload: bytes = b"") -> bytes:
    """A request."""
    body = bytes((len(payload), number)) + payload
    return _START + _ASK + body + bytes((_checksum(body),))


class Answers:
    """Cuts answers out of what comes from the serial port."""

    def __init__(self) -> None:
        self._rest = b""

    def feed(self, data: bytes) -> list[tuple[int, bytes]]:
        """(number, payload) of each answer that this completes; refusals and wrong checksums are left out."""
        buffer = self._rest + data
        found: list[tuple[int, bytes]] = []
        while True:
            at = buffer.find(_START)
            if at < 0:
                self._rest = buffer[-1:] if buffer.endswith(_START[:1]) else b""
                return found
            end = at + 6 + (buffer[at + 3] if len(buffer) > at + 3 else 0)
            if len(buffer) < at + 6 or len(buffer) < end:
                self._rest = buffer[at:]
                return found
            body = buffer[at + 3 : end - 1]
            if buffer[at + 2 : at + 3] in (_ANSWER, _ERROR) and _checksum(body) == buffer[end - 1]:
                if buffer[at + 2 : at + 3] == _ANSWER:
                    found.append((body[1], body[2:]))
                buffer = buffer[end:]
            else:
                buffer = buffer[at + 1 :]


class Status(NamedTuple):
    """MSP_STATUS_EX."""

    armed: bool
    load: int
    """Of the processor [%], which is none here."""
    arming: int
    """Bits of ``ARMING`` that prevent arming; 0: it can be armed."""

    @property
    def reasons(self) -> str:
        """The flags by name; "" : none."""
        return ", ".join(name for bit, name in enumerate(ARMING) if self.arming >> bit & 1)


def status(payload: bytes) -> Status | None:
    """The status in an answer to STATUS_EX; None when it is too short."""
    if len(payload) < 16 or len(payload) < 21 + payload[15]:
        return None
    flags, _, load = struct.unpack_from("<IBH", payload, 6)
    (arming,) = struct.unpack_from("<I", payload, 17 + payload[15])
    return Status(bool(flags & 1), load, arming)


class Rates(NamedTuple):
    """How far a stick turns: MSP_RC_TUNING."""

    kind: int
    """RATES_TYPE; 3 is ACTUAL."""
    centre: tuple[int, int, int]
    """Of ACTUAL: rate of a small deflection, roll, pitch, yaw [10 deg/s]."""
    greatest: tuple[int, int, int]
    """Rate of the whole deflection [10 deg/s]."""
    expo: tuple[int, int, int]
    """[%]"""


ACTUAL = 3
"""``Rates.kind`` whose curve is known here."""


def rates(payload: bytes) -> Rates | None:
    """The rates in an answer to RC_TUNING; None when it is too short."""
    if len(payload) < 23:
        return None
    b = payload
    return Rates(b[22], (b[0], b[12], b[11]), (b[2], b[3], b[4]), (b[1], b[13], b[10]))
