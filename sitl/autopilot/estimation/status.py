# SPDX-License-Identifier: BSD-3-Clause
"""The estimate that the rest of the firmware sees, and its flags (MAVLink EKF_STATUS_FLAGS)."""

from __future__ import annotations

from ...core.algebra import euler_of
from ...core.kernels import law
from ...core.vectors import Quat, Vec3
from .alignment import CALIBRATE
from .gps import POSITION_TIMEOUT_US

ATTITUDE = 1
VELOCITY_HORIZ = 2
VELOCITY_VERT = 4
POS_HORIZ_REL = 8
POS_HORIZ_ABS = 16
POS_VERT_ABS = 32
CONST_POS_MODE = 128
PRED_POS_HORIZ_REL = 256
PRED_POS_HORIZ_ABS = 512
UNINITIALIZED = 1024
GPS_GLITCHING = 32768


@law
def flags(ekf, now_us):
    """EKF_STATUS_FLAGS of the filter."""
    if ekf.phase == CALIBRATE:
        return UNINITIALIZED
    value = VELOCITY_VERT | POS_VERT_ABS
    if ekf.tilt_aligned != 0:
        value |= ATTITUDE
    if ekf.gps_in_use != 0:
        value |= VELOCITY_HORIZ | POS_HORIZ_REL | PRED_POS_HORIZ_REL
        if now_us - ekf.gps_pos_fused_us < POSITION_TIMEOUT_US:
            value |= POS_HORIZ_ABS | PRED_POS_HORIZ_ABS
        if ekf.gps_glitch != 0:
            value |= GPS_GLITCHING
    else:
        value |= CONST_POS_MODE
    return value


@law
def publish_status(ap, now_us):
    """What changes slowly: flags and biases."""
    ekf, estimate = ap.ekf, ap.estimate
    value = flags(ekf, now_us)
    estimate.status_flags = value
    estimate.attitude_ok = 1 if ekf.tilt_aligned != 0 and ekf.yaw_aligned != 0 else 0
    estimate.position_ok = 1 if value & POS_HORIZ_ABS != 0 else 0
    estimate.gyro_bias = Vec3(ekf.gyro_bias[0], ekf.gyro_bias[1], ekf.gyro_bias[2])
    estimate.acc_bias = Vec3(ekf.acc_bias[0], ekf.acc_bias[1], ekf.acc_bias[2])


@law
def publish(ap, dt):
    """What changes every tick; corrections of the filter reach it with the time constant EK3_TAU_OUTPUT."""
    ekf, estimate = ap.ekf, ap.estimate
    keep = max(0.0, 1.0 - 100.0 * dt / ap.params.EK3.TAU_OUTPUT)
    for k in range(3):
        ekf.lag_vel[k] *= keep
        ekf.lag_pos[k] *= keep
    pos, vel, rates, acc = ekf.pos, ekf.vel, ekf.last_gyro, ekf.last_acc_ned
    estimate.vel = Vec3(vel[0] + ekf.lag_vel[0], vel[1] + ekf.lag_vel[1], vel[2] + ekf.lag_vel[2])
    estimate.pos = Vec3(pos[0] + ekf.lag_pos[0], pos[1] + ekf.lag_pos[1], pos[2] + ekf.lag_pos[2])
    estimate.rates = Vec3(rates[0], rates[1], rates[2])
    estimate.acc_ned = Vec3(acc[0], acc[1], acc[2])
    estimate.q = Quat(ekf.q[0], ekf.q[1], ekf.q[2], ekf.q[3])
    estimate.euler = euler_of(estimate.q)
