# SPDX-License-Identifier: BSD-3-Clause
"""Which commands of missions have a location, by MAVLink's definition of them, and which are navigation commands, by
ArduPilot's rule."""

from __future__ import annotations

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.autopilot.mission.item import COMMANDS, STORED, MissionItem, home_item

HAVE_ONE_HERE_TOO = {30, 92, 191}
"""NAV_CONTINUE_AND_CHANGE_ALT, NAV_GUIDED_ENABLE, DO_GO_AROUND: ArduPilot keeps them with a location (AP_Mission's
``stored_in_location``), which MAVLink's definition does not mention."""
NAVIGATE = {213, 42702, 42703}
"""NAV_SET_YAW_SPEED, NAV_SCRIPT_TIME, NAV_ATTITUDE_TIME: beyond NAV_LAST."""
NOT_IN_MISSIONS = {5000, 5001, 5002, 5003, 5004, 5100}
"""Of fences and rally points."""


@pytest.mark.parametrize("number", sorted(COMMANDS))
def test_a_command_has_a_location_where_mavlink_says_so(number: int) -> None:
    defined = bool(mavlink.enums["MAV_CMD"][number].has_location)
    assert COMMANDS[number].has_location == (defined or number in HAVE_ONE_HERE_TOO)


@pytest.mark.parametrize("number", sorted(COMMANDS))
def test_navigation_commands_are_those_up_to_nav_last_and_three_others(number: int) -> None:
    navigates = number <= mavlink.MAV_CMD_NAV_LAST or number in NAVIGATE
    assert COMMANDS[number].is_nav == navigates == MissionItem(number).is_nav
    assert (number in STORED) == (number not in NOT_IN_MISSIONS)


def test_names_are_their_own_and_short() -> None:
    names = [command.name for number, command in COMMANDS.items() if number not in NOT_IN_MISSIONS]
    assert len(set(names)) == len(names) and all(0 < len(name) <= 20 for name in names)
    assert MissionItem(16).name == "WP" and MissionItem(9999).name == "?" and not MissionItem(9999).is_nav
    assert MissionItem(600, p1=7.0).title == "Tag 0" and MissionItem(16).title == "WP"


@pytest.mark.parametrize(("x", "y", "none"), [(0, 0, True), (1, 0, False), (0, -1, False)])
def test_no_location_is_latitude_and_longitude_zero(x: int, y: int, none: bool) -> None:
    assert MissionItem(16, x=x, y=y).no_location == none


def test_home_is_a_waypoint_above_the_sea() -> None:
    assert home_item(1, 2, 3.0)[:10] == (16, 0, 0.0, 0.0, 0.0, 0.0, 1, 2, 3.0, 1)
