# SPDX-License-Identifier: BSD-3-Clause
"""LOITER_TURNS as ArduPilot's storage keeps it: what ArduCopter and ArduRover 4.7 give back."""

from __future__ import annotations

import pytest

from sitl.autopilot.mission.commands import stored
from sitl.autopilot.mission.item import NAV_LOITER_TURNS, NAV_WAYPOINT, MissionItem


@pytest.mark.parametrize(
    ("turns", "kept"), [(2.25, 2.0), (0.1, 0.09765625), (300, 255), (1.004, 1), (0.75, 0.75), (0.003, 0), (255.5, 255)]
)
def test_turns(turns: float, kept: float) -> None:
    assert stored(MissionItem(NAV_LOITER_TURNS, 3, p1=turns, p3=7.0)).p1 == kept


@pytest.mark.parametrize(
    ("radius", "kept"),
    [(7.5, 7), (-7.5, -7), (303, 300), (3000, 2550), (0.4, 0), (255.6, 250), (-300, -300), (256, 250)],
)
def test_radius(radius: float, kept: float) -> None:
    assert stored(MissionItem(NAV_LOITER_TURNS, 3, p1=1.0, p3=radius)).p3 == kept


def test_others_are_kept_as_they_are() -> None:
    item = MissionItem(NAV_WAYPOINT, 3, p1=2.25, p3=7.5)
    assert stored(item) is item
