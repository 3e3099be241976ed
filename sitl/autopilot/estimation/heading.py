# SPDX-License-Identifier: BSD-3-Clause
"""Yaw from the magnetometer as slowly as ArduPilot's filter takes it, unless EK3_MAG_CAL is 4.

On the ground the heading alone is fused, with EK3_YAW_M_NSE (0.5 rad) as it stands: against it the gyro is nearly all,
and the bias about the vertical, of which little is known at the start, takes its part of each innovation. The
declination, unknown until the second fix, so comes in over ten seconds, swings past, and takes a minute to settle. The
drift of the gyro then leaves a degree.

2.5 m above the take-off point yaw jumps to what the magnetometer shows, as what lies on the ground no longer disturbs
it. From there on biases of the magnetometer are learnt, too, with EK3_MAG_M_NSE as it stands; not with EK3_MAG_CAL 2, a
rover's.
"""

from __future__ import annotations

import math

from ...core.algebra import ZERO, rotate, rotation_matrix
from ...core.elementary import atan2
from ...core.kernels import law
from ...core.scalars import constrain, wrap_pi
from ..events import Events, emit
from ..params.estimator import Ekf3
from ..state import Estimate
from . import noise
from .covariance import clear
from .estimator_events import EKF_YAW_ALIGNED, EKF_YAW_ALIGNED_IN_FLIGHT
from .fusion import NIS_MAGNETOMETER, Innovation, clear_row, correct, gate_ratio, innovate
from .magnetometer import (
    FUSE_SAMPLES,
    TIMEOUT_US,
    assume_field,
    is_leaving_ground,
    is_yaw_confirmed,
    set_row,
    shows_yaw,
    take_mean,
    turn,
)
from .state import BG, BM, THETA, Ekf, N

NEVER, ALWAYS = 2.0, 4.0
"""EK3_MAG_CAL: biases of the magnetometer are never learnt, always."""
STEP = 0.0125
"""Step of ArduPilot's filter [s]. Each adds the noise of EK3_GYRO_P_NSE and EK3_GBIAS_P_NSE for its time: their density
is the parameter times the root of this."""
LONGEST = 0.1
"""Noise grows for so long at most from one fusion to the next [s]."""
TIED = 0.6
"""What a fusion leaves of the covariance of yaw with all other states. The receiver is more exact than
EK3_VELNE_M_NSE and EK3_POSNE_M_NSE say (noise.py): yaw would be learnt sooner from accelerations than by ArduPilot."""
MAX_INNOVATION = 0.5
"""More of an innovation does not count at once [rad]."""
UNKNOWN_BIAS = math.radians(2.5)
"""Standard deviation of the gyro's bias about the vertical when yaw is aligned [rad/s]."""


@law
def forget_bias(ekf: Ekf) -> None:
    """Add to the variance of the gyro's bias about the vertical."""
    down = UNKNOWN_BIAS * rotation_matrix(ekf.q).z
    size = (down.x, down.y, down.z)
    for i in range(3):
        for j in range(3):
            ekf.P[BG + i, BG + j] += size[i] * size[j]
    ekf.biases_mirrored = False


@law
def align(ekf: Ekf, estimate: Estimate, residual: float, params: Ekf3) -> None:
    """Turn to the yaw that the field shows, ``residual`` [rad] away."""
    turn(ekf, estimate, residual)
    clear(ekf.P, THETA + 2, 1, params.YAW_M_NSE * params.YAW_M_NSE)
    ekf.mag_fused_us = ekf.now_us
    ekf.innovation_yaw = 0.0
    estimate.variance_mag = 0.0


@law
def align_in_flight(ekf: Ekf, estimate: Estimate, residual: float, params: Ekf3) -> None:
    """Away from what lies on the ground: yaw, and biases of the magnetometer, begin anew."""
    align(ekf, estimate, residual, params)
    ekf.mag_bias = ZERO
    clear(ekf.P, BM, 3, params.MAG_M_NSE * params.MAG_M_NSE)


@law
def add_noise(ekf: Ekf, params: Ekf3, elapsed: float) -> None:
    """Add to yaw and to the gyro's bias what noise.py leaves of the parameters' noise in a time [s]."""
    gyro, bias = params.GYRO_P_NSE * params.GYRO_P_NSE, params.GBIAS_P_NSE * params.GBIAS_P_NSE
    ekf.P[THETA + 2, THETA + 2] += (STEP - noise.GYRO * noise.GYRO) * gyro * elapsed
    for k in range(3):
        ekf.P[BG + k, BG + k] += (STEP - noise.GYRO_BIAS * noise.GYRO_BIAS) * bias * elapsed


@law
def loosen(ekf: Ekf) -> None:
    """Let yaw, and the gyro's bias about the vertical, be less tied to all else.

    Not while biases of the magnetometer are learnt: through these, yaw would stay tied. From all other states alike:
    the factors then are a covariance themselves, and the product of two, element by element, is one (Schur). With a
    factor for velocity and position alone, variances fall below zero in the end.
    """
    P, yaw, bias = ekf.P, THETA + 2, BG + 2
    for j in range(N):
        if j in (yaw, bias):
            continue
        for k in (yaw, bias):
            P[k, j] *= TIED
            P[j, k] *= TIED


@law
def fuse(ekf: Ekf, estimate: Estimate, log: Events, params: Ekf3, armed: bool) -> bool:
    """Align or fuse yaw when there are enough samples; whether something was fused."""
    if ekf.mag_n < FUSE_SAMPLES:
        return False
    field = take_mean(ekf)
    if not shows_yaw(ekf, field):
        return False
    assume_field(ekf, field)
    learns = ekf.yaw_in_flight and params.MAG_CAL != NEVER
    if not learns:
        field += rotate(ekf.q, ekf.mag_bias)  # the heading is that of the field as it is measured
    residual = wrap_pi(ekf.declination - atan2(field.y, field.x))
    if not ekf.yaw_aligned:
        ekf.yaw_aligned = True
        emit(log, ekf.now_us, EKF_YAW_ALIGNED, float(ekf.imu), float(ekf.compass))
        align(ekf, estimate, residual, params)
        forget_bias(ekf)
        return True
    if is_leaving_ground(ekf, armed):
        ekf.yaw_in_flight = True
        emit(log, ekf.now_us, EKF_YAW_ALIGNED_IN_FLIGHT, float(ekf.imu), float(ekf.compass))
        align_in_flight(ekf, estimate, residual, params)
        return True
    add_noise(ekf, params, min(1e-6 * (ekf.now_us - ekf.mag_fused_us), LONGEST))
    sigma = params.YAW_M_NSE
    if learns:
        expected = ekf.earth_field
        set_row(ekf)
        sigma = params.MAG_M_NSE / math.sqrt(expected.x * expected.x + expected.y * expected.y)
    else:
        loosen(ekf)
        clear_row(ekf)
        ekf.h[THETA + 2] = 1.0
    innovation = innovate(ekf, residual, sigma * sigma)
    ekf.innovation_yaw = innovation.value
    ratio = gate_ratio(innovation.value * innovation.value, innovation.variance, 0.0, params.YAW_I_GATE)
    estimate.variance_mag = math.sqrt(ratio)
    if ratio < 1.0 or not armed:
        value = constrain(innovation.value, -MAX_INNOVATION, MAX_INNOVATION)
        correct(ekf, Innovation(value, innovation.variance), NIS_MAGNETOMETER)
        ekf.mag_fused_us = ekf.now_us
        return True
    if ekf.now_us - ekf.mag_fused_us > TIMEOUT_US and not is_yaw_confirmed(ekf, estimate):
        align(ekf, estimate, residual, params)
        return True
    return False
