# SPDX-License-Identifier: BSD-3-Clause
"""Batteries, missions, clocks, fences and slow links in telemetry, by MAVLink's units and enumerations."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.bridge.copter import status_messages as copter_status
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
