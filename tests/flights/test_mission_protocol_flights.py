# SPDX-License-Identifier: BSD-3-Clause
"""What a client reads of home and missions, and delays on the ground, as of a real ArduPilot 4.7."""

from __future__ import annotations

import pytest

from sitl import Simulation
from sitl.autopilot.mission.item import MissionItem
from sitl.client import Client
from sitl.core.mavlink import MavCmd
from sitl.simulation import Core

HOME = MissionItem(MavCmd.NAV_WAYPOINT, 0)


@pytest.fixture(scope="module")
def copter(core: Core) -> Client:
    vehicle = Client(Simulation("ardupilot_quad", seed=1, core=core))
    vehicle.wait_ready()
    return vehicle


def test_home_comes_with_the_origin(core: Core) -> None:
    vehicle = Client(Simulation("ardupilot_quad", seed=1, core=core))
    with vehicle.messages("GPS_GLOBAL_ORIGIN") as origins, vehicle.messages("HOME_POSITION") as homes:
        assert vehicle.passes(lambda: homes, 60.0)
        assert homes[0].time_usec - origins[0].time_usec < 500_000


def test_a_mission_has_home_before_it_has_others(copter: Client) -> None:
    counts: list[int] = []
    with copter.messages("MISSION_COUNT") as seen:
        for clears in (False, True):
            if clears:
                copter.send("MISSION_CLEAR_ALL", mission_type=0)
            copter.send("MISSION_REQUEST_LIST", mission_type=0)
            copter.delay(0.2)
            counts.append(seen[-1].count)
    assert counts == [1, 0]


def test_a_height_for_guided_is_taken_without_effect(copter: Client) -> None:
    with copter.messages("MISSION_ACK") as acks:
        copter.send("MISSION_ITEM_INT", seq=0, command=16, frame=3, current=3, x=1, y=1, z=20.0, mission_type=0)
        copter.delay(0.2)
    assert [ack.type for ack in acks] == [0]


@pytest.mark.parametrize(("tag", "result"), [(7.0, 0), (8.0, 4), (65535.0, 4), (65536.0, 2)])
def test_jump_to_a_tag(copter: Client, tag: float, result: int) -> None:
    copter.upload(
        [
            HOME,
            MissionItem(MavCmd.NAV_TAKEOFF, z=10.0),
            MissionItem(MavCmd.JUMP_TAG, p1=7.0),
            MissionItem(MavCmd.NAV_LAND),
        ]
    )
    with copter.messages("COMMAND_ACK") as acks:
        copter.send("COMMAND_LONG", command=MavCmd.DO_JUMP_TAG, param1=tag)
        copter.delay(0.2)
    assert [ack.result for ack in acks] == [result]
    assert copter.telemetry.item == (3 if result == 0 else copter.telemetry.item)


def test_a_delay_before_the_take_off(copter: Client) -> None:
    delay, takeoff = MissionItem(MavCmd.NAV_DELAY, p1=20.0), MissionItem(MavCmd.NAV_TAKEOFF, z=10.0)
    copter.upload([HOME, delay, takeoff, MissionItem(MavCmd.NAV_LAND)])
    copter.send("MISSION_SET_CURRENT", seq=0)
    copter.params["AUTO_OPTIONS"] = 3.0
    copter.params["DISARM_DELAY"] = 0.0  # else it disarms after 10 s on the ground
    copter.set_mode("AUTO")
    copter.arm()
    begun = copter.now
    copter.wait_current_waypoint(2)
    assert copter.now - begun == pytest.approx(20.0, abs=2.0)
    assert copter.altitude == pytest.approx(0.0, abs=0.3)
    copter.wait(lambda t: t.altitude > 9.0, timeout=30)
