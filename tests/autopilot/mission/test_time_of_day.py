# SPDX-License-Identifier: BSD-3-Clause
"""When a delay until a time of day ends."""

from __future__ import annotations

import pytest

from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.mission.time_of_day import seconds_until
from sitl.core.mavlink import MavCmd

NOON_US = (20454 * 86400 + 12 * 3600 + 30 * 60 + 15) * 1_000_000
"""12:30:15 of a day."""


@pytest.mark.parametrize(
    ("hour", "minute", "second", "wait"),
    [
        (12, 31, 32, 77.0),
        (12, 30, 15, 0.0),
        (12, 30, 14, 86399.0),
        (0, 0, 0, 11 * 3600 + 29 * 60 + 45.0),
        (-1, 31, 0, 45.0),
        (-1, 30, 0, 3585.0),
        (-1, -1, 20, 5.0),
        (-1, -1, 10, 55.0),
        (-1, -1, -1, 0.0),
    ],
)
def test_seconds_until(hour: int, minute: int, second: int, wait: float) -> None:
    item = MissionItem(MavCmd.NAV_DELAY, p2=hour, p3=minute, p4=second)
    assert seconds_until(item, NOON_US) == wait
    if hour != second:
        assert seconds_until(item, NOON_US - 250_000) == wait + 0.25
