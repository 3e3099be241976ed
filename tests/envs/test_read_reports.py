# SPDX-License-Identifier: BSD-3-Clause
"""Messages in the core fill the columns of what a vehicle reports, each its own, in MAVLink's units."""

from __future__ import annotations

import ctypes
import math
from typing import Any

import numpy as np
import pytest

from sitl.bridge.dialect import message
from sitl.envs.mavlink.reports import ACCELERATION, BATTERY, LANDED, RANGE, REPORTED, WIND, read_report

UNTOUCHED = -7.0
CASES = [
    ("SCALED_IMU", {"xacc": 100, "yacc": -200, "zacc": -1000}, ACCELERATION, (0.980665, 1.96133, 9.80665)),
    ("SYS_STATUS", {"voltage_battery": 11850, "current_battery": 1234, "battery_remaining": 87}, BATTERY,
     (11.85, 12.34, 0.87)),
    ("SYS_STATUS", {"voltage_battery": 65535, "current_battery": -1, "battery_remaining": -1}, BATTERY,
     (0.0, 0.0, 0.0)),
    ("SYS_STATUS", {"voltage_battery": 0, "current_battery": 0, "battery_remaining": 0}, BATTERY, (0.0, 0.0, 0.0)),
    ("WIND", {"direction": 0.0, "speed": 5.0}, WIND, (-5.0, 0.0)),  # from the north: it blows to the south
    ("WIND", {"direction": 90.0, "speed": 5.0}, WIND, (0.0, -5.0)),
    ("WIND", {"direction": -135.0, "speed": 2.0}, WIND, (math.sqrt(2.0), math.sqrt(2.0))),
    ("RANGEFINDER", {"distance": 3.25, "voltage": 9.0}, RANGE, (3.25,)),
    ("EXTENDED_SYS_STATE", {"vtol_state": 4, "landed_state": 2}, LANDED, (2.0,)),
]  # fmt: skip


@pytest.mark.parametrize(("name", "fields", "first", "values"), CASES)
def test_a_message_fills_its_own_columns(name: str, fields: Any, first: int, values: tuple[float, ...]) -> None:
    row = np.full(REPORTED, UNTOUCHED)
    payload = message(name).payload(**fields)
    memory = ctypes.create_string_buffer(payload + bytes(300 - len(payload)))
    read_report(row, message(name).id, ctypes.addressof(memory))
    last = first + len(values)
    assert row[first:last] == pytest.approx(values, abs=1e-5)
    assert (np.delete(row, range(first, last)) == UNTOUCHED).all(), "the rest stays"


@pytest.mark.parametrize("name", ["HEARTBEAT", "ATTITUDE", "RAW_IMU", "WIND_COV"])
def test_other_messages_are_left_alone(name: str) -> None:
    row = np.full(REPORTED, UNTOUCHED)
    memory = ctypes.create_string_buffer(bytes(300))
    read_report(row, message(name).id, ctypes.addressof(memory))
    assert (row == UNTOUCHED).all()
