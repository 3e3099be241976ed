# SPDX-License-Identifier: BSD-3-Clause
"""Optical flow and a range-finder: velocity over ground without GPS.

The sensor shows (-v_y, v_x) / distance besides body rates, v: velocity on the body. The distance down its axis follows
from the height over the ground that the range-finder saw last, so that flow goes on between its readings.
"""

from __future__ import annotations

import math

from ...core.algebra import cross, horizontal, norm2, rotate, rotate_inverse
from ...core.kernels import law
from ...core.vectors import Vec2, Vec3
from ..events import Events, emit
from ..optical_flow import OpticalFlow
from ..params.estimator import Ekf3
from ..state import Estimate, Sensors
from . import noise
from .aiding import reset_ne
from .estimator_events import BY_FLOW, EKF_RELATIVE, EKF_STOPPED_AIDING, EKF_USES
from .fusion import NO_NIS, Innovation, clear_row, correct, gate_ratio, innovate
from .history import past_at
from .state import THETA, VEL, Ekf

LEAST_DISTANCE = 0.1
"""Of the lens from the ground [m]: that of a vehicle that stands."""
LEAST_COS = 0.5
"""Cosine of the greatest lean at which the range-finder is believed."""
TERRAIN_US = 5_000_000
"""So long the height over the ground is known without the range-finder."""
FRESH_US = 1_000_000
"""After so long without flow the position is no longer known."""
STOP_US = 5_000_000
"""After so long the filter holds its position."""


@law
def read_range(ekf: Ekf, sensors: Sensors) -> None:
    """Note where the ground is when the range-finder has measured."""
    if sensors.rangefinder_count == ekf.range_seen:
        return
    ekf.range_seen = sensors.rangefinder_count
    reading, upright = float(sensors.rangefinder_range[0]), rotate(ekf.q, Vec3(0.0, 0.0, 1.0)).z
    if reading < math.inf and upright > LEAST_COS:
        ekf.terrain_d = ekf.pos.z + reading * upright
        ekf.terrain_us = ekf.now_us


@law
def knows_height(ekf: Ekf) -> bool:
    """Whether the height over the ground is known."""
    return ekf.terrain_us > 0 and ekf.now_us - ekf.terrain_us < TERRAIN_US


@law
def distance(ekf: Ekf) -> float:
    """Distance to the ground down the body's axis [m]."""
    upright = max(rotate(ekf.q, Vec3(0.0, 0.0, 1.0)).z, LEAST_COS)
    return max(max(ekf.terrain_d - ekf.pos.z, LEAST_DISTANCE) / upright, LEAST_DISTANCE)


@law
def begin(ekf: Ekf, estimate: Estimate, log: Events, shown: Vec2) -> None:
    """From holding the position to flow ``shown`` [rad/s]: velocity from it, position from where it is."""
    away = distance(ekf)
    vel = rotate(ekf.q, Vec3(shown.y * away, -shown.x * away, 0.0))
    reset_ne(ekf, estimate, horizontal(ekf.pos), horizontal(vel))
    ekf.relative = True
    ekf.relative_us = ekf.now_us
    emit(log, ekf.now_us, EKF_USES, float(ekf.imu), BY_FLOW)
    emit(log, ekf.now_us, EKF_RELATIVE, float(ekf.imu), 0.0)


@law
def innovate_flow(ekf: Ekf, vel: Vec3, axis: Vec3, sign: float, residual: float, variance: float) -> Innovation:
    """Innovation of ``sign`` times the velocity along a body ``axis`` (NED), by the distance of the ground."""
    k = sign / distance(ekf)
    turn = k * cross(axis, vel)
    clear_row(ekf)
    ekf.h[VEL], ekf.h[VEL + 1], ekf.h[VEL + 2] = k * axis.x, k * axis.y, k * axis.z
    ekf.h[THETA], ekf.h[THETA + 1], ekf.h[THETA + 2] = turn.x, turn.y, turn.z
    return innovate(ekf, residual, variance)


@law
def fuse_rates(ekf: Ekf, shown: Vec2, when_us: int, params: Ekf3) -> bool:
    """Fuse rates of the ground without those of the body [rad/s], taken at ``when_us``; whether they pass the gate."""
    vel = past_at(ekf, when_us).vel
    forward, right = rotate(ekf.q, Vec3(1.0, 0.0, 0.0)), rotate(ekf.q, Vec3(0.0, 1.0, 0.0))
    on_body, away = rotate_inverse(ekf.q, vel), distance(ekf)
    residual = Vec2(shown.x + on_body.y / away, shown.y - on_body.x / away)
    sigma = noise.FLOW * params.FLOW_M_NSE
    variance = sigma * sigma
    x = innovate_flow(ekf, vel, right, -1.0, residual.x, variance)
    y = innovate_flow(ekf, vel, forward, 1.0, residual.y, variance)
    ekf.innovation_flow = Vec2(x.value, y.value)
    nominal = math.sqrt(2.0) * params.FLOW_M_NSE
    squares, variances = x.value * x.value + y.value * y.value, x.variance + y.variance
    if not gate_ratio(squares, variances, nominal, params.FLOW_I_GATE) < 1.0:
        return False
    correct(ekf, innovate_flow(ekf, vel, right, -1.0, residual.x, variance), NO_NIS)
    correct(ekf, innovate_flow(ekf, vel, forward, 1.0, residual.y, variance), NO_NIS)
    ekf.relative_us = ekf.now_us
    return True


@law
def fuse(ekf: Ekf, estimate: Estimate, log: Events, flow: OpticalFlow, params: Ekf3) -> bool:
    """Look at a new sample of optical flow; whether it was fused."""
    if flow.count == ekf.flow_seen:
        return False
    ekf.flow_seen = flow.count
    if flow.quality == 0 or not norm2(flow.rate) < params.MAX_FLOW or not (ekf.yaw_aligned and knows_height(ekf)):
        return False
    shown = flow.rate - flow.body
    if not (ekf.relative or ekf.absolute):
        begin(ekf, estimate, log, shown)
        return False
    return fuse_rates(ekf, shown, flow.time_us - int(1000.0 * params.FLOW_DELAY), params)


@law
def watch(ekf: Ekf, estimate: Estimate, log: Events, has_source: bool) -> None:
    """Hold the position when nothing has been fused for long, or nothing will be."""
    if ekf.relative and (ekf.now_us - ekf.relative_us > STOP_US or not has_source):
        stop(ekf, estimate)
        emit(log, ekf.now_us, EKF_STOPPED_AIDING, float(ekf.imu), 0.0)


@law
def stop(ekf: Ekf, estimate: Estimate) -> None:
    """Hold the position from here."""
    ekf.relative = False
    ekf.hold_pos = horizontal(ekf.pos)
    reset_ne(ekf, estimate, ekf.hold_pos, Vec2(0.0, 0.0))
