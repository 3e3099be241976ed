# SPDX-License-Identifier: BSD-3-Clause
"""The services on the copter firmware's own laws (plain Python), without the core."""

from __future__ import annotations

import math
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.mission.mission import Mission
from sitl.autopilot.mission.sequencer import Sequencer
from sitl.bridge.bridge import Bridge
from sitl.bridge.copter.autopilot import CopterAutopilot
from tests.bridge.fakes import HOME, Bench, FakeVehicle

SQUARE = (
    MissionItem(16, 0, x=HOME[0], y=HOME[1], z=584.0), MissionItem(22, 3, z=10.0),
    MissionItem(16, 3, x=HOME[0] + 2700, y=HOME[1], z=10.0),
)  # fmt: skip


class Vehicle(FakeVehicle):
    def __init__(self) -> None:
        super().__init__()
        self.mission = Mission()
        self.sequencer = Sequencer(self, self.firmware.commands)


class CopterBench(Bench):
    """As Bench, but the autopilot is the firmware's."""

    def __init__(self) -> None:
        self.vehicle = Vehicle()
        self.autopilot = CopterAutopilot(self.vehicle)  # type: ignore[assignment]
        self.bridge = Bridge(self.vehicle, autopilot=self.autopilot)
        self.client = self.connect()

    def ready(self) -> None:
        """On the ground with a position, in GUIDED, armed."""
        self.vehicle.locate()
        ap = self.vehicle.v.autopilot
        ap.estimate.attitude_ok, ap.estimate.q = True, (1.0, 0.0, 0.0, 0.0)
        ap.modes.number = 4
        ap.arming.armed = 1
        self.vehicle.v.time_us = 60_000_000


@pytest.fixture
def copter() -> CopterBench:
    return CopterBench()


def test_arming_too_early_is_refused_with_reasons(copter: CopterBench) -> None:
    answers = copter.ask(mavlink.MAVLink_command_long_message(1, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0))
    texts = [m.text for m in answers if m.get_type() == "STATUSTEXT"]
    assert texts and all(t.startswith("Arm: ") for t in texts) and len(set(texts)) == len(texts)
    assert [m.result for m in answers if m.get_type() == "COMMAND_ACK"] == [4]


def test_mode_refusals_are_said_once(copter: CopterBench) -> None:
    copter.ready()
    answers = copter.ask(mavlink.MAVLink_command_long_message(1, 1, 176, 0, 1, 3, 0, 0, 0, 0, 0))
    texts = [m.text for m in answers if m.get_type() == "STATUSTEXT"]
    assert texts == ["Mode change to AUTO failed: init failed"]
    assert copter.command(300) == 4
    answers = copter.ask(mavlink.MAVLink_command_long_message(1, 1, 176, 0, 1, 99, 0, 0, 0, 0, 0))
    assert [m.text for m in answers if m.get_type() == "STATUSTEXT"] == ["No such mode 99"]


def test_takeoff_and_disarm(copter: CopterBench) -> None:
    assert copter.command(22, 0, 0, 0, 0, 0, 0, 10) == 4
    copter.ready()
    assert copter.command(22, 0, 0, 0, 0, 0, 0, 10) == 0
    assert copter.vehicle.v.autopilot.modes.takeoff.target_d == -10.0
    copter.vehicle.v.autopilot.arming.landed = 0
    assert copter.command(400, 0) == 4
    assert copter.command(400, 0, 21196) == 0
    assert "Disarming motors" in [m.text for m in copter.client.receive("STATUSTEXT")] or not copter.autopilot.armed()


def test_set_points_reach_guided(copter: CopterBench) -> None:
    copter.ready()
    guided = copter.vehicle.v.autopilot.modes.guided
    copter.ask(mavlink.MAVLink_set_position_target_local_ned_message(0, 1, 1, 1, 0xDF8, 5, 6, -7, *(math.nan,) * 8))
    assert list(guided.pos) == [5.0, 6.0, -7.0]
    copter.ask(mavlink.MAVLink_set_position_target_local_ned_message(0, 1, 1, 1, 0xDC7, 0, 0, 0, 1, 2, 3, *(0,) * 5))
    assert list(guided.vel) == [1.0, 2.0, 3.0]
    copter.ask(mavlink.MAVLink_set_attitude_target_message(0, 1, 1, 7, [1, 0, 0, 0], 0, 0, 0, 0.6))
    assert guided.thrust == pytest.approx(0.6)
    assert copter.command(115, 90, 0, 0, 0) == 0
    assert copter.command(178, 1, 3) == 0
    assert copter.command(193, 0) == 0 and guided.paused == 1


def test_home(copter: CopterBench) -> None:
    assert copter.command(179, 1) == 4
    copter.ready()
    copter.vehicle.v.autopilot.estimate.pos = (10.0, 0.0, -2.0)
    assert copter.command(179, 1) == 0
    home = copter.vehicle.v.autopilot.home
    assert home.locked == 1 and home.alt == 586.0 and home.lat > HOME[0]


def test_a_mission_is_kept_flown_and_cleared(copter: CopterBench) -> None:
    copter.ready()
    client = copter.client
    client.send(mavlink.MAVLink_mission_count_message(1, 1, len(SQUARE)))
    result: Any = None
    for _ in range(20):
        copter.bridge.receive()
        for m in client.receive("MISSION_REQUEST", "MISSION_ACK"):
            if m.get_type() == "MISSION_ACK":
                result = m.type
            else:
                i = SQUARE[m.seq]
                client.send(mavlink.MAVLink_mission_item_int_message(
                    1, 1, m.seq, i.frame, i.command, 0, 1, i.p1, i.p2, i.p3, i.p4, i.x, i.y, i.z
                ))  # fmt: skip
    assert result == 0 and len(copter.vehicle.mission) == 3
    assert copter.command(176, 1, 3) == 0
    copter.bridge.tell(copter.vehicle.sequencer.attend())
    copter.bridge.flush()
    assert "Mission: 1 Takeoff" in [m.text for m in client.receive("STATUSTEXT")]
    (ack,) = copter.ask(mavlink.MAVLink_mission_clear_all_message(1, 1), "MISSION_ACK")
    assert ack.type == 1  # it is being flown
    assert copter.command(224, 2) == 0
    assert copter.command(224, 9) == 2
    assert copter.command(176, 1, 4) == 0
    copter.vehicle.sequencer.attend()
    (ack,) = copter.ask(mavlink.MAVLink_mission_clear_all_message(1, 1), "MISSION_ACK")
    assert ack.type == 0 and len(copter.vehicle.mission) == 0
