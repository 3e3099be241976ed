# SPDX-License-Identifier: BSD-3-Clause
"""Take-off by command and by stick: when the vehicle has left the ground, how it climbs, when it is done."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.copter.control import altitude_start
from sitl.autopilot.copter.control.spool import DesiredSpoolState, SpoolState
from sitl.autopilot.copter.control.state import AltitudeState
from sitl.autopilot.copter.modes import takeoff
from sitl.autopilot.copter.modes.takeoff import TAKEOFF_COMPLETE
from tests.autopilot.copter.modes.obedient_copter import move, standing, ticks, turn_body
from tests.autopilot.copter.steady_copter import told

GUIDED = "GUIDED"


def begun(height: float = 5.0, spool: int = SpoolState.THROTTLE_UNLIMITED, **waypoint: float) -> Any:
    """A vehicle on the ground that was told to take off; ``waypoint``: parameters WP_*."""
    v = standing(GUIDED, spool)
    ap = v.autopilot
    for name, value in waypoint.items():
        ap.params.WP[name] = value
    takeoff.begin(ap.modes.takeoff, -height, True, ap.control, ap.estimate, ap.params)
    return v


@pytest.mark.parametrize(("armed", "commanded", "spool"), ((0, 1, 0), (1, 0, 1), (1, 1, 2)))
def test_it_rests_until_it_is_armed_and_told_to_fly(armed: int, commanded: int, spool: int) -> None:
    v = begun(spool=SpoolState.GROUND_IDLE)
    v.autopilot.arming.armed, v.autopilot.arming.auto_armed = armed, commanded
    ticks(v, takeoff.run)
    assert v.autopilot.control.motors.desired_spool == spool
    assert v.autopilot.control.attitude.throttle_in == 0.0 and v.autopilot.arming.landed


def test_while_the_motors_spool_up_it_stays_level_and_keeps_its_heading() -> None:
    v = begun(spool=SpoolState.SPOOLING_UP)
    turn_body(v, 0.0, 0.0, 0.8)
    v.autopilot.control.attitude.target_q = v.autopilot.control.attitude.target_q.replace(w=1.0, z=0.0)
    ticks(v, takeoff.run, 50)
    control = v.autopilot.control
    assert control.attitude.target_euler == pytest.approx((0.0, 0.0, 0.8), abs=1e-6)
    assert control.attitude.throttle_in == pytest.approx(0.0, abs=1e-6) and v.autopilot.arming.landed
    assert (control.pos_d.vel_desired, control.pos_ne.vel_desired) == (0.0, (0.0, 0.0))


@pytest.mark.parametrize(("slew", "seconds"), ((2.0, 2.0), (1.0, 1.0), (0.0, 0.1), (-1.0, 0.1)))
def test_the_throttle_rises_in_tkoff_slew_time_but_no_faster_than_in_a_tenth(slew: float, seconds: float) -> None:
    v = begun()
    v.autopilot.params.TKOFF.SLEW_TIME = slew
    ticks(v, takeoff.run, 20)
    assert v.autopilot.control.attitude.throttle_in == pytest.approx(20 * 0.0025 / seconds)


@pytest.mark.parametrize(
    ("throttle", "accel_d", "most", "lifts"),
    (
        (0.9, 0.0, 1.0, True),  # never waits for more than 0.9
        (0.89, 0.0, 1.0, False),
        (0.5, 0.0, 0.5, True),
        (0.49, 0.0, 0.5, False),
        (0.1, -1.25, 0.9, True),  # half of the acceleration limit, up
        (0.1, -1.24, 0.9, False),
    ),
)
def test_it_has_thrust_at_tkoff_thr_max_or_when_it_accelerates(
    throttle: float, accel_d: float, most: float, lifts: bool
) -> None:
    assert takeoff.has_thrust(throttle, accel_d, 2.5, most) == lifts


@pytest.mark.parametrize(("climb", "lifted"), ((0.24, False), (0.25, True), (1.0, True), (-1.0, False)))
def test_by_command_it_has_left_the_ground_at_a_tenth_of_its_climb_speed(climb: float, lifted: bool) -> None:
    v = begun()
    move(v, 0.0, 0.0, -climb)
    ticks(v, takeoff.run)
    assert bool(v.autopilot.arming.landed) != lifted


def by_stick(climb: float, height: float = 0.0) -> Any:
    """A take-off of ALT_HOLD with a stick that asks for ``climb`` [m/s], PILOT_TKOFF_ALT ``height`` [m]."""
    v = standing("ALT_HOLD", SpoolState.THROTTLE_UNLIMITED)
    ap = v.autopilot
    altitude_start.set_max_speed_accel_d(ap.control.pos_d, ap.params.PSC, 1.5, 2.0, 2.5)
    takeoff.begin_user(ap.modes.takeoff, height, ap.control, ap.estimate, ap.params)
    return v


def lifts_off(v: Any, climb: float) -> bool:
    ap = v.autopilot
    return bool(takeoff.lift_off_user(ap.modes.takeoff, climb, ap.control, ap.estimate, ap.params))


@pytest.mark.parametrize(
    ("asked", "speed", "lifted"),
    (
        (0.5, 0.49, False),
        (0.5, 0.5, True),
        (0.0, 0.19, False),  # a tenth of the fastest at the least
        (0.0, 0.2, True),
        (2.0, 0.99, False),  # half of it at the most
        (2.0, 1.0, True),
    ),
)
def test_by_stick_it_has_left_the_ground_at_the_speed_asked_for(asked: float, speed: float, lifted: bool) -> None:
    v = by_stick(asked)
    move(v, 0.0, 0.0, -speed)
    assert lifts_off(v, asked) == lifted


@pytest.mark.parametrize(("height", "risen", "lifted"), ((1.0, 0.5, False), (1.0, 0.51, True), (0.0, 5.0, False)))
def test_by_stick_it_has_left_the_ground_half_way_up(height: float, risen: float, lifted: bool) -> None:
    v = by_stick(1.0, height)
    v.autopilot.estimate.pos = v.autopilot.estimate.pos.replace(z=-risen)
    assert lifts_off(v, 1.0) == lifted


def test_by_stick_it_lifts_off_with_thrust() -> None:
    v = by_stick(1.0)
    v.autopilot.params.TKOFF.THR_MAX = 0.6
    v.autopilot.control.attitude.throttle_in = 0.599
    assert lifts_off(v, 1.0)


@pytest.mark.parametrize(
    ("height", "climb", "at", "goes_on"),
    ((2.0, 1.0, 1.99, True), (2.0, 1.0, 2.0, False), (2.0, -0.1, 0.5, False), (2.0, 0.0, 0.5, True)),
)
def test_a_climb_by_stick_ends_at_its_height_or_with_the_stick_low(
    height: float, climb: float, at: float, goes_on: bool
) -> None:
    v = by_stick(climb, height)
    ap = v.autopilot
    ap.estimate.pos = ap.estimate.pos.replace(z=-at)
    ap.control.pos_d.pos_desired = -at
    takeoff.climb_user(ap.modes.takeoff, climb, ap.control, ap.estimate, ap.params)
    assert bool(ap.modes.takeoff.user_active) == goes_on
    assert ap.control.pos_d.last_tick == ap.control.tick


def test_it_climbs_to_its_height_says_so_once_and_stays() -> None:
    v = begun(3.0)
    ap = v.autopilot
    ap.arming.landed, ap.control.pos_d.jerk_max, ap.control.pos_d.accel_max = 0, 50.0, 5.0
    ticks(v, takeoff.run, 900)
    assert ap.modes.takeoff.complete and -ap.estimate.pos.z == pytest.approx(3.0, abs=0.05)
    heights = [a for a, _ in told(v, TAKEOFF_COMPLETE)]
    assert len(heights) == 1 and heights[0] == pytest.approx(3.0, abs=0.1)
    assert ap.control.motors.desired_spool == DesiredSpoolState.THROTTLE_UNLIMITED


@pytest.mark.parametrize(
    ("least", "landed", "drifts"), ((2.0, True, True), (0.0, True, False), (2.0, False, False), (-1.0, True, False))
)
def test_below_wp_navalt_min_it_does_not_hold_its_position(least: float, landed: bool, drifts: bool) -> None:
    v = standing(GUIDED, SpoolState.THROTTLE_UNLIMITED)
    ap = v.autopilot
    ap.params.WP.NAVALT_MIN = least
    takeoff.begin(ap.modes.takeoff, -10.0, landed, ap.control, ap.estimate, ap.params)
    ap.arming.landed = 0
    ap.estimate.pos = ap.estimate.pos.replace(x=3.0, z=-1.0)  # blown away
    ap.control.pos_ne.last_tick = ap.control.tick
    ap.control.tick += 1
    takeoff.run(v)
    assert (ap.control.pos_ne.pos_desired[0] == pytest.approx(3.0)) == drifts


def test_the_height_of_wp_navalt_min_counts_from_where_it_stood_last() -> None:
    v = begun(NAVALT_MIN=2.0)
    ap = v.autopilot
    assert ap.modes.takeoff.no_nav_d == -2.0
    ap.arming.auto_armed, ap.estimate.pos = 0, ap.estimate.pos.replace(z=1.5)
    takeoff.run(v)
    assert ap.modes.takeoff.no_nav_d == -0.5


@pytest.mark.parametrize(
    ("left", "climb", "done"),
    ((0.0, 0.0, True), (0.012, 0.24, True), (0.013, 0.24, False), (0.0, 0.25, False), (-0.5, -0.1, True)),
)
def test_it_is_done_near_its_height_at_less_than_a_tenth_of_its_speed(left: float, climb: float, done: bool) -> None:
    """``left`` [m] to climb, at ``climb`` [m/s]: 0.25^2 / (2 x 2.5) = 0.0125 m stop a tenth of 2.5 m/s."""
    path = AltitudeState()
    path.speed_up, path.accel_max, path.pos_desired, path.vel_desired = 2.5, 2.5, -10.0 + left, -climb
    assert takeoff.is_done(path, -10.0) == done


def test_the_end_of_a_take_off_reckons_with_a_tenth_of_acceleration_at_least() -> None:
    path = AltitudeState()
    path.speed_up, path.accel_max, path.pos_desired = 1.0, 0.0, -9.951
    assert takeoff.is_done(path, -10.0) and math.isclose(0.5 * 0.1 * 0.1 / 0.1, 0.05)
    path.pos_desired = -9.949
    assert not takeoff.is_done(path, -10.0)


def test_a_climb_by_stick_follows_its_path_with_the_speed_of_the_stick_and_no_acceleration() -> None:
    v = by_stick(0.0, 2.0)
    ap = v.autopilot
    ap.estimate.pos = ap.estimate.pos.replace(z=-2.0)
    path = ap.control.pos_d
    path.pos_desired, path.vel_desired, path.accel_desired, path.jerk_max = -2.0, -0.7, 0.0, 5.0
    takeoff.climb_user(ap.modes.takeoff, 0.7, ap.control, ap.estimate, ap.params)
    assert path.accel_desired == pytest.approx(0.0, abs=0.005), "the jerk would allow 0.0125"
    assert path.vel_desired == pytest.approx(-0.7)
