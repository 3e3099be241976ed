# SPDX-License-Identifier: BSD-3-Clause
"""Every builder: units at the border, and numbers that do not fit."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl.bridge.dialect import message
from sitl.core.algebra import quat_about_down
from sitl.core.vectors import Vec3
from tests.bridge.fakes import HOME, Bench


def get(bench: Bench, name: str) -> object:
    """One message, as a client decodes it."""
    found = bench.telemetry(name)
    assert len(found) == 1
    return found[0]


def test_position_and_attitude(bench: Bench) -> None:
    v = bench.vehicle.v
    bench.vehicle.locate()
    v.time_us = 12_345_678
    v.autopilot.estimate.pos = (100.0, -50.0, -20.0)
    v.autopilot.estimate.vel = (1.5, -2.5, 0.25)
    v.autopilot.estimate.euler = (0.1, -0.2, -math.pi / 2)
    v.autopilot.estimate.rates = (0.01, 0.02, 0.03)
    where = get(bench, "GLOBAL_POSITION_INT")
    assert where.time_boot_ms == 12345
    assert where.lat == pytest.approx(HOME[0] + 100.0 / 0.0111318845, abs=1)
    scale = math.cos(math.radians(HOME[0] * 1e-7))
    assert where.lon == pytest.approx(HOME[1] - 50.0 / (0.0111318845 * scale), abs=1)
    assert (where.alt, where.relative_alt, where.hdg) == (604_000, 20_000, 27_000)
    assert (where.vx, where.vy, where.vz) == (150, -250, 25)
    local = get(bench, "LOCAL_POSITION_NED")
    assert (local.x, local.y, local.z, local.vx) == (100.0, -50.0, -20.0, 1.5)
    attitude = get(bench, "ATTITUDE")
    assert attitude.pitch == pytest.approx(-0.2) and attitude.yawspeed == pytest.approx(0.03)
    hud = get(bench, "VFR_HUD")
    assert hud.heading == 270 and hud.alt == pytest.approx(604.0) and hud.climb == -0.25
    home = get(bench, "HOME_POSITION")
    assert (home.latitude, home.longitude, home.altitude) == (HOME[0], HOME[1], 584_000)


def test_imu_units(bench: Bench) -> None:
    sensors, shown = bench.vehicle.v.sensors, bench.vehicle.v.autopilot.calibrated
    shown.acc = (0.0, 9.80665, -9.80665)
    shown.gyro = (0.5, 0.0, -0.25)
    shown.mag = (0.25, -0.05, 0.4)
    sensors.abs_pressure, sensors.temperature = 945.0, 25.5
    raw = get(bench, "RAW_IMU")
    assert (raw.xacc, raw.zgyro, raw.xmag, raw.temperature) == (0, -250, 250, 2550)
    assert raw.yacc in (999, 1000) and raw.zacc in (-999, -1000)
    high = get(bench, "HIGHRES_IMU")
    assert high.abs_pressure == 945.0 and high.pressure_alt == pytest.approx(584.0, abs=6.0)
    assert get(bench, "SCALED_PRESSURE").press_abs == 945.0


def test_second_imu_and_other_compasses(bench: Bench) -> None:
    v = bench.vehicle.v
    v.autopilot.calibrated.acc, v.autopilot.calibrated.acc2 = Vec3(0.0, 0.0, -9.81), Vec3(0.0, 9.81, 0.0)
    v.autopilot.calibrated.gyro2 = Vec3(0.1, 0.0, 0.0)
    for name in (f"COMPASS_OFS{k}_{axis}" for k in (2, 3) for axis in "XYZ"):
        v.autopilot.params[name] = 0.0
    v.sensors.mag2, v.sensors.mag3 = (0.1, 0.2, 0.3), (0.4, 0.5, 0.6)
    imu = get(bench, "SCALED_IMU2")
    assert imu.zacc in (-1000, -1001) and (imu.yacc, imu.xgyro) == (0, 0), "both show the same"
    v.sensors.imu_state = 1
    imu = get(bench, "SCALED_IMU2")
    assert imu.yacc in (1000, 1001) and (imu.zacc, imu.xgyro) == (0, 100)
    assert (imu.xmag, imu.ymag, imu.zmag) == pytest.approx((100, 200, 300), abs=1)
    third = get(bench, "SCALED_IMU3")
    assert (third.xmag, third.ymag, third.zmag) == pytest.approx((400, 500, 600), abs=1)
    assert (third.xacc, third.zacc, third.xgyro, third.temperature) == (0, 0, 0, 0)


def test_the_truth(bench: Bench) -> None:
    v = bench.vehicle.v
    body, place = v.physics.body, v.physics.origin
    place.lat, place.lon, place.alt = *HOME[:2], HOME[2]
    body.pos, body.vel, body.q = Vec3(100.0, 0.0, -20.0), Vec3(1.0, -2.0, 0.5), quat_about_down(0.5)
    m = get(bench, "SIM_STATE")
    assert (m.q1, m.q4, m.yaw) == pytest.approx((math.cos(0.25), math.sin(0.25), 0.5), abs=1e-5)
    assert (m.vn, m.ve, m.vd) == pytest.approx((1.0, -2.0, 0.5), abs=0.011)
    assert m.alt == pytest.approx(HOME[2] + 20.0, abs=0.01)
    assert m.lat_int == pytest.approx(HOME[0] + 8983, abs=2) and m.lon_int == HOME[1]
    assert (m.lat, m.lon) == pytest.approx((m.lat_int, m.lon_int), rel=1e-6), "degE7, as a real one's"
    assert (m.lat_int, m.yaw) == (get(bench, "SIMSTATE").lat, get(bench, "SIMSTATE").yaw)


def test_home_has_no_orientation(bench: Bench) -> None:
    bench.vehicle.locate()
    assert all(math.isnan(x) for x in get(bench, "HOME_POSITION").q)


def test_channels_are_eight_or_sixteen(bench: Bench) -> None:
    rc, v = bench.vehicle.v.autopilot.rc, bench.vehicle.v
    rc.receiver_us = v.time_us
    rc.channels[:] = 0
    assert get(bench, "RC_CHANNELS").chancount == 0
    rc.channels[7] = 1500
    assert get(bench, "RC_CHANNELS").chancount == 8
    rc.channels[8] = 1500
    assert get(bench, "RC_CHANNELS").chancount == 16
    rc.channels[7] = 0
    assert get(bench, "RC_CHANNELS").chancount == 16


def test_terrain_that_nobody_knows_is_at_sea_level(bench: Bench) -> None:
    bench.vehicle.locate()
    terrain, estimate = bench.vehicle.v.autopilot.terrain, bench.vehicle.v.autopilot.estimate
    estimate.pos = Vec3(0.0, 0.0, -10.0)
    terrain.asked = True
    report = get(bench, "TERRAIN_REPORT")
    assert (report.terrain_height, report.current_height) == (0.0, 594.0)
    terrain.was_known = True
    assert get(bench, "TERRAIN_REPORT").current_height == pytest.approx(10.0)


def test_heartbeat_and_status(bench: Bench) -> None:
    ap = bench.vehicle.v.autopilot
    beat = get(bench, "HEARTBEAT")
    assert (beat.type, beat.autopilot, beat.base_mode, beat.custom_mode, beat.system_status) == (2, 3, 81, 0, 3)
    ap.modes.number, ap.arming.armed, ap.arming.landed = 4, 1, 0
    beat = get(bench, "HEARTBEAT")
    assert (beat.base_mode, beat.custom_mode, beat.system_status) == (81 | 8 | 128, 4, 4)
    ap.arming.armed, ap.arming.prearm_ok, ap.battery.voltage, ap.battery.current = 0, 0, 12.6, 3.5
    ap.params.BATT_MONITOR = 4
    status = get(bench, "SYS_STATUS")
    assert (status.voltage_battery, status.current_battery) == (12600, 350)
    assert status.onboard_control_sensors_present & 0x10000000
    assert not status.onboard_control_sensors_health & 0x10000000
    ap.arming.prearm_ok = 1
    assert get(bench, "SYS_STATUS").onboard_control_sensors_health & 0x10000000
    fence = 0x100000  # ground stations report a breach where its health is missing
    status = get(bench, "SYS_STATUS")
    assert status.onboard_control_sensors_health & fence and status.onboard_control_sensors_present & fence
    assert not status.onboard_control_sensors_enabled & fence
    ap.params.FENCE.TYPE = 0
    assert not get(bench, "SYS_STATUS").onboard_control_sensors_present & fence


def test_landed_state(bench: Bench) -> None:
    ap = bench.vehicle.v.autopilot
    assert get(bench, "EXTENDED_SYS_STATE").landed_state == 1
    ap.arming.landed, ap.modes.number, ap.modes.guided.submode = 0, 4, 0
    assert get(bench, "EXTENDED_SYS_STATE").landed_state == 3
    ap.modes.takeoff.complete = 1
    assert get(bench, "EXTENDED_SYS_STATE").landed_state == 2
    ap.modes.landing.landing = 1
    assert get(bench, "EXTENDED_SYS_STATE").landed_state == 4


@pytest.mark.parametrize("value", [0.0, math.nan, math.inf, -math.inf, 1e30, -1e300])
def test_nothing_in_the_record_can_break_a_message(bench: Bench, value: float) -> None:
    """A diverged simulation still speaks (or leaves out what the wire cannot carry)."""
    bench.vehicle.locate()
    words = bench.vehicle.fleet.view("f8")
    keep = bench.vehicle.fleet.copy()
    for name in ("estimate", "battery", "home", "control"):
        offset = bench.vehicle.fleet.dtype["autopilot"].fields[name][1]
        start = (bench.vehicle.fleet.itemsize + bench.vehicle.fleet.dtype.fields["autopilot"][1] + offset) // 8
        size = bench.vehicle.fleet.dtype["autopilot"][name].itemsize // 8
        words[start : start + size] = value
    estimate = bench.vehicle.v.autopilot.estimate
    for name in estimate.dtype.names:
        if estimate.dtype[name].base == np.dtype("i8"):
            estimate[name] = keep[1]["autopilot"]["estimate"][name]
    for number in bench.bridge.telemetry:
        bench.bridge.send_now(bench.bridge.channels[0], number)
    bench.bridge.flush()
    assert "HEARTBEAT" in {m.get_type() for m in bench.client.receive()}


def test_absent_position_is_not_invented(bench: Bench) -> None:
    where = get(bench, "GLOBAL_POSITION_INT")
    assert (where.lat, where.lon, where.relative_alt) == (0, 0, 0)
    bench.vehicle.v.sensors.gps_fix, bench.vehicle.v.sensors.gps_lat = 3, 123
    assert get(bench, "GLOBAL_POSITION_INT").lat == 123


def test_pulses_that_are_none(bench: Bench) -> None:
    bench.vehicle.v.autopilot.rc.channels[:3] = (1500, -5, 70000)
    bench.vehicle.v.actuators.pwm[:2] = (1600, 2**40)
    rc, servo = get(bench, "RC_CHANNELS"), get(bench, "SERVO_OUTPUT_RAW")
    assert (rc.chan1_raw, rc.chan2_raw, rc.chan3_raw) == (1500, 0, 65535)
    assert (servo.servo1_raw, servo.servo2_raw) == (1600, 65535)


@pytest.mark.parametrize(("monitor", "millivolts", "centiamperes", "used"), [
    (0, 65535, -1, -1), (3, 12600, -1, -1), (4, 12600, 350, 100),
])  # fmt: skip
def test_what_the_battery_monitor_does_not_measure_is_unknown(
    bench: Bench, monitor: int, millivolts: int, centiamperes: int, used: int
) -> None:
    ap = bench.vehicle.v.autopilot
    ap.params.BATT_MONITOR = monitor
    ap.battery.voltage, ap.battery.current, ap.battery.consumed_mah, ap.battery.remaining_pct = 12.6, 3.5, 100, -1
    status, battery = get(bench, "SYS_STATUS"), get(bench, "BATTERY_STATUS")
    assert (status.voltage_battery, status.current_battery, status.battery_remaining) == (millivolts, centiamperes, -1)
    assert (battery.voltages[0], battery.current_battery, battery.battery_remaining) == (millivolts, centiamperes, -1)
    assert battery.current_consumed == used
    assert bool(status.onboard_control_sensors_present & 0x2000000) == (monitor > 0)


@pytest.mark.parametrize(
    ("remaining", "sent"), [(-1.0, -1), (0.0, 0), (0.9, 0), (57.9, 57), (250.0, 100), (math.nan, -1)]
)
def test_charge_left(bench: Bench, remaining: float, sent: int) -> None:
    bench.vehicle.v.autopilot.battery.remaining_pct = remaining
    assert get(bench, "SYS_STATUS").battery_remaining == sent
    assert get(bench, "BATTERY_STATUS").battery_remaining == sent


def test_sensor_health_is_what_the_firmware_knows(bench: Bench) -> None:
    gyro, compass, barometer, gps, ahrs, battery = 0x1, 0x4, 0x8, 0x20, 0x200000, 0x2000000
    v = bench.vehicle.v
    ekf, sensors = v.autopilot.ekf, v.sensors

    def health() -> int:
        return get(bench, "SYS_STATUS").onboard_control_sensors_health & (
            gyro | compass | barometer | gps | ahrs | battery
        )

    assert health() == 0
    v.time_us = sensors.time_us = sensors.gps_time_us = 30_000_000
    sensors.mag_count = sensors.baro_count = 1
    sensors.gps_fix = 3
    assert health() == gyro | compass | barometer | gps
    v.autopilot.estimate.attitude_ok = ekf.yaw_aligned = 1
    assert health() == gyro | gps | ahrs, "the filter has seen no sane sample for 30 s"
    ekf.mag_us = ekf.baro_us = v.time_us - 100_000
    ekf.bad_imu = 3
    assert health() == compass | barometer | gps | ahrs
    v.time_us += 5_000_000
    ekf.use_external = v.autopilot.battery.healthy = True
    v.autopilot.params.BATT_MONITOR = 4
    assert health() == gyro | compass | barometer | ahrs | battery, "the truth needs no filter; the GPS is silent"
    v.autopilot.modes.failsafe.battery = 1
    assert not health() & battery


def test_gps_accuracies(bench: Bench) -> None:
    sensors = bench.vehicle.v.sensors
    sensors.gps_eph, sensors.gps_epv = 121, 200
    raw = get(bench, "GPS_RAW_INT")
    assert (raw.eph, raw.epv, raw.h_acc, raw.v_acc, raw.vel_acc) == (65535, 65535, 0, 0, 0)
    sensors.gps_fix = 3
    raw = get(bench, "GPS_RAW_INT")
    assert (raw.eph, raw.epv, raw.h_acc, raw.v_acc, raw.vel_acc) == (121, 200, 300, 300, 0)
    sensors.gps_eph, sensors.gps_epv = 40121, 40000  # a jammed receiver's
    raw = get(bench, "GPS_RAW_INT")
    assert (raw.h_acc, raw.v_acc, raw.vel_acc) == (pytest.approx(99473, abs=1), 60000, 32000)


def test_no_channels_without_receiver_or_override(bench: Bench) -> None:
    v = bench.vehicle.v
    assert get(bench, "RC_CHANNELS").chancount == 0
    v.autopilot.rc.channels[:4] = 1500
    assert get(bench, "RC_CHANNELS").chancount == 8
    v.time_us += 10_000_000
    assert get(bench, "RC_CHANNELS").chancount == 0
    v.autopilot.rc.receiver_us = v.time_us
    assert get(bench, "RC_CHANNELS").chancount == 8


def test_a_message_that_is_left_out_is_told_once(bench: Bench) -> None:
    kind = message("HEARTBEAT")
    bench.bridge.by_shell[kind.id] = lambda: kind.pack(-1, 2, 3, 4, 5, 6)
    for _ in range(3):
        assert bench.bridge.send_now(bench.bridge.channels[0], kind.id)
    assert len(bench.bridge.dropped) == 1 and "HEARTBEAT" in bench.bridge.dropped[0]


@pytest.mark.parametrize(
    ("failsafe", "value", "critical"),
    [
        ("gcs", 1, True), ("radio", 1, True), ("battery", 1, True), ("battery", 2, True), ("ekf", 1, True),
        ("battery", 0, False),
    ],
)  # fmt: skip
@pytest.mark.parametrize("landed", [0, 1])
def test_a_vehicle_in_a_failsafe_is_critical(
    bench: Bench, failsafe: str, value: int, critical: bool, landed: int
) -> None:
    """MAV_STATE_CRITICAL; else MAV_STATE_STANDBY on the ground, MAV_STATE_ACTIVE in the air."""
    ap = bench.vehicle.v.autopilot
    ap.arming.landed = landed
    setattr(ap.modes.failsafe, failsafe, value)
    assert get(bench, "HEARTBEAT").system_status == (5 if critical else 3 if landed else 4)
