# SPDX-License-Identifier: BSD-3-Clause
"""Set-points of environments as MAVLink has them: axes, frames, what the masks let count; and what reports say."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sitl.bridge.dialect import message
from sitl.core.algebra import euler_of
from sitl.core.vectors import Quat
from sitl.envs.mavlink import target_messages
from sitl.envs.mavlink.betaflight import Hold
from sitl.envs.mavlink.last_messages import StepTelemetry
from sitl.envs.mavlink.reports import ACCELERATION, BATTERY, LANDED, RANGE, REPORTED, WIND, note_report, show_report

POSITION, VELOCITY, ACCELERATIONS, YAW, YAW_RATE = 0o7, 0o7 << 3, 0o7 << 6, 1 << 10, 1 << 11
"""Bits of POSITION_TARGET_TYPEMASK: what does not count."""


@pytest.fixture
def inbox() -> StepTelemetry:
    """Of vehicle 5, which heads east."""
    made = StepTelemetry(1)
    made.system, made.attitude = 5, (0, 0.0, 0.0, math.pi / 2, 0.0, 0.0, 0.0)
    return made


def told(table: Any, name: str, row: tuple[float, ...], inbox: StepTelemetry, origin: Any = (0.0, 0.0, 0.0)) -> Any:
    kind, payload = table[name](row, inbox, origin)
    found = kind.decode(payload)
    assert found.target_system == 5
    return found


@pytest.mark.parametrize("table", [target_messages.COPTER, target_messages.ROVER])
def test_velocities_go_along_the_heading(inbox: StepTelemetry, table: Any) -> None:
    """MAV_FRAME_BODY_OFFSET_NED: forward, right, down; ours are forward, left, up, counter-clockwise."""
    m = told(table, "velocity", (1.0, 0.5, 0.25, 0.3), inbox)
    assert (m.vx, m.vy, m.vz, m.yaw_rate) == pytest.approx((1.0, -0.5, -0.25, -0.3))
    assert (m.coordinate_frame, m.type_mask) == (9, POSITION | ACCELERATIONS | YAW)


def test_accelerations_too(inbox: StepTelemetry) -> None:
    m = told(target_messages.COPTER, "acceleration", (1.0, 0.5, 0.25, 0.3), inbox)
    assert (m.afx, m.afy, m.afz, m.yaw_rate) == pytest.approx((1.0, -0.5, -0.25, -0.3))
    assert (m.coordinate_frame, m.type_mask) == (9, POSITION | VELOCITY | YAW)


def test_positions_are_from_the_vehicles_origin(inbox: StepTelemetry) -> None:
    """x of a world is north, y west, z up; yaw 0 looks north and grows counter-clockwise."""
    m = told(target_messages.COPTER, "position", (3.0, 2.0, 1.5, 0.5), inbox, (1.0, 4.0, -2.0))
    assert (m.x, m.y, m.z) == pytest.approx((2.0, -6.0, 0.5))
    assert math.cos(m.yaw + 0.5) == pytest.approx(1.0)
    assert (m.coordinate_frame, m.type_mask) == (1, VELOCITY | ACCELERATIONS | YAW_RATE)
    m = told(target_messages.ROVER, "position", (3.0, 2.0, 1.5, 0.5), inbox)
    assert (m.x, m.y) == pytest.approx((3.0, -2.0))
    assert (m.coordinate_frame, m.type_mask) == (1, VELOCITY | ACCELERATIONS | YAW | YAW_RATE)


@pytest.mark.parametrize(("name", "value", "thrust"), [("attitude", 0.5, 0.75), ("attitude", -1.0, 0.0),
                                                       ("attitude", 0.0, 0.5), ("thrust", 0.6, 0.6)])  # fmt: skip
def test_leans_keep_the_heading(inbox: StepTelemetry, name: str, value: float, thrust: float) -> None:
    m = told(target_messages.COPTER, name, (0.1, -0.2, 0.3, value), inbox)
    assert euler_of(Quat(*m.q)) == pytest.approx((0.1, -0.2, math.pi / 2), abs=1e-6)
    assert (m.body_yaw_rate, m.thrust, m.type_mask) == pytest.approx((-0.3, thrust, 0))


def test_rates_come_without_an_attitude(inbox: StepTelemetry) -> None:
    m = told(target_messages.COPTER, "rates", (0.1, -0.2, 0.3, 0.6), inbox)
    assert (m.body_roll_rate, m.body_pitch_rate, m.body_yaw_rate) == pytest.approx((0.1, -0.2, -0.3))
    assert m.thrust == pytest.approx(0.6) and m.type_mask == 128 and m.q == (1.0, 0.0, 0.0, 0.0)


def test_a_car_turns_and_drives(inbox: StepTelemetry) -> None:
    m = told(target_messages.ROVER, "attitude", (0.0, 0.0, 0.3, -0.4), inbox)
    assert (m.body_yaw_rate, m.thrust, m.type_mask) == pytest.approx((-0.3, -0.4, 1 | 2 | 128))


def test_pulses_are_whole(inbox: StepTelemetry) -> None:
    for name in ("rc", "loiter"):
        m = told(target_messages.COPTER, name, (1500.4, 1499.6, 0.0, 2000.0, 1100.0, 0.0, 0.0, 1900.0), inbox)
        assert [getattr(m, f"chan{k}_raw") for k in range(1, 9)] == [1500, 1500, 0, 2000, 1100, 0, 0, 1900]
        assert (m.chan9_raw, m.chan18_raw, m.target_component) == (0, 0, 1)


# ---------------------------------------------------------------- a pilot for Betaflight


def held(
    position: Any, velocity: Any = (0.0, 0.0, 0.0), attitude: Any = (0.0, 0.0, 0.0), hold: Hold | None = None
) -> Any:
    """Roll, pitch, yaw rate, thrust of a pilot who holds the origin, looking north."""
    made = StepTelemetry(1)
    made.position, made.attitude = (0, *position, *velocity), (0, *attitude, 0.0, 0.0, 0.0)
    return (hold or Hold((0.0, 0.0, 0.0), 0.0)).act(made, 0.02)


def test_at_rest_where_it_is_to_be_it_keeps_the_thrust_of_hovering() -> None:
    assert held((0.0, 0.0, 0.0)) == pytest.approx((0.0, 0.0, 0.0, 0.45))


@pytest.mark.parametrize(
    ("position", "heading", "roll", "pitch"),
    [
        ((-1.0, 0.0, 0.0), 0.0, 0, -1),  # behind it: nose down
        ((1.0, 0.0, 0.0), 0.0, 0, 1),
        ((0.0, -1.0, 0.0), 0.0, 1, 0),  # to the left: right side down
        ((0.0, 1.0, 0.0), 0.0, -1, 0),
        ((-1.0, 0.0, 0.0), math.pi / 2, -1, 0),  # it looks east, and has to go north: left
        ((0.0, -1.0, 0.0), math.pi / 2, 0, -1),
    ],
)
def test_it_leans_to_where_it_has_to_go(position: Any, heading: float, roll: int, pitch: int) -> None:
    found = held(position, attitude=(0.0, 0.0, heading))
    for rate, sign in zip(found[:2], (roll, pitch), strict=True):
        assert abs(rate) < 1e-9 if sign == 0 else rate * sign > 0.1


def test_it_brakes_and_levels_and_turns_the_shorter_way() -> None:
    assert held((0.0, 0.0, 0.0), velocity=(1.0, 0.0, 0.0))[1] > 0.1, "nose up against a speed ahead"
    assert held((0.0, 0.0, 0.0), velocity=(0.0, 1.0, 0.0))[0] < -0.1
    assert held((0.0, 0.0, 0.0), attitude=(0.1, 0.0, 0.0))[0] == pytest.approx(-0.5)
    assert held((0.0, 0.0, 0.0), attitude=(0.0, 0.1, 0.0))[1] == pytest.approx(-0.5)
    assert held((0.0, 0.0, 0.0), attitude=(0.0, 0.0, 0.2))[2] == pytest.approx(-0.3)
    assert held((0.0, 0.0, 0.0), attitude=(0.0, 0.0, 6.0))[2] > 0.0


def test_its_leans_have_an_end() -> None:
    assert held((-100.0, 0.0, 0.0), velocity=(-100.0, 0.0, 0.0))[1] == pytest.approx(-5.0 * 0.35)
    assert held((100.0, 0.0, 0.0), velocity=(100.0, 0.0, 0.0))[1] == pytest.approx(5.0 * 0.35)


def test_it_climbs_from_below_and_finds_the_thrust_of_hovering() -> None:
    assert held((0.0, 0.0, 1.0))[3] > 0.5 > 0.4 > held((0.0, 0.0, -1.0))[3]
    hold = Hold((0.0, 0.0, 0.0), 0.0)
    for _ in range(100):
        held((0.0, 0.0, 1.0), hold=hold)
    assert held((0.0, 0.0, 0.0), hold=hold)[3] == pytest.approx(0.45 + 0.03 * 100 * 0.02)
    assert held((0.0, 0.0, 0.0), attitude=(math.pi / 3, 0.0, 0.0))[3] == pytest.approx(0.9), "more where it leans"
    assert held((0.0, 0.0, 0.0), velocity=(0.0, 0.0, 99.0))[3] == 1.0
    assert held((0.0, 0.0, 0.0), velocity=(0.0, 0.0, -99.0))[3] == 0.0


# ---------------------------------------------------------------- reports


def noted(name: str, **fields: Any) -> Any:
    values = np.full(REPORTED, 9.0)
    note_report(values, message(name), message(name).payload(**fields))
    return values


def test_specific_forces_are_forward_left_up() -> None:
    values = noted("SCALED_IMU", xacc=100, yacc=200, zacc=-1000)
    assert values[ACCELERATION : ACCELERATION + 3] == pytest.approx([0.980665, -1.96133, 9.80665])
    assert (values[3:] == 9.0).all()


@pytest.mark.parametrize(
    ("fields", "told_as"),
    [
        ({"voltage_battery": 12600, "current_battery": 1234, "battery_remaining": 75}, [12.6, 12.34, 0.75]),
        ({"voltage_battery": 65535, "current_battery": -1, "battery_remaining": -1}, [0.0, 0.0, 0.0]),
        ({"voltage_battery": 65534, "current_battery": 0, "battery_remaining": 0}, [65.534, 0.0, 0.0]),
        ({"voltage_battery": 0, "current_battery": 1, "battery_remaining": 1}, [0.0, 0.01, 0.01]),
    ],
)
def test_what_no_battery_monitor_measures_is_zero(fields: Any, told_as: list[float]) -> None:
    assert noted("SYS_STATUS", **fields)[BATTERY : BATTERY + 3] == pytest.approx(told_as)


@pytest.mark.parametrize(("direction", "north", "east"), [(0, -4, 0), (90, 0, -4), (180, 4, 0), (-90, 0, 4)])
def test_wind_blows_to_where_it_does_not_come_from(direction: float, north: float, east: float) -> None:
    values = noted("WIND", direction=direction, speed=4.0)
    assert values[WIND : WIND + 2] == pytest.approx([north, east], abs=1e-6)


def test_ranges_and_landings() -> None:
    assert noted("RANGEFINDER", distance=3.25)[RANGE] == 3.25
    assert noted("EXTENDED_SYS_STATE", landed_state=2)[LANDED] == 2.0


@pytest.mark.parametrize(
    ("heading", "forward", "left"), [(0.0, 3.0, -2.0), (math.pi / 2, 2.0, 3.0), (math.pi, -3.0, 2.0)]
)
def test_wind_is_shown_along_the_heading(heading: float, forward: float, left: float) -> None:
    values, rows = np.arange(REPORTED, dtype=float), np.zeros((2, REPORTED))
    values[WIND], values[WIND + 1] = 3.0, 2.0
    show_report(values, heading, rows, 1)
    assert rows[1, WIND : WIND + 2] == pytest.approx([forward, left])
    rest = [k for k in range(REPORTED) if k not in (WIND, WIND + 1)]
    assert rows[1, rest].tolist() == values[rest].tolist() and (rows[0] == 0.0).all()
