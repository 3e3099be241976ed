# SPDX-License-Identifier: BSD-3-Clause
"""Legs, corners, speed changes, reversing and pivot turns, driven in plain Python."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.navigation import path
from sitl.autopilot.navigation.state import LEG_ENDING, SPEED_REQUEST
from sitl.autopilot.rover.control import forward_speed
from sitl.autopilot.rover.modes.guided import GUIDED
from sitl.autopilot.rover.modes.hold import HOLD
from sitl.autopilot.rover.modes.set_mode import request
from sitl.autopilot.rover.navigation import pivot, waypoint
from sitl.autopilot.rover.navigation.planner import PLANNER
from sitl.autopilot.rover.navigation.state import DriveState
from sitl.autopilot.rover.parameters import Parameters
from sitl.core.algebra import horizontal, norm2, turned
from sitl.core.vectors import Vec2, Vec3
from tests.autopilot.rover.modes.driven_rover import Rover

SKID = {"SERVO1_FUNCTION": 73.0, "SERVO3_FUNCTION": 74.0}


class Driver(Rover):
    """Armed in GUIDED; destinations are given to ``navigation.waypoint``, the mode drives after it."""

    def __init__(self, **params: float) -> None:
        super().__init__(**params)
        self.run(2.0)
        self.arm()
        assert request(self.v, GUIDED, 2) == 0
        self.rows: list[tuple[float, ...]] = []

    def to(self, n: float, e: float) -> Driver:
        """Go there along a leg."""
        self.ask(n, e)
        return self.follow()

    def ask(self, n: float, e: float) -> None:
        """Ask the shell for a leg to there."""
        path.request_leg(self.ap.modes.nav, self.ap.events, self.v.time_us, Vec3(n, e, 0.0))

    def ask_two(self, corner: Vec3, following: Vec3) -> None:
        """Ask the shell for two legs, joined without a stop."""
        path.request_legs(self.ap.modes.nav, self.ap.events, self.v.time_us, corner, following)

    def run_path(self) -> bool:
        """One period of ``waypoint.follow``; whether the speed limit changed."""
        ap = self.ap
        s = ap.control.speed
        forward_speed.sense(s, ap.estimate, self.v.sensors, self.v.time_us)
        return waypoint.follow(ap.modes.nav, ap.control, ap.estimate, ap.arming.armed, self.v.time_us, ap.params)

    def set_reversed(self, backward: bool) -> None:
        """Drive backwards or forwards."""
        waypoint.set_reversed(self.ap.modes.nav, self.ap.estimate, backward, self.ap.params)

    def follow(self) -> Driver:
        """Let GUIDED drive after what ``waypoint`` has."""
        self.ap.modes.guided.submode = 1
        self.ap.modes.guided.has_target = 1
        PLANNER.serve(self.ap, int(self.v.time_us))
        return self

    def step(self) -> None:
        """One period; a change of speed asks the shell for new legs."""
        super().step()
        if (LEG_ENDING, SPEED_REQUEST, 0.0) in self.events():
            PLANNER.change_speed(self.ap)

    def until_reached(self, most: float = 60.0) -> float:
        """Seconds until the destination is reached; infinity when it is not."""
        for k in range(round(most / 0.02)):
            self.step()
            nav = self.ap.modes.nav
            self.rows.append((*self.position, self.speed, float(nav.pos[0]), float(nav.pos[1])))
            if waypoint.reached(self.ap.modes.nav):
                return 0.02 * (k + 1)
        return math.inf


def test_a_leg_ends_at_its_destination() -> None:
    p = Driver().to(30.0, 0.0)
    assert path.distance(p.ap.modes.nav, p.ap.estimate.pos) == pytest.approx(30.0)
    assert path.bearing(p.ap.modes.nav, p.ap.estimate.pos) == 0.0
    assert p.until_reached() < 20.0
    assert p.position[0] == pytest.approx(30.0, abs=3.0)
    p.run(5.0)
    assert abs(p.speed) < 0.05
    assert p.position[0] == pytest.approx(30.0, abs=1.0)


def test_not_reached_while_the_next_leg_is_planned() -> None:
    p = Driver().to(10.0, 0.0)
    p.until_reached()
    p.ask(20.0, 0.0)
    assert not waypoint.reached(p.ap.modes.nav)
    PLANNER.serve(p.ap, int(p.v.time_us))
    assert not waypoint.reached(p.ap.modes.nav)
    assert p.ap.modes.nav.current.origin[0] == pytest.approx(10.0)  # goes on from the end of the last leg


def test_a_corner_is_rounded_without_a_stop_and_near_the_waypoint() -> None:
    p = Driver()
    p.ask_two(Vec3(25.0, 0.0, 0.0), Vec3(25.0, 25.0, 0.0))
    p.follow()
    assert p.ap.modes.nav.current.fast
    p.until_reached()
    p.to(25.0, 25.0)
    assert p.ap.modes.nav.joined == 1
    p.until_reached()
    rows = np.array(p.rows)
    corner = rows[(np.hypot(rows[:, 0] - 25.0, rows[:, 1]) < 6.0)]
    assert corner[:, 2].min() > 1.5
    target_gap = np.hypot(rows[:, 3] - 25.0, rows[:, 4]).min()
    assert 0.5 < target_gap < 3.3  # WP_RADIUS holds in the middle of the turn
    assert np.hypot(rows[:, 0] - 25.0, rows[:, 1]).min() < 4.0


def test_beyond_the_finish_line_counts_as_reached() -> None:
    p = Driver(WP_RADIUS=0.5).to(10.0, 0.0)
    p.place(12.0, 8.0)
    assert p.until_reached(30.0) < 30.0


def test_crosstrack_is_negative_on_the_right() -> None:
    p = Driver().to(20.0, 0.0)
    p.place(5.0, 2.0)
    p.step()
    assert p.ap.modes.nav.drive.crosstrack == pytest.approx(-2.0, abs=0.05)
    waypoint.stop(p.ap.modes.nav)
    assert p.ap.modes.nav.drive.crosstrack == 0.0


def test_speed_changes_on_the_way_and_not_more_than_twice_a_second() -> None:
    p = Driver().to(100.0, 0.0)
    p.run(8.0)
    assert p.speed > 4.0
    assert waypoint.set_speed(p.ap.modes.nav, 2.0)
    p.run(8.0)
    assert p.speed == pytest.approx(2.0, abs=0.15)
    for wrong in (math.nan, math.inf, 0.0, -1.0, 0.01):
        assert not waypoint.set_speed(p.ap.modes.nav, wrong)
    assert waypoint.top_speed(p.ap.modes.nav, p.ap.params) == 2.0
    for nudge, seen in ((3.0, 3.0), (4.0, 3.0), (1.0, 3.0)):
        p.ap.modes.nav.drive.nudge_speed = nudge
        p.run_path()
        assert p.ap.control.position.speed_max == seen
    p.run(0.6)
    assert p.ap.control.position.speed_max == 2.0
    assert p.until_reached() < 60.0


def test_backwards() -> None:
    p = Driver()
    p.set_reversed(True)
    p.to(-20.0, 0.0)
    p.run(5.0)
    assert p.speed < -1.0
    assert p.position[0] < -2.0
    assert abs(math.degrees(p.heading)) < 10.0
    p.until_reached()
    assert p.position == pytest.approx((-20.0, 0.0), abs=3.0)


def test_a_shaped_destination_may_change_at_any_time() -> None:
    p = Driver()
    for k in range(20):
        nav, place = p.ap.modes.nav, Vec2(10.0 + k, 0.0)
        waypoint.set_destination_shaped(nav, p.ap.estimate, p.v.time_us, place, p.ap.params)
        p.follow()
        p.run(0.2)
    assert p.speed > 1.0
    assert p.until_reached() < 30.0
    assert p.position[0] == pytest.approx(29.0, abs=3.0)


@pytest.mark.parametrize("backward", [False, True])
def test_straight_behind_is_no_way_without_end(backward: bool) -> None:
    """Nothing pushes a car to either side then; it turns all the same."""
    p = Driver()
    p.set_reversed(backward)
    p.to(20.0 if backward else -20.0, 0.0)
    assert p.until_reached() < 40.0


@pytest.mark.parametrize("because", ["disarmed", "no position", "no destination"])
def test_brakes_when_it_cannot_go(because: str) -> None:
    p = Driver().to(50.0, 0.0)
    p.run(6.0)
    if because == "disarmed":
        p.ap.arming.armed = 0
    elif because == "no position":
        p.ap.estimate.position_ok = 0
    else:
        waypoint.stop(p.ap.modes.nav)
    before = float(p.ap.control.speed.desired)
    p.run_path()
    drive = p.ap.modes.nav.drive
    assert 0.0 < drive.desired_speed < before
    assert drive.desired_turn_rate == drive.crosstrack == 0.0


def test_pivot_turn() -> None:
    """A skid-steered vehicle stops, turns on the spot, waits WP_PIVOT_DELAY, goes on; a car never does."""
    assert not pivot.would_turn(math.pi, Driver().ap.params)
    p = Driver(**SKID, WP_PIVOT_DELAY=1.0)
    assert pivot.would_turn(math.radians(61.0), p.ap.params)
    assert not pivot.would_turn(math.radians(59.0), p.ap.params)
    p.to(0.0, 20.0)
    assert pivot.is_active(p.ap.modes.nav.drive, p.ap.params)
    p.run_path()
    assert p.ap.modes.nav.drive.desired_speed == 0.0
    assert 0.0 < p.ap.modes.nav.drive.desired_turn_rate <= math.radians(60.0) + 1e-9
    p.place(0.0, 0.0, math.radians(88.0))
    p.run_path()
    assert pivot.is_active(p.ap.modes.nav.drive, p.ap.params)
    p.v.time_us += 1_100_000
    p.run_path()
    assert not pivot.is_active(p.ap.modes.nav.drive, p.ap.params)


def test_reversed_on_the_way_a_skid_steered_vehicle_turns_round() -> None:
    """Else it would stand for ever with its nose where its tail should go."""
    p = Driver(**SKID).to(60.0, 0.0)
    p.place(10.0, 0.0)
    p.set_reversed(True)
    assert pivot.is_active(p.ap.modes.nav.drive, p.ap.params)
    p.run_path()
    assert abs(p.ap.modes.nav.drive.desired_turn_rate) > 0.5
    pivot.end(p.ap.modes.nav.drive)
    p.set_reversed(True)  # said again, it changes nothing
    assert not pivot.is_active(p.ap.modes.nav.drive, p.ap.params)


@pytest.mark.parametrize(("backward", "turn"), [(False, 1.0), (True, -1.0)])
def test_standing_it_turns_as_for_the_way_it_will_drive(backward: bool, turn: float) -> None:
    """Towards a destination on the right of its nose or, backwards, away from it."""
    p = Driver(**SKID, WP_PIVOT_ANGLE=0.0)
    p.set_reversed(backward)
    p.to(20.0, 5.0)
    for _ in range(100):
        p.run_path()
        p.v.time_us += 20_000
        p.ap.control.tick += 1
    assert p.ap.modes.nav.drive.desired_turn_rate * turn > 0.0


def test_a_pivot_corner_is_a_stop() -> None:
    p = Driver(**SKID)
    p.ask_two(Vec3(20.0, 0.0, 0.0), Vec3(20.0, 20.0, 0.0))
    p.follow()
    assert not p.ap.modes.nav.current.fast
    assert p.ap.modes.nav.drive.pivot_next == 1
    p.ask_two(Vec3(20.0, 0.0, 0.0), Vec3(40.0, 10.0, 0.0))
    p.follow()
    assert p.ap.modes.nav.current.fast


def test_wp_pivot_angle_of_zero_means_none() -> None:
    p = Driver(**SKID, WP_PIVOT_ANGLE=0.0)
    assert not pivot.would_turn(math.pi, p.ap.params)


def test_limits_that_its_motion_does_not_fit_leave_the_leg_as_it_is() -> None:
    p = Driver(ATC_ACCEL_MAX=5.0, WP_ACCEL=5.0, WP_JERK=5.0, WP_SPEED=30.0).to(300.0, 0.0)
    p.run(1.5)
    leg = p.ap.modes.nav.current
    before = float(leg.duration)
    p.ap.params.WP_ACCEL = p.ap.params.WP_JERK = 0.01
    waypoint.set_speed(p.ap.modes.nav, 2.0)
    p.run(1.0)
    assert float(leg.duration) == before


def test_limits() -> None:
    ap = Driver(ATC_ACCEL_MAX=0.0, WP_ACCEL=0.0, WP_JERK=0.0).ap
    assert waypoint.accel_max(ap.params) == waypoint.UNLIMITED
    ap.params.ATC_ACCEL_MAX, ap.params.ATC_DECEL_MAX = 2.0, 1.5
    assert waypoint.accel_max(ap.params) == 1.5
    assert waypoint.jerk_max(ap.params) == 1.5
    ap.params.WP_ACCEL, ap.params.WP_JERK = 0.5, 3.0
    assert (waypoint.accel_max(ap.params), waypoint.jerk_max(ap.params)) == (0.5, 3.0)
    ap.params.TURN_RADIUS = 7.0
    assert waypoint.corner_radius(ap.params) == 7.0


@given(st.floats(-50.0, 50.0), st.floats(-50.0, 50.0), st.floats(-3.0, 3.0))
def test_crosstrack_and_finish_line_turn_with_the_world(n: float, e: float, heading: float) -> None:
    """Seen from the line, it does not matter where it leads."""
    pos, target = Vec2(n, e), Vec2(20.0, 0.0)
    assert waypoint.crosstrack(Vec2(0.0, 0.0), target, pos) == pytest.approx(-e)
    away = waypoint.crosstrack(Vec2(0.0, 0.0), turned(target, heading), turned(pos, heading))
    assert away == pytest.approx(-e, abs=1e-9)
    assert waypoint.has_passed(Vec2(0.0, 0.0), target, pos) == (n >= 20.0)


def test_pivot_on_its_record_alone() -> None:
    drive, params = DriveState(), Parameters()
    for servo, function in ((0, 73.0), (2, 74.0)):
        params.SERVO[servo].FUNCTION = function
    params.WP.PIVOT_ANGLE, params.WP.PIVOT_DELAY = 60.0, 1.0
    pivot.check(drive, 1, math.radians(59.0), False, params)
    assert not drive.pivoting
    pivot.check(drive, 1, math.radians(-61.0), False, params)
    assert pivot.is_active(drive, params)
    pivot.check(drive, 10, 0.01, False, params)
    assert drive.pivoting
    pivot.check(drive, 1_000_010, 0.01, False, params)
    assert not drive.pivoting


@pytest.mark.parametrize("speed", (1.0, 0.0))
def test_wp_speed_that_is_set_on_the_way_acts_when_the_mode_is_entered_again(speed: float) -> None:
    p = Driver(WP_SPEED=5.0).to(100.0, 0.0)
    p.run(4.0)
    p.ap.params.WP_SPEED = speed
    p.run(4.0)
    assert norm2(horizontal(p.ap.estimate.vel)) == pytest.approx(5.0, abs=0.3)
    assert request(p.v, HOLD, 2) == 0
    p.run(5.0)
    assert request(p.v, GUIDED, 2) == 0
    assert waypoint.top_speed(p.ap.modes.nav, p.ap.params) == max(speed, waypoint.SPEED_MIN)


def test_a_command_changes_the_speed_on_the_way() -> None:
    p = Driver(WP_SPEED=5.0).to(100.0, 0.0)
    p.run(4.0)
    assert waypoint.set_speed(p.ap.modes.nav, 2.0)
    p.run(4.0)
    assert norm2(horizontal(p.ap.estimate.vel)) == pytest.approx(2.0, abs=0.1)
