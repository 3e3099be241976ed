# SPDX-License-Identifier: BSD-3-Clause
"""AUTO: legs, corners, pivot turns, stays, circles, reverse, speed, jumps, guided driving and ends of missions."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl.core.geodesy import METRES_PER_DEGE7
from sitl.core.mavlink import MavCmd
from sitl.simulation import Core
from tests.drives import rover_driver as rover
from tests.drives.rover_driver import Driver, outside, path_error, square
from tests.pilots.witness import Item

ALL = pytest.mark.parametrize("frame", rover.AIRFRAMES)
CARS = pytest.mark.parametrize("frame", rover.AIRFRAMES[:3])
OUTSIDE = {"erle_rover": 0.20, "erle_rover_small": 0.16, "ardupilot_rover": 0.20, "skid_rover": 0.08}
"""Furthest that the square is left to its outside [m]."""


def corners(frame: str) -> list[tuple[float, float]]:
    """The square of docs/vehicles.md, without its start."""
    return square(rover.SIDE[frame])[1:]


def way(*places: tuple[float, float]) -> list[Item]:
    return [Item(MavCmd.NAV_WAYPOINT, place) for place in places]


def driver(core: Core, frame: str, **params: float) -> Driver:
    """Armed, with an estimator that makes no errors, so that the driving is judged."""
    return Driver(core, frame, estimator="truth", **params).armed_in()


@ALL
def test_square(core: Core, frame: str) -> None:
    """Corners are rounded within WP_RADIUS, or turned on the spot, and hardly left to the outside."""
    d = driver(core, frame)
    side, start = rover.SIDE[frame], d.now
    d.start_mission(*way(*corners(frame)))
    d.finish_mission(60.0 + 6.0 * side / d.cruise)
    d.wait_until_it_stands()
    rows = d.since(start)
    place = rows[:, 1:3]
    assert outside(rows, side) < OUTSIDE[frame]
    for corner in corners(frame):
        assert np.hypot(*(place - corner).T).min() < float(d.ap.params.WP_RADIUS)
    legs = path_error(rows, (0.0, 0.0), *corners(frame))
    assert np.sqrt(np.mean(legs**2)) < 0.25 * float(d.ap.params.WP_RADIUS)
    assert list(d.reached) == [1, 2, 3, 4]
    assert d.away(0.0, 0.0) < 0.5 * float(d.ap.params.WP_RADIUS)
    assert d.mode == rover.AUTO and d.armed


@ALL
def test_square_by_the_real_estimator(core: Core, frame: str) -> None:
    """GPS wanders by half a metre: so does the path."""
    d = Driver(core, frame).armed_in()
    side, start = rover.SIDE[frame], d.now
    d.start_mission(*way(*corners(frame)))
    d.finish_mission(60.0 + 6.0 * side / d.cruise)
    place = d.since(start)[:, 1:3]
    assert outside(d.since(start), side) < OUTSIDE[frame] + 1.2
    for corner in corners(frame):
        assert np.hypot(*(place - corner).T).min() < float(d.ap.params.WP_RADIUS) + 1.0


@ALL
@pytest.mark.parametrize("angle", [30, 60, 120, 175])
def test_corners(core: Core, frame: str, angle: int) -> None:
    """Of any angle; both legs are driven, the second to its end."""
    leg = rover.SIDE[frame]
    d = driver(core, frame)
    turn = math.radians(angle)
    end = (leg + leg * math.cos(turn), leg * math.sin(turn))
    start = d.now
    d.start_mission(*way((leg, 0.0), end))
    d.finish_mission(100.0 + 4.0 * leg / d.cruise)
    d.wait_until_it_stands()
    rows = d.since(start)
    assert np.hypot(rows[:, 1] - leg, rows[:, 2]).min() < 1.15 * float(d.ap.params.WP_RADIUS)
    assert d.away(*end) < 0.5 * float(d.ap.params.WP_RADIUS)
    if d.is_skid:
        assert path_error(rows, (0.0, 0.0), (leg, 0.0), end).max() < 0.35
    spot = rows[np.hypot(rows[:, 4], rows[:, 5]) < 0.02]
    on_corner = np.hypot(spot[:, 1] - leg, spot[:, 2]) < 0.5
    pivots = bool(on_corner.any()) and float(np.ptp(np.unwrap(spot[on_corner][:, 9], period=360.0))) > 20.0
    assert pivots == (d.is_skid and angle >= 60)


@ALL
def test_backwards(core: Core, frame: str) -> None:
    """DO_SET_REVERSE 1: tail first round the corner, nearly as exact as forwards."""
    side = rover.SIDE[frame]
    d = driver(core, frame)
    start = d.now
    d.start_mission(Item(MavCmd.DO_SET_REVERSE, None, 0.0, (1,)), *way((-side, 0.0), (-side, side)))
    d.finish_mission(100.0 + 4.0 * side / d.cruise)
    d.wait_until_it_stands()
    rows = d.since(start)
    heading = np.radians(rows[:, 9])
    forward = rows[:, 4] * np.cos(heading) + rows[:, 5] * np.sin(heading)
    assert forward.max() < 0.1 * d.cruise and forward.min() > -1.15 * d.cruise
    straight = rows[np.hypot(rows[:, 1] + side, rows[:, 2]) > 0.3 * side]
    assert path_error(straight, (0.0, 0.0), (-side, 0.0), (-side, side)).max() < 0.1 * side
    leg = rows[(rows[:, 1] < -0.2 * side) & (rows[:, 1] > -0.6 * side)]
    assert np.ptp(leg[:, 9]) < 4.0, "it does not weave"
    assert d.away(-side, side) < 0.6 * float(d.ap.params.WP_RADIUS)


@ALL
def test_delay_at_a_waypoint(core: Core, frame: str) -> None:
    side = rover.SIDE[frame]
    d = driver(core, frame)
    d.start_mission(Item(MavCmd.NAV_WAYPOINT, (side, 0.0), 0.0, (5.0,)), *way((2.0 * side, 0.0)))
    assert d.fly(60.0 + 2.0 * side / d.cruise, lambda: d.said("Reached waypoint #1. Loiter for 5 seconds"))
    d.fly(4.9)
    assert abs(d.speed) < 0.05 and d.said("Mission: 1") and not d.said("Mission: 2")
    d.fly(0.3)
    assert d.said("Mission: 2")
    d.finish_mission(60.0 + 2.0 * side / d.cruise)


@ALL
def test_stays(core: Core, frame: str) -> None:
    """NAV_DELAY, LOITER_TIME, then LOITER_UNLIMITED for good."""
    side = rover.SIDE[frame]
    d = driver(core, frame)
    d.start_mission(Item(MavCmd.NAV_DELAY, None, 0.0, (4.0, -1, -1, -1)),
                    Item(MavCmd.NAV_LOITER_TIME, (side, 0.0), 0.0, (6.0,)),
                    Item(MavCmd.NAV_LOITER_UNLIM, (side, side)), *way((0.0, 0.0)))  # fmt: skip
    d.fly(3.8)
    assert d.stands() and np.hypot(*d.place) < 0.01
    assert d.fly(60.0 + 3.0 * side / d.cruise, lambda: d.said("Finished active loiter"))
    d.fly(60.0 + 3.0 * side / d.cruise)
    assert d.away(side, side) < 0.6 * float(d.ap.params.WP_RADIUS)
    assert d.stands() and not d.said("Mission Complete")


@ALL
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_turns(core: Core, frame: str, side: float) -> None:
    """LOITER_TURNS: a negative radius goes anticlockwise."""
    radius = 0.25 * rover.SIDE[frame]
    d = driver(core, frame)
    d.start_mission(Item(MavCmd.NAV_LOITER_TURNS, (0.0, 2.0 * radius), 0.0, (2.0, 0.0, side * radius)))
    assert d.fly(60.0 + 30.0 * radius / d.cruise, lambda: d.said("Mission Complete"))
    rows = d.since(d.now - 2.0 * math.pi * radius / d.cruise)
    distance = np.hypot(rows[:, 1], rows[:, 2] - 2.0 * radius)
    assert np.abs(distance - radius).max() < 0.1 * radius + 0.1
    assert np.sign(np.sum((np.diff(rows[:, 9]) + 180.0) % 360.0 - 180.0)) == side


@ALL
def test_speed_and_conditions(core: Core, frame: str) -> None:
    """Do-commands run once the waypoint before them is reached, those behind a condition when it is met."""
    side = rover.SIDE[frame]
    d = driver(core, frame)
    d.start_mission(
        *way((side, 0.0)), Item(MavCmd.CONDITION_DELAY, None, 0.0, (6.0,)),
        Item(MavCmd.DO_CHANGE_SPEED, None, 0.0, (1, 0.5 * d.cruise)),
        Item(MavCmd.CONDITION_DISTANCE, None, 0.0, (0.4 * side,)),
        Item(MavCmd.DO_CHANGE_SPEED, None, 0.0, (1, d.cruise)), *way((3.0 * side, 0.0)),
    )  # fmt: skip
    d.finish_mission(100.0 + 8.0 * side / d.cruise)
    assert d.reached_at(3) - d.reached_at(1) == pytest.approx(6.0, abs=0.3)
    rows = d.since(0.0)
    speed = np.hypot(rows[:, 4], rows[:, 5])
    place = np.interp(d.reached_at(5), rows[:, 0], rows[:, 1])
    assert 3.0 * side - place == pytest.approx(0.4 * side, abs=0.15 * d.cruise)
    slow = (rows[:, 0] > d.reached_at(3) + 6.0) & (rows[:, 0] < d.reached_at(5))
    assert speed[slow] == pytest.approx(0.5 * d.cruise, rel=0.1)
    assert speed[rows[:, 0] < d.reached_at(3)].max() == pytest.approx(d.cruise, rel=0.1)
    assert speed[rows[:, 0] > d.reached_at(5)].max() == pytest.approx(d.cruise, rel=0.1)


@ALL
def test_jump(core: Core, frame: str) -> None:
    """Twice back to the first of two places."""
    side = rover.SIDE[frame]
    d = driver(core, frame)
    d.start_mission(*way((side, 0.0), (side, side)), Item(MavCmd.DO_JUMP, None, 0.0, (1, 2)), *way((0.0, 0.0)))
    d.finish_mission(200.0 + 16.0 * side / d.cruise)
    assert list(d.reached) == [1, 2, 1, 2, 1, 2, 4]


@ALL
def test_heading_and_speed_item(core: Core, frame: str) -> None:
    """NAV_SET_YAW_SPEED turns while it drives, and is done at the heading."""
    d = driver(core, frame)
    d.start_mission(Item(MavCmd.NAV_SET_YAW_SPEED, None, 0.0, (90.0, 0.6 * d.cruise, 0.0)))
    d.finish_mission(60.0)
    d.wait_until_it_stands()
    assert d.heading == pytest.approx(90.0, abs=12.0)


@ALL
def test_return_item(core: Core, frame: str) -> None:
    d = driver(core, frame)
    d.start_mission(*way((rover.SIDE[frame], 0.0)), Item(MavCmd.NAV_RETURN_TO_LAUNCH))
    d.finish_mission(100.0 + 4.0 * rover.SIDE[frame] / d.cruise)
    d.wait_until_it_stands()
    home = np.array(d.ap.home.pos)[:2]
    assert d.away(*home) < 0.6 * float(d.ap.params.WP_RADIUS)


@ALL
def test_guided_within_a_mission(core: Core, frame: str) -> None:
    """GUIDED_ENABLE takes set-points until DO_GUIDED_LIMITS ends it; then the mission goes on."""
    side = rover.SIDE[frame]
    d = driver(core, frame)
    d.start_mission(*way((side, 0.0)), Item(MavCmd.DO_GUIDED_LIMITS, None, 0.0, (8.0, 0, 0, 0)),
                    Item(MavCmd.NAV_GUIDED_ENABLE, None, 0.0, (1.0,)), *way((side, side)))  # fmt: skip
    assert d.fly(60.0 + 2.0 * side / d.cruise, lambda: d.said("Mission: 3"))
    start = d.now
    while not d.said("Mission: 4"):
        d.target(rover.VELOCITY, vx=0.5 * d.cruise)
        d.fly(0.1)
        assert d.now < start + 12.0
    assert d.now - start == pytest.approx(8.0, abs=1.0)
    assert d.speed > 0.3 * d.cruise and d.mode == rover.AUTO
    d.finish_mission(100.0 + 4.0 * side / d.cruise)


@pytest.mark.parametrize(("choice", "mode"), [(0, rover.AUTO), (1, rover.AUTO), (2, rover.ACRO), (3, rover.MANUAL)])
def test_after_the_last_item(core: Core, choice: int, mode: int) -> None:
    """MIS_DONE_BEHAVE: hold, loiter, ACRO or MANUAL."""
    d = Driver(core, "erle_rover", MIS_DONE_BEHAVE=choice).armed_in()
    d.start_mission(*way((10.0, 0.0)))
    d.finish_mission(60.0)
    d.fly(5.0)
    assert d.mode == mode
    assert abs(d.speed) < 0.3


def test_a_mission_goes_on_where_it_was_left(core: Core) -> None:
    """HOLD in between: AUTO goes on to the same item (MIS_RESTART 0)."""
    d = driver(core, "erle_rover")
    d.start_mission(*way(*corners("erle_rover")))
    assert d.fly(60.0, lambda: d.said("Mission: 2"))
    d.fly(3.0)
    d.set_mode(rover.HOLD)
    d.fly(4.0)
    d.set_mode(rover.AUTO)
    d.fly(0.5)
    assert int(d.ap.modes.nav.mission_current) == 2
    d.finish_mission(200.0)
    assert list(d.reached) == [1, 2, 3, 4]


def test_what_only_copters_fly_is_taken_and_passed_over(core: Core) -> None:
    d = driver(core, "erle_rover")
    assert d.upload(Item(MavCmd.NAV_TAKEOFF, None, 10.0), *way((10.0, 0.0))) == 0
    assert d.upload(*way((10.0, 0.0)), Item(MavCmd.NAV_LAND)) == 0
    assert d.upload(Item(MavCmd.DO_SET_ROI_LOCATION, (5.0, 5.0)), *way((10.0, 0.0))) == 0
    assert d.mode == rover.GUIDED


@CARS
def test_very_short_legs(core: Core, frame: str) -> None:
    """Shorter than the turning radius: all are passed, it does not stick."""
    u = max(0.3 * Driver(core, frame).radius, 0.1)
    places = [(u * k, 0.5 * u * (k % 2)) for k in range(1, 12)] + [(12.0 * u, 0.0)] * 2
    d = driver(core, frame)
    d.start_mission(*way(*places))
    d.finish_mission(300.0)
    assert len(d.reached) == len(places)


def test_servo_outputs_and_relays(core: Core) -> None:
    """As ArduPilot 4.7: set at once; to and fro with half of the period each, beginning at once."""
    d = driver(core, "ardupilot_rover", RELAY1_PIN=1.0)
    actuators, values = d.simulation.v.actuators, d.simulation.parameters
    d.start_mission(
        Item(MavCmd.DO_SET_SERVO, None, 0.0, (9.0, 1600.0)), Item(MavCmd.DO_SET_RELAY, None, 0.0, (0.0, 1.0)),
        *way((5.0, 0.0)),
        Item(MavCmd.DO_REPEAT_SERVO, None, 0.0, (10.0, 1900.0, 3.0, 1.0)), Item(MavCmd.NAV_DELAY, None, 0.0, (3.0,)),
        Item(MavCmd.DO_REPEAT_RELAY, None, 0.0, (0.0, 2.0, 1.0)), Item(MavCmd.NAV_DELAY, None, 0.0, (3.0,)),
    )  # fmt: skip
    d.fly(1.0)
    assert (actuators.pwm[8], values["SIM_PIN_MASK"]) == (1600, 2.0)
    seen: list[tuple[float, int, float]] = []
    while d.now < 200.0 and 7 not in d.reached:
        now = (int(actuators.pwm[9]), float(values["SIM_PIN_MASK"]))
        if not seen or seen[-1][1:] != now:
            seen.append((d.now, *now))
        d.fly(0.05)
    begun = seen[1][0]
    steps = [(1900, 2.0), (1500, 2.0)] * 3 + [(1500, 0.0), (1500, 2.0)] * 2
    assert [row[1:] for row in seen[1:]] == steps
    assert [row[0] - begun for row in seen[1:]] == pytest.approx([0, 0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5], abs=0.06)
    assert {3, 5, 7} <= set(d.reached)


@pytest.mark.parametrize("frame", ["ardupilot_rover", "skid_rover"])
def test_pictures_on_the_way(core: Core, frame: str) -> None:
    """One each 2 m, then one each 5 m, then one by command; none where no distance is asked for."""
    d = driver(core, frame, CAM1_TYPE=1.0, SERVO9_FUNCTION=10.0, CAM1_DURATION=0.3)
    pwm, pulses = d.simulation.v.actuators.pwm, set()
    with d.messages("CAMERA_FEEDBACK") as pictures:
        d.start_mission(
            *way((4.0, 0.0)), Item(MavCmd.DO_SET_CAM_TRIGG_DIST, None, 0.0, (2.0,)), *way((24.0, 0.0)),
            Item(MavCmd.DO_SET_CAM_TRIGG_DIST, None, 0.0, (5.0,)), *way((49.0, 0.0)),
            Item(MavCmd.DO_SET_CAM_TRIGG_DIST, None, 0.0, (0.0,)),
            Item(MavCmd.IMAGE_START_CAPTURE, None, 0.0, (0.0, 0.0, 1.0)),
            *way((54.0, 0.0)),
        )  # fmt: skip
        while d.now < 300.0 and not d.said("Mission Complete"):
            d.fly(0.1)
            pulses.add(int(pwm[8]))
    assert d.said("Mission Complete")
    assert [m.img_idx for m in pictures] == list(range(1, len(pictures) + 1))
    assert pulses == {1300, 1100}
    north = METRES_PER_DEGE7 * (np.array([m.lat for m in pictures]) - pictures[0].lat)
    gaps = np.diff(north)
    near, far = gaps[:8], gaps[10:-1]
    assert near == pytest.approx(2.0, abs=0.3) and len(far) >= 2 and far == pytest.approx(5.0, abs=0.3)
