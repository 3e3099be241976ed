# SPDX-License-Identifier: BSD-3-Clause
"""What a vehicle reports besides where it is: acceleration, battery, wind, range-finder, whether it has landed. Asked
for only where an observation (``sitl.envs.senses.REPORTS``) or a task needs it.

The laws read one message each, from a record in the core or from a decoded message of ``sitl.bridge.dialect``.
"""

from __future__ import annotations

import math
from typing import Any

from sitl.bridge.dialect import MessageType
from sitl.bridge.telemetry.own import ExtendedSysState, Wind
from sitl.bridge.telemetry.ranging import RangeFinder
from sitl.bridge.telemetry.sensors import MILLIG_PER_ACC, ScaledImu
from sitl.bridge.telemetry.status import SysStatus
from sitl.bridge.wire.message import Message
from sitl.core.array_kernels import Line, Table
from sitl.core.elementary import sincos
from sitl.core.kernels import law
from sitl.core.memory import record_at

ACCELERATION, BATTERY, WIND, RANGE, LANDED = 0, 3, 6, 8, 9
"""Columns of what is reported: specific force forward, left, up [m/s^2]; voltage [V], current [A], share that is left
[0, 1]; where the wind blows to, north and east here, forward and left in ``RobotArrays.reports`` [m/s]; range of the
range-finder that looks down [m]; MAV_LANDED_STATE."""
REPORTED = 10
"""Number of these."""


IMU_, STATUS_, WIND_, RANGE_ = ScaledImu.kind.id, SysStatus.kind.id, Wind.kind.id, RangeFinder.kind.id
LANDED_ = ExtendedSysState.kind.id
_UNKNOWN = 65535
"""Voltage of SYS_STATUS when nothing measures it [mV]."""


@law
def read_imu(values: Line, m: ScaledImu) -> None:
    """SCALED_IMU: mG along the body's axes (forward, right, down), at rest (0, 0, -1000)."""
    values[ACCELERATION] = m.acc.x / MILLIG_PER_ACC
    values[ACCELERATION + 1] = -m.acc.y / MILLIG_PER_ACC
    values[ACCELERATION + 2] = -m.acc.z / MILLIG_PER_ACC


@law
def read_battery(values: Line, m: SysStatus) -> None:
    """SYS_STATUS: mV, cA, per cent; what is not measured (65535, -1) becomes 0."""
    values[BATTERY] = 0.0 if m.voltage_battery == _UNKNOWN else 1e-3 * m.voltage_battery
    values[BATTERY + 1] = 0.01 * m.current_battery if m.current_battery >= 0 else 0.0
    values[BATTERY + 2] = 0.01 * m.battery_remaining if m.battery_remaining >= 0 else 0.0


@law
def read_wind(values: Line, m: Wind) -> None:
    """WIND: where it comes from [deg], its speed [m/s]."""
    angle = math.radians(m.direction)
    sine, cosine = sincos(angle)
    values[WIND] = -m.speed * cosine
    values[WIND + 1] = -m.speed * sine


@law
def read_range(values: Line, m: RangeFinder) -> None:
    """RANGEFINDER [m]."""
    values[RANGE] = m.distance


@law
def read_landed(values: Line, m: ExtendedSysState) -> None:
    """EXTENDED_SYS_STATE."""
    values[LANDED] = float(m.landed_state)


@law
def read_report(values: Line, number: int, payload: int) -> None:
    """The message ``number`` whose payload is at an address; others are left alone."""
    if number == IMU_:
        read_imu(values, record_at(ScaledImu, payload))
    elif number == STATUS_:
        read_battery(values, record_at(SysStatus, payload))
    elif number == WIND_:
        read_wind(values, record_at(Wind, payload))
    elif number == RANGE_:
        read_range(values, record_at(RangeFinder, payload))
    elif number == LANDED_:
        read_landed(values, record_at(ExtendedSysState, payload))


@law
def show_report(values: Line, heading: float, reports: Table, i: int) -> None:
    """Write what a vehicle of this heading [rad] has told into row ``i``, the wind along its heading."""
    for k in range(REPORTED):
        reports[i, k] = values[k]
    s, c = sincos(heading)
    reports[i, WIND] = values[WIND] * c + values[WIND + 1] * s
    reports[i, WIND + 1] = values[WIND] * s - values[WIND + 1] * c


_READERS: dict[int, tuple[type[Message], Any]] = {
    IMU_: (ScaledImu, read_imu), STATUS_: (SysStatus, read_battery), WIND_: (Wind, read_wind),
    RANGE_: (RangeFinder, read_range), LANDED_: (ExtendedSysState, read_landed),
}  # fmt: skip


def note_report(values: Any, kind: MessageType, payload: bytes) -> None:
    """Read a message of one of these kinds into ``values``, ``REPORTED`` floats."""
    record, read = _READERS[kind.id]
    read(values, record.of_payload(payload))
