# SPDX-License-Identifier: BSD-3-Clause
"""What a rover sends unasked, and who it says it is."""

from __future__ import annotations

from collections import Counter

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.autopilot.rover.modes.table import NAMES
from sitl.bridge.frame import Splitter
from tests.bridge.fakes import Bench

RECORDED = {
    "AHRS", "AHRS2", "ATTITUDE", "BATTERY_STATUS", "EKF_STATUS_REPORT", "GLOBAL_POSITION_INT", "GPS_RAW_INT",
    "HEARTBEAT", "LOCAL_POSITION_NED", "MEMINFO", "MISSION_CURRENT", "POWER_STATUS", "RAW_IMU", "RC_CHANNELS",
    "RC_CHANNELS_SCALED", "SCALED_PRESSURE", "SERVO_OUTPUT_RAW", "SIMSTATE", "SYSTEM_TIME", "SYS_STATUS", "VFR_HUD",
}  # fmt: skip
"""What a real ArduRover sends once a second in MANUAL, but for second sensors and vibration."""
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


def test_no_faster_than_the_loop(rover_bench: Bench) -> None:
    assert rover_bench.command(511, 30, 20_000) == 0
    assert rover_bench.command(511, 30, 19_999) == 2


def test_its_own_parameters(rover_bench: Bench) -> None:
    def read(name: bytes) -> list[float]:
        ask = mavlink.MAVLink_param_request_read_message(1, 1, name, -1)
        return [m.param_value for m in rover_bench.ask(ask, "PARAM_VALUE")]

    assert read(b"CRUISE_SPEED") == [rover_bench.vehicle.firmware.table["CRUISE_SPEED"].default]
    assert read(b"MAV1_EXTRA1") == [1.0] and read(b"WPNAV_SPEED") == []


def test_version(rover_bench: Bench) -> None:
    ask = mavlink.MAVLink_command_long_message(1, 1, 512, 0, 148, 0, 0, 0, 0, 0, 0)
    (version,) = rover_bench.ask(ask, "AUTOPILOT_VERSION")
    recorded = 0xF1EF
    assert version.capabilities & ~recorded == 0 and version.capabilities & 0x1C0 == 0x1C0


def test_modes(rover_bench: Bench) -> None:
    rover_bench.client.send(mavlink.MAVLink_command_long_message(1, 1, 512, 0, 435, 0, 0, 0, 0, 0, 0))
    rover_bench.bridge.receive()
    frames = Splitter().feed(rover_bench.client.link.receive())
    found = [f.kind.decode(f.payload) for f in frames if f.kind.name == "AVAILABLE_MODES"]
    assert {m.custom_mode: m.mode_name.decode() for m in found} == NAMES
    assert [m.mode_name for m in found if m.properties & 2] == [b"INITIALISING"]
