# SPDX-License-Identifier: BSD-3-Clause
"""What a vehicle sends, how often, and who it says it is."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.autopilot.copter.modes.mode_list import TITLES
from sitl.autopilot.rover.modes.mode_list import NAMES as ROVER_MODES
from sitl.bridge.frame import Splitter
from sitl.bridge.links.inprocess import InProcessLink
from sitl.bridge.wire.streams import interval_of
from sitl.core.vectors import Vec2, Vec3
from tests.bridge.fakes import HOME, Bench, Client

SET_INTERVAL, GET_INTERVAL, REQUEST = 511, 510, 512
ALL_GROUPS = {
    "RAW_IMU", "SCALED_PRESSURE", "SYS_STATUS", "POWER_STATUS", "MEMINFO", "MISSION_CURRENT", "GPS_RAW_INT",
    "NAV_CONTROLLER_OUTPUT", "SERVO_OUTPUT_RAW", "RC_CHANNELS", "GLOBAL_POSITION_INT", "LOCAL_POSITION_NED",
    "ATTITUDE", "SIMSTATE", "AHRS2", "VFR_HUD", "AHRS", "SYSTEM_TIME", "BATTERY_STATUS",
    "EKF_STATUS_REPORT", "WIND", "VIBRATION", "TERRAIN_REPORT", "SCALED_IMU2", "SCALED_IMU3", "SCALED_PRESSURE2",
}  # fmt: skip


def request_stream(group: int, rate: int, start: int = 1) -> object:
    return mavlink.MAVLink_request_data_stream_message(1, 1, group, rate, start)


def counts(bench: Bench, seconds: float) -> Counter[str]:
    bench.client.receive()
    bench.run(seconds)
    return Counter(m.get_type() for m in bench.client.receive())


def test_silence_but_for_heartbeat_and_timesync(bench: Bench) -> None:
    bench.run(3.0)
    bench.client.receive()
    assert counts(bench, 20.0) == {"HEARTBEAT": 20, "TIMESYNC": 2}


def test_all_streams_at_4_hz(bench: Bench) -> None:
    bench.vehicle.locate()
    bench.run(3.0)
    bench.ask(request_stream(0, 4))
    found = counts(bench, 10.0)
    assert {name for name, n in found.items() if n == 40} == ALL_GROUPS
    bench.ask(request_stream(0, 4, start=0))
    assert set(counts(bench, 5.0)) <= {"HEARTBEAT", "TIMESYNC"}


def test_pid_tuning_comes_with_its_group_and_mask(bench: Bench) -> None:
    bench.ask(request_stream(10, 4))
    assert counts(bench, 5.0)["PID_TUNING"] == 0
    bench.vehicle.v.autopilot.params["GCS_PID_MASK"] = 5.0
    bench.client.receive()
    bench.run(5.0)
    assert Counter(m.axis for m in bench.client.receive("PID_TUNING")) == {1: 20, 3: 20}


def test_each_client_has_its_own_streams_and_sequence(bench: Bench) -> None:
    other = bench.connect(system=250)
    assert bench.command(SET_INTERVAL, 30, 100_000) == 0
    bench.run(5.0)
    other_types = {m.get_type() for m in other.receive()}
    mine = bench.client.receive()
    assert "ATTITUDE" not in other_types
    assert sum(m.get_type() == "ATTITUDE" for m in mine) == 50
    numbers = [m.get_seq() for m in mine]
    assert all((b - a) % 256 == 1 for a, b in pairwise(numbers))


@pytest.mark.parametrize("hz", [1, 3, 7, 30, 50, 320])
def test_rates_are_exact(bench: Bench, hz: int) -> None:
    assert bench.command(SET_INTERVAL, 30, 1e6 / hz) == 0
    assert abs(counts(bench, 10.0)["ATTITUDE"] - 10 * hz) <= 1


def test_intervals_refused_and_told(bench: Bench) -> None:
    say = mavlink.MAVLink_command_long_message(1, 1, SET_INTERVAL, 0, 30, 1000, 0, 0, 0, 0, 0)
    answers = bench.ask(say)
    assert [m.result for m in answers if m.get_type() == "COMMAND_ACK"] == [2]
    pieces = [m.text for m in answers if m.get_type() == "STATUSTEXT"]
    assert pieces == ["Requested rate for message ID 30 too fast. Increas", "e SCHED_LOOP_RATE"]
    assert bench.command(SET_INTERVAL, 9999, 100_000) == 2
    assert bench.command(SET_INTERVAL, 30, 100_000, 1) == 2, "the third parameter is none of it"
    assert bench.command(REQUEST, 999) == 4
    assert bench.command(REQUEST, 30) == 0


@pytest.mark.parametrize(("us", "of_copter", "of_rover"), [
    (-2, 2, 2), (1, 2, 2), (2500, 2, 2), (2999, 2, 2), (3000, 0, 2), (20_000, 0, 2), (24_999, 0, 2), (25_000, 0, 0),
    (-1, 0, 0), (0, 0, 0),
])  # fmt: skip
def test_messages_come_at_most_at_four_fifths_of_the_loop_rate(
    bench: Bench, rover_bench: Bench, us: int, of_copter: int, of_rover: int
) -> None:
    """In whole milliseconds, as ArduPilot counts them."""
    assert bench.command(SET_INTERVAL, 30, us) == of_copter
    assert rover_bench.command(SET_INTERVAL, 30, us) == of_rover


def test_a_stream_that_is_asked_for_too_often_comes_as_often_as_it_can(rover_bench: Bench) -> None:
    rover_bench.ask(request_stream(10, 50))
    assert counts(rover_bench, 10.0)["ATTITUDE"] == 400


def test_get_interval(bench: Bench) -> None:
    def interval(number: int) -> int:
        ask = mavlink.MAVLink_command_long_message(1, 1, GET_INTERVAL, 0, number, 0, 0, 0, 0, 0, 0)
        return int(bench.ask(ask, "MESSAGE_INTERVAL")[0].interval_us)

    assert (interval(0), interval(30), interval(9999)) == (1_000_000, -1, 0)
    bench.command(SET_INTERVAL, 30, 40_000)
    assert interval(30) == 40_000
    bench.command(SET_INTERVAL, 30, -1)
    assert interval(30) == -1
    bench.command(SET_INTERVAL, 0, -1)
    assert "HEARTBEAT" not in counts(bench, 3.0)
    bench.command(SET_INTERVAL, 0, 0)
    assert interval(0) == 1_000_000


def test_the_default_of_a_message_is_the_rate_that_its_group_was_asked_for(bench: Bench) -> None:
    """A client's own: SET_MESSAGE_INTERVAL 0 after REQUEST_DATA_STREAM goes back to the stream's rate."""
    other = bench.connect(system=250)
    bench.ask(request_stream(0, 4))
    bench.command(SET_INTERVAL, 30, 100_000)
    moment = bench.bridge.snapshot()
    bench.ask(request_stream(0, 2))
    assert bench.command(SET_INTERVAL, 30, 0) == 0
    assert counts(bench, 10.0)["ATTITUDE"] == 20
    bench.bridge.restore(moment)
    assert bench.command(SET_INTERVAL, 30, 0) == 0
    other.receive()
    assert counts(bench, 10.0)["ATTITUDE"] in (40, 41)  # the first is late: only the bridge was put back
    assert not other.receive("ATTITUDE")


def test_the_longest_interval_can_be_told(bench: Bench) -> None:
    assert bench.command(SET_INTERVAL, 30, 3.0e9) == 0
    ask = mavlink.MAVLink_command_long_message(1, 1, GET_INTERVAL, 0, 30, 0, 0, 0, 0, 0, 0)
    assert bench.ask(ask, "MESSAGE_INTERVAL")[0].interval_us == 60_000_000


def test_a_rate_parameter_holds_for_every_client(bench: Bench) -> None:
    bench.ask(mavlink.MAVLink_param_set_message(1, 1, b"MAV1_EXTRA1", 5.0, 4))
    assert counts(bench, 2.0)["ATTITUDE"] == 10
    late = bench.connect()
    bench.run(2.0)
    assert len(late.receive("ATTITUDE")) == 10


def test_the_rates_that_the_first_client_asked_for_are_in_its_parameters(bench: Bench) -> None:
    """Those of others are not; and nobody begins with what another has asked for."""
    bench.ask(request_stream(10, 5))
    assert bench.vehicle.parameters["MAV1_EXTRA1"] == 5.0
    assert bench.vehicle.parameters["MAV1_EXTRA2"] == 0.0
    late = bench.connect()
    late.send(request_stream(11, 2))
    bench.run(2.0)
    assert not late.receive("ATTITUDE")
    assert bench.vehicle.parameters["MAV1_EXTRA2"] == 0.0
    bench.ask(request_stream(0, 3))
    bench.ask(request_stream(10, 9, 0))
    assert [bench.vehicle.parameters[f"MAV1_{name}"] for name in ("EXTRA1", "EXTRA2", "RAW_SENS")] == [0.0, 3.0, 3.0]


def test_a_reboot_forgets_rates_that_were_asked_for_and_keeps_those_that_were_set(bench: Bench) -> None:
    bench.ask(mavlink.MAVLink_param_set_message(1, 1, b"MAV1_EXTRA2", 2.0, 4))
    bench.ask(request_stream(0, 5))
    bench.bridge.successor()
    assert [bench.vehicle.parameters[f"MAV1_{name}"] for name in ("EXTRA1", "EXTRA2")] == [0.0, 2.0]


def test_request_message_before_a_position_is_known(bench: Bench) -> None:
    ask = mavlink.MAVLink_command_long_message(1, 1, REQUEST, 0, 242, 0, 0, 0, 0, 0, 0)
    assert [m.get_type() for m in bench.ask(ask)] == ["COMMAND_ACK"]
    bench.vehicle.locate()
    assert [m.get_type() for m in bench.ask(ask)] == ["COMMAND_ACK", "HOME_POSITION"]


def test_streams_wait_for_a_client_that_does_not_read(bench: Bench) -> None:
    bench.command(SET_INTERVAL, 30, 100_000)
    type(bench.bridge.channels[0].peer).congested = property(lambda self: True)  # type: ignore[assignment]
    try:
        assert not {"ATTITUDE", "HEARTBEAT"} & set(counts(bench, 2.0))
    finally:
        del type(bench.bridge.channels[0].peer).congested
    assert counts(bench, 2.0)["ATTITUDE"] == 20


def test_available_modes(bench: Bench) -> None:
    def modes(index: int) -> list[object]:
        bench.client.send(mavlink.MAVLink_command_long_message(1, 1, REQUEST, 0, 435, index, 0, 0, 0, 0, 0))
        bench.bridge.receive()
        frames = Splitter().feed(bench.client.link.receive())
        return [f.kind.decode(f.payload) for f in frames if f.kind.name == "AVAILABLE_MODES"]

    every = modes(0)
    assert [m.mode_index for m in every] == list(range(1, every[0].number_modes + 1))
    assert {m.custom_mode: m.mode_name.decode() for m in every} == TITLES
    assert modes(4) == every[3:4]
    assert modes(99) == []


RECORDED = {
    "AHRS", "AHRS2", "ATTITUDE", "BATTERY_STATUS", "EKF_STATUS_REPORT", "GLOBAL_POSITION_INT", "GPS_RAW_INT",
    "HEARTBEAT", "LOCAL_POSITION_NED", "MEMINFO", "MISSION_CURRENT", "POWER_STATUS", "RAW_IMU", "RC_CHANNELS",
    "RC_CHANNELS_SCALED", "SCALED_IMU2", "SCALED_IMU3", "SCALED_PRESSURE", "SCALED_PRESSURE2", "SERVO_OUTPUT_RAW",
    "SIMSTATE", "SYSTEM_TIME", "SYS_STATUS", "VFR_HUD", "VIBRATION",
}  # fmt: skip
"""What a real ArduRover sends once a second in MANUAL."""
IN_GUIDED = {"NAV_CONTROLLER_OUTPUT"}


def rates(bench: Bench, seconds: float) -> Counter[str]:
    bench.run(3.0)
    bench.client.receive()
    bench.run(seconds)
    return Counter(m.get_type() for m in bench.client.receive())


def test_everything_once_a_second(rover_bench: Bench) -> None:
    rover_bench.vehicle.locate()
    assert rates(rover_bench, 10.0) == {**dict.fromkeys(RECORDED, 10), "TIMESYNC": 1}
    rover_bench.vehicle.v.autopilot.modes.number = 15
    assert set(rates(rover_bench, 10.0)) == RECORDED | IN_GUIDED | {"TIMESYNC"}


def test_raw_controller_stream(rover_bench: Bench) -> None:
    rover_bench.ask(mavlink.MAVLink_request_data_stream_message(1, 1, 0, 0, 0))
    rover_bench.ask(mavlink.MAVLink_request_data_stream_message(1, 1, 4, 4, 1))
    assert rates(rover_bench, 10.0) == {"HEARTBEAT": 10, "TIMESYNC": 1, "RC_CHANNELS_SCALED": 40}


def test_its_own_parameters(rover_bench: Bench) -> None:
    def read(name: bytes) -> list[float]:
        ask = mavlink.MAVLink_param_request_read_message(1, 1, name, -1)
        return [m.param_value for m in rover_bench.ask(ask, "PARAM_VALUE")]

    assert read(b"CRUISE_SPEED") == [rover_bench.vehicle.firmware.table["CRUISE_SPEED"].default]
    assert read(b"MAV1_EXTRA1") == [1.0] and read(b"WPNAV_SPEED") == []


def test_version(rover_bench: Bench) -> None:
    ask = mavlink.MAVLink_command_long_message(1, 1, 512, 0, 148, 0, 0, 0, 0, 0, 0)
    (version,) = rover_bench.ask(ask, "AUTOPILOT_VERSION")
    assert version.capabilities == 0xF1EF  # a recorded rover's


def test_high_latency_by_request(bench: Bench) -> None:
    bench.vehicle.locate()
    estimate, v = bench.vehicle.v.autopilot.estimate, bench.vehicle.v
    estimate.pos, estimate.vel = Vec3(100.0, 0.0, -20.0), Vec3(0.0, 3.0, -1.5)
    v.autopilot.battery.remaining_pct = -1.0
    v.autopilot.arming.armed = True
    v.autopilot.control.motors.throttle_out = 0.36
    modes, control = v.autopilot.modes, v.autopilot.control
    modes.number, modes.guided.pos = 4, Vec3(100.0, 95.0, -20.0)
    control.tick = control.pos_ne.last_tick = control.pos_d.last_tick = 1
    control.pos_d.pos_error, control.pos_ne.vel_target = -4.0, Vec2(3.0, 4.0)
    (m,) = bench.telemetry("HIGH_LATENCY2")
    assert (m.latitude, m.longitude, m.altitude) == (pytest.approx(HOME[0] + 8983, abs=2), HOME[1], 604)
    assert (m.groundspeed, m.climb_rate, m.heading, m.battery, m.temperature_air) == (15, 0, 0, -1, -128)
    assert (m.target_altitude, m.target_heading, m.target_distance) == (608, 45, 9)
    assert (m.throttle, m.airspeed, m.airspeed_sp, m.wind_heading) == (36, 15, 25, 90)
    (beat,) = bench.telemetry("HEARTBEAT")
    assert m.custom0 & 0xFF == beat.base_mode and beat.base_mode & 0x80
    assert m.failure_flags & 0x803 == 2, "there is no airspeed sensor"
    v.sensors.temperature = 21.7
    for params, told in (({"ARSPD_ENABLE": 1.0}, -128), ({"ARSPD_TYPE": 7.0}, 21), ({"ARSPD_ENABLE": 0.0}, -128)):
        bench.vehicle.parameters.update(params)
        assert bench.telemetry("HIGH_LATENCY2")[0].temperature_air == told, params
    v.sensors.gps_fix = 1
    assert bench.telemetry("HIGH_LATENCY2")[0].failure_flags & 1 == 1


def high_latency_client(bench: Bench) -> Client:
    """A client on a link that is paid by the byte."""
    link = InProcessLink()
    link.is_high_latency = True
    bench.bridge.add_link(link)
    return Client(link, system=250)


def count(bench: Bench, client: Client, seconds: float) -> int:
    """How many HIGH_LATENCY2 come in so long; there is no other telemetry."""
    client.receive()
    bench.run(seconds)
    names = [m.get_type() for m in client.receive()]
    assert not set(names) & {"HEARTBEAT", "TIMESYNC", "SYS_STATUS"}
    return names.count("HIGH_LATENCY2")


def test_a_link_of_high_latency_has_one_message_and_only_when_it_is_on(bench: Bench) -> None:
    bench.vehicle.locate()
    client = high_latency_client(bench)
    switch, interval = 2600, 511
    assert count(bench, client, 30.0) == 0
    assert bench.command(switch, 1) == 0
    assert count(bench, client, 30.0) == 6
    assert interval_of(bench.bridge.channels[1].port, 235) == 5_000_000
    client.send(mavlink.MAVLink_command_long_message(1, 1, interval, 0, 235, 1e6, 0, 0, 0, 0, 0))
    client.send(mavlink.MAVLink_request_data_stream_message(1, 1, 0, 10, 1))
    assert count(bench, client, 30.0) == 30
    assert bench.command(switch, 0) == 0
    assert count(bench, client, 30.0) == 0
    assert "HIGH_LATENCY2" not in {m.get_type() for m in bench.client.receive()}
    assert bench.command(switch, 1) == 0
    assert count(bench, client, 10.0) == 10
    client.send(mavlink.MAVLink_command_long_message(1, 1, interval, 0, 235, 0, 0, 0, 0, 0, 0))
    assert count(bench, client, 30.0) == 6
    state = bench.bridge.snapshot()
    assert bench.command(switch, 0) == 0
    bench.bridge.restore(state)
    late = high_latency_client(bench)
    assert count(bench, late, 10.0) == 2, "it is on"


def test_what_is_asked_for_follows_the_answer(bench: Bench) -> None:
    ask = mavlink.MAVLink_command_long_message(1, 1, 512, 0, 30, 0, 0, 0, 0, 0, 0)
    assert [m.get_type() for m in bench.ask(ask)] == ["COMMAND_ACK", "ATTITUDE"]


def test_modes(rover_bench: Bench) -> None:
    rover_bench.client.send(mavlink.MAVLink_command_long_message(1, 1, 512, 0, 435, 0, 0, 0, 0, 0, 0))
    rover_bench.bridge.receive()
    frames = Splitter().feed(rover_bench.client.link.receive())
    found = [f.kind.decode(f.payload) for f in frames if f.kind.name == "AVAILABLE_MODES"]
    assert {m.custom_mode: m.mode_name.decode() for m in found} == ROVER_MODES
    assert [m.mode_name for m in found if m.properties & 2] == [b"INITIALISING"]


OF_PARTS = (
    22, 35, 127, 128, 132, 133, 143, 173, 180, 191, 192, 225, 226, 246, 259, 260, 262, 269, 271, 277, 280, 281, 285,
    295, 301, 373, 9005, 10008,
)  # fmt: skip


def test_messages_of_parts_that_are_off_may_be_asked_for(bench: Bench, rover_bench: Bench) -> None:
    """As ArduCopter and ArduRover 4.7 answer without gimbal, winch and range-finder."""
    for each, more, none in ((bench, (), (85, 284, 158)), (rover_bench, (85, 168, 11030), (284, 158))):
        for number in (*OF_PARTS, *more):
            assert each.command(REQUEST, number) == 0, number
        for number in none:
            assert each.command(REQUEST, number) == 4 or number in each.bridge.telemetry


def test_what_is_asked_for_by_other_numbers_than_the_telemetrys(bench: Bench) -> None:
    """TIMESYNC is not sent by request; MESSAGE_INTERVAL tells of a number that a message has."""
    assert bench.command(REQUEST, 111) == 4
    for number, told in ((0, 1_000_000), (111, 10_000_000), (30, -1), (65535, 0), (65536, None), (-1, None)):
        for ask in ((REQUEST, 244, number), (GET_INTERVAL, number)):
            values = (*ask[1:], *(0,) * (8 - len(ask)))
            answers = bench.ask(mavlink.MAVLink_command_long_message(1, 1, ask[0], 0, *values))
            intervals = [m.interval_us for m in answers if m.get_type() == "MESSAGE_INTERVAL"]
            assert intervals == ([] if told is None else [told]), number
            assert [m.result for m in answers if m.get_type() == "COMMAND_ACK"] == [0 if told else 4]


def test_default_intervals_of_what_everybody_is_sent(bench: Bench) -> None:
    bench.run(3.0)
    for number in (0, 111):
        bench.command(SET_INTERVAL, number, 500_000)
        bench.command(SET_INTERVAL, number, 0)
    assert counts(bench, 40.0) == {"HEARTBEAT": 40, "TIMESYNC": 4}


@pytest.mark.parametrize("number", [148, 253, 9999])
def test_messages_that_are_sent_on_request_only(bench: Bench, number: int) -> None:
    answers = bench.ask(mavlink.MAVLink_command_long_message(1, 1, SET_INTERVAL, 0, number, 1e5, 0, 0, 0, 0, 0))
    assert [m.result for m in answers if m.get_type() == "COMMAND_ACK"] == [2]
    said = [(m.severity, m.text) for m in answers if m.get_type() == "STATUSTEXT"]
    assert said == [(6, f"No ap_message for mavlink id ({number})")]


@pytest.mark.parametrize(("stepped", "pushed", "us"), [(True, False, 2500), (False, True, 2500), (False, False, 3000)])
def test_who_steps_a_vehicle_may_have_messages_of_every_tick(
    bench: Bench, stepped: bool, pushed: bool, us: int
) -> None:
    bench.bridge.is_stepped = stepped
    if pushed:
        bench.bridge.push_clock()
    assert (bench.command(SET_INTERVAL, 30, us - 1), bench.command(SET_INTERVAL, 30, us)) == (2, 0)


def test_rates_beyond_what_a_parameter_tells_and_requests_that_mean_nothing(bench: Bench) -> None:
    for rate, start, told in ((400, 1, 400), (401, 1, 400), (399, 1, 399), (5, 2, 399), (5, 0, 0)):
        bench.ask(request_stream(10, rate, start))
        assert bench.vehicle.parameters["MAV1_EXTRA1"] == told
    bench.ask(request_stream(99, 5))
    bench.ask(mavlink.MAVLink_param_set_message(1, 1, b"MAV1_EXTRA1", -5.0, 4))
    assert counts(bench, 3.0)["ATTITUDE"] == 0


def test_modes_tell_whether_they_fly_by_themselves(bench: Bench) -> None:
    bench.client.send(mavlink.MAVLink_command_long_message(1, 1, REQUEST, 0, 435, 0, 0, 0, 0, 0, 0))
    bench.bridge.receive()
    frames = Splitter().feed(bench.client.link.receive())
    modes = [f.kind.decode(f.payload) for f in frames if f.kind.name == "AVAILABLE_MODES"]
    properties = {m.custom_mode: m.properties for m in modes}
    by_itself = {3, 4, 6, 9, 17, 20, 21, 22, 23, 25, 27}
    assert {number: properties[number] & 4 for number in (0, 1, 2, 5, 16, 3, 4, 6, 9, 21)} == {
        number: 4 * (number in by_itself) for number in (0, 1, 2, 5, 16, 3, 4, 6, 9, 21)
    }
    last = len(modes)
    for index, result in ((last, 0), (last + 1, 2), (-1, 2), (1, 0)):
        assert bench.command(REQUEST, 435, index) == result
