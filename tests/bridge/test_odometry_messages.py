# SPDX-License-Identifier: BSD-3-Clause
"""What other systems tell of the vehicle's place."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.bridge.services import odometry as o
from sitl.bridge.telemetry.flow import OpticalFlow, take_flow
from sitl.core.vectors import Vec3
from tests.bridge.fakes import Bench, filled

SENDER = 42


@pytest.mark.parametrize(
    ("law", "kind", "more"),
    [
        (o.vision_position, o.VisionPosition, {"yaw": 0.5}),
        (o.global_vision_position, o.GlobalVisionPosition, {"yaw": 0.5}),
        (o.vicon_position, o.ViconPosition, {"yaw": 0.5}),
        (o.motion_capture, o.MotionCapture, {"q": [math.cos(0.25), 0.0, 0.0, math.sin(0.25)]}),
    ],
)
def test_a_place_and_heading(bench: Bench, law: Any, kind: type, more: dict[str, Any]) -> None:
    v = bench.vehicle.v
    seen: Any = v.autopilot.odometry
    m = filled(kind, x=1.0, y=2.0, z=-3.0, **more)
    law(m, v, SENDER)
    assert seen.pose.count == 0, "VISO_TYPE 0"
    seen.kind = 1
    v.autopilot.params.VISO.SCALE = 2.0
    law(m, v, SENDER)
    assert seen.pose.count == 1 and tuple(seen.pose.pos) == (2.0, 4.0, -6.0)
    assert seen.pose.q.z == pytest.approx(math.sin(0.25), abs=1e-6) and seen.pose.sigma == pytest.approx(0.2)
    for north in (math.nan, math.inf, 1e30, -60_000.0):
        m.pos = Vec3(north, 2.0, -3.0)
        law(m, v, SENDER)
        assert seen.pose.count == 1, "no number, or further off than 100 km"


def test_variances_and_resets(bench: Bench) -> None:
    v = bench.vehicle.v
    seen: Any = v.autopilot.odometry
    seen.kind = 1
    m = filled(o.VisionPosition, x=1.0)
    m.covariance[0], m.covariance[6], m.covariance[11] = 1.0, 2.0, 6.0
    o.vision_position(m, v, SENDER)
    assert seen.pose.sigma == pytest.approx(3.0)
    m.reset_counter = 1
    o.vision_position(m, v, SENDER)
    assert seen.resets == 1
    for law, kind, told, counts in (
        (o.global_vision_position, o.GlobalVisionPosition, {"reset_counter": 7}, 7),
        (o.vicon_position, o.ViconPosition, {}, 0),
        (o.odometry, o.Odometry, {"reset_counter": 9, "q": [1, 0, 0, 0], "frame_id": 1, "child_frame_id": 12}, 9),
    ):
        law(filled(kind, **told), v, SENDER)
        assert seen.resets == counts


def test_variances_of_velocities(bench: Bench) -> None:
    v = bench.vehicle.v
    seen: Any = v.autopilot.odometry
    seen.kind = 1
    v.autopilot.params.VISO.VEL_M_NSE = 0.1
    covariance = [1.0, 40.0, 40.0, 40.0, 2.0, 40.0, 40.0, 40.0, 6.0]
    o.vision_speed(filled(o.VisionSpeed, x=1.0, covariance=covariance), v, SENDER)
    assert seen.velocity.sigma == pytest.approx(3.0)
    pose, speed = [0.0] * 21, [0.0] * 21
    pose[0], speed[0], speed[6], speed[11] = 4.0, 4.0, 4.0, 8.0
    still: dict[str, Any] = {"frame_id": 1, "child_frame_id": 12, "q": [1, 0, 0, 0]}
    o.odometry(filled(o.Odometry, vx=2.0, pose_covariance=pose, velocity_covariance=speed, **still), v, SENDER)
    assert (seen.velocity.sigma, seen.pose.sigma) == (4.0, 2.0)
    assert tuple(seen.velocity.vel) == (2.0, 0.0, 0.0) and seen.velocity.on_body
    o.motion_capture(filled(o.MotionCapture, q=[1, 0, 0, 0], covariance=[9.0] + [0.0] * 20), v, SENDER)
    assert seen.pose.sigma == 3.0


def test_confidence_is_a_quality_and_a_place_has_a_heading(bench: Bench) -> None:
    v = bench.vehicle.v
    seen: Any = v.autopilot.odometry
    seen.kind = 1
    for confidence, quality in ((-5.0, 0), (0.0, 0), (55.9, 55), (100.0, 100), (150.0, 100)):
        o.vision_delta(filled(o.VisionDelta, time_delta_usec=1, confidence=confidence), v, SENDER)
        assert seen.quality == quality
    assert seen.velocity.count == 5
    o.vision_delta(filled(o.VisionDelta, time_delta_usec=1, confidence=math.inf), v, SENDER)
    for axis in ("roll", "pitch", "yaw"):
        o.vision_position(filled(o.VisionPosition, **{axis: math.nan}), v, SENDER)
    o.motion_capture(filled(o.MotionCapture), v, SENDER)
    assert (seen.velocity.count, seen.pose.count) == (5, 0)


def test_velocities(bench: Bench) -> None:
    v = bench.vehicle.v
    seen: Any = v.autopilot.odometry
    seen.kind = 1
    o.vision_speed(filled(o.VisionSpeed, x=1.0, y=2.0, z=-3.0), v, SENDER)
    assert tuple(seen.velocity.vel) == (1.0, 2.0, -3.0) and not seen.velocity.on_body
    o.vision_speed(filled(o.VisionSpeed, x=1e5), v, SENDER)
    assert seen.velocity.count == 1
    m = filled(o.VisionDelta, time_delta_usec=500_000, position_delta=[0.5, 0.0, -1.0], confidence=90.0)
    o.vision_delta(m, v, SENDER)
    assert tuple(seen.velocity.vel) == (1.0, 0.0, -2.0) and seen.velocity.on_body and seen.quality == 90
    m.time_delta_usec = 0
    o.vision_delta(m, v, SENDER)
    assert seen.velocity.count == 2, "no time has passed"


@pytest.mark.parametrize(
    ("frame", "child", "quality", "taken"),
    [(20, 12, 80, True), (1, 12, 50, True), (20, 12, 49, False), (20, 8, 80, False), (0, 12, 80, False)],
)
def test_odometry(bench: Bench, frame: int, child: int, quality: int, taken: bool) -> None:
    v = bench.vehicle.v
    seen: Any = v.autopilot.odometry
    seen.kind = 1
    v.autopilot.params.VISO.QUAL_MIN = 50
    m = filled(o.Odometry, frame_id=frame, child_frame_id=child, x=1.0, vx=2.0, q=[1.0, 0.0, 0.0, 0.0], quality=quality)
    o.odometry(m, v, SENDER)
    assert (seen.pose.count, seen.velocity.count) == ((1, 1) if taken else (0, 0))


def test_flow_is_heard_from_a_companion_only(bench: Bench) -> None:
    v = bench.vehicle.v
    flow: Any = v.autopilot.flow
    m = filled(OpticalFlow, flow_rate_x=0.1, flow_rate_y=-0.2, quality=200)
    for kind, count in ((0, 0), (10, 0), (5, 1)):
        flow.kind = kind
        take_flow(m, v, SENDER)
        assert flow.count == count
    assert tuple(flow.rate) == pytest.approx((0.1, -0.2)) and flow.quality == 200
    m.flow_rate_x = math.inf
    take_flow(m, v, SENDER)
    assert flow.count == 1


def test_flow_counts_are_turned_into_rates(bench: Bench) -> None:
    """flow_x and flow_y times the time since the last message, as ArduPilot has it."""
    v = bench.vehicle.v
    flow: Any = v.autopilot.flow
    flow.kind = 5
    v.time_us, flow.time_us = 1_500_000, 1_000_000
    v.autopilot.estimate.rates = Vec3(0.3, -0.4, 9.0)
    for x, y, expected in ((6, 0, (3.0, 0.0)), (0, -4, (0.0, -2.0)), (0, 0, (0.25, 0.5))):
        flow.time_us = 1_000_000
        take_flow(filled(OpticalFlow, flow_x=x, flow_y=y, flow_rate_x=0.25, flow_rate_y=0.5), v, SENDER)
        assert tuple(flow.rate) == expected and tuple(flow.body) == (0.3, -0.4)
    assert bench.telemetry("OPTICAL_FLOW") != []


def test_the_flow_that_is_seen_is_told(bench: Bench) -> None:
    v = bench.vehicle.v
    flow, ekf = v.autopilot.flow, v.autopilot.ekf
    v.time_us = 5_000_000
    flow.kind, flow.count, flow.time_us, flow.quality = 5, 1, 4_900_000, 200
    flow.rate, flow.body = (0.5, -0.25), (0.125, 0.5)
    ekf.terrain_d, ekf.pos = 3.0, Vec3(0.0, 0.0, -7.5)
    (m,) = bench.telemetry("OPTICAL_FLOW")
    assert (m.flow_comp_m_x, m.flow_comp_m_y, m.flow_rate_x, m.flow_rate_y) == (0.375, -0.75, 0.5, -0.25)
    assert (m.time_usec, m.quality, m.ground_distance) == (4_900_000, 200, -1.0)
    ekf.terrain_us = ekf.now_us = 4_950_000
    assert bench.telemetry("OPTICAL_FLOW")[0].ground_distance == 10.5
