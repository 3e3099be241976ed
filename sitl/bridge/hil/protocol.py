# SPDX-License-Identifier: BSD-3-Clause
"""What both ends agree on: addresses on the link, flags, which numbers cannot be right, and frames."""

from __future__ import annotations

from collections.abc import Iterable
from operator import lt

from ...core.mavlink import MavCmd
from ...errors import SitlError
from ..dialect import MessageType
from ..frame import encode_v2

BASE_PORT = 4560
"""Where physics listens; instance N at 4560 + N, as PX4 expects."""

AUTOPILOT = (1, 1)
"""System and component of our autopilot on this link."""
PHYSICS = (1, 158)
"""Of the physics: a peripheral of the same system (MAV_COMP_ID_PERIPHERAL)."""

LOCKSTEP = 1
"""Bit of ``HIL_ACTUATOR_CONTROLS.flags``: the sender waits for the next HIL_SENSOR."""

IMU_UPDATED, MAG_UPDATED, BARO_UPDATED = 0x3F, 0x1C0, 0x1A00
"""Bits of ``HIL_SENSOR.fields_updated`` (HIL_SENSOR_UPDATED_FLAGS)."""

RESEED = MavCmd.USER_2
"""As COMMAND_INT: x and y are the seed's low and high 32 bits."""

LATEST_US = 1 << 62
"""No clock goes this far [us]."""


class RefusedError(SitlError, ValueError):
    """A message with a number that cannot be right."""


def within(values: Iterable[float], limits: Iterable[float]) -> bool:
    """Whether each value is finite and its size below its limit."""
    return all(map(lt, map(abs, values), limits))


def culprit(name: str, fields: Iterable[str], values: Iterable[float], limits: Iterable[float]) -> RefusedError:
    """The error that names the first value that is not ``within``; there is one."""
    rows = zip(fields, values, limits)
    field, value, limit = next(row for row in rows if not abs(row[1]) < row[2])
    return RefusedError(f"{name}.{field} = {value}: less than {limit:g} in size is needed")


class Sender:
    """Makes the frames of one end, counted."""

    def __init__(self, system: int, component: int) -> None:
        self.system, self.component = system, component
        self.sequence = 255
        """Of the last frame."""

    def frame(self, kind: MessageType, payload: bytes) -> bytes:
        """A MAVLink 2 frame."""
        self.sequence = self.sequence + 1 & 255
        return encode_v2(kind, payload, self.sequence, self.system, self.component)
