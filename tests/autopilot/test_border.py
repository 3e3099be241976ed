# SPDX-License-Identifier: BSD-3-Clause
"""The border records carry what MAVLink's HIL messages carry, at that precision (docs/architecture.md)."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.core.border import Actuators, Sensors

FLOATS = ("acc", "gyro", "mag", "abs_pressure", "temperature", "battery_voltage", "battery_current")
INTEGERS = ("gps_lat", "gps_lon", "gps_alt", "gps_eph", "gps_epv", "gps_vel", "gps_satellites")


@pytest.mark.parametrize("name", FLOATS)
def test_sensors_are_single_precision(name: str) -> None:
    assert Sensors.dtype[name].base == np.float32


@pytest.mark.parametrize("name", INTEGERS)
def test_a_fix_is_whole_numbers(name: str) -> None:
    assert Sensors.dtype[name].base == np.int32


def test_controls_are_single_precision() -> None:
    assert Actuators.dtype["controls"].base == np.float32
