# SPDX-License-Identifier: BSD-3-Clause
"""DOCK and FOLLOW of the rover: conditions to enter, the line to the dock, where it stops, and keeping to a lead."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.followed_vehicle import FOLLOW_OFF, FOLLOW_OFFSET
from sitl.autopilot.rover.control import position, speed
from sitl.autopilot.rover.modes import dock, drive, follow
from sitl.autopilot.rover.modes.dock import DOCK_DID, lead_in, slowed
from sitl.autopilot.rover.modes.mode import POSITION_TO_HOLD
from sitl.core.vectors import Vec2, Vec3
from tests.autopilot.rover.modes.driven_rover import Rover


def told(rover: Rover, event: Any) -> list[tuple[float, float]]:
    """(a, b) of the events of a kind since the last call."""
    return [(a, b) for code, a, b in rover.events() if code == int(event)]


def docking(n: float = 10.0, e: float = 0.0, **params: float) -> Rover:
    """A rover at the origin, heading north, that sees a dock; in DOCK."""
    rover = Rover()
    p = rover.ap.params
    p.PLND.ENABLED, p.DOCK.STOP_DIST, p.DOCK.HDG_CORR_EN = 1.0, 0.3, 0.0
    for name, value in params.items():
        setattr(p.DOCK, name, value)
    rover.ap.landing_target.acquired, rover.ap.landing_target.away = True, Vec2(n, e)
    rover.events()
    return rover


@pytest.mark.parametrize(
    ("enabled", "seen", "corrects", "direction", "said"),
    (
        (1.0, True, 0.0, -1.0, []),
        (0.0, True, 0.0, -1.0, [(dock.NO_TARGET, 0.0)]),
        (1.0, False, 0.0, -1.0, [(dock.NO_TARGET, 0.0)]),
        (1.0, True, 1.0, -1.0, [(dock.NO_DIRECTION, 0.0)]),
        (1.0, True, 1.0, 0.0, []),
    ),
)
def test_a_dock_must_be_seen_and_its_direction_be_known(enabled, seen, corrects, direction, said):
    rover = docking(HDG_CORR_EN=corrects, DIR=direction)
    rover.ap.params.PLND.ENABLED, rover.ap.landing_target.acquired = enabled, seen
    rover.ap.modes.dock.done = True
    assert (dock.start(rover.v) == 0) == (not said)
    assert told(rover, DOCK_DID) == said
    assert bool(rover.ap.modes.dock.done) == bool(said)


@pytest.mark.parametrize(("asked", "used"), ((2.0, 2.0), (0.0, 5.0)))
def test_its_speed_is_that_of_dock_speed_or_of_wp_speed(asked: float, used: float) -> None:
    rover = docking(SPEED=asked)
    dock.start(rover.v)
    assert rover.ap.control.position.speed_max == used


@pytest.mark.parametrize(("orient", "backwards"), ((0.0, False), (4.0, True), (5.0, False)))
def test_a_sensor_that_looks_back_docks_in_reverse(orient: float, backwards: bool) -> None:
    rover = docking()
    rover.ap.params.PLND.ORIENT = orient
    dock.start(rover.v)
    assert bool(rover.ap.control.position.reversed) == backwards


@pytest.mark.parametrize(
    ("distance", "seen", "located", "arrives"),
    (
        (0.31, True, True, False),
        (0.3, True, True, True),
        (0.3, True, False, False),
        (2.9, False, True, True),  # lost on the last part
        (3.0, False, True, False),
        (2.9, True, True, False),
    ),
)
def test_where_it_has_arrived(distance: float, seen: bool, located: bool, arrives: bool) -> None:
    rover = docking(distance)
    dock.start(rover.v)
    state = rover.ap.modes.dock
    state.pos = Vec2(distance, 0.0)
    rover.ap.landing_target.acquired = seen
    rover.set_estimate(located)
    dock.run(rover.v)
    assert bool(state.done) == arrives
    assert told(rover, DOCK_DID) == ([(dock.ARRIVED, 0.0)] if arrives else [])
    dock.run(rover.v)
    assert told(rover, DOCK_DID) == []
    assert dock.destination(rover.ap.modes) == (POSITION_TO_HOLD, state.pos)


@pytest.mark.parametrize(
    ("done", "located", "drives"), ((False, True, True), (True, True, False), (False, False, False))
)
def test_when_it_drives_and_when_it_stops(done, located, drives, monkeypatch):
    rover = docking()
    dock.start(rover.v)
    rover.ap.modes.dock.done = done
    rover.set_estimate(located)
    ran: list[str] = []
    monkeypatch.setattr(speed, "stop", lambda *args: ran.append("stop"))
    monkeypatch.setattr(position, "follow_target", lambda *args: ran.append("target"))
    monkeypatch.setattr(drive, "turn", lambda *args: ran.append("turn"))
    monkeypatch.setattr(drive, "on_path", lambda *args: ran.append("speed"))
    dock.run(rover.v)
    assert ran == (["target", "turn", "speed"] if drives else ["stop"])


@pytest.mark.parametrize(
    ("away", "direction", "weight", "lead"),
    (
        ((10.0, 0.0), 0.0, 0.75, (7.5, 0.0)),
        ((10.0, 5.0), 0.0, 0.75, (7.5, 0.0)),
        ((-10.0, 5.0), 0.0, 0.5, (5.0, 0.0)),  # a dock entered to the north is approached from the south
        ((0.0, -8.0), 90.0, 0.75, (0.0, 6.0)),
    ),
)
def test_it_aims_before_the_dock_on_the_line_of_dock_dir(away, direction, weight, lead):
    rover = docking(HDG_CORR_EN=1.0, DIR=direction, HDG_CORR_WT=weight)
    found = lead_in(Vec2(*away), math.hypot(*away), rover.ap.params)
    assert (found.x, found.y) == pytest.approx(lead, abs=1e-12)


def test_the_last_part_is_straight() -> None:
    rover = docking(HDG_CORR_EN=1.0, DIR=0.0, HDG_CORR_WT=0.75)
    assert tuple(lead_in(Vec2(2.9, 0.0), 2.9, rover.ap.params)) == (0.0, 0.0)
    assert lead_in(Vec2(3.0, 0.0), 3.0, rover.ap.params).x > 0.0
    rover.ap.params.DOCK.HDG_CORR_EN = 0.0
    assert tuple(lead_in(Vec2(10.0, 0.0), 10.0, rover.ap.params)) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("wanted", "aside", "distance", "used"),
    (
        (2.0, 0.0, 1.0, 2.0),
        (2.0, 0.1, 5.0, 1.0),
        (2.0, -0.1, 5.0, 1.0),
        (-2.0, 0.1, 5.0, -1.0),
        (2.0, 0.1, 10.0, 1.5),  # counts half at 10 m
        (2.0, 0.1, 15.0, 2.0),
        (2.0, 0.1, 30.0, 2.0),
        (2.0, 9.0, 1.0, 0.5),
        (-2.0, 9.0, 1.0, -0.5),
        (0.4, 9.0, 1.0, 0.4),
        (0.6, 9.0, 1.0, 0.5),
    ),
)
def test_out_of_line_it_is_slow_near_the_dock(wanted: float, aside: float, distance: float, used: float) -> None:
    assert slowed(wanted, aside, distance) == pytest.approx(used)


def following(**params: float) -> Rover:
    """A rover at the origin behind a lead that is 20 m north and drives east at 2 m/s."""
    rover = Rover()
    p = rover.ap.params
    p.FOLL.ENABLE, p.FOLL.OFS_X, p.FOLL.POS_P, p.FOLL.TIMEOUT = 1.0, -5.0, 0.1, 3.0
    p.FOLL.ACCEL_NE = 0.0  # the motion reported, as it is
    p.WP.SPEED = 4.0
    for name, value in params.items():
        setattr(p.FOLL, name, value)
    lead = rover.ap.modes.follow
    lead.sender, lead.update_us = 2, int(rover.v.time_us)
    lead.received_pos, lead.received_vel = Vec3(20.0, 0.0, 0.0), Vec3(0.0, 2.0, 0.0)
    rover.events()
    return rover


def driven(rover: Rover, monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """What one period asks for: ("stop",), or the heading [rad] and the speed [m/s]."""
    asked: list[Any] = []
    monkeypatch.setattr(speed, "stop", lambda *args: asked.append("stop"))
    monkeypatch.setattr(drive, "turn_to", lambda control, est, sticks, heading, p: asked.append(heading))
    monkeypatch.setattr(drive, "at_speed", lambda v, desired: asked.append(desired))
    follow.run(rover.v)
    return asked


def test_it_drives_with_the_lead_and_faster_the_further_its_side_is(monkeypatch: pytest.MonkeyPatch) -> None:
    vel = (0.1 * 15.0, 2.0)
    assert driven(following(), monkeypatch) == pytest.approx([math.atan2(vel[1], vel[0]), math.hypot(*vel)])


def test_it_is_no_faster_than_wp_speed(monkeypatch: pytest.MonkeyPatch) -> None:
    vel = (1.0 * 15.0, 2.0)
    assert driven(following(POS_P=1.0), monkeypatch) == pytest.approx([math.atan2(vel[1], vel[0]), 4.0])
    assert tuple(follow.limited(Vec2(3.0, 4.0), 5.0)) == (3.0, 4.0)
    assert tuple(follow.limited(Vec2(6.0, 8.0), 5.0)) == pytest.approx((3.0, 4.0))


def test_it_stops_without_a_lead_and_where_nothing_is_left_to_drive(monkeypatch: pytest.MonkeyPatch) -> None:
    rover = following()
    rover.v.time_us += 3_000_001
    assert driven(rover, monkeypatch) == ["stop"]
    rover = following(OFS_X=-20.0)
    rover.ap.modes.follow.received_vel = Vec3(0.0, 0.0, 0.0)
    assert driven(rover, monkeypatch) == ["stop"]
    for vel in ((0.0, 1.0), (1.0, 0.0)):
        rover = following(OFS_X=-20.0)
        rover.ap.modes.follow.received_vel = Vec3(*vel, 0.0)
        assert driven(rover, monkeypatch) == pytest.approx([math.atan2(vel[1], vel[0]), 1.0])


def test_without_offsets_it_keeps_its_distance_and_says_so_once(monkeypatch: pytest.MonkeyPatch) -> None:
    rover = following(OFS_X=0.0, OFS_TYPE=1.0)
    assert driven(rover, monkeypatch) == pytest.approx([0.5 * math.pi, 2.0])
    assert told(rover, FOLLOW_OFFSET) == [(1.0, 0.0)]
    driven(rover, monkeypatch)
    assert told(rover, FOLLOW_OFFSET) == []


def test_foll_enable_must_be_set() -> None:
    rover = following(ENABLE=0.0)
    assert follow.start(rover.v) != 0
    assert told(rover, FOLLOW_OFF) == [(0.0, 0.0)]
    rover.ap.params.FOLL.ENABLE = 1.0
    rover.ap.modes.follow.is_known = rover.ap.modes.follow.keeps_distance = True
    assert follow.start(rover.v) == 0
    assert not rover.ap.modes.follow.is_known and not rover.ap.modes.follow.keeps_distance
