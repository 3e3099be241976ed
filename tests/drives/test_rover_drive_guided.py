# SPDX-License-Identifier: BSD-3-Clause
"""GUIDED: places, velocities, headings, turn rates and throttle as set-points, judged by the truth."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl.simulation import Core
from tests.drives import rover_driver as rover
from tests.drives.rover_driver import Driver, path_error

ALL = pytest.mark.parametrize("frame", rover.AIRFRAMES)
CARS = pytest.mark.parametrize("frame", rover.AIRFRAMES[:3])
TIMED_OUT = "target not received last 3secs, stopping"


def course(d: Driver) -> float:
    """Direction of the motion [deg]."""
    return math.degrees(math.atan2(d.vel[1], d.vel[0]))


def angle(a: float, b: float) -> float:
    """Between two directions [deg]."""
    return abs((a - b + 180.0) % 360.0 - 180.0)


def stopping_distance(d: Driver, speed: float) -> float:
    """In which the firmware's deceleration takes a speed away [m]."""
    return 0.5 * speed * speed / float(d.ap.params.ATC_ACCEL_MAX)


def reach(d: Driver) -> float:
    """A distance that suits the size of the vehicle [m]."""
    return 16.0 * d.cruise


@ALL
@pytest.mark.parametrize("bearing", [0, 70, 180, 250])
def test_a_place(core: Core, frame: str, bearing: int) -> None:
    """Drives there the short way round and stops within WP_RADIUS, not far over; MISSION_ITEM_REACHED."""
    d = Driver(core, frame, estimator="truth").armed_in()
    way = reach(d)
    place = (way * math.cos(math.radians(bearing)), way * math.sin(math.radians(bearing)))
    start = d.now
    d.target(rover.POSITION, x=place[0], y=place[1])
    assert d.fly(90.0, lambda: bool(d.reached))
    d.wait_until_it_stands()
    assert d.away(*place) < 0.6 * float(d.ap.params.WP_RADIUS)
    rows = d.since(start)
    along = rows[:, 1] * math.cos(math.radians(bearing)) + rows[:, 2] * math.sin(math.radians(bearing))
    assert along.max() < 1.15 * way
    # a half turn of its radius, twice for what the loops need
    assert path_error(rows, (0.0, 0.0), place).max() < max(0.1 * way, 4.0 * d.radius)
    assert np.hypot(rows[:, 4], rows[:, 5]).max() < 1.15 * d.cruise


@ALL
def test_a_place_by_the_real_estimator(core: Core, frame: str) -> None:
    """Where the estimator says it is: within WP_RADIUS; truly within that and what GPS is off."""
    d = Driver(core, frame).armed_in()
    way = reach(d)
    d.target(rover.POSITION, x=way, y=-way)
    assert d.fly(90.0, lambda: bool(d.reached))
    d.wait_until_it_stands()
    assert d.away(way, -way) < float(d.ap.params.WP_RADIUS)
    assert np.hypot(*(d.place - (way, -way))) < float(d.ap.params.WP_RADIUS) + 1.5


@ALL
def test_velocity_steps(core: Core, frame: str) -> None:
    """Heading and speed follow each step, without much overshoot; a turn takes what the steering takes."""
    d = Driver(core, frame, estimator="truth").armed_in()
    v = d.cruise
    for bearing, share in ((0.0, 1.0), (90.0, 1.0), (-150.0, 0.5), (-30.0, 0.8)):
        start = d.now
        north, east = math.cos(math.radians(bearing)), math.sin(math.radians(bearing))
        d.stream(12.0, rover.VELOCITY, vx=share * v * north, vy=share * v * east)
        assert d.speed == pytest.approx(share * v, rel=0.03)
        assert angle(course(d), bearing) < 4.0
        late = d.since(start + 8.0)
        assert np.hypot(late[:, 4], late[:, 5]).max() < 1.1 * share * v + 0.02


@ALL
def test_velocity_steps_by_the_real_estimator(core: Core, frame: str) -> None:
    d = Driver(core, frame).armed_in()
    for bearing in (0.0, 90.0, 180.0):
        north, east = math.cos(math.radians(bearing)), math.sin(math.radians(bearing))
        d.stream(12.0, rover.VELOCITY, vx=d.cruise * north, vy=d.cruise * east)
        assert d.speed == pytest.approx(d.cruise, rel=0.08, abs=0.04)
        assert angle(course(d), bearing) < 8.0


@ALL
def test_faster_than_wp_speed_is_wp_speed(core: Core, frame: str) -> None:
    d = Driver(core, frame, estimator="truth").armed_in()
    d.stream(12.0, rover.VELOCITY, vx=3.0 * d.cruise)
    assert d.speed == pytest.approx(d.cruise, rel=0.03)


@ALL
def test_body_frame(core: Core, frame: str) -> None:
    """Forward is where the nose points."""
    d = Driver(core, frame, estimator="truth").armed_in()
    d.stream(8.0, rover.VELOCITY, vx=0.0, vy=d.cruise)
    heading = d.heading
    d.target(rover.VELOCITY, rover.BODY, vx=0.5 * d.cruise)
    d.fly(2.5)
    assert angle(course(d), heading) < 5.0


@ALL
def test_time_out(core: Core, frame: str) -> None:
    """Three seconds after the last set-point it stops, and says so once."""
    d = Driver(core, frame, estimator="truth").armed_in()
    d.get_going()
    silent = d.now - 0.1  # the last was sent then
    assert d.fly(4.0, lambda: d.said(TIMED_OUT))
    assert d.now - silent == pytest.approx(3.0, abs=0.15)
    place, speed = d.place, d.speed
    d.wait_until_it_stands()
    assert np.hypot(*(d.place - place)) == pytest.approx(stopping_distance(d, speed), rel=0.1, abs=0.5 * speed)
    d.fly(5.0)
    assert sum(said == TIMED_OUT for _, _, said in d.texts) == 1
    assert d.mode == rover.GUIDED


@ALL
@pytest.mark.parametrize("share", [0.8, -0.8])
def test_heading_and_speed(core: Core, frame: str, share: float) -> None:
    """Velocity with yaw: backwards keeps the nose at the heading."""
    d = Driver(core, frame, estimator="truth").armed_in()
    d.stream(14.0, rover.VELOCITY_YAW, vx=share * d.cruise, yaw=math.radians(40.0))
    assert d.speed == pytest.approx(share * d.cruise, rel=0.04)
    assert angle(d.heading, 40.0) < 4.0


@ALL
@pytest.mark.parametrize("share", [0.8, -0.8])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_turn_rate_and_speed(core: Core, frame: str, share: float, side: float) -> None:
    """A circle: three quarters of the turn that the steering gives."""
    d = Driver(core, frame, estimator="truth").armed_in()
    speed = share * d.cruise
    rate = side * 0.75 * min(abs(speed) / max(d.radius, 1e-9), 1.0)
    d.stream(6.0, rover.VELOCITY_YAW_RATE, rover.BODY, vx=speed, yaw_rate=rate)
    start = d.now
    d.stream(4.0, rover.VELOCITY_YAW_RATE, rover.BODY, vx=speed, yaw_rate=rate)
    rows = d.since(start)
    turned = math.radians(float(np.sum((np.diff(rows[:, 9]) + 180.0) % 360.0 - 180.0)))
    assert turned / (rows[-1, 0] - rows[0, 0]) == pytest.approx(rate, rel=0.06)
    assert d.speed == pytest.approx(speed, rel=0.06)


def test_yaw_alone_turns_a_skid_rover_on_the_spot(core: Core) -> None:
    d = Driver(core, "skid_rover", estimator="truth").armed_in()
    place = d.place
    d.stream(6.0, rover.YAW, yaw=math.radians(120.0))
    assert angle(d.heading, 120.0) < 3.0
    assert np.hypot(*(d.place - place)) < 0.05


@CARS
def test_yaw_alone_leaves_a_car_where_it_is(core: Core, frame: str) -> None:
    d = Driver(core, frame, estimator="truth").armed_in()
    d.stream(4.0, rover.YAW, yaw=math.radians(120.0))
    assert np.hypot(*d.place) < 0.05


@ALL
def test_share_of_the_speed_by_attitude_target(core: Core, frame: str) -> None:
    """SET_ATTITUDE_TARGET: thrust is a share of WP_SPEED, the quaternion's yaw the heading."""
    d = Driver(core, frame, estimator="truth").armed_in()
    half = math.radians(30.0) / 2
    for _ in range(120):
        d.send(
            "SET_ATTITUDE_TARGET", type_mask=7,
            q=(math.cos(half), 0.0, 0.0, math.sin(half)), thrust=0.6,
        )  # fmt: skip
        d.fly(0.1)
    assert d.speed == pytest.approx(0.6 * d.cruise, rel=0.04)
    assert angle(d.heading, 30.0) < 4.0


@ALL
def test_speed_is_changed_on_the_way(core: Core, frame: str) -> None:
    """DO_CHANGE_SPEED counts for the place under way."""
    d = Driver(core, frame, estimator="truth").armed_in()
    d.target(rover.POSITION, x=60.0 * d.cruise)
    d.fly(10.0)
    assert d.speed == pytest.approx(d.cruise, rel=0.05)
    assert d.ask(178, 1, 0.5 * d.cruise) == 0
    d.fly(10.0)
    assert d.speed == pytest.approx(0.5 * d.cruise, rel=0.05)


@ALL
def test_backwards_to_a_place(core: Core, frame: str) -> None:
    """DO_SET_REVERSE: tail first, in a straight line, and it stops there."""
    d = Driver(core, frame, estimator="truth").armed_in()
    heading = math.radians(d.heading)
    back = (-reach(d) * math.cos(heading), -reach(d) * math.sin(heading))
    d.target(rover.POSITION, x=back[0], y=back[1])
    assert d.ask(194, 1) == 0
    start = d.now
    assert d.fly(60.0, lambda: bool(d.reached))
    d.wait_until_it_stands()
    assert d.away(*back) < 0.5 * float(d.ap.params.WP_RADIUS)
    assert angle(d.heading, math.degrees(heading)) < 10.0
    assert path_error(d.since(start), (0.0, 0.0), back).max() < 0.1 * d.cruise + 0.05


@ALL
def test_planned_legs(core: Core, frame: str) -> None:
    """GUID_OPTIONS 64: the same place along an s-curve."""
    d = Driver(core, frame, estimator="truth", GUID_OPTIONS=64).armed_in()
    d.target(rover.POSITION, x=reach(d), y=reach(d))
    assert d.fly(90.0, lambda: bool(d.reached))
    d.wait_until_it_stands()
    assert d.away(reach(d), reach(d)) < 0.5 * float(d.ap.params.WP_RADIUS)


def test_set_points_outside_of_guided_do_nothing(core: Core) -> None:
    d = Driver(core, "erle_rover").armed_in(rover.HOLD)
    d.stream(2.0, rover.VELOCITY, vx=1.0)
    d.target(rover.POSITION, x=10.0)
    d.fly(2.0)
    assert d.stands() and d.mode == rover.HOLD
    assert not d.set_mode(rover.AUTO), "no mission"


def test_numbers_that_are_none_stop(core: Core) -> None:
    d = Driver(core, "erle_rover").armed_in()
    d.get_going()
    d.target(rover.VELOCITY, vx=math.nan)
    d.wait_until_it_stands()
    assert not d.not_finite("estimate", "control", "modes")
