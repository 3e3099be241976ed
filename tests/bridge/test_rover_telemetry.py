# SPDX-License-Identifier: BSD-3-Clause
"""Telemetry that the rover has in its own way."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sitl.autopilot.rover.modes import auto
from sitl.autopilot.rover.modes import guided as guided_mode
from sitl.core.vectors import Vec3
from tests.bridge.fakes import HOME, Bench

MANUAL, HOLD, AUTO, RTL, GUIDED, INITIALISING = 0, 4, 10, 11, 15, 16
CUSTOM, AUTONOMOUS, STICKS, ARMED = 1, 8, 64, 128


def get(bench: Bench, name: str) -> Any:
    """One message, as a client decodes it; None when there is nothing to say."""
    found = bench.telemetry(name)
    return found[0] if found else None


@pytest.mark.parametrize(("mode", "base", "state"), [
    (MANUAL, CUSTOM | STICKS, 4), (HOLD, CUSTOM, 3), (GUIDED, CUSTOM | AUTONOMOUS, 4), (AUTO, CUSTOM | AUTONOMOUS, 4),
    (INITIALISING, CUSTOM | STICKS, 2),
])  # fmt: skip
def test_heartbeat(rover_bench: Bench, mode: int, base: int, state: int) -> None:
    ap = rover_bench.vehicle.v.autopilot
    ap.modes.number = mode
    beat = get(rover_bench, "HEARTBEAT")
    assert (beat.type, beat.autopilot, beat.custom_mode) == (10, 3, mode)
    assert (beat.base_mode, beat.system_status) == (base, state)
    ap.arming.armed, ap.params.STICK_MIXING, ap.modes.links.acted = 1, 1, 2
    beat = get(rover_bench, "HEARTBEAT")
    starting = mode == INITIALISING
    assert beat.base_mode == (base if starting else base | ARMED | STICKS) and beat.system_status == 5


def test_controllers_are_at_work_in_some_modes(rover_bench: Bench) -> None:
    rates, heading, altitude, place = 0x400 | 0x800, 0x1000, 0x2000, 0x4000
    every = rates | heading | place | altitude
    ap = rover_bench.vehicle.v.autopilot
    for mode, armed, at_work in (
        (MANUAL, 0, 0), (1, 0, rates), (HOLD, 1, 0), (GUIDED, 1, rates | heading | place)
    ):  # fmt: skip
        ap.modes.number, ap.arming.armed = mode, armed
        status = get(rover_bench, "SYS_STATUS")
        assert status.onboard_control_sensors_present & every == every & ~altitude
        assert status.onboard_control_sensors_enabled & every == at_work
        assert status.onboard_control_sensors_health & every == at_work
        assert status.onboard_control_sensors_enabled & status.onboard_control_sensors_health & 0x8000, "outputs"


def test_it_neither_flies_nor_lands(rover_bench: Bench) -> None:
    state = get(rover_bench, "EXTENDED_SYS_STATE")
    assert (state.vtol_state, state.landed_state) == (0, 0)
    names = {kind.name for kind in rover_bench.bridge.telemetry.values()}
    assert not names & {"ATTITUDE_TARGET", "POSITION_TARGET_LOCAL_NED"}


def test_throttle_and_outputs(rover_bench: Bench) -> None:
    motors, p = rover_bench.vehicle.v.autopilot.control.motors, rover_bench.vehicle.v.autopilot.params
    motors.throttle, motors.out_throttle, motors.out_steering = -0.4, -0.5, 0.25
    motors.out_left, motors.out_right = 1.0, -0.125
    assert get(rover_bench, "VFR_HUD").throttle == 40
    out = get(rover_bench, "RC_CHANNELS_SCALED")
    assert (out.chan1_scaled, out.chan3_scaled, out.chan2_scaled, out.rssi) == (2500, -5000, 0, 255)
    p.SERVO1_FUNCTION, p.SERVO3_FUNCTION = 73, 74
    out = get(rover_bench, "RC_CHANNELS_SCALED")
    assert (out.chan1_scaled, out.chan3_scaled) == (10_000, -1250)


def test_wheel_distance_needs_encoders(rover_bench: Bench) -> None:
    sensors = rover_bench.vehicle.v.sensors
    assert get(rover_bench, "WHEEL_DISTANCE") is None
    sensors.wheel_count, sensors.wheel_distance = 7, (12.5, -3.0)
    rolled = get(rover_bench, "WHEEL_DISTANCE")
    assert rolled.count == 2 and list(rolled.distance[:3]) == [12.5, -3.0, 0.0]
    p = rover_bench.vehicle.v.autopilot.params
    for first, second, count in ((1.0, 0.0, 1), (1.0, 1.0, 2), (0.0, 0.0, 2)):
        p.WENC.TYPE, p.WENC2.TYPE = first, second
        rolled = get(rover_bench, "WHEEL_DISTANCE")
        assert rolled.count == count and list(rolled.distance[:3]) == [12.5, -3.0 if count == 2 else 0.0, 0.0]


@pytest.mark.parametrize(("acted", "ekf", "state"), [(0, 0, 4), (1, 0, 5), (0, 1, 5)])
def test_a_rover_in_a_failsafe_is_critical(rover_bench: Bench, acted: int, ekf: int, state: int) -> None:
    modes = rover_bench.vehicle.v.autopilot.modes
    modes.links.acted, modes.failsafe.ekf = acted, ekf
    assert get(rover_bench, "HEARTBEAT").system_status == state


@pytest.fixture
def driving(rover_bench: Bench) -> Bench:
    """At (3, 4) m, on the way to (3, 24) m, with the target of the moment at (8, 9) m."""
    rover_bench.vehicle.locate()
    ap = rover_bench.vehicle.v.autopilot
    ap.estimate.pos, ap.modes.nav.target = (3.0, 4.0, 0.0), (3.0, 24.0, 0.0)
    ap.modes.loiter.hold_pos, ap.modes.circle.target = (13.0, 4.0), (-7.0, 4.0)
    ap.modes.nav.drive.crosstrack, ap.control.position.pos_target = -1.5, (8.0, 9.0)
    return rover_bench


def test_targets_of_guided(driving: Bench) -> None:
    modes = driving.vehicle.v.autopilot.modes
    modes.number = GUIDED
    assert get(driving, "POSITION_TARGET_GLOBAL_INT") is None
    modes.guided.submode, modes.guided.heading = guided_mode.HEADING_AND_SPEED, math.radians(-30.5)
    modes.guided.has_target = 1
    output = get(driving, "NAV_CONTROLLER_OUTPUT")
    assert (output.nav_bearing, output.target_bearing, output.wp_dist, output.xtrack_error) == (-30, 0, 0, 0.0)
    modes.guided.has_target = 0
    assert get(driving, "NAV_CONTROLLER_OUTPUT").nav_bearing == 0, "timed out"
    modes.guided.submode = guided_mode.POSITION
    output = get(driving, "NAV_CONTROLLER_OUTPUT")
    assert (output.nav_bearing, output.target_bearing, output.wp_dist, output.xtrack_error) == (0, 90, 20, -1.5)
    target = get(driving, "POSITION_TARGET_GLOBAL_INT")
    assert target.type_mask == 0xFDF8 and target.lat_int == pytest.approx(HOME[0] + 270, abs=1)


@pytest.mark.parametrize(("mode", "in_auto", "bearing", "distance"), [
    (RTL, 0, 90, 20), (12, 0, 90, 20), (5, 0, 0, 10), (9, 0, 180, 10), (AUTO, auto.ON_PATH, 90, 20),
    (AUTO, auto.RETURNING, 90, 20), (AUTO, auto.CIRCLING, 180, 10), (AUTO, auto.LOITERING, 0, 10),
    (AUTO, auto.STOPPED, 0, 0),
])  # fmt: skip
def test_targets_of_other_modes(driving: Bench, mode: int, in_auto: int, bearing: int, distance: int) -> None:
    modes = driving.vehicle.v.autopilot.modes
    modes.number, modes.auto.submode = mode, in_auto
    output = get(driving, "NAV_CONTROLLER_OUTPUT")
    assert (abs(output.target_bearing), output.wp_dist) == (bearing, distance)
    assert (get(driving, "POSITION_TARGET_GLOBAL_INT") is None) == (distance == 0)


@pytest.mark.parametrize("mode", [MANUAL, 1, 3, HOLD, 7, INITIALISING])
def test_the_pilots_modes_have_no_target(driving: Bench, mode: int) -> None:
    driving.vehicle.v.autopilot.modes.number = mode
    assert get(driving, "NAV_CONTROLLER_OUTPUT") is get(driving, "POSITION_TARGET_GLOBAL_INT") is None


@pytest.mark.parametrize("value", [math.nan, math.inf, -1e300, 1e18])
def test_no_number_of_the_record_stops_telemetry(rover_bench: Bench, value: float) -> None:
    """Whatever a controller or the physics comes to: messages are sent, or left out, and nothing raises."""
    v = rover_bench.vehicle.v
    for mode in (AUTO, RTL, GUIDED, 5, 9, 12):
        v.autopilot.modes.number, v.autopilot.estimate.origin_set = mode, 1
        v.autopilot.estimate.pos = Vec3(value, value, value)
        v.autopilot.modes.guided.submode, v.autopilot.modes.guided.heading = guided_mode.POSITION, value
        v.autopilot.control.motors.throttle = v.autopilot.control.motors.out_throttle = value
        for number in rover_bench.bridge.telemetry:
            rover_bench.bridge.send_now(rover_bench.bridge.channels[0], number)
    assert np.isnan(v.autopilot.estimate.pos[0]) or v.autopilot.estimate.pos[0] == value
