# SPDX-License-Identifier: BSD-3-Clause
"""CIRCLE of the rover at its edges: circles that fit the vehicle, the target that goes round, falling behind."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.modes import ModeReason, ModeResult
from sitl.autopilot.notes import Text
from sitl.autopilot.rover.modes import circle, loiter
from sitl.autopilot.rover.modes.circle import CIRCLE, CIRCLE_ADAPTED, FELL_BEHIND, RADIUS_ENLARGED
from sitl.autopilot.rover.modes.set_mode import request
from sitl.autopilot.rover.modes.state import CircleState
from sitl.core.mavlink import MavSeverity
from sitl.core.vectors import Vec2
from tests.autopilot.rover.modes.driven_rover import Rover


def said(rover: Rover) -> list[tuple[float, float]]:
    """CIRCLE_ADAPTED since the last call: (what, value)."""
    return [(a, b) for code, a, b in rover.events() if code == CIRCLE_ADAPTED]


def on_edge(**values: Any) -> CircleState:
    """A circle of 10 m around the origin, at its northern point."""
    state = CircleState()
    state.radius, state.direction, state.speed, state.at_edge = 10.0, 1.0, 2.0, True
    for name, value in values.items():
        setattr(state, name, value)
    return state


@pytest.mark.parametrize(
    ("radius", "turn", "wanted"), ((0.4, 0.0, 0.1), (0.5, 0.0, 0.2), (20.0, 0.9, 0.9), (0.4, 0.05, 0.1))
)
def test_so_near_to_its_edge_it_is_on_it(radius: float, turn: float, wanted: float) -> None:
    assert circle.tolerance(radius, turn) == wanted


@pytest.mark.parametrize(
    ("radius", "turn", "wanted", "told"),
    (
        (20.0, 0.9, 20.0, False),
        (-20.0, 0.9, 20.0, False),
        (0.0, 0.0, 0.1, False),
        (0.5, 0.9, 0.9, True),
        (0.9, 0.9, 0.9, False),
    ),
)
def test_a_radius_is_one_that_the_vehicle_can_drive(
    rover: Rover, radius: float, turn: float, wanted: float, told: bool
) -> None:
    state = rover.ap.modes.circle
    circle.set_radius(state, rover.ap.events, 5, radius, turn)
    assert state.radius == pytest.approx(wanted)
    assert said(rover) == ([(float(RADIUS_ENLARGED), pytest.approx(wanted))] if told else [])


@pytest.mark.parametrize(
    ("what", "value", "text"),
    (
        (0, 3.456, "Circle: max speed is  3.5"),
        (1, 12.34, "Circle: radius increased to TURN_RADIUS (12.3)"),
        (2, 3.456, "Circle: cannot keep up, slowing to 3.5m/s"),
    ),
)
def test_what_a_circle_says(what: int, value: float, text: str) -> None:
    assert CIRCLE_ADAPTED.notes(None, float(what), value) == [Text(MavSeverity.WARNING, text)]


@pytest.mark.parametrize(
    ("own", "decel", "waypoint", "wanted"),
    (
        (1.5, 0.0, 0.0, 1.5),
        (1.5, 1.2, 0.0, 1.2),
        (1.5, 0.0, 0.7, 0.7),
        (1.5, 0.0, 9.0, 1.5),
        (0.0, 0.0, 0.0, 1.0),
        (0.0, 0.0, 0.4, 0.4),
    ),
)
def test_the_acceleration_of_a_circle(rover: Rover, own: float, decel: float, waypoint: float, wanted: float) -> None:
    p = rover.ap.params
    p.ATC.ACCEL_MAX, p.ATC.DECEL_MAX, p.WP.ACCEL = own, decel, waypoint
    assert circle.acceleration(p) == pytest.approx(wanted)


@pytest.mark.parametrize(("jerk", "wanted"), ((0.0, 0.7), (2.0, 2.0)))
def test_limits_of_a_circle_go_to_the_position_controller(rover: Rover, jerk: float, wanted: float) -> None:
    p, c, state = rover.ap.params, rover.ap.control.position, rover.ap.modes.circle
    p.WP.JERK, p.WP.ACCEL, state.speed = jerk, 0.7, 2.5
    circle.set_limits(c, state, p)
    assert (c.speed_max, c.accel_max, c.jerk_max) == pytest.approx((2.5, 0.7, wanted))


@pytest.mark.parametrize(("choice", "direction"), ((0.0, 1.0), (1.0, -1.0), (2.0, 1.0)))
def test_circ_dir_says_which_way_round(rover: Rover, choice: float, direction: float) -> None:
    rover.ap.params.CIRC.DIR, rover.ap.params.CIRC.RADIUS = choice, 10.0
    rover.place(3.0, 4.0, 0.5)
    assert circle.start(rover.v) == ModeResult.ACCEPTED
    state = rover.ap.modes.circle
    assert (state.direction, state.centre, state.angle) == (direction, (3.0, 4.0), pytest.approx(0.5))
    assert state.target == pytest.approx((3.0 + 10.0 * math.cos(0.5), 4.0 + 10.0 * math.sin(0.5)))


@pytest.mark.parametrize(("own", "wanted"), ((0.0, 5.0), (2.0, 2.0)))
def test_the_speed_of_a_circle_is_circ_speed_or_wp_speed(rover: Rover, own: float, wanted: float) -> None:
    rover.ap.params.CIRC.SPEED, rover.ap.params.CIRC.RADIUS = own, 30.0
    circle.start(rover.v)
    assert rover.ap.modes.circle.speed == pytest.approx(wanted)


def test_without_an_origin_there_is_no_circle(rover: Rover) -> None:
    rover.ap.estimate.origin_set = 0
    assert circle.start(rover.v) == loiter.start(rover.v) == ModeResult.INIT_FAILED


@pytest.mark.parametrize("direction", (1.0, -1.0))
def test_the_target_goes_round_with_its_acceleration_and_speed(rover: Rover, direction: float) -> None:
    state = on_edge(direction=direction)
    moves = [circle.advance(state, 1.0, rover.ap.estimate) for _ in range(300)]
    assert moves[0].vel == pytest.approx((0.0, 0.01 * direction), abs=1e-4), "half of the acceleration, for 20 ms"
    assert moves[0].acc.y == pytest.approx(0.5 * direction, abs=1e-3)
    last = moves[-1]
    assert math.hypot(*last.vel) == pytest.approx(2.0) and math.hypot(*last.acc) == pytest.approx(2.0 * 2.0 / 10.0)
    assert last.pos.x * last.vel.x + last.pos.y * last.vel.y == pytest.approx(0.0, abs=1e-9)
    assert last.pos.x * last.acc.x + last.pos.y * last.acc.y == pytest.approx(-4.0), "inwards"
    assert state.total * direction > 0.0 and circle.turns(state) == pytest.approx(abs(state.total) / math.tau)
    assert state.target == last.pos and math.hypot(*last.pos) == pytest.approx(10.0)


def test_a_target_that_waits_stays_beside_the_vehicle(rover: Rover) -> None:
    rover.place(0.0, 5.0)
    state = on_edge(waiting=True, total=1.0)
    circle.advance(state, 1.0, rover.ap.estimate)
    assert (state.angle, state.total) == (pytest.approx(math.pi / 2), 1.0)
    assert state.target == pytest.approx((0.0, 10.0), abs=1e-9)


@pytest.mark.parametrize(
    ("north", "waits_before", "behind", "waits", "speed"),
    (
        (12.1, False, True, True, 1.6),  # twice the tolerance of 1 m
        (11.9, False, False, False, 2.0),
        (8.1, False, False, False, 2.0),
        (7.9, False, True, True, 1.6),
        (12.1, True, False, True, 2.0),
        (11.1, True, False, True, 2.0),
        (10.9, True, False, False, 2.0),  # near again
    ),
)
def test_a_vehicle_that_falls_behind_gets_a_slower_circle(
    rover: Rover, north: float, waits_before: bool, behind: bool, waits: bool, speed: float
) -> None:
    rover.place(north, 0.0)
    state = on_edge(waiting=waits_before)
    assert circle.follow(state, rover.ap.control.position, rover.ap.estimate, 1.0) is behind
    assert (bool(state.waiting), state.speed) == (waits, pytest.approx(speed))


@pytest.mark.parametrize(("north", "there"), ((11.0, True), (11.01, False)))
def test_first_it_drives_to_the_edge(rover: Rover, north: float, there: bool) -> None:
    rover.place(north, 0.0)
    state = on_edge(at_edge=False, target=Vec2(10.0, 0.0))
    assert not circle.follow(state, rover.ap.control.position, rover.ap.estimate, 1.0)
    assert bool(state.at_edge) == there and state.total == 0.0


def test_falling_behind_is_told_with_the_new_speed(rover: Rover) -> None:
    assert request(rover.v, CIRCLE, ModeReason.GCS) == 0
    state = rover.ap.modes.circle
    state.at_edge, state.speed = True, 2.0
    rover.place(500.0, 0.0)
    rover.events()
    rover.step()
    assert said(rover) == [(float(FELL_BEHIND), pytest.approx(1.6))]


def test_without_a_position_a_circle_stops(rover: Rover) -> None:
    assert request(rover.v, CIRCLE, ModeReason.GCS) == 0
    rover.place(0.0, 0.0, speed=2.0)
    rover.ap.estimate.position_ok = 0
    rover.ap.control.motors.steering = 0.7
    circle.run(rover.v)
    assert rover.ap.control.motors.steering == 0.0


@pytest.mark.parametrize(
    ("wanted", "taken", "limit_raised"),
    ((3.0, True, True), (1.0, True, False), (0.0, False, False), (-1.0, False, False)),
)
def test_a_circle_takes_a_new_speed(rover: Rover, wanted: float, taken: bool, limit_raised: bool) -> None:
    rover.ap.params.CIRC.SPEED = 2.0
    assert request(rover.v, CIRCLE, ModeReason.GCS) == 0
    assert circle.change_speed(rover.v, wanted) is taken
    assert rover.ap.modes.circle.speed == pytest.approx(wanted if taken else 2.0)
    assert rover.ap.control.position.speed_max == pytest.approx(wanted if limit_raised else 2.0)
