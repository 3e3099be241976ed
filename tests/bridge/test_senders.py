# SPDX-License-Identifier: BSD-3-Clause
"""MAV_OPTIONS bit 0: only ground stations, the vehicle itself and radios are heard."""

from __future__ import annotations

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.bridge.services.parameter_protocol import ParameterService
from sitl.bridge.services.senders import SenderService
from tests.bridge.fakes import Bench, Client


def enforce(bench: Bench, first: int = 250, last: int = 0) -> None:
    """As a ground station sets it."""
    service = bench.bridge.get(ParameterService)
    for name, value in (("MAV_GCS_SYSID", first), ("MAV_GCS_SYSID_HI", last), ("MAV_OPTIONS", 1)):
        assert service.set(name, float(value)) is None


def answers(bench: Bench, client: Client) -> list[str]:
    client.receive()
    client.send(mavlink.MAVLink_command_long_message(1, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0))
    client.send(mavlink.MAVLink_timesync_message(0, 5))
    bench.bridge.receive()
    return sorted({m.get_type() for m in client.receive()} & {"COMMAND_ACK", "TIMESYNC"})


HEARD = ["COMMAND_ACK", "TIMESYNC"]


@pytest.mark.parametrize(("system", "heard"), ((250, True), (249, False), (251, False), (1, True), (72, False)))
def test_others_are_not_heard(bench: Bench, system: int, heard: bool) -> None:
    client = bench.connect(system=system, component=190)
    assert answers(bench, client) == HEARD
    enforce(bench)
    bench.autopilot.calls.clear()
    assert answers(bench, client) == (HEARD if heard else [])
    assert bench.autopilot.calls == ([("arm", False)] if heard else [])
    assert bench.bridge.get(SenderService).refused == (0 if heard else 2)


def test_ground_stations_may_be_several(bench: Bench) -> None:
    enforce(bench, 200, 210)
    for system, heard in ((199, False), (200, True), (205, True), (210, True), (211, False)):
        assert answers(bench, bench.connect(system=system, component=190)) == (HEARD if heard else [])


def test_setpoints_of_others_do_not_reach_the_core(bench: Bench) -> None:
    client = bench.connect(system=72, component=190)
    ports = bench.bridge.channels
    enforce(bench)
    before = [channel.port.received for channel in ports]
    client.send(mavlink.MAVLink_manual_control_message(1, 0, 0, 500, 0, 0))
    bench.bridge.receive()
    assert [channel.port.received for channel in ports] == before


def test_it_ends_and_comes_back_with_a_snapshot(bench: Bench) -> None:
    client = bench.connect(system=72, component=190)
    open_to_all = bench.bridge.snapshot()
    enforce(bench)
    assert not bench.bridge.goes_by_itself()
    assert answers(bench, client) == []
    bench.vehicle.parameters["MAV_OPTIONS"] = 0.0
    bench.bridge.restore(open_to_all)
    assert answers(bench, client) == HEARD


def stations(bench: Bench, first: int, last: int) -> None:
    for name, value in (("MAV_GCS_SYSID", first), ("MAV_GCS_SYSID_HI", last)):
        assert bench.bridge.get(ParameterService).set(name, float(value)) is None


@pytest.mark.parametrize(("system", "counts"), ((199, False), (200, True), (204, True), (210, True), (211, False)))
def test_sticks_and_heartbeats_of_all_ground_stations_count(bench: Bench, system: int, counts: bool) -> None:
    client, v = bench.connect(system=system), bench.vehicle.v
    stations(bench, 200, 210)
    bench.run(1.0)
    for message in (
        mavlink.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3),
        mavlink.MAVLink_rc_channels_override_message(1, 1, 1600, *(7 * [0])),
        mavlink.MAVLink_manual_control_message(1, 500, 0, 0, 0, 0),
    ):
        v.autopilot.modes.failsafe.gcs_us = 0
        client.send(message)
        bench.bridge.receive()
        assert (v.autopilot.modes.failsafe.gcs_us > 0) == counts
    assert (v.autopilot.rc.override[0] > 0) == counts


def test_a_last_ground_station_below_the_first_is_none(bench: Bench) -> None:
    stations(bench, 200, 100)
    bench.run(1.0)
    bench.connect(system=150).send(mavlink.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3))
    bench.bridge.receive()
    assert bench.vehicle.v.autopilot.modes.failsafe.gcs_us == 0
