# SPDX-License-Identifier: BSD-3-Clause
"""Landings on a target: a simulated beacon, and LANDING_TARGET of a companion computer.

Values in comments: the same flight of ArduCopter 4.7.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sitl.core.algebra import rotate_inverse
from sitl.core.mavlink import MavCmd
from sitl.core.vectors import Vec3
from sitl.simulation import Core
from sitl.vehicle.landing_beacon import position_of
from tests.flights.aviator import AUTO, LAND, LOITER, RTL, Aviator, Item

EVERYWHERE = {"PLND_ALT_MIN": 0.0, "PLND_ALT_MAX": 0.0}
"""The target is missed at any height, without a range-finder, too."""
BODY_FRD, LOCAL_NED, LOCAL_FRD = 12, 1, 20


def beacon(p: Aviator, north: float, east: float) -> np.ndarray:
    """Switch on a beacon about there, as near as parameters can say it; where it truly is, NE [m]."""
    lat, lon = p.lat_lon(north, east)
    p.set_parameter("SIM_PLD_LAT", lat * 1e-7)
    p.set_parameter("SIM_PLD_LON", lon * 1e-7)
    p.set_parameter("SIM_PLD_ENABLE", 1)
    v = p.simulation.v
    return np.array(position_of(v.autopilot.params.SIM.PLD, v.physics.origin))[:2]


def pilot(core: Core, **params: float) -> Aviator:
    """A copter with the sensor of a beacon."""
    return Aviator(core, "ardupilot_quad", **{"PLND_ENABLED": 1, "PLND_TYPE": 4, "SIM_PLD_OPTIONS": 1, **params})


def aside(p: Aviator, place: np.ndarray) -> float:
    """True distance from a place [m]."""
    return float(np.hypot(*(p.pos[:2] - place)))


def heights_at(p: Aviator, text: str) -> list[float]:
    """True heights at which something was said [m]."""
    rows = np.array(p.track)
    return [float(-rows[np.searchsorted(rows[:, 0], time) - 1, 3]) for time, _, said in p.texts if text in said]


@pytest.mark.parametrize("wind", [0.0, 5.0])
@pytest.mark.parametrize("filtered", [0, 1])
def test_a_landing_ends_on_the_beacon(core: Core, wind: float, filtered: int) -> None:
    p = pilot(core, PLND_EST_TYPE=filtered, SIM_WIND_SPD=wind, SIM_WIND_DIR=90).hover(10.0)
    place = beacon(p, 3.0, 0.0)
    p.fly(3.0)
    assert p.said("PrecLand: Target Found") and p.said("PrecLand: Init Complete") == bool(filtered)
    assert aside(p, place) > 2.0
    start = p.now
    assert p.set_mode(LAND)
    p.wait_disarmed(60.0)
    assert aside(p, place) < 0.1  # 0.02 m, in that wind 0.03 m
    rows = p.since(start)
    assert rows[0, 0] + 24.0 < p.now < rows[0, 0] + 31.0  # 27.4 s: the last 1.6 m are slow
    slow = rows[(rows[:, 3] > -1.5) & (rows[:, 3] < -0.6)]
    assert 0.19 < slow[:, 6].mean() < 0.26  # 0.22 m/s
    assert p.simulation.v.autopilot.params.LAND.SPEED == 50.0


def test_without_a_target_in_sight_it_lands_where_it_is(core: Core) -> None:
    p = pilot(core, PLND_STRICT=0).hover(10.0)
    beacon(p, 30.0, 0.0)
    here = p.pos[:2]
    assert p.set_mode(LAND)
    p.wait_disarmed(60.0)
    assert aside(p, here) < 0.5 and not p.said("PrecLand")


def test_it_does_not_descend_far_aside_of_the_target(core: Core) -> None:
    p = pilot(core, PLND_XY_DIST_MAX=1.0).hover(10.0)
    place = beacon(p, 5.0, 0.0)
    p.fly(3.0)
    start = p.now
    assert p.set_mode(LAND)
    p.fly(20.0, lambda: aside(p, place) < 1.0)
    assert p.height > 9.6
    p.fly(6.0)
    assert p.height < 8.5 and p.since(start)[:, 3].min() > -10.5


@pytest.mark.parametrize(
    ("strict", "texts", "lands"),
    [
        (0, ["Target Lost"], True),
        (1, ["Target Lost", "Retrying", "Retry Completed", "Failsafe Measures"], True),
        (2, ["Target Lost", "Retrying", "Retry Completed", "Failsafe Measures"], False),
    ],
)
def test_a_lost_target_is_looked_for_as_strictly_as_asked(
    core: Core, strict: int, texts: list[str], lands: bool
) -> None:
    """ArduCopter says so 2.0, 6.0 and 11.9 s after the beacon went out; it climbs to 7.1 m and hovers at 6.2 m."""
    p = pilot(core, PLND_STRICT=strict, **EVERYWHERE).hover(10.0)
    beacon(p, 3.0, 0.0)
    p.fly(3.0)
    assert p.set_mode(LAND)
    assert p.fly(40.0, lambda: p.height < 6.0)
    p.texts.clear()
    p.set_parameter("SIM_PLD_ENABLE", 0)
    out = p.now
    p.fly(16.0)
    said = {text.removeprefix("PrecLand: "): time - out for time, _, text in p.texts if text.startswith("PrecLand")}
    assert list(said) == texts and said["Target Lost"] == pytest.approx(2.0, abs=0.15)
    if strict:
        assert said["Retrying"] == pytest.approx(6.0, abs=0.2)
        assert said["Retry Completed"] == pytest.approx(11.9, abs=1.0)
        assert -p.since(out + said["Retrying"])[:, 3].min() == pytest.approx(7.1, abs=0.4)
        assert p.height == pytest.approx(6.2, abs=0.3)
    p.fly(30.0, lambda: not p.ap.arming.armed)
    assert bool(p.ap.arming.armed) == (not lands)


def test_a_target_found_again_is_landed_on(core: Core) -> None:
    p = pilot(core, **EVERYWHERE).hover(10.0)
    place = beacon(p, 3.0, 0.0)
    p.fly(3.0)
    assert p.set_mode(LAND)
    assert p.fly(40.0, lambda: p.height < 6.0)
    p.set_parameter("SIM_PLD_ENABLE", 0)
    assert p.fly(10.0, lambda: p.said("Retrying"))
    p.set_parameter("SIM_PLD_ENABLE", 1)
    p.wait_disarmed(60.0)
    assert aside(p, place) < 0.1 and not p.said("Failsafe Measures")


@pytest.mark.parametrize(("strict", "lands"), [(1, True), (2, False)])
def test_a_target_that_never_came_stops_a_strict_landing(core: Core, strict: int, lands: bool) -> None:
    p = pilot(core, PLND_STRICT=strict, **EVERYWHERE).hover(10.0)
    assert p.set_mode(LAND)
    p.fly(6.5)
    assert p.said("PrecLand: Failsafe Measures") and p.height > 9.5
    p.fly(60.0, lambda: not p.ap.arming.armed)
    assert bool(p.ap.arming.armed) == (not lands)


def test_the_heights_of_the_sensor_bound_the_retries(core: Core) -> None:
    """Without a range-finder the default heights leave the target out of range: it lands (as ArduCopter)."""
    p = pilot(core, PLND_STRICT=2).hover(10.0)
    beacon(p, 3.0, 0.0)
    p.fly(3.0)
    assert p.set_mode(LAND)
    assert p.fly(40.0, lambda: p.height < 6.0)
    p.set_parameter("SIM_PLD_ENABLE", 0)
    p.wait_disarmed(40.0)
    assert p.said("Target Lost") and not p.said("Retrying")


def test_no_more_tries_than_allowed(core: Core) -> None:
    p = pilot(core, PLND_RET_MAX=0, **EVERYWHERE).hover(10.0)
    beacon(p, 3.0, 0.0)
    p.fly(3.0)
    assert p.set_mode(LAND)
    assert p.fly(40.0, lambda: p.height < 6.0)
    p.set_parameter("SIM_PLD_ENABLE", 0)
    assert p.fly(7.0, lambda: p.said("Failsafe Measures")) and not p.said("Retrying")
    p.wait_disarmed(60.0)


def test_the_sticks_take_the_place_over(core: Core) -> None:
    p = pilot(core).hover(10.0)
    place = beacon(p, 3.0, 0.0)
    p.fly(3.0)
    assert p.set_mode(LAND)
    p.fly(6.0)
    assert aside(p, place) < 0.6
    p.sticks(4.0, roll=1800)
    p.hold()
    p.wait_disarmed(60.0)
    assert aside(p, place) > 1.0


@pytest.mark.parametrize(("kind", "limit", "lowest", "highest"), [(0, 15.0, 0.0, 15.0), (1, 15.0, 4.0, 15.0)])
def test_the_beacon_is_seen_in_its_cylinder_or_cone(
    core: Core, kind: int, limit: float, lowest: float, highest: float
) -> None:
    """A cone of 10 m radius at 15 m is seen from 4.5 m on, 3 m aside; ArduCopter: 4.52 m. Above 15 m nothing is."""
    p = pilot(core, SIM_PLD_TYPE=kind, SIM_PLD_ALT_LMT=limit).ready()
    place = beacon(p, 3.0, 0.0)
    p.arm()
    p.take_off(18.0)
    found, lost = heights_at(p, "Target Found"), heights_at(p, "Target Lost")
    expected = 1.5 * aside(p, place) if kind else 0.0
    assert len(found) == 1 and found[0] == pytest.approx(expected, abs=0.3)
    assert len(lost) == 1 and lost[0] > highest  # two seconds later


def test_the_beacon_is_seen_in_its_sphere(core: Core) -> None:
    p = pilot(core, SIM_PLD_TYPE=2, SIM_PLD_DIST_LMT=6.0).ready()
    beacon(p, 3.0, 0.0)
    p.arm()
    p.take_off(10.0)
    assert p.said("Target Lost")
    assert p.set_mode(LAND)
    assert p.fly(20.0, lambda: p.height < 6.0) and not p.ap.landing_target.running
    p.fly(4.0)
    assert p.ap.landing_target.acquired


def test_rtl_and_missions_land_on_the_beacon(core: Core) -> None:
    p = pilot(core, RTL_ALT=800, AUTO_OPTIONS=3).hover(8.0)
    place = beacon(p, 3.0, 0.0)
    assert p.set_mode(RTL)
    p.wait_disarmed(60.0)
    assert aside(p, place) < 0.1
    assert p.upload(Item(MavCmd.NAV_TAKEOFF, z=8.0), Item(MavCmd.NAV_LAND, (0.0, 0.0))) == 0
    assert p.set_mode(AUTO)
    p.arm()
    assert p.fly(40.0, lambda: p.height > 5.0)
    p.wait_disarmed(60.0)
    assert aside(p, place) < 0.1


def test_it_lands_aside_of_the_target_as_told(core: Core) -> None:
    """ArduCopter: 0.99 m ahead and 0.50 m right of where it lands without."""
    p = pilot(core, PLND_LAND_OFS_X=100, PLND_LAND_OFS_Y=50).hover(8.0)
    place = beacon(p, 3.0, 0.0)
    p.fly(3.0)
    heading = math.radians(p.euler[2])
    ahead = np.array((math.cos(heading), math.sin(heading)))
    right = np.array((-ahead[1], ahead[0]))
    assert p.set_mode(LAND)
    p.wait_disarmed(60.0)
    assert aside(p, place + ahead + 0.5 * right) < 0.12


def send_target(p: Aviator, target: Vec3, frame: int, as_place: bool, with_distance: bool = True) -> None:
    """LANDING_TARGET of a target, NED from the origin [m], as a camera sees it that looks down."""
    est = p.ap.estimate
    away = target - Vec3(*est.pos)
    q = est.q if frame == BODY_FRD else (math.cos(0.5 * est.yaw), 0.0, 0.0, math.sin(0.5 * est.yaw))
    seen = rotate_inverse(type(est.q)(*q), away)
    fields: dict[str, Any] = {"x": seen.x, "y": seen.y, "z": seen.z, "position_valid": 1} if as_place else {
        "angle_x": math.atan2(seen.y, seen.z), "angle_y": -math.atan2(seen.x, seen.z)
    }  # fmt: skip
    distance = math.sqrt(seen.x**2 + seen.y**2 + seen.z**2) if with_distance else 0.0
    p.send("LANDING_TARGET", frame=frame, distance=distance, **fields)


@pytest.mark.parametrize("frame", [BODY_FRD, LOCAL_FRD])
@pytest.mark.parametrize("as_place", [False, True])
def test_it_lands_on_what_a_companion_computer_sees(core: Core, frame: int, as_place: bool) -> None:
    p = Aviator(core, "ardupilot_quad", PLND_ENABLED=1, PLND_TYPE=1).hover(8.0)
    origin = p.pos - np.array(p.ap.estimate.pos)
    target = Vec3(3.0, 1.0, 0.0)
    assert p.set_mode(LAND)
    for _ in range(20 * 60):
        send_target(p, target, frame, as_place)
        p.fly(0.05)
        if not p.ap.arming.armed:
            break
    assert not p.ap.arming.armed and p.said("PrecLand: Init Complete")
    assert np.hypot(*(p.pos - origin)[:2] - (3.0, 1.0)) < 0.3


@pytest.mark.parametrize(("frame", "with_distance"), [(LOCAL_NED, True), (0, True), (BODY_FRD, False)])
def test_targets_of_other_frames_or_of_unknown_distance_are_not_taken(
    core: Core, frame: int, with_distance: bool
) -> None:
    p = Aviator(core, "ardupilot_quad", PLND_ENABLED=1, PLND_TYPE=1).hover(8.0)
    for _ in range(10):
        send_target(p, Vec3(3.0, 1.0, 0.0), frame, True, with_distance)
        p.fly(0.05)
    assert not p.ap.landing_target.running
    assert [text for _, _, text in p.texts].count("Plnd: Frame not supported") == (frame != BODY_FRD)


@pytest.mark.parametrize(("distance", "angle"), [(1e30, 0.5), (2000.0, 0.5), (0.0, 1.5707)])
def test_a_target_beyond_all_sense_is_passed_over(core: Core, distance: float, angle: float) -> None:
    p = Aviator(core, "ardupilot_quad", PLND_ENABLED=1, PLND_TYPE=1, PLND_STRICT=0, RNGFND1_TYPE=100).hover(8.0)
    here = p.pos[:2]
    assert p.set_mode(LAND)
    for _ in range(100):
        p.send("LANDING_TARGET", frame=BODY_FRD, distance=distance, angle_x=angle)
        p.fly(0.05)
    assert not p.said("Target Found") and aside(p, here) < 0.5


def test_a_companion_computer_is_not_heard_without_its_type(core: Core) -> None:
    p = pilot(core).hover(8.0)
    for _ in range(10):
        send_target(p, Vec3(3.0, 1.0, 0.0), BODY_FRD, True)
        p.fly(0.05)
    assert not p.ap.landing_target.running


def test_a_beacon_without_a_place_is_told(core: Core) -> None:
    p = pilot(core, SIM_PLD_ENABLE=1).ready()
    assert [text for _, _, text in p.texts].count("Set SIM_PLD_LAT, SIM_PLD_LON and SIM_PLD_ALT") == 1
    assert p.message("SYS_STATUS").onboard_control_sensors_present & 0x80
    assert not p.message("SYS_STATUS").onboard_control_sensors_health & 0x80


def test_the_sensor_needs_to_be_enabled(core: Core) -> None:
    p = pilot(core, PLND_ENABLED=0).hover(8.0)
    place = beacon(p, 3.0, 0.0)
    p.fly(3.0)
    assert p.set_mode(LAND)
    p.wait_disarmed(60.0)
    assert aside(p, place) > 1.5 and not p.said("PrecLand")
    assert not p.message("SYS_STATUS").onboard_control_sensors_present & 0x80


def test_loiter_holds_over_the_target_while_a_switch_lets_it(core: Core) -> None:
    p = pilot(core, SIM_PLD_DIST_LMT=40).hover(8.0)
    p.hold()
    assert p.set_mode(LOITER)
    place = beacon(p, 3.0, 0.0)
    p.fly(4.0)
    assert aside(p, place) > 2.0
    assert p.ask(218, 39, 2) == 0
    p.fly(8.0)
    assert aside(p, place) < 0.15
    p.sticks(3.0, pitch=1800)
    assert aside(p, place) > 2.0
    p.hold()
    p.fly(15.0)
    assert aside(p, place) < 0.3
    assert p.ask(218, 39, 0) == 0
    p.sticks(2.0, pitch=1800)
    p.hold()
    p.fly(8.0)
    assert aside(p, place) > 2.0


def test_loiter_that_loses_its_sensor_stays(core: Core) -> None:
    p = pilot(core).hover(8.0)
    place = beacon(p, 4.0, 0.0)
    p.hold()
    assert p.set_mode(LOITER) and p.ask(218, 39, 2) == 0
    p.fly(3.0)
    assert p.ap.modes.loiter.on_target
    p.set_parameter("PLND_ENABLED", 0)
    p.fly(20.0)
    assert not p.ap.modes.loiter.on_target and not p.ap.landing_target.acquired
    assert aside(p, place) < 5.0 and np.hypot(*p.vel[:2]) < 0.2
