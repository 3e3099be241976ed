# SPDX-License-Identifier: BSD-3-Clause
"""Items as ArduPilot's storage keeps them: what ArduCopter and ArduRover 4.7 give back."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.mission.item import STORED, MissionItem
from sitl.autopilot.mission.storage import stored, stored_home
from sitl.core.mavlink import MavCmd

HEIGHTS = st.integers(-80000, 80000)
"""Whole metres: of others, single precision may lose a centimetre each time, as in ArduPilot."""
NUMBERS = st.floats(-1e5, 1e5, width=32)


@pytest.mark.parametrize(
    ("turns", "kept"),
    [(2.25, 2.0), (0.1, 0.09765625), (300, 255), (1.004, 1), (0.75, 0.75), (0.003, 0), (255.5, 255), (-1.75, 255)],
)
def test_turns(turns: float, kept: float) -> None:
    assert stored(MissionItem(MavCmd.NAV_LOITER_TURNS, 3, p1=turns, p3=7.0)).p1 == kept


@pytest.mark.parametrize(
    ("radius", "kept"),
    [(7.5, 7), (-7.5, -7), (303, 300), (3000, 2550), (0.4, 0), (255.6, 250), (-300, -300), (256, 250)],
)
def test_radius(radius: float, kept: float) -> None:
    assert stored(MissionItem(MavCmd.NAV_LOITER_TURNS, 3, p1=1.0, p3=radius)).p3 == kept


@pytest.mark.parametrize(("given", "kept"), [(12.345, 12.34), (-12.345, -12.34), (20.0, 20.0), (128.04, 128.03)])
def test_altitudes_are_cut_to_centimetres(given: float, kept: float) -> None:
    assert stored(MissionItem(MavCmd.NAV_WAYPOINT, 3, z=given)).z == pytest.approx(kept, abs=1e-5)


def test_a_waypoint_keeps_its_delay_in_whole_seconds_and_nothing_else() -> None:
    given = MissionItem(MavCmd.NAV_WAYPOINT, 6, 2.25, 7.5, 1.0, math.nan, 350_000_000, 1_490_000_000, 5.0, current=1)
    assert stored(given) == MissionItem(MavCmd.NAV_WAYPOINT, 3, p1=2.0, x=350_000_000, y=1_490_000_000, z=5.0)


def test_an_item_without_a_place_has_frame_0_and_none() -> None:
    given = MissionItem(MavCmd.DO_CHANGE_SPEED, 3, 1.0, 5.5, -1.0, 3.0, 350_000_000, 1_490_000_000, 5.0)
    assert stored(given) == MissionItem(MavCmd.DO_CHANGE_SPEED, 0, 1.0, 5.5, -1.0)


@pytest.mark.parametrize("alt", [583.99994, 584.0, 584.00001])
def test_home_has_the_nearest_centimetre(alt: float) -> None:
    assert stored_home(1, 2, alt).z == 584.0


def test_a_wrapped_height_loses_a_centimetre_when_it_is_kept_again() -> None:
    """ArduPilot multiplies 327.36 m by 100 in single precision, which gives 32735.998 cm, and cuts that off."""
    once = stored(MissionItem(MavCmd.DO_ENGINE_CONTROL, 3, p3=-328.0))
    assert once.p3 == pytest.approx(327.36, abs=1e-4)
    assert stored(once).p3 == pytest.approx(327.35, abs=1e-4)


@given(st.sampled_from(sorted(STORED)), st.tuples(NUMBERS, NUMBERS, NUMBERS, NUMBERS, HEIGHTS))
def test_what_was_read_back_is_kept_as_it_is(command: int, values: tuple[float, ...]) -> None:
    p1, p2, p3, p4, z = values
    if command == MavCmd.NAV_PAYLOAD_PLACE:  # centimetres that wrap at 655.36 m
        p1 = float(round(abs(p1)) % 600)
    elif command == MavCmd.DO_ENGINE_CONTROL:
        p3 = float(round(abs(p3)) % 600)
    once = stored(MissionItem(command, 3, p1, p2, p3, p4, 350_000_001, -1_490_000_001, z))
    assert stored(once) == once


@pytest.mark.parametrize(
    ("radius", "timed", "unlimited"),
    [(30.4, 1.0, 30.0), (0.5, 1.0, 0.0), (0.0, 1.0, 0.0), (-0.5, -1.0, 0.0), (-30.4, -1.0, -30.0)],
)
def test_of_a_stay_for_a_time_the_direction_is_kept_of_one_without_end_the_radius(
    radius: float, timed: float, unlimited: float
) -> None:
    for command, kept in ((MavCmd.NAV_LOITER_TIME, timed), (MavCmd.NAV_LOITER_UNLIM, unlimited)):
        assert stored(MissionItem(command, 3, p1=5.0, p3=radius)).p3 == kept
