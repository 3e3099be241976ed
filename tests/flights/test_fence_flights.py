# SPDX-License-Identifier: BSD-3-Clause
"""Fences and rally points in the air: what a breach does, when fences switch themselves, where RTL goes.

Times and texts as a real ArduPilot's executable gave them for the same commands (docs/fences.md). Avoidance, which
stops before a fence, is off.
"""

from __future__ import annotations

import numpy as np
import pytest

from sitl.autopilot.mission.item import MissionItem
from sitl.core.mavlink import MavCmd, MavFrame
from sitl.simulation import Core
from tests.flights.aviator import BRAKE, GUIDED, LAND, LOITER, POSITION, RTL, SMART_RTL, STABILIZE, Aviator

HIGHEST, CIRCLE, AREAS, LOWEST = 1, 2, 4, 8
NORTHWARDS = 1000
"""Pitch stick of a fast flight to the north, where the copter points [us]."""
ENABLE_FENCE = 207
GEOFENCE = 0x100000
"""SYS_STATUS"""


def area(p: Aviator, command: int, *corners: tuple[float, float], p1: float | None = None) -> list[MissionItem]:
    """Items of an area, places in metres from home."""
    places = [p.location_of(*corner) for corner in corners]
    return [MissionItem(command, MavFrame.GLOBAL, p1 or len(corners), x=x, y=y) for x, y in places]


def square(p: Aviator, command: int, north: float, east: float, half: float) -> list[MissionItem]:
    """A square around a place."""
    turns = ((-half, -half), (-half, half), (half, half), (half, -half))
    return area(p, command, *((north + n, east + e) for n, e in turns))


def fly_north(p: Aviator) -> float:
    """Fly north in LOITER until the mode changes, or for half a minute; how far it was then [m]."""
    assert p.set_mode(LOITER)
    p.hold(pitch=NORTHWARDS)
    p.fly(30.0, lambda: p.mode != LOITER)
    p.hold()
    return float(p.pos[0])


@pytest.mark.parametrize(
    ("action", "mode"), [(0, LOITER), (1, RTL), (2, LAND), (3, SMART_RTL), (4, BRAKE), (5, SMART_RTL), (99, RTL)]
)
def test_what_follows_a_breach_of_the_circle(core: Core, action: int, mode: int) -> None:
    p = Aviator(core, AVOID_ENABLE=0, FENCE_ENABLE=1, FENCE_TYPE=CIRCLE, FENCE_RADIUS=30.0, FENCE_ACTION=action).hover()
    there = fly_north(p)
    assert p.mode == mode and p.said("Circle fence breached")
    if action == 0:
        assert there > 100.0 and not p.said("Manual recovery started")
    else:
        assert there == pytest.approx(30.5, abs=1.0)  # breached at 30 m, noticed within 0.04 s
        assert p.said("Manual recovery started")


def test_the_way_back_clears_the_breach_and_lands(core: Core) -> None:
    p = Aviator(core, AVOID_ENABLE=0, FENCE_ENABLE=1, FENCE_TYPE=CIRCLE, FENCE_RADIUS=30.0).hover()
    fly_north(p)
    status, health = p.message("FENCE_STATUS"), p.message("SYS_STATUS").onboard_control_sensors_health
    assert (status.breach_status, status.breach_type, health & GEOFENCE) == (1, 3, 0)
    assert p.fly(20.0, lambda: p.said("Fence breach cleared"))
    assert np.hypot(*p.pos[:2]) == pytest.approx(30.0, abs=2.0)
    assert p.fly(90.0, lambda: not p.armed) and np.hypot(*p.pos[:2]) < 1.5
    status, health = p.message("FENCE_STATUS"), p.message("SYS_STATUS").onboard_control_sensors_health
    assert (status.breach_status, status.breach_type, health & GEOFENCE) == (0, 0, GEOFENCE)


def test_too_high_and_no_further_breach_until_twenty_metres_more(core: Core) -> None:
    """A pilot who goes back to LOITER has ten seconds; what is breached then counts anew 20 m further."""
    p = Aviator(core, AVOID_ENABLE=0, FENCE_ENABLE=1, FENCE_TYPE=HIGHEST, FENCE_ALT_MAX=30.0).hover(20.0)
    assert p.set_mode(LOITER)
    p.hold(throttle=1800)
    assert p.fly(30.0, lambda: p.mode == RTL) and p.said("Max Alt fence breached")
    assert p.height == pytest.approx(30.0, abs=1.0)
    assert p.set_mode(LOITER)
    assert p.fly(30.0, lambda: p.mode == RTL)
    assert p.height > 45.0
    p.hold()


def test_a_hundred_metres_beyond_it_lands_there(core: Core) -> None:
    p = Aviator(core, AVOID_ENABLE=0, FENCE_ENABLE=0, FENCE_TYPE=CIRCLE, FENCE_RADIUS=30.0).hover()
    p.target(POSITION, x=150.0, z=-10.0)
    assert p.fly(60.0, lambda: p.pos[0] > 148.0)
    p.set_parameter("FENCE_ENABLE", 1)
    assert p.fly(1.0, lambda: p.mode == LAND)


@pytest.mark.parametrize("by_area", [True, False])
def test_areas_to_stay_in_and_out_of(core: Core, by_area: bool) -> None:
    """A square around home; a circle to stay out of to the north is nearer, when it is there."""
    p = Aviator(core, AVOID_ENABLE=0, FENCE_TYPE=AREAS).ready()
    items = square(p, MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION, 0.0, 0.0, 40.0)
    if not by_area:
        items += area(p, MavCmd.NAV_FENCE_CIRCLE_EXCLUSION, (35.0, 0.0), p1=10.0)
    p.upload_fence(items)
    p.set_parameter("FENCE_ENABLE", 1)
    p.arm()
    p.take_off(10.0)
    assert fly_north(p) == pytest.approx(40.5 if by_area else 25.5, abs=1.0)
    assert p.mode == RTL and p.said("Polygon fence breached")


def test_the_floor_goes_on_above_it_and_off_for_the_landing(core: Core) -> None:
    p = Aviator(core, AVOID_ENABLE=0, FENCE_ENABLE=1, FENCE_TYPE=15, FENCE_ALT_MIN=20.0, FENCE_ALT_MAX=60.0).ready()
    p.arm()
    assert not p.said("Min Alt fence enabled (auto enable)")
    p.take_off(25.0)
    assert p.said("Min Alt fence enabled (auto enable)")
    assert p.set_mode(LOITER)
    p.hold(throttle=1200)
    assert p.fly(20.0, lambda: p.mode == RTL) and p.said("Min Alt fence breached")
    assert p.height == pytest.approx(20.0, abs=0.7)
    p.hold()
    assert p.fly(90.0, lambda: not p.armed)
    assert p.said("Min Alt fence auto-disabled") and p.said("Fence breach cleared")


def test_fences_go_on_after_a_take_off_and_off_on_the_ground(core: Core) -> None:
    limits = {"FENCE_TYPE": 11.0, "FENCE_ALT_MIN": 5.0, "FENCE_ALT_MAX": 40.0}
    p = Aviator(core, AVOID_ENABLE=0, FENCE_AUTOENABLE=1, **limits).ready()
    p.arm()
    assert p.ap.fence.on == 0
    p.take_off(10.0)
    assert p.said("Max Alt, Circle and Min Alt fences auto-enabled") and p.ap.fence.on == 11
    assert p.set_mode(LAND)
    assert p.fly(60.0, lambda: not p.armed)
    assert p.said("Max Alt, Circle and Min Alt fences auto-disabled") and p.ap.fence.on == 0


def test_fences_go_on_with_arming_and_off_with_disarming(core: Core) -> None:
    p = Aviator(core, AVOID_ENABLE=0, FENCE_AUTOENABLE=3, FENCE_TYPE=3.0).ready()
    assert p.ap.fence.on == 0
    p.arm()
    assert p.ap.fence.on == 3 and p.said("Max Alt and Circle fences auto-enabled")
    assert p.fly(15.0, lambda: not p.armed)
    assert p.ap.fence.on == 0 and p.said("Max Alt and Circle fences auto-disabled")


def test_commands_and_a_switch_put_fences_on_and_off(core: Core) -> None:
    p = Aviator(core, AVOID_ENABLE=0, FENCE_TYPE=15).ready()
    assert [p.ask(ENABLE_FENCE, on, which) for on, which in ((1, 0), (0, 8), (0, 3))] == [0, 0, 0]
    assert p.ap.fence.on == AREAS
    assert p.ask(ENABLE_FENCE, 0, 0) == 0 and p.ap.fence.on == 0
    assert [p.ask(ENABLE_FENCE, on, which) for on, which in ((-1, 0), (1, 16))] == [4, 4]
    assert p.ask(218, 11, 2) == 0 and p.ap.fence.on == 15
    assert p.ask(218, 11, 0) == 0 and p.ap.fence.on == 0


@pytest.mark.parametrize(
    ("params", "text"),
    [
        ({"FENCE_TYPE": 0}, "Fences enabled, but none selected"),
        ({"FENCE_RADIUS": -1}, "Invalid Circle FENCE_RADIUS value"),
        ({"FENCE_ALT_MAX": -1}, "Invalid FENCE_ALT_MAX value"),
        ({"FENCE_ALT_MIN": -200}, "Invalid FENCE_ALT_MIN value"),
        ({"FENCE_TYPE": 9, "FENCE_ALT_MIN": 120}, "FENCE_ALT_MAX < FENCE_ALT_MIN"),
        ({"FENCE_TYPE": 9, "FENCE_ALT_MIN": 98}, "FENCE_MARGIN too big"),
        ({"FENCE_MARGIN": -1}, "Invalid FENCE_MARGIN value"),
    ],
)
def test_parameters_that_keep_it_on_the_ground(core: Core, params: dict[str, float], text: str) -> None:
    p = Aviator(core, AVOID_ENABLE=0, FENCE_TYPE=15).ready()
    p.set_parameter("FENCE_ENABLE", 1)
    for name, value in params.items():
        p.set_parameter(name, value)
    p.fly(0.2)
    assert p.ask(400, 1) == 4
    p.fly(0.2)
    assert p.said(f"Arm: {text}"), p.texts[-3:]


def test_who_stands_in_a_breach_is_not_armed(core: Core) -> None:
    p = Aviator(core, AVOID_ENABLE=0, FENCE_ENABLE=1).ready()
    p.upload_fence(square(p, MavCmd.NAV_FENCE_POLYGON_VERTEX_EXCLUSION, 0.0, 0.0, 20.0))
    p.fly(0.2)
    assert p.ask(400, 1) == 4
    assert p.said("Arm: Vehicle breaching Polygon fence")
    p.upload_fence(())
    p.fly(0.2)
    assert p.ask(400, 1) == 0


def test_a_fence_without_a_position_keeps_it_on_the_ground(core: Core) -> None:
    p = Aviator(core, AVOID_ENABLE=0, FENCE_ENABLE=1, SIM_GPS1_ENABLE=0)
    p.fly(45.0)
    assert p.set_mode(STABILIZE)
    assert p.ask(400, 1) == 4
    assert p.said("Arm: Fence enabled, need position estimate")


def test_a_place_beyond_the_fence_is_refused_in_guided(core: Core) -> None:
    p = Aviator(
        core, AVOID_ENABLE=0, FENCE_ENABLE=1, FENCE_TYPE=CIRCLE | HIGHEST, FENCE_RADIUS=30.0, FENCE_ALT_MAX=20.0
    ).hover()
    for place in ({"x": 40.0, "z": -10.0}, {"x": 5.0, "z": -25.0}):
        p.target(POSITION, **place)
        p.fly(5.0)
        assert np.hypot(*p.pos[:2]) < 1.0 and p.height == pytest.approx(10.0, abs=0.5) and p.mode == GUIDED
    p.target(POSITION, x=25.0, z=-15.0)
    assert p.fly(15.0, lambda: p.pos[0] > 24.0 and p.height > 14.0)


def test_no_other_mode_while_breached(core: Core) -> None:
    p = Aviator(core, AVOID_ENABLE=0, FENCE_ENABLE=1, FENCE_TYPE=CIRCLE, FENCE_RADIUS=30.0, FENCE_OPTIONS=1).hover()
    fly_north(p)
    assert p.mode == RTL and not p.set_mode(LOITER)
    assert p.said("Mode change to LOITER failed: in fence recovery")
    assert p.fly(20.0, lambda: p.said("Fence breach cleared")) and p.set_mode(LOITER)


def test_the_least_height_is_on_where_it_is_the_only_fence(core: Core) -> None:
    p = Aviator(core, AVOID_ENABLE=0, FENCE_ENABLE=1, FENCE_TYPE=LOWEST, FENCE_ALT_MIN=15.0).hover(25.0)
    assert p.said("Min Alt fence enabled (auto enable)")
    assert p.set_mode(LOITER)
    p.hold(throttle=1200)
    assert p.fly(25.0, lambda: p.mode == RTL) and p.said("Min Alt fence breached")
    assert p.height == pytest.approx(15.0, abs=0.5)


def test_the_margins_of_two_fences_are_told_as_they_are_reached(core: Core) -> None:
    """Texts of a real ArduPilot on the same flight, but for tenths."""
    params = {"FENCE_RADIUS": 30.0, "FENCE_MARGIN": 6.0, "FENCE_OPTIONS": 4.0}
    p = Aviator(core, AVOID_ENABLE=0, FENCE_ENABLE=1, FENCE_TYPE=CIRCLE | AREAS, **params).ready()
    p.upload_fence(square(p, MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION, 0.0, 0.0, 28.0))
    p.hover()
    assert p.set_mode(LOITER)
    p.hold(pitch=1250)
    assert p.fly(25.0, lambda: p.mode == RTL)
    p.hold()
    p.fly(15.0)
    told = [text.text.partition(" in ")[0] for text in p.texts if "fence" in text.text and "recovery" not in text.text]
    said = [text for text in told if "Indexed" not in text and "PreArm" not in text]
    assert said[:3] == ["Polygon fence", "Circle and Polygon fences", "Polygon fence breached"]
    assert said[-1] == "Polygon fence cleared margin breach" and "Circle fence cleared margin breach" in said
    assert "Circle fence" not in said


def test_the_margin_is_told(core: Core) -> None:
    params = {"FENCE_RADIUS": 30.0, "FENCE_MARGIN": 10.0, "FENCE_OPTIONS": 4.0, "FENCE_NTF_FREQ": 0.2}
    p = Aviator(core, AVOID_ENABLE=0, FENCE_ENABLE=1, FENCE_TYPE=CIRCLE, **params).hover()
    fly_north(p)
    told = [text.text for text in p.texts if "fence in" in text.text]
    assert told and 9.0 < float(told[0].removeprefix("Circle fence in ").removesuffix("m")) <= 10.0
    assert p.fly(30.0, lambda: p.said("Circle fence cleared margin breach"))


@pytest.mark.parametrize(
    ("params", "north"),
    [({"RALLY_INCL_HOME": 0}, 50.0), ({}, 0.0), ({"RALLY_INCL_HOME": 0, "RALLY_LIMIT_KM": 0.03}, 0.0)],
)
def test_rtl_goes_to_the_rally_point(core: Core, params: dict[str, float], north: float) -> None:
    """From over home, home is nearer; a point beyond RALLY_LIMIT_KM does not count."""
    p = Aviator(core, AVOID_ENABLE=0, **params).ready()
    x, y = p.location_of(50.0, -25.0)
    p.upload_rally_points([MissionItem(MavCmd.NAV_RALLY_POINT, MavFrame.GLOBAL_RELATIVE_ALT, x=x, y=y, z=37.0)])
    p.arm()
    p.take_off(10.0)
    assert p.set_mode(RTL)
    assert p.fly(60.0, lambda: p.ap.modes.rtl.state >= 4 or p.ap.modes.rtl.loiter_us > 0)
    assert p.pos[0] == pytest.approx(north, abs=1.5)
    assert p.height == pytest.approx(37.0 if north else 10.0, abs=1.0)
    assert p.fly(120.0, lambda: not p.armed) and p.pos[0] == pytest.approx(north, abs=1.5)


def test_the_nearest_rally_point_within_the_fence(core: Core) -> None:
    p = Aviator(core, AVOID_ENABLE=0, RALLY_INCL_HOME=0, FENCE_ENABLE=1, FENCE_TYPE=CIRCLE, FENCE_RADIUS=60.0).ready()
    places = [p.location_of(*place) for place in ((70.0, 0.0), (-30.0, 0.0), (0.0, 55.0))]
    p.upload_rally_points(
        [MissionItem(MavCmd.NAV_RALLY_POINT, MavFrame.GLOBAL_RELATIVE_ALT, x=x, y=y, z=10.0) for x, y in places]
    )
    p.arm()
    p.take_off(10.0)
    p.target(POSITION, x=45.0, z=-10.0)
    assert p.fly(30.0, lambda: p.pos[0] > 44.0)
    assert p.set_mode(RTL)
    assert p.fly(60.0, lambda: p.ap.modes.rtl.loiter_us > 0)
    assert p.pos[:2] == pytest.approx((0.0, 55.0), abs=1.5)


def test_rtl_stays_below_the_greatest_height(core: Core) -> None:
    p = Aviator(core, AVOID_ENABLE=0, FENCE_ENABLE=1, FENCE_TYPE=HIGHEST, FENCE_ALT_MAX=14.0).hover()
    p.target(POSITION, x=20.0, z=-10.0)
    p.fly(12.0)
    assert p.set_mode(RTL)
    assert p.fly(60.0, lambda: p.ap.modes.rtl.loiter_us > 0)
    assert p.height == pytest.approx(12.0, abs=0.5)
