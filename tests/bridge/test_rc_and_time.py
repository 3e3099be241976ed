# SPDX-License-Identifier: BSD-3-Clause
"""Sticks from the ground station, heartbeats, time, ping, home and origin."""

from __future__ import annotations

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from tests.bridge.fakes import HOME, Bench

IGNORE = 65535


def override(*pulses: int, target: int = 1) -> object:
    first = (*pulses, *(IGNORE,) * (8 - len(pulses)))
    return mavlink.MAVLink_rc_channels_override_message(target, 1, *first)


def test_override(bench: Bench) -> None:
    rc = bench.vehicle.v.autopilot.rc
    bench.vehicle.v.time_us = 5_000_000
    bench.ask(override(1500, 1600, 1700))
    assert list(rc.override[:4]) == [1500, 1600, 1700, 0]
    assert list(rc.override_us[:4]) == [5_000_000] * 3 + [0]
    bench.vehicle.v.time_us = 6_000_000
    bench.ask(override(0, IGNORE, 1800))
    assert list(rc.override[:3]) == [0, 1600, 1800] and rc.override_us[1] == 5_000_000
    bench.ask(override(70, 60000))
    assert list(rc.override[:2]) == [0, 1600]
    assert bench.vehicle.v.autopilot.modes.failsafe.gcs_us == 6_000_000


def test_only_the_ground_station_has_sticks(bench: Bench) -> None:
    before = bench.vehicle.fleet.tobytes()
    stranger = bench.connect(system=245)
    for message in (
        override(1500),
        override(1500, target=0),
        mavlink.MAVLink_manual_control_message(1, 0, 0, 500, 0, 0),
    ):
        stranger.send(message)
    stranger.send(mavlink.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3))
    bench.ask(override(1500, target=2))
    bench.bridge.receive()
    assert bench.vehicle.fleet.tobytes() == before


def test_manual_control(bench: Bench) -> None:
    rc = bench.vehicle.v.autopilot.rc
    bench.ask(mavlink.MAVLink_manual_control_message(1, 1000, -1000, 500, 0, 0))
    low, high = (int(bench.vehicle.v.autopilot.params[f"RC1_{x}"]) for x in ("MIN", "MAX"))
    assert list(rc.override[:4]) == [low, low, (low + high) // 2, (low + high) // 2]
    bench.ask(mavlink.MAVLink_manual_control_message(1, 32767, 1000, 0, 32767, 0))
    assert list(rc.override[:4]) == [high, low, low, (low + high) // 2]


def test_heartbeats_of_the_ground_station_are_noted(bench: Bench) -> None:
    bench.vehicle.v.time_us = 7_000_000
    bench.ask(mavlink.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3))
    assert bench.vehicle.v.autopilot.modes.failsafe.gcs_us == 7_000_000


def test_timesync_and_ping(bench: Bench) -> None:
    bench.vehicle.v.time_us = 3_000_000
    (answer,) = bench.ask(mavlink.MAVLink_timesync_message(0, 42))
    assert (answer.tc1, answer.ts1) == (3_000_000_000, 42)
    assert bench.ask(mavlink.MAVLink_timesync_message(5, 42)) == []
    (answer,) = bench.ask(mavlink.MAVLink_ping_message(99, 7, 0, 0))
    assert (answer.time_usec, answer.seq, answer.target_system, answer.target_component) == (99, 7, 255, 190)
    assert bench.ask(mavlink.MAVLink_ping_message(99, 7, 1, 1)) == []


def test_an_answer_at_time_zero_is_no_request(bench: Bench) -> None:
    bench.vehicle.v.time_us = 0
    (answer,) = bench.ask(mavlink.MAVLink_timesync_message(0, 42))
    assert (answer.tc1, answer.ts1) == (1, 42)


def test_home_and_origin(bench: Bench) -> None:
    bench.ask(mavlink.MAVLink_set_gps_global_origin_message(1, *HOME[:2], 584000))
    assert bench.autopilot.calls == [("set_origin", *HOME[:2], 584.0)]
    bench.vehicle.locate()
    bench.bridge.get(
        type(next(s for s in bench.bridge.services.values() if type(s).__name__ == "HomeService"))
    ).report_changes()
    bench.bridge.flush()
    assert {m.get_type() for m in bench.client.receive()} == {"HOME_POSITION", "GPS_GLOBAL_ORIGIN"}
    bench.ask(mavlink.MAVLink_set_gps_global_origin_message(1, 2**31 - 1, 0, 0))
    assert len(bench.autopilot.calls) == 1


def test_there_are_no_logs_on_board(bench: Bench) -> None:
    (entry,) = bench.ask(mavlink.MAVLink_log_request_list_message(1, 1, 0, 0xFFFF), "LOG_ENTRY")
    assert (entry.num_logs, entry.size) == (0, 0)
    (data,) = bench.ask(mavlink.MAVLink_log_request_data_message(1, 1, 3, 90, 90), "LOG_DATA")
    assert (data.ofs, data.count) == (90, 0)
