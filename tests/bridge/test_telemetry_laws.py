# SPDX-License-Identifier: BSD-3-Clause
"""Laws that build telemetry, on records filled in by hand."""

from __future__ import annotations

import math
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.autopilot.copter.modes.guided import ANGLE, GUIDED, POS_VEL_ACCEL
from sitl.bridge.copter import status_messages as copter
from sitl.bridge.copter import targets as copter_targets
from sitl.bridge.dialect import message
from sitl.bridge.firmware_profile import load
from sitl.bridge.rover import status_messages as rover
from sitl.bridge.telemetry import build, builder, register_message
from sitl.bridge.telemetry.motion import Attitude, attitude, global_position
from sitl.bridge.telemetry.ranging import PART, DebugFloatArray, scan
from sitl.bridge.telemetry.sensors import simstate
from sitl.bridge.telemetry.shell import shell_builders
from sitl.bridge.telemetry.status import system_time
from sitl.bridge.telemetry.units import boot_ms, heading_cdeg, int16, int32, percent, uint16
from sitl.bridge.wire.choose import message_of
from sitl.bridge.wire.port import Port
from sitl.core.geodesy import METRES_PER_DEGE7, longitude_scale
from sitl.core.kernels import law
from sitl.core.mavlink import MavSysStatus
from sitl.core.vectors import Vec2, Vec3
from sitl.physics.carried import Carried, carried
from sitl.vehicle.copter import Copter
from sitl.vehicle.record import Vehicle
from sitl.vehicle.rover import Rover
from tests.bridge.fakes import Bench

HOME = (-353632620, 1491652370, 584.0)


def says(law: Any, v: Vehicle, port: Port | None = None) -> Any:
    """What a law builds, decoded; None when it has nothing to say."""
    payload = build(law, v, port or Port())
    return message_of(law).kind.decode(payload) if payload else None


@pytest.fixture
def v() -> Copter:
    found = Copter()
    found.time_us = 12_345_678
    estimate = found.autopilot.estimate
    estimate.origin_lat, estimate.origin_lon, estimate.origin_alt = HOME
    return found


@pytest.mark.parametrize(
    ("unit", "x", "expected"),
    [
        (int16, -1.9, -1), (int16, 1e30, 32767), (int16, -math.inf, -32768), (int16, math.nan, -32768),
        (uint16, 65534.9, 65534), (uint16, math.inf, 65535), (uint16, -0.1, 0), (uint16, math.nan, 0),
        (int32, 0.5, 1), (int32, -0.5, 0), (int32, 1e30, 2147483647),
        (int32, 3e9, 2147483647), (int32, -3e9, -2147483648), (int32, math.nan, -2147483648),
        (percent, 99.9, 99), (percent, 1e30, 100), (percent, -0.1, -1), (percent, math.nan, -1),
        (heading_cdeg, -math.pi / 2, 27000), (heading_cdeg, -1e-300, 0),
        (heading_cdeg, math.inf, 0), (heading_cdeg, math.nan, 0),
        (boot_ms, (1 << 32) * 1000 + 5999, 5),
    ],
)  # fmt: skip
def test_numbers_become_integers(unit: Any, x: float, expected: int) -> None:
    assert unit(x) == expected


def test_the_place_is_the_fix_until_there_is_an_origin(v: Copter) -> None:
    assert global_position(v) == (0, 0, 0.0)
    v.sensors.gps_fix, v.sensors.gps_lat, v.sensors.gps_lon, v.sensors.gps_alt = 3, 10, 20, 30_000
    assert global_position(v) == (10, 20, 30.0)
    v.autopilot.estimate.origin_set = True
    v.autopilot.estimate.pos = v.autopilot.estimate.pos.replace(x=100.0, y=200.0, z=-5.0)
    here = global_position(v)
    scale = METRES_PER_DEGE7 * longitude_scale(HOME[0])
    assert here.lat == pytest.approx(HOME[0] + 100.0 / METRES_PER_DEGE7, abs=1)
    assert here.lon == pytest.approx(HOME[1] + 200.0 / scale, abs=2)
    assert here.alt == 589.0


@pytest.mark.parametrize(("east_m", "lon"), [(50.0, -1799995508), (-50.0, 1799995508)])
def test_longitudes_go_on_behind_180_degrees(v: Copter, east_m: float, lon: int) -> None:
    estimate = v.autopilot.estimate
    estimate.origin_set, estimate.origin_lat = True, 0
    estimate.origin_lon = 1800000000 if east_m > 0 else -1800000000
    estimate.pos = Vec3(0.0, east_m, 0.0)
    assert global_position(v).lon == lon


def test_attitude(v: Copter) -> None:
    v.autopilot.estimate.euler = (0.5, -0.25, 2.0)
    v.autopilot.estimate.rates = (0.125, 1e300, math.nan)
    with np.errstate(over="ignore"):
        m = says(attitude, v)
    assert m.time_boot_ms == 12_345
    assert (m.roll, m.pitch, m.yaw) == pytest.approx((0.5, -0.25, 2.0))
    assert (m.rollspeed, m.pitchspeed) == (0.125, math.inf)
    assert math.isnan(m.yawspeed)


def test_each_part_of_a_target_is_its_own(v: Copter) -> None:
    control, guided = v.autopilot.control, v.autopilot.modes.guided
    control.attitude.target_q, control.attitude.rate_target = (0.5, -0.25, 0.75, 0.125), (1.0, 2.0, 3.0)
    control.motors.throttle_in = 0.375
    m = says(copter_targets.attitude_target, v)
    assert (m.time_boot_ms, m.q) == (12_345, (0.5, -0.25, 0.75, 0.125))
    assert (m.body_roll_rate, m.body_pitch_rate, m.body_yaw_rate, m.thrust) == (1.0, 2.0, 3.0, 0.375)
    assert says(copter_targets.position_target_local, v) is None  # of GUIDED
    v.autopilot.modes.number, guided.submode = GUIDED, POS_VEL_ACCEL
    guided.pos, guided.vel, guided.acc = (1.0, 2.0, 3.0), (4.0, 5.0, 6.0), (7.0, 8.0, 9.0)
    m = says(copter_targets.position_target_local, v)
    assert (m.x, m.y, m.z, m.vx, m.vy, m.vz, m.afx, m.afy, m.afz) == tuple(range(1, 10))
    assert (m.time_boot_ms, m.type_mask, m.coordinate_frame) == (12_345, 0xC00, 1)
    guided.submode = ANGLE
    assert says(copter_targets.position_target_local, v) is None


@pytest.mark.parametrize("enabled", [0.0, 1.0])
def test_terrain_data_are_shown_where_they_are_switched_on(v: Copter, enabled: float) -> None:
    v.autopilot.params.TERRAIN.ENABLE = enabled
    m = says(copter.sys_status, v)
    for bits in (
        m.onboard_control_sensors_present,
        m.onboard_control_sensors_enabled,
        m.onboard_control_sensors_health,
    ):
        assert (bits & MavSysStatus.TERRAIN != 0) == (enabled == 1.0)


def test_the_controllers_of_a_firmware_that_rests() -> None:
    for record, status, idle in (
        (
            Copter(),
            copter.sys_status,
            MavSysStatus.SENSOR_ANGULAR_RATE_CONTROL
            | MavSysStatus.SENSOR_ATTITUDE_STABILIZATION
            | MavSysStatus.SENSOR_YAW_POSITION
            | MavSysStatus.SENSOR_PROPULSION,
        ),
        (Rover(), rover.sys_status, 0),
    ):
        v: Any = record
        assert not says(status, v).onboard_control_sensors_present & MavSysStatus.SENSOR_RC_RECEIVER, "not seen yet"
        v.autopilot.rc.receiver_us = 1
        m = says(status, v)
        assert (
            m.onboard_control_sensors_present & MavSysStatus.SENSOR_RC_RECEIVER
            and not m.onboard_control_sensors_health & MavSysStatus.SENSOR_RC_RECEIVER
        )
        v.autopilot.rc.receiver_ok = True
        m = says(status, v)
        assert m.onboard_control_sensors_health & copter.CONTROLLERS == idle
        assert m.onboard_control_sensors_health & MavSysStatus.SENSOR_RC_RECEIVER
        assert (m.voltage_battery, m.current_battery, m.battery_remaining) == (65535, -1, 0)


def test_channels_count_while_the_receiver_is_heard(v: Copter) -> None:
    v.autopilot.params.RC_FS_TIMEOUT = 1.0
    v.autopilot.rc.receiver_us = v.time_us - 999_999
    assert says(copter.rc_channels, v).chancount == 0, "no pulses"
    v.autopilot.rc.channels[17] = 1500
    v.autopilot.rc.channels[0] = 70_000
    m = says(copter.rc_channels, v)
    assert (m.chancount, m.chan18_raw, m.chan1_raw, m.rssi) == (16, 1500, 65535, 255)
    v.time_us += 1
    assert says(copter.rc_channels, v).chancount == 0


def test_time_of_day_is_the_ports(v: Copter) -> None:
    port = Port()
    port.epoch_us = 1_700_000_000_000_000
    assert says(system_time, v, port).time_unix_usec == 1_700_000_012_345_678


def test_a_scan_goes_on_where_the_port_says(v: Copter) -> None:
    port = Port()
    v.physics.airframe.lidar_samples = PART + 2
    assert says(scan, v, port) is None, "no scan yet"
    v.sensors.lidar_count, v.sensors.lidar_time_us = 1, 600
    v.sensors.lidar_ranges[: PART + 2] = np.arange(PART + 2)
    first = says(scan, v, port)
    assert (first.array_id, first.name, first.time_usec, port.part) == (0, b"LASER", 600, 1)
    second = says(scan, v, port)
    assert (second.array_id, second.data[:2], port.part) == (1, (PART, PART + 1), 0)
    assert all(map(math.isnan, second.data[2:]))


def tuned(law: Any, v: Vehicle, mask: int, loops: int) -> list[Any]:
    """All parts of PID_TUNING that are sent."""
    port, found = Port(), []
    v.autopilot.params["GCS_PID_MASK"] = mask
    for _ in range(loops):
        found.append(says(law, v, port))
    assert port.part == 0
    return [said for said in found if said is not None]


def test_loops_are_told_by_the_bits_of_gcs_pid_mask(v: Copter) -> None:
    rate, params = v.autopilot.control.rate, v.autopilot.params
    rate.roll.target, rate.roll.error, rate.roll.integrator, rate.roll.derivative = 0.5, 0.2, 0.03, 4.0
    params.ATC.RAT_RLL.P, params.ATC.RAT_RLL.D, params.ATC.RAT_RLL.FF = 0.1, 0.01, 0.3
    v.autopilot.estimate.rates = Vec3(0.3, 0.0, 0.0)
    v.autopilot.control.pos_d.accel.integrator = -0.02
    assert tuned(copter.pid_tuning, v, 0, 4) == []
    (roll,) = tuned(copter.pid_tuning, v, 1, 4)
    assert (roll.axis, roll.PDmod) == (1, 1.0)
    assert (roll.desired, roll.achieved, roll.P, roll.I, roll.D, roll.FF) == pytest.approx(
        (0.5, 0.3, 0.02, 0.03, 0.04, 0.15)
    )
    assert [said.axis for said in tuned(copter.pid_tuning, v, 0b1110, 4)] == [2, 3, 4]
    assert pytest.approx(-20.0) == tuned(copter.pid_tuning, v, 8, 4)[0].I  # thousandths of throttle
    r = Rover()
    r.autopilot.estimate.rates = Vec3(0.0, 0.0, 0.1)
    r.autopilot.control.speed.forward = 1.5
    steering, speed = tuned(rover.pid_tuning, r, 511, 2)
    assert (steering.axis, steering.achieved) == (5, pytest.approx(math.degrees(0.1), rel=1e-6))
    assert (speed.axis, speed.achieved) == (4, 1.5)


def test_the_truth_is_that_of_hil(v: Copter) -> None:
    body = v.physics.body
    body.q, body.rates = (0.6, 0.8, 0.0, 0.0), (0.1, 0.2, math.nan)
    body.vel, body.specific_force = (1.004, -400.0, math.nan), (0.0, 0.0, -9.80665)
    found = carried(v)
    assert found.attitude == tuple(float(np.float32(c)) for c in (0.6, 0.8, 0.0, 0.0))
    assert found.velocity == (100, -32768, 0) and found.acceleration == (0, 0, -1000)
    m = says(simstate, v)
    assert m.roll == pytest.approx(2.0 * math.atan2(0.8, 0.6))
    assert (m.xgyro, m.zacc) == (np.float32(0.1), np.float32(-9.80665))


def test_the_shell_asks_physics_that_is_elsewhere() -> None:
    truth = Carried((1.0, 0.0, 0.0, 0.0), (0.25, 0.0, 0.0), 7, 8, 9, (0, 0, 0), (0, 0, -1000))
    here: Any = SimpleNamespace(has_truth_in_record=True)
    there: Any = SimpleNamespace(has_truth_in_record=False, truth=lambda: truth)
    assert set(shell_builders(here)) == {"AUTOPILOT_VERSION", "COMPONENT_METADATA", "HIGH_LATENCY2", "RELAY_STATUS"}
    m = message("SIMSTATE").decode(shell_builders(there)["SIMSTATE"](there, load("copter")))
    assert (m.xgyro, m.lat, m.lng) == (0.25, 7, 8)


@law
def always_level(m: Attitude, v: Vehicle) -> bool:
    """ATTITUDE: always level."""
    return v.time_us > 0


@pytest.fixture
def registered() -> Iterator[Any]:
    yield register_message(always_level)
    del builder._registered[Attitude.kind.id]


def test_a_registered_law_comes_before_others(registered: Any, v: Copter) -> None:
    vehicle: Any = SimpleNamespace(v=v, has_truth_in_record=True)
    made = builder.shell_messages(vehicle, load("copter"), Port())
    assert Attitude.kind.decode(made[Attitude.kind.id]()).roll == 0.0
    v.time_us = 0
    assert made[Attitude.kind.id]() == b""


@law
def three_parts(m: DebugFloatArray, v: Vehicle, port: Port) -> bool:
    """DEBUG_FLOAT_ARRAY: three of them."""
    m.array_id = port.part
    port.part = (port.part + 1) % 3
    return True


def test_all_parts_of_a_registered_message_are_sent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(builder._registered, DebugFloatArray.kind.id, three_parts)
    bench = Bench()
    assert [m.array_id for m in bench.telemetry("DEBUG_FLOAT_ARRAY")] == [0, 1, 2]


def test_a_firmwares_own_laws_come_before_shared_ones() -> None:
    laws = builder.compiled((copter.heartbeat, always_level))
    assert always_level in laws and attitude not in laws
    numbers = [message_of(law).kind.id for law in laws]
    assert numbers == sorted(set(numbers))


def test_what_builds_no_message_is_refused() -> None:
    with pytest.raises(TypeError, match="no Message"):
        register_message(carried)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("mode", "velocity", "expected"),
    (
        (3, (2.0, 0.0), 4.0),  # AUTO, northwards: what is east of the track counts
        (3, (0.0, 2.0), 3.0),
        (3, (0.0, 0.0), 5.0),  # at rest: the distance
        (5, (2.0, 0.0), 4.0),
        (2, (2.0, 0.0), 0.0),  # ALT_HOLD has no track
    ),
)
def test_distance_beside_the_track_of_a_copter(
    v: Copter, mode: int, velocity: tuple[float, float], expected: float
) -> None:
    v.autopilot.modes.number = mode
    path = v.autopilot.control.pos_ne
    path.pos_desired, path.vel_desired = Vec2(13.0, 24.0), Vec2(*velocity)
    v.autopilot.estimate.pos = Vec3(10.0, 20.0, -5.0)
    assert says(copter_targets.nav_controller_output, v).xtrack_error == pytest.approx(expected)


def test_where_guided_flies_to_on_the_globe_is_a_position_alone_with_ardupilots_last_bits(v: Copter) -> None:
    v.autopilot.estimate.origin_set = True
    assert says(copter_targets.position_target_global, v) is None
    v.autopilot.modes.number, v.autopilot.modes.guided.pos = GUIDED, Vec3(100.0, 0.0, -30.0)
    told = says(copter_targets.position_target_global, v)
    assert told.lat_int == pytest.approx(HOME[0] + 100.0 / METRES_PER_DEGE7, abs=1) and told.lon_int == HOME[1]
    assert told.alt == pytest.approx(HOME[2] + 30.0)
    ignored = mavlink.POSITION_TARGET_TYPEMASK_FORCE_SET - 1 - 7  # velocities and accelerations
    ignored |= mavlink.POSITION_TARGET_TYPEMASK_YAW_IGNORE | mavlink.POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE
    assert told.type_mask == 0xF000 | ignored
