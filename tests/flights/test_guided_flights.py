# SPDX-License-Identifier: BSD-3-Clause
"""GUIDED: set-points of every kind in every frame, and their time-outs."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl.simulation import Core
from tests.flights.aviator import (
    ACCELERATION,
    AIRFRAMES,
    POS_VEL,
    POS_VEL_ACCEL,
    POSITION,
    POSITION_YAW,
    POSITION_YAW_RATE,
    VELOCITY,
    VELOCITY_YAW_RATE,
    Aviator,
    estimate,
    stream,
    target,
)  # fmt: skip

BOTH = pytest.mark.parametrize("frame", AIRFRAMES)


@BOTH
def test_positions_in_local_frames(core: Core, frame: str) -> None:
    p = Aviator(core, frame).hover()
    target(p, POSITION, 1, x=10.0, y=5.0, z=-12.0)
    p.fly(12.0)
    assert estimate(p) == pytest.approx([10.0, 5.0, -12.0], abs=0.3)
    here = estimate(p)
    target(p, POSITION, 7, x=5.0, z=-3.0)
    p.fly(12.0)
    assert estimate(p) == pytest.approx(here + [5.0, 0.0, -3.0], abs=0.3)
    for body in (8, 9):
        here, yaw = estimate(p), float(p.ap.estimate.euler[2])
        target(p, POSITION, body, x=6.0, y=-2.0)
        p.fly(12.0)
        moved = [6 * math.cos(yaw) + 2 * math.sin(yaw), 6 * math.sin(yaw) - 2 * math.cos(yaw), 0.0]
        assert estimate(p) == pytest.approx(here + moved, abs=0.3)


@BOTH
@pytest.mark.parametrize("coordinates", [0, 3, 5, 6, 10, 11])
def test_positions_in_global_frames(core: Core, frame: str, coordinates: int) -> None:
    p = Aviator(core, frame).hover()
    lat, lon = p.lat_lon(10.0, -10.0)
    height = 15.0 if coordinates in (3, 6, 10, 11) else float(p.ap.estimate.origin_alt) + 15.0
    p.send(
        "SET_POSITION_TARGET_GLOBAL_INT", coordinate_frame=coordinates,
        type_mask=POSITION, lat_int=lat, lon_int=lon, alt=height,
    )  # fmt: skip
    p.fly(15.0)
    assert estimate(p) == pytest.approx([10.0, -10.0, -15.0], abs=0.5)


@BOTH
def test_velocity_runs_out_after_three_seconds(core: Core, frame: str) -> None:
    p = Aviator(core, frame).hover()
    stream(p, 5.0, VELOCITY, vx=3.0, vz=-0.5)
    assert p.vel == pytest.approx([3.0, 0.0, -0.5], abs=0.25)
    p.fly(2.5)
    assert p.vel[0] == pytest.approx(3.0, abs=0.25)
    p.fly(4.5)
    assert np.linalg.norm(p.vel) < 0.25


@BOTH
def test_velocity_in_the_body_frame_with_a_turn_rate_flies_a_circle(core: Core, frame: str) -> None:
    p = Aviator(core, frame).hover()
    stream(p, 4.0, VELOCITY_YAW_RATE, 8, vx=2.0, yaw_rate=0.5)
    start = p.now
    stream(p, 12.6, VELOCITY_YAW_RATE, 8, vx=2.0, yaw_rate=0.5)
    rows = p.since(start)
    turned = np.unwrap(np.radians(rows[:, 9]))
    assert turned[-1] - turned[0] == pytest.approx(0.5 * 12.6, abs=0.2)
    assert np.ptp(rows[:, 1]) == pytest.approx(2.0 * 2.0 / 0.5, abs=1.0)


@BOTH
def test_acceleration(core: Core, frame: str) -> None:
    p = Aviator(core, frame).hover()
    stream(p, 3.0, ACCELERATION, afx=1.0)
    assert p.vel[0] == pytest.approx(3.0, abs=0.4)
    stream(p, 3.0, ACCELERATION, afx=-1.0)
    assert abs(p.vel[0]) < 0.6
    p.fly(7.0)
    assert np.linalg.norm(p.vel) < 0.25


@BOTH
def test_a_moving_point_is_followed(core: Core, frame: str) -> None:
    p = Aviator(core, frame).hover()
    here, radius, rate, off = estimate(p), 5.0, 0.5, []
    for k in range(200):
        a = 0.1 * k * rate
        s, c = math.sin(a), math.cos(a)
        target(
            p, POS_VEL_ACCEL, x=here[0] + radius * s, y=here[1] + radius * (1 - c), z=here[2],
            vx=radius * rate * c, vy=radius * rate * s, afx=-radius * rate**2 * s, afy=radius * rate**2 * c,
        )  # fmt: skip
        p.fly(0.1)
        a += 0.1 * rate
        want = here[:2] + [radius * math.sin(a), radius * (1 - math.cos(a))]
        off.append(np.linalg.norm(estimate(p)[:2] - want))
    assert max(off[100:]) < 0.4
    here = estimate(p)
    for k in range(80):
        target(p, POS_VEL, x=here[0] + 0.2 * k, y=here[1], z=here[2], vx=2.0)
        p.fly(0.1)
    assert estimate(p)[0] == pytest.approx(here[0] + 16.0, abs=0.4)


@BOTH
def test_yaw_and_turn_rate_of_a_position(core: Core, frame: str) -> None:
    p = Aviator(core, frame).hover()
    target(p, POSITION_YAW, z=-10.0, yaw=math.pi / 2)
    p.fly(6.0)
    assert p.euler[2] == pytest.approx(90.0, abs=2.0)
    target(p, POSITION_YAW_RATE, z=-10.0, yaw_rate=0.5)
    p.fly(2.5)
    assert p.euler[2] > 140.0
    p.fly(3.0)
    heading = p.euler[2]
    p.fly(2.0)
    assert p.euler[2] == pytest.approx(heading, abs=2.0), "the rate runs out after three seconds"


@BOTH
def test_far_target_at_full_speed(core: Core, frame: str) -> None:
    """500 m at WPNAV_SPEED 10 m/s: within the lean limit of 30 degrees, straight, level, without overshoot."""
    p = Aviator(core, frame).hover()
    here, start = p.pos, p.now
    target(p, POSITION, x=float(estimate(p)[0]) + 500.0, y=float(estimate(p)[1]), z=-10.0)
    assert p.fly(60.0, lambda: p.pos[0] - here[0] > 499.0)
    p.fly(8.0)
    rows = p.since(start)
    assert np.linalg.norm(rows[:, 4:6], axis=1).max() < 10.5
    assert np.abs(rows[:, 7:9]).max() < 31.0
    assert rows[:, 1].max() - here[0] - 500.0 < 1.2
    assert np.ptp(rows[:, 3]) < 0.6
    assert np.ptp(rows[:, 2]) < 1.0


@BOTH
@pytest.mark.parametrize("aside", [15.0, 40.0])
def test_a_point_beside_a_fast_way_is_reached_and_not_circled(core: Core, frame: str, aside: float) -> None:
    p = Aviator(core, frame, WPNAV_SPEED=1000.0).hover()
    stream(p, 8.0, VELOCITY, 1, vx=9.9)
    here = estimate(p)
    target(p, POSITION, 1, x=here[0], y=here[1] + aside, z=here[2])
    p.fly(40.0)
    assert estimate(p) == pytest.approx(here + [0.0, aside, 0.0], abs=0.5)


@BOTH
def test_reversals_keep_height_and_lean(core: Core, frame: str) -> None:
    p = Aviator(core, frame).hover(20.0)
    start = p.now
    for k in range(12):
        vn, ve = ((8.0, 0.0), (-8.0, 0.0), (0.0, 8.0), (0.0, -8.0))[k % 4]
        stream(p, 2.5, VELOCITY, vx=vn, vy=ve)
    rows = p.since(start)
    assert np.ptp(rows[:, 3]) < 0.8
    assert np.abs(rows[:, 7:9]).max() < 31.0


@BOTH
def test_climb_and_descent_keep_to_their_limits(core: Core, frame: str) -> None:
    p = Aviator(core, frame).hover()
    start = p.now
    target(p, POSITION, z=-50.0)
    p.fly(25.0)
    assert -p.since(start)[:, 6].min() == pytest.approx(2.5, abs=0.2)
    start = p.now
    target(p, POSITION, z=-10.0)
    p.fly(35.0)
    assert p.since(start)[:, 6].max() == pytest.approx(1.5, abs=0.2)
    assert p.height == pytest.approx(10.0, abs=0.6)
