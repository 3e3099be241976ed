# SPDX-License-Identifier: BSD-3-Clause
"""Fences and rally points on the ground: what a breach does, and where RTL goes.

As a real ArduPilot's executable did for the same commands (docs/fences.md). Avoidance is off.
"""

from __future__ import annotations

import numpy as np
import pytest

from sitl.autopilot.mission.item import MissionItem
from sitl.core.mavlink import MavCmd, MavFrame
from sitl.simulation import Core
from tests.drives.rover_driver import GUIDED, HOLD, LOITER, POSITION, RTL, SMART_RTL, Driver, Item

CIRCLE, AREAS = 2, 4


def drive_north(p: Driver) -> float:
    """Drive north in GUIDED until the mode changes or it is disarmed; how far it was then [m]."""
    p.target(POSITION, x=80.0)
    p.fly(40.0, lambda: p.mode != GUIDED or not p.ap.arming.armed)
    return float(p.place[0])


@pytest.mark.parametrize(
    ("action", "mode", "armed"),
    [
        (0, GUIDED, True),
        (1, RTL, True),
        (2, HOLD, True),
        (3, SMART_RTL, True),
        (4, SMART_RTL, True),
        (5, GUIDED, False),
        (6, LOITER, True),
        (99, GUIDED, True),
    ],
)
def test_what_follows_a_breach_of_the_circle(core: Core, action: int, mode: int, armed: bool) -> None:
    p = Driver(
        core, "ardupilot_rover", AVOID_ENABLE=0, FENCE_ENABLE=1, FENCE_RADIUS=20.0, FENCE_ACTION=action
    ).armed_in(GUIDED)
    there = drive_north(p)
    assert (p.mode, p.ap.arming.armed) == (mode, armed)
    assert (there > 50.0) if action in (0, 99) else (there == pytest.approx(20.3, abs=0.7))
    assert p.said("Manual recovery started") == (action in (1, 2, 3, 4, 6))
    assert not p.said("Circle fence breached")  # rovers are silent about it


def test_it_comes_home_from_a_polygon(core: Core) -> None:
    p = Driver(core, "ardupilot_rover", AVOID_ENABLE=0, FENCE_ENABLE=1).ready()
    corners = [p.location_of(*corner) for corner in ((-20.0, -20.0), (-20.0, 20.0), (25.0, 20.0), (25.0, -20.0))]
    p.upload_fence(
        [MissionItem(MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION, MavFrame.GLOBAL, 4, x=x, y=y) for x, y in corners]
    )
    p.arm(0.2)
    assert drive_north(p) == pytest.approx(25.3, abs=0.7)
    assert p.mode == RTL and p.fly(40.0, lambda: np.hypot(*p.place) < 3.0)
    assert p.ap.fence.breached == 0


def test_a_hundred_metres_beyond_it_holds(core: Core) -> None:
    p = Driver(core, "ardupilot_rover", AVOID_ENABLE=0, FENCE_RADIUS=20.0).armed_in(GUIDED)
    p.target(POSITION, x=130.0)
    assert p.fly(90.0, lambda: p.place[0] > 125.0)
    p.set_parameter("FENCE_ENABLE", 1)
    assert p.fly(1.0, lambda: p.mode == HOLD)


def test_a_mission_switches_fences(core: Core) -> None:
    p = Driver(core, "ardupilot_rover", AVOID_ENABLE=0).armed_in(GUIDED)
    first, last = (Item(MavCmd.NAV_WAYPOINT, (north, 0.0)) for north in (10.0, 20.0))
    p.start_mission(Item(MavCmd.DO_FENCE_ENABLE, p=(1.0,)), first, Item(MavCmd.DO_FENCE_ENABLE), last)
    assert p.said("Circle and Polygon fences enabled") and p.ap.fence.on == CIRCLE | AREAS
    p.finish_mission(30.0)
    assert p.said("Circle and Polygon fences disabled") and p.ap.fence.on == 0


def test_rtl_goes_to_the_rally_point(core: Core) -> None:
    p = Driver(core, "ardupilot_rover", AVOID_ENABLE=0, RALLY_INCL_HOME=0).ready()
    x, y = p.location_of(10.0, 20.0)
    p.upload_rally_points([MissionItem(MavCmd.NAV_RALLY_POINT, MavFrame.GLOBAL_RELATIVE_ALT, x=x, y=y)])
    p.arm(0.2)
    assert p.set_mode(RTL)
    assert p.fly(40.0, lambda: p.said("Reached destination"))
    assert p.away(10.0, 20.0) < 3.0
