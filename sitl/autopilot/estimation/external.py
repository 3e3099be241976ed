# SPDX-License-Identifier: BSD-3-Clause
"""Another system's position, velocity and heading (EK3_SRCn_* 6) in place of GPS, barometer and compass."""

from __future__ import annotations

import math

from ...core.algebra import horizontal, rotate, with_down, yaw_of
from ...core.kernels import law
from ...core.scalars import wrap_pi
from ...core.vectors import Vec2, Vec3
from ..events import Events, emit
from ..params.estimator import Ekf3
from ..params.without_gps import Sources
from ..params.without_gps import VisualOdometry as Settings
from ..state import Estimate
from ..visual_odometry import VisualOdometry
from . import flow, height
from .aiding import reset_ne
from .alignment import YAW
from .estimator_events import BY_OTHERS, EKF_RELATIVE, EKF_USES, YAW_BY_OTHERS
from .fusion import NO_NIS, Innovation, correct, gate_ratio, innovate_position, innovate_state
from .history import past_at
from .magnetometer import turn
from .sources import EXTERNAL
from .state import THETA, VEL, Ekf


@law
def delay_us(p: Settings) -> int:
    """Age of what the other system says when it comes [us]."""
    return int(1000.0 * p.DELAY_MS)


@law
def jump_to(ekf: Ekf, estimate: Estimate, seen: VisualOdometry, source: Sources, age: float) -> None:
    """Jump to the position reported, which is ``age`` [s] old, with the velocity reported if that is a source."""
    vel = velocity_of(ekf, seen) if source.VELXY == EXTERNAL and seen.velocity.count > 0 else ekf.vel
    reset_ne(ekf, estimate, horizontal(seen.pose.pos + age * vel), horizontal(vel))
    if source.POSZ == EXTERNAL:
        height.reset(ekf, estimate, seen.pose.pos.z, seen.pose.sigma * seen.pose.sigma)
    ekf.pose_resets = seen.resets


@law
def velocity_of(ekf: Ekf, seen: VisualOdometry) -> Vec3:
    """The velocity reported, NED [m/s]."""
    vel = seen.velocity.vel
    return rotate(ekf.q, vel) if seen.velocity.on_body else vel


@law
def begin(ekf: Ekf, estimate: Estimate, log: Events, seen: VisualOdometry, source: Sources, age: float) -> None:
    """From holding the position, or a relative one, to the position reported, ``age`` [s] old."""
    jump_to(ekf, estimate, seen, source, age)
    ekf.absolute, ekf.relative = True, False
    ekf.pos_fused_us = ekf.now_us
    ekf.vel_fused_us = ekf.now_us
    emit(log, ekf.now_us, EKF_USES, float(ekf.imu), BY_OTHERS)


@law
def innovate_down(ekf: Ekf, down: float, age: float, sigma: float) -> Innovation:
    """Innovation of a position down [m], ``age`` [s] old."""
    return innovate_position(ekf, 2, age, down - (ekf.pos.z - age * ekf.vel.z), sigma * sigma)


@law
def fuse_pose(ekf: Ekf, estimate: Estimate, seen: VisualOdometry, params: Ekf3, when_us: int, height: bool) -> bool:
    """Fuse a position reported of ``when_us``, with its ``height`` or without; whether it passes its gate."""
    pose, past, age = seen.pose, past_at(ekf, when_us).pos, 1e-6 * (ekf.now_us - when_us)
    residual, variance = horizontal(pose.pos - past), pose.sigma * pose.sigma
    north = innovate_position(ekf, 0, age, residual.x, variance)
    east = innovate_position(ekf, 1, age, residual.y, variance)
    ekf.innovation_pos = Vec3(north.value, east.value, ekf.innovation_pos.z)
    squares, nominal = north.value * north.value + east.value * east.value, math.sqrt(2.0) * pose.sigma
    ratio = gate_ratio(squares, north.variance + east.variance, nominal, params.POS_I_GATE)
    estimate.variance_pos = math.sqrt(ratio)
    if height:
        down = innovate_down(ekf, pose.pos.z, age, pose.sigma)
        ekf.innovation_pos = with_down(horizontal(ekf.innovation_pos), down.value)
        vertical = gate_ratio(down.value * down.value, down.variance, pose.sigma, params.HGT_I_GATE)
        estimate.variance_hgt = math.sqrt(vertical)
        if vertical < 1.0:
            correct(ekf, innovate_down(ekf, pose.pos.z, age, pose.sigma), NO_NIS)
    if not ratio < 1.0:
        return False
    correct(ekf, innovate_position(ekf, 0, age, residual.x, variance), NO_NIS)
    correct(ekf, innovate_position(ekf, 1, age, residual.y, variance), NO_NIS)
    ekf.pos_fused_us = ekf.now_us
    return True


@law
def fuse_velocity(
    ekf: Ekf, estimate: Estimate, seen: VisualOdometry, params: Ekf3, when_us: int, vertical: bool
) -> bool:
    """Fuse a velocity reported of ``when_us``, with its ``vertical`` part or without; whether it passes its gate."""
    measured = velocity_of(ekf, seen)
    residual, variance = measured - past_at(ekf, when_us).vel, seen.velocity.sigma * seen.velocity.sigma
    north, east = innovate_state(ekf, VEL, residual.x, variance), innovate_state(ekf, VEL + 1, residual.y, variance)
    squares, variances, nominal = (
        north.value * north.value + east.value * east.value,
        north.variance + east.variance,
        2.0 * variance,
    )
    down = innovate_state(ekf, VEL + 2, residual.z, variance)
    if vertical:
        squares += down.value * down.value
        variances += down.variance
        nominal += variance
    ekf.innovation_vel = Vec3(north.value, east.value, down.value if vertical else 0.0)
    ratio = gate_ratio(squares, variances, math.sqrt(nominal), params.VEL_I_GATE)
    estimate.variance_vel = math.sqrt(ratio)
    if not ratio < 1.0:
        return False
    correct(ekf, innovate_state(ekf, VEL, residual.x, variance), NO_NIS)
    correct(ekf, innovate_state(ekf, VEL + 1, residual.y, variance), NO_NIS)
    if vertical:
        correct(ekf, innovate_state(ekf, VEL + 2, residual.z, variance), NO_NIS)
    ekf.vel_fused_us = ekf.now_us
    ekf.relative_us = ekf.now_us
    return True


@law
def align_yaw(ekf: Ekf, estimate: Estimate, log: Events, yaw: float) -> None:
    """Take the first heading reported [rad]."""
    turn(ekf, estimate, wrap_pi(yaw - yaw_of(ekf.q)))
    ekf.yaw_aligned = True
    emit(log, ekf.now_us, EKF_USES, float(ekf.imu), YAW_BY_OTHERS)


@law
def fuse_yaw(ekf: Ekf, estimate: Estimate, residual: float, sigma: float, params: Ekf3) -> None:
    """Fuse reported minus estimated heading [rad]; one beyond the gate for too long is taken over."""
    found = innovate_state(ekf, THETA + 2, residual, sigma * sigma)
    ekf.innovation_yaw = found.value
    ratio = gate_ratio(found.value * found.value, found.variance, sigma, params.YAW_I_GATE)
    estimate.variance_mag = math.sqrt(ratio)
    if ratio < 1.0:
        correct(ekf, innovate_state(ekf, THETA + 2, residual, sigma * sigma), NO_NIS)
        ekf.mag_fused_us = ekf.now_us
    elif ekf.now_us - ekf.mag_fused_us > flow.STOP_US:
        turn(ekf, estimate, residual)
        ekf.mag_fused_us = ekf.now_us


@law
def take_pose(
    ekf: Ekf, estimate: Estimate, log: Events, seen: VisualOdometry, source: Sources, params: Ekf3, p: Settings
) -> bool:
    """Look at a new pose; whether something was fused."""
    when_us, yaw = seen.pose.time_us - delay_us(p), yaw_of(seen.pose.q)
    if source.YAW == EXTERNAL:
        if not ekf.yaw_aligned:
            if ekf.phase == YAW:
                align_yaw(ekf, estimate, log, yaw)
            return False
        fuse_yaw(ekf, estimate, wrap_pi(yaw - yaw_of(ekf.q)), p.YAW_M_NSE, params)
    if source.POSXY != EXTERNAL or not ekf.yaw_aligned:
        return source.YAW == EXTERNAL
    age = 1e-6 * (ekf.now_us - when_us)
    if not ekf.absolute:
        begin(ekf, estimate, log, seen, source, age)
    elif seen.resets != ekf.pose_resets:
        jump_to(ekf, estimate, seen, source, age)
        ekf.pos_fused_us = ekf.now_us
    elif not fuse_pose(ekf, estimate, seen, params, when_us, source.POSZ == EXTERNAL):
        if ekf.now_us - ekf.pos_fused_us > flow.STOP_US:
            jump_to(ekf, estimate, seen, source, age)
            ekf.pos_fused_us = ekf.now_us
    return True


@law
def take_velocity(
    ekf: Ekf, estimate: Estimate, log: Events, seen: VisualOdometry, source: Sources, params: Ekf3, p: Settings
) -> bool:
    """Look at a new velocity; whether something was fused. Without positions it makes a relative one."""
    if not ekf.yaw_aligned:
        return False
    if not (ekf.absolute or ekf.relative):
        if source.POSXY == EXTERNAL:
            return False
        vel = velocity_of(ekf, seen)
        reset_ne(ekf, estimate, horizontal(ekf.pos), Vec2(vel.x, vel.y))
        ekf.relative, ekf.relative_us = True, ekf.now_us
        emit(log, ekf.now_us, EKF_RELATIVE, float(ekf.imu), 0.0)
        return False
    when_us = seen.velocity.time_us - delay_us(p)
    return fuse_velocity(ekf, estimate, seen, params, when_us, source.VELZ == EXTERNAL)


@law
def fuse(
    ekf: Ekf, estimate: Estimate, log: Events, seen: VisualOdometry, source: Sources, params: Ekf3, p: Settings
) -> bool:
    """Look at what the other system has reported since the last step; whether something was fused."""
    fused = False
    if seen.pose.count != ekf.pose_seen:
        ekf.pose_seen = seen.pose.count
        fused |= take_pose(ekf, estimate, log, seen, source, params, p)
    if seen.velocity.count != ekf.velocity_seen:
        ekf.velocity_seen = seen.velocity.count
        if source.VELXY == EXTERNAL:
            fused |= take_velocity(ekf, estimate, log, seen, source, params, p)
    return fused
