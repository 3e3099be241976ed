# SPDX-License-Identifier: BSD-3-Clause
"""What clients ask for now and then, in ArduPilot's numbers."""

from __future__ import annotations

import math
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.autopilot.notes import ItemReached
from sitl.bridge.copter.autopilot import CopterAutopilot
from sitl.bridge.services.statustext import EventService
from sitl.core.algebra import quat_about_down
from sitl.core.vectors import Vec3
from sitl.simulation import Simulation
from tests.bridge.fakes import Bench


def asked(bench: Bench, number: int, parameter: float = 0.0, *names: str) -> list[Any]:
    """What is answered to MAV_CMD_REQUEST_MESSAGE."""
    return bench.ask(mavlink.MAVLink_command_long_message(1, 1, 512, 0, number, parameter, 0, 0, 0, 0, 0), *names)


def test_times_of_a_flight(bench: Bench) -> None:
    v = bench.vehicle.v
    v.autopilot.arming.landed = True
    (m,) = asked(bench, 264, 0.0, "FLIGHT_INFORMATION")
    assert (m.arming_time_utc, m.takeoff_time_utc, m.flight_uuid) == (0, 0, 0)
    v.autopilot.arming.armed_us, v.autopilot.arming.landed = 2_000_000, False
    v.time_us = 5_000_000
    asked(bench, 264)
    state = bench.bridge.snapshot()
    v.time_us = 7_000_000
    (m,) = asked(bench, 264, 0.0, "FLIGHT_INFORMATION")
    assert (m.time_boot_ms, m.arming_time_utc, m.takeoff_time_utc) == (7000, 2_000_000, 5_000_000)
    v.autopilot.arming.landed = True
    (m,) = asked(bench, 264, 0.0, "FLIGHT_INFORMATION")
    assert m.takeoff_time_utc == 0
    bench.bridge.restore(state)
    v.autopilot.arming.landed = False
    (m,) = asked(bench, 264, 0.0, "FLIGHT_INFORMATION")
    assert m.takeoff_time_utc == 5_000_000


def test_a_rover_never_takes_off(rover_bench: Bench) -> None:
    rover_bench.vehicle.v.autopilot.arming.landed = False
    (m,) = asked(rover_bench, 264, 0.0, "FLIGHT_INFORMATION")
    assert m.takeoff_time_utc == 0


def test_a_gimbal_learns_how_fast_the_copter_wants_to_turn() -> None:
    simulation = Simulation("erle_copter", estimator="truth")
    autopilot = CopterAutopilot(simulation)
    simulation.v.autopilot.control.attitude.target_euler = (0.4, 0.0, 0.0)
    simulation.v.autopilot.control.attitude.target_rate = Vec3(0.1, 0.2, 0.3)
    assert autopilot.yaw_rate_target() == 0.0  # on the ground
    simulation.v.autopilot.arming.landed = False
    assert autopilot.yaw_rate_target() == pytest.approx(0.2 * math.sin(0.4) + 0.3 * math.cos(0.4))


def test_what_a_gimbal_needs(bench: Bench) -> None:
    estimate = bench.vehicle.v.autopilot.estimate
    estimate.q, estimate.vel = quat_about_down(math.pi / 2), Vec3(1.0, 2.0, 3.0)
    estimate.rates, estimate.status_flags = Vec3(0.0, 0.0, 0.5), 0x33F
    (m,) = asked(bench, 286, 0.0, "AUTOPILOT_STATE_FOR_GIMBAL_DEVICE")
    assert m.q == pytest.approx([math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)])
    assert (m.vx, m.vy, m.vz, m.angular_velocity_z) == (1.0, 2.0, 3.0, 0.5)
    assert (m.target_system, m.estimator_status, m.landed_state) == (1, 0x33F, 0)


def test_the_item_that_was_reached_last(bench: Bench) -> None:
    assert asked(bench, 46, 0.0, "MISSION_ITEM_REACHED")[0].seq == 65535
    bench.bridge.get(EventService).notes([ItemReached(3)])
    assert asked(bench, 46, 0.0, "MISSION_ITEM_REACHED")[0].seq == 3


def test_the_interval_of_a_message(bench: Bench) -> None:
    (m,) = asked(bench, 244, 0.0, "MESSAGE_INTERVAL")
    assert (m.message_id, m.interval_us) == (0, 1_000_000)
    (m,) = asked(bench, 244, 30.0, "MESSAGE_INTERVAL")
    assert (m.message_id, m.interval_us) == (30, -1)


@pytest.mark.parametrize(("number", "result"), [(22, 0), (127, 0), (259, 0), (373, 0), (11038, 4), (111, 4), (83, 0)])
def test_messages_that_say_nothing(bench: Bench, number: int, result: int) -> None:
    (ack,) = asked(bench, number, 0.0, "COMMAND_ACK")
    assert ack.result == result


def test_messages_that_say_nothing_of_a_rover(rover_bench: Bench) -> None:
    assert [asked(rover_bench, number, 0.0, "COMMAND_ACK")[0].result for number in (83, 136, 11038)] == [0, 0, 0]
