# SPDX-License-Identifier: BSD-3-Clause
"""Which items are taken and with what result the others are refused."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.mission.item import COMMANDS, MissionItem
from sitl.autopilot.mission.mission import Mission, MissionError
from sitl.autopilot.mission.storage import stored
from sitl.autopilot.mission.validate import LOCATION_FRAMES, MAX_ITEMS, check, check_all, check_count
from sitl.core.mavlink import MavCmd

WP = MissionItem(MavCmd.NAV_WAYPOINT, x=-353632621, y=1491652371, z=10.0)

CASES = [
    (WP, 0),
    (WP._replace(p1=math.nan), 6),
    (WP._replace(p2=math.nan), 7),
    (WP._replace(p3=math.nan), 8),
    (WP._replace(p4=math.nan), 0),
    (WP._replace(p4=math.inf), 9),
    (WP._replace(command=MavCmd.NAV_TAKEOFF, p4=math.nan), 0),
    (WP._replace(command=MavCmd.NAV_LAND, p4=math.nan), 0),
    (WP._replace(command=MavCmd.NAV_LOITER_UNLIM, p4=math.nan), 0),
    (WP._replace(command=MavCmd.NAV_LOITER_TIME, p4=math.nan), 9),
    (WP._replace(command=MavCmd.NAV_LOITER_TURNS, p1=math.nan), 6),
    (WP._replace(command=MavCmd.DO_JUMP, p2=math.nan), 7),
    (WP._replace(command=MavCmd.DO_CHANGE_SPEED, p1=math.inf), 6),
    (WP._replace(command=84, p4=math.nan), 0),
    (WP._replace(command=85, p3=math.nan, p4=math.nan), 0),
    (WP._replace(command=85, p3=math.inf), 8),
    (WP._replace(command=82, p4=math.nan), 9),
    (WP._replace(command=36, p2=math.nan, p3=math.nan, p4=math.nan), 0),
    (WP._replace(command=83), 0),
    (WP._replace(command=23), 3),
    (WP._replace(command=0), 5),
    (WP._replace(command=1), 5),
    (WP._replace(command=5001), 3),
    (WP._replace(command=23, p1=math.nan), 6),
    (WP._replace(x=900000001), 10),
    (WP._replace(y=-1800000001), 11),
    (WP._replace(z=math.nan), 12),
    (WP._replace(z=math.inf), 12),
    (WP._replace(z=83000.0), 12),
    (WP._replace(frame=1), 2),
    (WP._replace(frame=8), 2),
    (MissionItem(MavCmd.DO_JUMP, frame=1, p1=1.0), 0),
    (MissionItem(MavCmd.NAV_RETURN_TO_LAUNCH, frame=99), 0),
    (MissionItem(MavCmd.DO_JUMP), 1),
    (MissionItem(MavCmd.DO_JUMP, p1=-1.0), 1),
    (MissionItem(MavCmd.DO_CHANGE_SPEED, p2=5.0, x=2**31 - 1, z=math.nan), 0),
]


@pytest.mark.parametrize(("item", "result"), CASES)
def test_check(item: MissionItem, result: int) -> None:
    """MAV_MISSION_RESULT of good and bad items."""
    assert check(item) == result


@pytest.mark.parametrize("frame", [0, 2, 3, 5, 6, 10, 11])
def test_frames(frame: int) -> None:
    """The frames that ArduPilot takes for places."""
    assert check(WP._replace(frame=frame)) == 0
    assert frame in LOCATION_FRAMES


def test_count() -> None:
    """A mission that does not fit is refused before any item is sent."""
    assert check_count(MAX_ITEMS) == 0
    assert check_count(MAX_ITEMS + 1) == 4
    assert check_all([WP] * (MAX_ITEMS + 1))[0] == 4
    assert check_all([WP, WP._replace(command=999)]) == (3, 1)
    assert check_all([]) == (0, -1)


def test_jumps_lead_to_an_item_that_is_there() -> None:
    assert check_all([WP, WP, MissionItem(MavCmd.DO_JUMP, p1=2.0)]) == (0, -1)
    assert check_all([WP, WP, MissionItem(MavCmd.DO_JUMP, p1=3.0)]) == (1, 2)
    assert check_all([WP, MissionItem(MavCmd.DO_JUMP, p1=2.0), WP]) == (0, -1)


REALS = (MavCmd.DO_DIGICAM_CONFIGURE, MavCmd.NAV_SCRIPT_TIME)
"""Keep what is no number: the one where a height stands, the other beyond half precision."""
anything = st.one_of(st.floats(), st.just(0.0))
items = st.builds(
    MissionItem,
    st.one_of(st.sampled_from(sorted(COMMANDS)), st.integers(0, 65535)),
    st.integers(0, 255),
    anything,
    anything,
    anything,
    anything,
    st.integers(-(2**31), 2**31 - 1),
    st.integers(-(2**31), 2**31 - 1),
    anything,
)


@given(items)
def test_any_item_has_a_result(item: MissionItem) -> None:
    """No item on the wire breaks the check, and of an accepted one only numbers are kept."""
    result = check(item)
    assert 0 <= result <= 14
    if result == 0:
        kept = stored(item)
        assert all(math.isfinite(p) for p in (kept.p1, kept.p2, kept.p3, kept.p4, kept.z)) or item.command in REALS
        assert item.command in COMMANDS


def test_mission_names_what_it_refuses() -> None:
    """The error says which item, which command, and why."""
    with pytest.raises(MissionError) as caught:
        Mission.of([WP, WP._replace(command=999)])
    assert str(caught.value) == "mission item 1 (command 999, frame 3): unsupported command"
    assert (caught.value.result, caught.value.seq) == (3, 1)


def test_item_0_is_home_and_is_not_flown() -> None:
    mission = Mission.of([WP, WP])
    assert mission.get(0) is None
    assert mission.get(2) is None
    assert mission.get(1) == WP
