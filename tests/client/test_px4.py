# SPDX-License-Identifier: BSD-3-Clause
"""What PX4 does otherwise: numbers of modes, encodings, missions without home."""

from __future__ import annotations

import pytest

from sitl.autopilot.mission.item import MissionItem, home_item
from sitl.bridge.dialect import message
from sitl.client import px4
from sitl.client.telemetry import Telemetry
from sitl.core.mavlink import MavAutopilot
from sitl.errors import OptionError

HEARTBEAT, VALUE, REACHED = (message(name) for name in ("HEARTBEAT", "PARAM_VALUE", "MISSION_ITEM_REACHED"))


def fields(kind, **values):
    return kind.decode(kind.payload(**values))


def test_modes_have_pymavlinks_names_and_two_numbers():
    mavutil = pytest.importorskip("pymavlink.mavutil")
    for number, name in px4.MODE_NAMES.items():
        main, sub = px4.mode_parameters(number)
        assert main << 16 | sub << 24 == number
        if name != "PRECLAND":
            assert mavutil.interpret_px4_mode(0xFF & ~2, number) == name or name in ("FOLLOWME", "MANUAL")


@pytest.mark.parametrize("value", [0, 1, -1, 1000, 16777217, -(1 << 31), (1 << 31) - 1])
def test_whole_numbers_travel_as_their_bytes(value):
    sent = px4.encoded("NAV_RCL_ACT", value, 6)
    assert px4.value_of(fields(VALUE, param_value=sent, param_type=6)) == value
    assert px4.value_of(fields(VALUE, param_value=0.5, param_type=9)) == 0.5


@pytest.mark.parametrize("value", [0.5, float(1 << 31)])
def test_a_whole_number_is_needed_where_there_is_one(value):
    with pytest.raises(OptionError, match=r"NAV_RCL_ACT = .*; PX4 has a whole number there"):
        px4.encoded("NAV_RCL_ACT", value, 6)


def test_a_mission_has_no_home_and_every_place_is_given():
    home = home_item(470000000, 80000000, 400.0)
    there = MissionItem(16, 3, 0.0, 0.0, 0.0, 0.0, 470001000, 80001000, 10.0)
    items = [home, MissionItem(22, 3, 0.0, 0.0, 0.0, 0.0, 0, 0, 10.0), there,
             MissionItem(178, 2, 1.0, 5.0, -1.0, 0.0, 0, 0, 0.0), MissionItem(21, 3, 0.0, 0.0, 0.0, 0.0, 0, 0, 0.0),
             MissionItem(20, 3, 0.0, 0.0, 0.0, 0.0, 0, 0, 0.0)]  # fmt: skip
    up, first, speed, land, back = px4.mission(items)
    assert (up.x, up.y) == (home.x, home.y) and first == there and (land.x, land.y) == (there.x, there.y)
    assert speed == items[3] and (back.frame, back.x) == (2, 0)
    assert px4.mission([]) == []


def test_its_items_are_counted_as_uploaded_and_told_once():
    for autopilot, expected in ((3, [0, 0, 1]), (MavAutopilot.PX4, [1, 2])):
        telemetry = Telemetry()
        telemetry.take(0.0, "HEARTBEAT", fields(HEARTBEAT, autopilot=autopilot, type=2))
        for seq in (0, 0, 1):
            telemetry.take(1.0, "MISSION_ITEM_REACHED", fields(REACHED, seq=seq))
        assert [seq for _, seq in telemetry.reached] == expected


def test_its_estimate_says_when_its_position_is_good():
    status = message("ESTIMATOR_STATUS")
    telemetry = Telemetry()
    telemetry.take(0.0, "HEARTBEAT", fields(HEARTBEAT, autopilot=MavAutopilot.PX4, type=2))
    telemetry.take(0.0, "ESTIMATOR_STATUS", fields(status, flags=px4.VALID & ~16))
    assert not telemetry.has_position
    telemetry.take(0.0, "ESTIMATOR_STATUS", fields(status, flags=px4.VALID | 8))
    assert telemetry.has_position
