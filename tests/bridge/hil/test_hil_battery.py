# SPDX-License-Identifier: BSD-3-Clause
"""Voltages of BATTERY_STATUS: ten cells, four more in the extension; what is spread over them comes together again."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.bridge.hil import sensor
from sitl.bridge.hil.protocol import RefusedError

UNKNOWN = 65535


def read(**fields: Any) -> tuple[int, int]:
    voltages = fields.pop("voltages", (12_000, *[UNKNOWN] * 9))
    return sensor.BatteryReader.read(sensor.BATTERY_KIND.payload(voltages=voltages, **fields))


@pytest.mark.parametrize(
    ("millivolts", "cells"),
    [(0, [0]), (12_600, [12_600]), (65_534, [65_534]), (65_535, [65_534, 1]), (131_068, [65_534, 65_534]), (-5, [0]),
     (655_340, [65_534] * 10), (700_000, [65_534] * 10)],
)  # fmt: skip
def test_a_voltage_is_spread_over_as_many_cells_as_it_needs(millivolts: int, cells: list[int]) -> None:
    assert sensor.spread(millivolts) == cells + [UNKNOWN] * (10 - len(cells))


@pytest.mark.parametrize(
    ("fields", "millivolts"),
    [
        ({}, 12_000), ({"voltages": (4000, 4100, 4200, *[UNKNOWN] * 7)}, 12_300),
        ({"voltages_ext": (100, 20, 3, 0)}, 12_123),
        ({"voltages_ext": (0, 0, 0, 7)}, 12_007), ({"voltages": (3000,) * 10, "voltages_ext": (1, 1, 1, 1)}, 30_004),
        ({"charge_state": 3, "mode": 9, "fault_bitmask": 77, "time_remaining": 55, "id": 5}, 12_000),
        ({"current_consumed": 5, "energy_consumed": 6, "temperature": 7, "battery_remaining": 8, "type": 9}, 12_000),
    ],
)  # fmt: skip
def test_cells_are_added_up_and_nothing_else(fields: Any, millivolts: int) -> None:
    assert read(**fields)[0] == millivolts


@pytest.mark.parametrize(("told", "current"), [(-1, 0), (0, 0), (1234, 1234), (-500, 0)])
def test_a_current_that_is_not_measured_is_zero(told: int, current: int) -> None:
    assert read(current_battery=told)[1] == current


def test_without_a_voltage_there_is_no_sample() -> None:
    with pytest.raises(RefusedError, match="BATTERY_STATUS has no voltage"):
        read(voltages=(UNKNOWN,) * 10, voltages_ext=(1, 2, 3, 4))


def wheels(*distance: float, count: int = 2, time_usec: int = 5) -> tuple[float, float]:
    kind = sensor.WHEELS_KIND
    return sensor.WheelReader.read(kind.payload(time_usec=time_usec, distance=distance, count=count))


def test_two_wheels_and_what_else_there_may_be() -> None:
    assert wheels(1.5, -2.5) == (1.5, -2.5) == wheels(1.5, -2.5, 9.0, count=3)


@pytest.mark.parametrize(
    ("distance", "more", "error"),
    [
        ((math.nan, 0.0), {}, r"distance\[0\]"), ((0.0, 2e9), {}, r"distance\[1\]"),
        ((0.0, math.inf), {}, r"distance\[1\]"),
        ((0.0, 0.0), {"count": 1}, "count 1"), ((0.0, 0.0), {"time_usec": 1 << 63}, "time_usec"),
    ],
)  # fmt: skip
def test_wheels_that_cannot_be_are_refused(distance: Any, more: Any, error: str) -> None:
    with pytest.raises(RefusedError, match=error):
        wheels(*distance, **more)
