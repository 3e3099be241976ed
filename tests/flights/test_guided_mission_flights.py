# SPDX-License-Identifier: BSD-3-Clause
"""Set-points within missions: GUIDED_ENABLE and DO_GUIDED_LIMITS, flown as a real ArduPilot flies them."""

from __future__ import annotations

import pytest

from sitl.core.mavlink import MavCmd
from sitl.simulation import Core
from tests.flights import aviator
from tests.flights.aviator import AUTO, LOITER, POSITION, Aviator, Item
from tests.pilots.witness import MIDDLE

UP = Item(MavCmd.NAV_TAKEOFF, None, 10.0)
ENABLE, ON = Item(MavCmd.NAV_GUIDED_ENABLE, None, 0.0, (1.0,)), Item(MavCmd.NAV_WAYPOINT, (20.0, 0.0), 10.0)


def guided(core: Core, *limits: float) -> Aviator:
    """In AUTO, 10 m up, where a mission has just given the vehicle to set-points."""
    p = Aviator(core, "ardupilot_quad").ready()
    p.start_mission(UP, Item(MavCmd.DO_GUIDED_LIMITS, None, 0.0, limits), ENABLE, ON)
    assert p.fly(60.0, lambda: p.said("Mission: 3 GuidedEnable"))
    return p


def until_the_limit(p: Aviator, place: tuple[float, float, float]) -> float:
    """Seconds until the mission goes on, with a set-point twice a second."""
    start = p.now
    while not p.said("Mission: 4 WP"):
        p.target(POSITION, x=place[0], y=place[1], z=place[2])
        p.fly(0.5, lambda: p.said("Mission: 4 WP"))
        assert p.now < start + 30.0
    assert p.mode == AUTO
    return p.now - start


def test_a_limit_of_time(core: Core) -> None:
    p = guided(core, 5.9)  # whole seconds
    assert until_the_limit(p, (40.0, 0.0, -10.0)) == pytest.approx(5.0, abs=0.1)
    assert p.vel[0] > 6.0  # the real one: 7.2
    assert p.fly(30.0, lambda: p.said("Reached command #4"))


@pytest.mark.parametrize(
    ("limits", "to", "axis", "at", "seconds"),
    [
        ((0.0, 0.0, 0.0, 10.0), (40.0, 0.0, -10.0), 0, 10.0, 3.2),
        ((0.0, 0.0, 15.0, 0.0), (0.0, 0.0, -30.0), 2, -15.0, 3.4),
        ((0.0, 5.0, 0.0, 0.0), (0.0, 0.0, -2.0), 2, -5.0, 4.2),
    ],
)
def test_limits_of_place(
    core: Core, limits: tuple[float, ...], to: tuple[float, float, float], axis: int, at: float, seconds: float
) -> None:
    """``seconds``: those of a real ArduPilot from the first set-point on, half a second for its link taken off."""
    p = guided(core, *limits)
    assert until_the_limit(p, to) == pytest.approx(seconds, abs=0.5)
    assert aviator.estimate(p)[axis] == pytest.approx(at, abs=0.3)


def test_without_limits_it_waits_and_begins_again_after_another_mode(core: Core) -> None:
    p = guided(core, 0.0, 0.0, 0.0, 0.0)
    for _ in range(30):
        p.target(POSITION, x=15.0, y=0.0, z=-10.0)
        p.fly(0.5)
    assert aviator.estimate(p) == pytest.approx([15.0, 0.0, -10.0], abs=0.5)
    p.hold(throttle=MIDDLE)
    assert p.set_mode(LOITER) and p.set_mode(AUTO)
    p.fly(1.0)
    assert [text for _, _, text in p.texts][-1] == "Mission: 3 GuidedEnable"
    p.target(POSITION, x=15.0, y=10.0, z=-10.0)
    p.fly(8.0)
    assert aviator.estimate(p)[1] == pytest.approx(10.0, abs=0.5)


def test_the_command_of_zero_is_passed_over(core: Core) -> None:
    p = Aviator(core, "ardupilot_quad").ready()
    p.start_mission(UP, Item(MavCmd.NAV_GUIDED_ENABLE), ON)
    assert p.fly(60.0, lambda: p.said("Reached command #3"))


def test_set_points_are_not_taken_on_the_way_to_a_waypoint(core: Core) -> None:
    p = Aviator(core, "ardupilot_quad").ready()
    p.start_mission(UP, ON, ENABLE)
    assert p.fly(60.0, lambda: p.said("Mission: 2 WP"))
    p.target(POSITION, x=0.0, y=30.0, z=-10.0)
    assert p.fly(30.0, lambda: p.said("Reached command #2"))
    assert aviator.estimate(p)[:2] == pytest.approx([20.0, 0.0], abs=1.0)
