# SPDX-License-Identifier: BSD-3-Clause
"""Batteries, missions, clocks, fences and slow links in telemetry, by MAVLink's units and enumerations."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.autopilot.navigation.state import TAKEOFF
from sitl.bridge.copter import status_messages as copter_status
from sitl.bridge.copter import targets as copter_targets
from sitl.bridge.telemetry import fence_status, status
from sitl.bridge.telemetry.high_latency import FAILURES, failures
from sitl.core.mavlink import MavSysStatus
from sitl.core.vectors import Euler, Vec3
from tests.bridge.fakes import Bench
from tests.bridge.test_message_values import located
from tests.bridge.test_telemetry_laws import says


@pytest.fixture
def v() -> Any:
    return located()


@pytest.mark.parametrize(
    ("monitor", "voltage", "current", "consumed", "energy"),
    [(0.0, 65535, -1, -1, -1), (3.0, 12_600, -1, -1, -1), (4.0, 12_600, 1234, 1500, 720), (2.0, 65535, -1, -1, -1)],
)
def test_what_the_monitor_of_the_battery_measures(
    v: Any, monitor: float, voltage: int, current: int, consumed: int, energy: int
) -> None:
    battery = v.autopilot.battery
    v.autopilot.params["BATT_MONITOR"] = monitor
    battery.voltage, battery.current, battery.consumed_mah, battery.consumed_wh = 12.6, 12.34, 1500.4, 20.0
    battery.remaining_pct = 74.9
    m = says(status.battery_status, v)
    assert m.voltages[0] == voltage and set(m.voltages[1:]) == {65535} and m.temperature == 32767
    assert (m.current_battery, m.current_consumed, m.energy_consumed, m.battery_remaining) == (
        current,
        consumed,
        energy,
        74,
    )


@pytest.mark.parametrize(
    ("level", "healthy", "state"),
    [(0, True, 1), (0, False, 6), (1, True, 2), (1, False, 2), (2, True, 3), (2, False, 3)],
)
def test_states_of_charge(level: int, healthy: bool, state: int) -> None:
    assert status.charge_state(level, healthy) == state


def test_the_filters_report(v: Any) -> None:
    estimate = v.autopilot.estimate
    estimate.variance_vel, estimate.variance_pos, estimate.variance_hgt, estimate.variance_mag = 0.125, 0.25, 0.5, 0.75
    estimate.status_flags = 0x1033F
    m = says(status.ekf_status_report, v)
    assert (m.velocity_variance, m.pos_horiz_variance, m.pos_vert_variance, m.compass_variance) == (
        0.125,
        0.25,
        0.5,
        0.75,
    )
    assert m.flags == 0x033F and m.terrain_alt_variance == 0.0


@pytest.mark.parametrize(
    ("total", "running", "paused", "state"),
    [(0.0, 0, False, 1), (1.0, 1, False, 1), (2.0, 0, False, 2), (2.0, 1, False, 3), (2.0, 2, False, 5),
     (2.0, 2, True, 5), (2.0, 1, True, 4), (2.0, 0, True, 4)],
)  # fmt: skip
@pytest.mark.parametrize("mode", [3, 4])
def test_states_of_a_mission(v: Any, total: float, running: int, paused: bool, state: int, mode: int) -> None:
    """MISSION_STATE; home, item 0, is no mission, and does not count."""
    modes: Any = v.autopilot.modes
    v.autopilot.params["MIS_TOTAL"], modes.nav.mission_current, modes.nav.mission_state, modes.number = (
        total,
        7,
        running,
        mode,
    )
    found: Any = type("Current", (), {})()
    assert status.mission_current(found, v, 3, paused) is True
    assert (found.seq, found.total) == (7, max(int(total) - 1, 0)) and found.mission_state == state
    assert found.mission_mode == int(mode == 3)


def test_boards_and_clocks(v: Any) -> None:
    assert says(status.power_status, v).Vcc == 5000
    assert (says(status.meminfo, v).freemem, says(status.meminfo, v).freemem32) == (65535, 524288)
    assert says(status.timesync, v).ts1 == 12_345_678_001 and says(status.timesync, v).tc1 == 0
    assert says(status.available_modes_monitor, v).seq == 0


# ---------------------------------------------------------------- fences, slow links


@pytest.mark.parametrize(("breached", "kind"), [(0, 0), (8, 1), (1, 2), (2, 3), (4, 3), (9, 1), (3, 2), (6, 3)])
def test_kinds_of_breaches(breached: int, kind: int) -> None:
    """FENCE_TYPE: 1 highest, 2 circle, 4 polygons, 8 lowest; FENCE_BREACH: 1 below, 2 above, 3 outside."""
    assert fence_status.breach_type(breached) == kind


@pytest.mark.parametrize(
    ("on", "kinds", "action", "is_at_work"),
    [
        (0, 7.0, 1.0, False),
        (7, 7.0, 1.0, True),
        (7, 7.0, 0.0, False),
        (2, 7.0, 2.0, True),
        (2, 5.0, 1.0, False),
        (7, 4.0, 1.0, True),
    ],
)
def test_a_fence_is_at_work_while_it_is_on_and_does_something(
    v: Any, on: int, kinds: float, action: float, is_at_work: bool
) -> None:
    """FENCE_ACTION 0 only reports."""
    v.autopilot.fence.on, v.autopilot.fence.shapes = on, 1
    v.autopilot.params["FENCE_TYPE"], v.autopilot.params["FENCE_ACTION"] = kinds, action
    assert fence_status.is_at_work(v) is is_at_work
    enabled = says(copter_status.sys_status, v).onboard_control_sensors_enabled
    assert bool(enabled & MavSysStatus.GEOFENCE) is is_at_work


def test_a_fence_that_is_on_tells_of_its_breaches(v: Any) -> None:
    found = v.autopilot.fence
    assert says(fence_status.fence_status, v) is None
    found.on, found.breached, found.breaches, found.breach_us = 1, 2, 65537, 9_876_543
    m = says(fence_status.fence_status, v)
    assert (m.breach_status, m.breach_type, m.breach_count, m.breach_time, m.breach_mitigation) == (1, 3, 1, 9_876, 1)
    found.breached = 0
    assert says(fence_status.fence_status, v).breach_status == 0


@pytest.mark.parametrize("sensor", sorted(FAILURES))
def test_what_is_not_healthy_has_its_bit(sensor: int) -> None:
    """HL_FAILURE_FLAG."""
    everything = sum(FAILURES)
    assert failures(everything) == 0 and failures(everything & ~sensor) == FAILURES[MavSysStatus(sensor)]
    assert failures(0) == sum(set(FAILURES.values())) and len(set(FAILURES.values())) == len(FAILURES)


def test_a_slow_link_has_coarse_numbers() -> None:
    bench = Bench()
    bench.vehicle.locate()
    ap = bench.vehicle.v.autopilot
    ap.estimate.vel, ap.estimate.pos = Vec3(3.0, -4.0, 0.0), Vec3(0.0, 0.0, -10.5)
    ap.estimate.euler = Euler(0.0, 0.0, 1.5)
    ap.battery.remaining_pct, ap.modes.nav.mission_current, ap.arming.armed = 42.9, 7, True
    bench.vehicle.v.time_us = 9_876_543
    (m,) = bench.telemetry("HIGH_LATENCY2")
    assert (m.groundspeed, m.airspeed, m.heading, m.altitude) == (25, 25, 42, 594)
    assert (m.battery, m.wp_num, m.timestamp, m.autopilot, m.type) == (42, 7, 9_876, 3, 2)
    assert m.custom0 < 0 and m.temperature_air == -128, "base_mode with its highest bit; no airspeed sensor"
    bench.vehicle.parameters.update({"ARSPD_ENABLE": 1.0, "ARSPD_TYPE": 1.0})
    bench.vehicle.v.sensors.temperature = 21.9
    assert bench.telemetry("HIGH_LATENCY2")[0].temperature_air == 21


# ---------------------------------------------------------------- what is there, at work and well


def bits(law: Any, v: Any, bit: int) -> tuple[bool, bool, bool]:
    """Whether SYS_STATUS has a sensor present, enabled, healthy."""
    m = says(law, v)
    names = ("present", "enabled", "health")
    return tuple(bool(getattr(m, f"onboard_control_sensors_{name}") & bit) for name in names)  # type: ignore[return-value]


@pytest.mark.parametrize(
    ("backend", "disarmed", "armed_us", "expected"),
    [(0.0, 1.0, 5, (False, False, False)), (4.0, 0.0, 0, (True, False, True)), (4.0, 1.0, 0, (True, True, True)),
     (4.0, 0.0, 1, (True, True, True))],
)  # fmt: skip
def test_logging_is_at_work_once_armed_or_with_log_disarmed(
    v: Any, backend: float, disarmed: float, armed_us: int, expected: Any
) -> None:
    v.autopilot.params.LOG.BACKEND_TYPE, v.autopilot.params.LOG.DISARMED = backend, disarmed
    v.autopilot.arming.armed_us = armed_us
    assert bits(copter_status.sys_status, v, MavSysStatus.LOGGING) == expected


@pytest.mark.parametrize(("name", "bit"), [
    ("flow", MavSysStatus.SENSOR_OPTICAL_FLOW), ("odometry", MavSysStatus.SENSOR_VISION_POSITION),
])  # fmt: skip
def test_what_companions_see_is_healthy_while_they_speak(v: Any, name: str, bit: int) -> None:
    part: Any = getattr(v.autopilot, name)
    assert bits(copter_status.sys_status, v, bit) == (False, False, False)
    part.kind = 1
    assert bits(copter_status.sys_status, v, bit) == (True, True, False)
    if name == "flow":
        part.count, part.time_us = 1, v.time_us - 100_000
    else:
        part.pose.time_us = v.time_us - 100_000
    assert bits(copter_status.sys_status, v, bit) == (True, True, True)


def test_parts_of_a_copter_in_its_status(v: Any) -> None:
    ap = v.autopilot
    seen, motors = MavSysStatus.SENSOR_VISION_POSITION, MavSysStatus.SENSOR_PROPULSION
    ap.params.PLND.ENABLED = 1.0
    assert bits(copter_status.sys_status, v, seen) == (True, True, False)
    ap.landing_target.sees = True
    assert bits(copter_status.sys_status, v, seen) == (True, True, True)
    assert bits(copter_status.sys_status, v, motors) == (True, True, True)
    ap.control.motors.boosting = True
    assert bits(copter_status.sys_status, v, motors) == (True, True, False)
    for part, bit in (
        (ap.control.pos_ne, MavSysStatus.SENSOR_XY_POSITION_CONTROL),
        (ap.control.pos_d, MavSysStatus.SENSOR_Z_ALTITUDE_CONTROL),
    ):
        assert bits(copter_status.sys_status, v, bit)[0]
        ap.control.tick, part.last_tick = 1000, 1000
        assert bits(copter_status.sys_status, v, bit) == (True, True, True)
        part.last_tick = 0
        assert bits(copter_status.sys_status, v, bit) == (True, False, False)


@pytest.mark.parametrize(("ok", "armed", "healthy"), [(0, 0, False), (1, 0, True), (0, 1, True)])
def test_checks_before_arming_are_healthy_when_armed(v: Any, ok: int, armed: int, healthy: bool) -> None:
    v.autopilot.arming.prearm_ok, v.autopilot.arming.armed = ok, armed
    assert bits(copter_status.sys_status, v, MavSysStatus.PREARM_CHECK) == (True, True, healthy)


def test_receivers_and_batteries_are_there_where_they_say_something(v: Any) -> None:
    gps, battery = MavSysStatus.SENSOR_GPS, MavSysStatus.SENSOR_BATTERY
    for fix, there in ((0, False), (1, True), (3, True)):
        v.sensors.gps_fix = fix
        assert bits(copter_status.sys_status, v, gps)[:2] == (there, there)
    for monitor, there in ((2.0, False), (3.0, True), (4.0, True)):
        v.autopilot.params["BATT_MONITOR"] = monitor
        v.autopilot.battery.healthy = False
        assert bits(copter_status.sys_status, v, battery) == (there, there, False)
        v.autopilot.battery.healthy = True
        assert bits(copter_status.sys_status, v, battery) == (there, there, there)


@pytest.mark.parametrize(
    ("change", "missing"),
    [
        ({}, 0), ({"imu_state": 2}, MavSysStatus.SENSOR_3D_GYRO), ({"imu_state": 4}, MavSysStatus.SENSOR_3D_GYRO),
        ({"imu_state": 8}, MavSysStatus.SENSOR_3D_ACCEL), ({"imu_state": 16}, MavSysStatus.SENSOR_3D_ACCEL),
        ({"imu_state": 1}, 0), ({"mag_count": 0}, MavSysStatus.SENSOR_3D_MAG),
        ({"baro_count": 0}, MavSysStatus.SENSOR_ABSOLUTE_PRESSURE), ({"gps_fix": 2}, MavSysStatus.SENSOR_GPS),
        ({"time_us": 0}, MavSysStatus.SENSOR_3D_GYRO | MavSysStatus.SENSOR_3D_ACCEL),
        ({"ekf.mag_us": 29_500_000}, 0), ({"ekf.mag_us": 29_499_999}, MavSysStatus.SENSOR_3D_MAG),
        ({"ekf.baro_us": 29_500_000}, 0), ({"ekf.baro_us": 29_499_999}, MavSysStatus.SENSOR_ABSOLUTE_PRESSURE),
        ({"ekf.mag_us": 0, "ekf.yaw_aligned": 0}, 0), ({"ekf.baro_us": 0, "ekf.use_external": True}, 0),
        ({"gps_time_us": 26_000_000}, 0), ({"gps_time_us": 25_999_999}, MavSysStatus.SENSOR_GPS),
        ({"ekf.bad_imu": 1}, MavSysStatus.SENSOR_3D_GYRO | MavSysStatus.SENSOR_3D_ACCEL),
        ({"ekf.bad_imu": 1, "ekf.use_external": True}, 0),
    ],
)  # fmt: skip
def test_sensors_are_healthy_while_sane_samples_come(v: Any, change: dict[str, Any], missing: int) -> None:
    """Half a second for what the filter uses, four seconds for the GPS."""
    well = {"mag_count": 1, "baro_count": 1, "gps_fix": 3, "gps_time_us": 30_000_000, "time_us": 30_000_000,
            "ekf.yaw_aligned": 1, "ekf.mag_us": 30_000_000, "ekf.baro_us": 30_000_000}  # fmt: skip
    v.time_us = 30_000_000
    found = []
    for values in (well, change):
        for name, value in values.items():
            setattr(v.autopilot.ekf if name.startswith("ekf.") else v.sensors, name.removeprefix("ekf."), value)
        found.append(status.sensor_health(v))
    assert found[0] & 0x2F == 0x2F and found[0] & ~found[1] == missing


# ---------------------------------------------------------------- what only the copter tells


@pytest.mark.parametrize(("motors", "kind"), [(4, 2), (6, 13), (8, 14), (5, 2)])
def test_kinds_of_multicopters(v: Any, motors: int, kind: int) -> None:
    v.autopilot.control.motors.count = motors
    assert says(copter_status.heartbeat, v).type == kind


@pytest.mark.parametrize(
    ("mode", "submode", "command", "active", "complete", "state"),
    [
        (4, 0, 0, False, False, 3), (4, 0, 0, False, True, 2), (4, 1, 0, False, False, 2), (5, 0, 0, False, False, 2),
        (3, 1, TAKEOFF, False, False, 3), (3, 1, TAKEOFF, False, True, 2), (3, 1, TAKEOFF + 1, False, False, 2),
        (5, 1, TAKEOFF, False, False, 2), (5, 1, 0, True, False, 3), (5, 1, 0, True, True, 3),
    ],
)  # fmt: skip
def test_a_copter_takes_off(
    v: Any, mode: int, submode: int, command: int, active: bool, complete: bool, state: int
) -> None:
    """MAV_LANDED_STATE, of MAV_VTOL_STATE_MC: by GUIDED, a mission or the pilot."""
    modes = v.autopilot.modes
    modes.number, modes.guided.submode, modes.nav.command_kind = mode, submode, command
    modes.takeoff.user_active, modes.takeoff.complete, modes.landing.landing = active, complete, False
    v.autopilot.arming.landed = False
    m = says(copter_status.extended_sys_state, v)
    assert (m.vtol_state, m.landed_state) == (3, state)


def test_speed_controllers_report_their_share(v: Any) -> None:
    s = v.sensors
    s.esc_motors, s.esc_count, s.temperature, s.battery_voltage, s.battery_current = 6, 65538, 21.9, 12.345, 30.0
    v.autopilot.battery.consumed_mah = 600.0
    s.esc_rpm[:6] = range(1000, 7000, 1000)
    v.autopilot.params.RPM1_TYPE = 5.0
    first, second = says(copter_status.esc_telemetry_1_to_4, v), says(copter_status.esc_telemetry_5_to_8, v)
    assert (first.rpm, second.rpm) == ((1000, 2000, 3000, 4000), (5000, 6000, 0, 0))
    for m, n in ((first, 4), (second, 2)):
        for found, value in (
            (m.temperature, 21), (m.voltage, 1234), (m.current, 500), (m.totalcurrent, 100), (m.count, 2)
        ):  # fmt: skip
            assert tuple(found) == n * (value,) + (4 - n) * (0,)
    m = says(copter_status.rpm, v)
    assert (m.rpm1, m.rpm2) == (3500.0, -1.0)
    s.esc_motors = 4
    assert says(copter_status.esc_telemetry_5_to_8, v) is None and says(copter_status.rpm, v).rpm1 == 2500.0
    v.autopilot.params.RPM1_TYPE = 4.0
    assert says(copter_status.rpm, v) is None


def test_a_copter_knows_no_wind(v: Any) -> None:
    m = says(copter_status.wind, v)
    assert (m.direction, m.speed, m.speed_z) == (-180.0, 0.0, 0.0)


def test_the_ground_below_a_copter(v: Any) -> None:
    """10 m above the origin, home 1 m above it, the terrain at home 580 m above sea level."""
    t = v.autopilot.terrain
    t.home, t.offset, t.spacing, t.pending, t.loaded, t.is_known = 580.0, 2.0, 100, 3, 5, False
    t.was_known, t.asked = True, True
    m = says(copter_status.terrain_report.terrain_report, v)
    assert (m.spacing, m.pending, m.loaded, m.terrain_height, m.current_height) == (0, 3, 5, 582.0, 9.0)
    assert m.lat == pytest.approx(-353632620 + 8983, abs=2)
    for was_known, asked, height in ((True, False, 9.0), (False, False, 9.0), (False, True, 594.0)):
        t.was_known, t.asked = was_known, asked
        assert says(copter_status.terrain_report.terrain_report, v).current_height == height


@pytest.mark.parametrize(
    ("mode", "submode", "to"),
    [(4, 1, "guided"), (3, 1, "nav"), (21, 1, "nav"), (6, 1, "home"), (5, 1, None)],
)  # fmt: skip
def test_where_a_copter_flies_to(v: Any, mode: int, submode: int, to: str | None) -> None:
    ap = v.autopilot
    ap.modes.number, ap.modes.guided.submode = mode, submode
    ap.modes.guided.pos, ap.modes.nav.target = Vec3(103.0, 204.0, 0.0), Vec3(100.0, 180.0, 0.0)
    ap.home.pos = Vec3(70.0, 200.0, 0.0)
    ap.control.attitude.target_euler = Euler(0.1, -0.2, 1.5)
    ap.control.pos_d.pos_error = -2.5
    m = says(copter_targets.nav_controller_output, v)
    expected = {"guided": (53, 5), "nav": (-90, 20), "home": (180, 30), None: (0, 0)}
    assert (m.target_bearing, m.wp_dist) == expected[to]
    assert (m.nav_roll, m.nav_pitch, m.nav_bearing, m.alt_error) == pytest.approx(
        (5.7296, -11.4592, 85, -2.5), rel=1e-5
    )


@pytest.mark.parametrize(("submode", "mask"), [(0, 0xDF8), (1, 0xDF8), (2, 0xC00), (3, 0xC07), (4, 0xC3F), (5, None)])
def test_what_counts_of_a_target_of_guided(v: Any, submode: int, mask: int | None) -> None:
    v.autopilot.modes.number, v.autopilot.modes.guided.submode = 4, submode
    m = says(copter_targets.position_target_local, v)
    assert (None if m is None else m.type_mask) == mask
