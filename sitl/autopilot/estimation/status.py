# SPDX-License-Identifier: BSD-3-Clause
"""The estimate that the rest of the firmware sees, and its flags (MAVLink EKF_STATUS_FLAGS)."""

from __future__ import annotations

from ...core.kernels import law
from ..state import Estimate
from .alignment import CALIBRATE
from .flow import FRESH_US, knows_height
from .gps import is_position_fresh
from .state import Ekf

ATTITUDE = 1
VELOCITY_HORIZ = 2
VELOCITY_VERT = 4
POS_HORIZ_REL = 8
POS_HORIZ_ABS = 16
POS_VERT_ABS = 32
POS_VERT_AGL = 64
CONST_POS_MODE = 128
PRED_POS_HORIZ_REL = 256
PRED_POS_HORIZ_ABS = 512
UNINITIALIZED = 1024
GPS_GLITCHING = 32768


@law
def flags(ekf: Ekf) -> int:
    """EKF_STATUS_FLAGS of the filter."""
    if ekf.phase == CALIBRATE:
        return UNINITIALIZED
    value = VELOCITY_VERT | POS_VERT_ABS
    if ekf.tilt_aligned:
        value |= ATTITUDE
    if ekf.absolute:
        value |= VELOCITY_HORIZ
        if is_position_fresh(ekf):
            value |= POS_HORIZ_REL | PRED_POS_HORIZ_REL | POS_HORIZ_ABS | PRED_POS_HORIZ_ABS
        if ekf.gps_glitch:
            value |= GPS_GLITCHING
    elif ekf.relative:
        value |= VELOCITY_HORIZ
        if ekf.now_us - ekf.relative_us < FRESH_US:
            value |= POS_HORIZ_REL | PRED_POS_HORIZ_REL
    else:
        value |= CONST_POS_MODE
    if ekf.terrain_us > 0 and knows_height(ekf):
        value |= POS_VERT_AGL
    return value


@law
def publish_status(ekf: Ekf, estimate: Estimate) -> None:
    """What changes slowly: flags and biases."""
    estimate.status_flags = flags(ekf)
    estimate.attitude_ok = ekf.tilt_aligned and ekf.yaw_aligned
    wanted = POS_HORIZ_REL if ekf.relative else POS_HORIZ_ABS
    estimate.position_ok = estimate.status_flags & wanted != 0
    estimate.gyro_bias = ekf.gyro_bias
    estimate.acc_bias = ekf.acc_bias


@law
def publish(ekf: Ekf, estimate: Estimate, dt: float, tau: float) -> None:
    """What changes every tick of ``dt`` [s]; corrections of the filter reach it with the time constant ``tau`` [cs]."""
    keep = max(0.0, 1.0 - 100.0 * dt / tau)
    ekf.lag_vel *= keep
    ekf.lag_pos *= keep
    estimate.vel = ekf.vel + ekf.lag_vel
    estimate.pos = ekf.pos + ekf.lag_pos
    estimate.rates = ekf.last_gyro
    estimate.acc_ned = ekf.last_acc_ned
    estimate.q = ekf.q
