# SPDX-License-Identifier: BSD-3-Clause
"""What FOLLOW takes of other vehicles' GLOBAL_POSITION_INT and FOLLOW_TARGET."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.state import FollowState
from sitl.bridge.copter import setpoints as copter
from sitl.bridge.rover import setpoints as rover
from sitl.bridge.services.follow_target import FollowTarget, follow_target, take_position
from sitl.bridge.telemetry.motion import GlobalPositionInt
from sitl.core.vectors import Vec3
from tests.bridge.fakes import HOME, FakeRover, FakeVehicle, filled

LEAD = 7
NOW_US = 5_000_000
PLACE = {"lat": HOME[0] + 10_000, "lon": HOME[1]}
NORTH = 111.319
"""Of the place, from the origin [m]."""
POSITION, VELOCITY, ACCELERATION, ATTITUDE = 1, 2, 4, 8
"""FOLLOW_TARGET's est_capabilities: attitude stands for body rates, too."""
EAST = (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))
"""Heading of 90 degrees as a quaternion."""


def follower(vehicle: FakeVehicle | None = None, **params: float) -> Any:
    """A vehicle that follows, with home 6 m above its origin."""
    made = vehicle or FakeVehicle()
    made.locate()
    made.v.autopilot.home.alt = HOME[2] + 6.0
    made.v.time_us = NOW_US
    made.parameters.update({"FOLL_ENABLE": 1.0} | params)
    return made.v


def position(**fields: Any) -> GlobalPositionInt:
    return filled(GlobalPositionInt, **PLACE | {"alt": 600_000, "relative_alt": 20_000, "hdg": 9000} | fields)


def target(has: int, **fields: Any) -> FollowTarget:
    numbers = {"vel": (1, 2, 3), "acc": (4, 5, 6), "attitude_q": EAST, "rates": (0.1, 0.2, 0.3)}
    return filled(FollowTarget, **PLACE | numbers | {"alt": 600.0, "est_capabilities": has} | fields)


def about(*numbers: float) -> Any:
    return pytest.approx(numbers, abs=2e-3)


def lead_of(v: Any) -> FollowState:
    found: FollowState = v.autopilot.modes.follow
    return found


def is_taken(v: Any) -> bool:
    lead = lead_of(v)
    assert (lead.sender, lead.update_us) in ((0, 0), (LEAD, NOW_US))
    return lead.sender == LEAD


# ---------------------------------------------------------------------- GLOBAL_POSITION_INT


@pytest.mark.parametrize(("over_home", "down"), [(False, -16.0), (True, -26.0)])
def test_a_height_is_that_above_the_sea_or_that_above_home(over_home: bool, down: float) -> None:
    v = follower()
    take_position(position(vx=100, vy=-250, vz=50), v, LEAD, over_home)
    lead = lead_of(v)
    assert is_taken(v) and not lead.sends_more
    assert tuple(lead.received_pos) == about(NORTH, 0.0, down)
    assert tuple(lead.received_vel) == about(1.0, -2.5, 0.5)
    assert tuple(lead.received_acc) == (0.0, 0.0, 0.0) and lead.received_heading_rate == 0.0


@pytest.mark.parametrize(("kind", "down"), [(0.0, -16.0), (1.0, -26.0), (2.0, -16.0)])
def test_a_copter_takes_the_height_that_its_parameter_names(kind: float, down: float) -> None:
    v = follower(FOLL_ALT_TYPE=kind)
    copter.other_position(position(), v, LEAD)
    assert lead_of(v).received_pos.z == pytest.approx(down)


def test_a_rover_takes_the_height_above_the_sea() -> None:
    v = follower(FakeRover())
    rover.other_position(position(), v, LEAD)
    assert lead_of(v).received_pos.z == pytest.approx(-16.0)


@pytest.mark.parametrize(
    ("told", "heading"), [(0, 0.0), (9000, 90.0), (35_999, 359.99), (36_000, 360.0), (36_001, -1.0), (65_535, -1.0)]
)
def test_a_heading_beyond_a_turn_is_unknown(told: int, heading: float) -> None:
    v = follower()
    lead_of(v).received_heading = math.radians(-1.0)  # that of before
    take_position(position(hdg=told), v, LEAD, False)
    assert math.degrees(lead_of(v).received_heading) == pytest.approx(heading)
    turning = follower(FOLL_OFS_TYPE=1.0)
    take_position(position(hdg=told), turning, LEAD, False)
    assert is_taken(turning) == (heading >= 0.0), "without a heading there is nothing to turn offsets by"


# ---------------------------------------------------------------------- FOLLOW_TARGET


@pytest.mark.parametrize("velocity", [0, VELOCITY])
@pytest.mark.parametrize("acceleration", [0, ACCELERATION])
@pytest.mark.parametrize("attitude", [0, ATTITUDE])
def test_a_lead_is_believed_what_it_can_tell(velocity: int, acceleration: int, attitude: int) -> None:
    v = follower()
    follow_target(target(POSITION | velocity | acceleration | attitude), v, LEAD)
    lead = lead_of(v)
    assert is_taken(v) and lead.sends_more
    assert tuple(lead.received_pos) == about(NORTH, 0.0, -16.0)
    assert lead.received_vel == (Vec3(1.0, 2.0, 3.0) if velocity else Vec3(0.0, 0.0, 0.0))
    assert lead.received_acc == (Vec3(4.0, 5.0, 6.0) if acceleration else Vec3(0.0, 0.0, 0.0))
    assert lead.received_heading == pytest.approx(math.pi / 2 if attitude else 0.0)
    assert lead.received_heading_rate == pytest.approx(0.3 if attitude else 0.0)


def test_the_rate_of_a_leaning_lead_is_that_about_the_vertical() -> None:
    v, half = follower(), math.radians(30.0)
    rolled = (math.cos(half), math.sin(half), 0.0, 0.0)
    follow_target(target(POSITION | ATTITUDE, attitude_q=rolled, rates=(0.0, 0.5, 0.25)), v, LEAD)
    expected = 0.5 * math.sin(2.0 * half) + 0.25 * math.cos(2.0 * half)
    assert lead_of(v).received_heading_rate == pytest.approx(expected)


CANNOT_BE = [
    ("vel", VELOCITY, (0, math.nan, 0)),
    ("acc", ACCELERATION, (math.inf, 0, 0)),
    ("rates", ATTITUDE, (0, 0, math.nan)),
]


@pytest.mark.parametrize(("field", "bit", "numbers"), CANNOT_BE)
def test_numbers_that_cannot_be_spoil_a_report_only_if_they_are_told(field: str, bit: int, numbers: Any) -> None:
    others = POSITION | (VELOCITY | ACCELERATION | ATTITUDE) & ~bit
    for has, taken in ((others | bit, False), (others, True), (POSITION, True)):
        v = follower()
        follow_target(target(has, **{field: numbers}), v, LEAD)
        assert (is_taken(v), lead_of(v).sends_more) == (taken, taken), has


@pytest.mark.parametrize("numbers", [(0, 0, 0, 0), (math.nan, 0, 0, 0)])
def test_an_attitude_that_is_none_is_no_heading(numbers: Any) -> None:
    v = follower()
    follow_target(target(POSITION | ATTITUDE, attitude_q=numbers), v, LEAD)
    assert is_taken(v) and lead_of(v).received_heading == lead_of(v).received_heading_rate == 0.0


def test_who_sends_more_is_followed_by_that_alone() -> None:
    v = follower()
    take_position(position(), v, LEAD, False)
    follow_target(target(POSITION, alt=610.0), v, LEAD)
    take_position(position(), v, LEAD, False)
    assert lead_of(v).received_pos.z == pytest.approx(-26.0)
    follow_target(target(POSITION, alt=620.0), v, LEAD)
    assert lead_of(v).received_pos.z == pytest.approx(-36.0)


# ---------------------------------------------------------------------- both

TAKERS = {
    "GLOBAL_POSITION_INT": lambda v, **fields: take_position(position(**fields), v, LEAD, False),
    "FOLLOW_TARGET": lambda v, **fields: follow_target(target(POSITION, **fields), v, LEAD),
}


@pytest.mark.parametrize("take", TAKERS.values(), ids=TAKERS)
@pytest.mark.parametrize(
    ("params", "fields", "taken"),
    [
        ({}, {}, True),
        ({"FOLL_ENABLE": 0.0}, {}, False),
        ({"FOLL_SYSID": LEAD}, {}, True),
        ({"FOLL_SYSID": LEAD + 1}, {}, False),
        ({}, {"lat": 0, "lon": 0}, False),
        ({}, {"lat": 0}, True),
        ({}, {"lon": 0}, True),
        ({}, {"lat": 900_000_001}, False),
        ({}, {"lon": -1_800_000_001}, False),
    ],
)
def test_whose_reports_are_taken(take: Any, params: Any, fields: dict[str, int], taken: bool) -> None:
    v = follower(**params)
    take(v, **fields)
    assert is_taken(v) == taken
    if not taken:
        assert not lead_of(v).sends_more


@pytest.mark.parametrize("take", TAKERS.values(), ids=TAKERS)
def test_nobody_is_followed_before_there_is_an_origin(take: Any) -> None:
    v = follower()
    v.autopilot.estimate.origin_set = 0
    take(v)
    assert not is_taken(v)


def test_a_target_without_a_position_is_none() -> None:
    v = follower()
    follow_target(target(VELOCITY | ACCELERATION | ATTITUDE), v, LEAD)
    assert not is_taken(v) and not lead_of(v).sends_more
