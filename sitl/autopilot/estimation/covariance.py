# SPDX-License-Identifier: BSD-3-Clause
"""Covariance P of the error state: prediction, resets and bounds.

The attitude error is a small rotation of the NED frame (true = exp(error) * estimated), so the transition is

    attitude'  = attitude - R dt gyro_bias
    velocity'  = velocity + attitude x dv - R dt acc_bias     (dv: specific force summed over the step, NED)
    position'  = position + dt velocity

and needs no rates. P' = F P F' + Q is two sweeps of rows with a transposition between. Biases stay: where their rows
and columns are the same numbers, the second sweep would give their columns what the first gave.
Source of the error-state formulation: Sola, "Quaternion kinematics for the error-state Kalman filter",
arXiv:1711.02508, section 7 (global errors).
"""

from __future__ import annotations

import math

from ...core.algebra import Matrix3, apply, cross, rotation_matrix, scaled
from ...core.elementary import sincos
from ...core.kernels import inlined, law
from ...core.records import Floats
from ...core.vectors import Vec3
from ..params.estimator import Ekf3
from . import noise
from .state import BA, BG, BM, POS, THETA, VEL, Ekf, N

MOVING = 9
"""States that a prediction changes: attitude, velocity, position."""
MAX_VARIANCE = (1.0, 1e4, 1e8, 0.1, 25.0, 1.0)  # attitude, velocity, position, gyro, acc and mag bias
MIN_VARIANCE = (1e-9, 1e-6, 1e-6, 1e-13, 1e-9, 1e-11)


@inlined
def _column(P: Floats, first: int, j: int) -> Vec3:
    return Vec3(P[first, j], P[first + 1, j], P[first + 2, j])


@inlined
def _set_column(P: Floats, first: int, j: int, v: Vec3) -> None:
    P[first, j], P[first + 1, j], P[first + 2, j] = v.x, v.y, v.z


@inlined
def _advance_column(P: Floats, turn: Matrix3, dv: Vec3, dt: float, j: int) -> None:
    """A column of F P in place of that of P; ``turn``: R dt."""
    attitude, vel = _column(P, THETA, j), _column(P, VEL, j)
    _set_column(P, POS, j, _column(P, POS, j) + dt * vel)
    _set_column(P, VEL, j, vel + (cross(attitude, dv) - apply(turn, _column(P, BA, j))))
    _set_column(P, THETA, j, attitude - apply(turn, _column(P, BG, j)))


@inlined
def predict(ekf: Ekf, params: Ekf3) -> None:
    """Covariance after ``step_dt`` in which the specific force summed up to ``step_dv``."""
    P, dv, dt = ekf.P, ekf.step_dv, ekf.step_dt
    turn = scaled(rotation_matrix(ekf.q), dt)
    columns = MOVING if ekf.biases_mirrored else N
    for j in range(N):
        _advance_column(P, turn, dv, dt, j)
    for i in range(columns):
        for j in range(i):
            P[i, j], P[j, i] = P[j, i], P[i, j]
    for i in range(columns, N):
        for j in range(MOVING):
            P[i, j] = P[j, i]
    if ekf.biases_mirrored:
        for j in range(MOVING):  # loops of known length become vector instructions
            _advance_column(P, turn, dv, dt, j)
    else:
        for j in range(N):
            _advance_column(P, turn, dv, dt, j)
    gyro, acc = noise.GYRO * params.GYRO_P_NSE, noise.ACC * params.ACC_P_NSE
    gyro_bias, acc_bias = noise.GYRO_BIAS * params.GBIAS_P_NSE, noise.ACC_BIAS * params.ABIAS_P_NSE
    if ekf.doubt_us != 0:
        gyro, acc = noise.DOUBTED_GYRO * params.GYRO_P_NSE, noise.DOUBTED_ACC * params.ACC_P_NSE
        acc_bias = noise.DOUBTED_ACC_BIAS * params.ABIAS_P_NSE
    mag_bias = noise.MAG_BIAS * params.MAGB_P_NSE
    for k in range(3):
        P[THETA + k, THETA + k] += gyro * gyro * dt
        P[VEL + k, VEL + k] += acc * acc * dt
        P[BG + k, BG + k] += gyro_bias * gyro_bias * dt
        P[BA + k, BA + k] += acc_bias * acc_bias * dt
        P[BM + k, BM + k] += mag_bias * mag_bias * dt
    symmetrise(P, columns)
    ekf.biases_mirrored = True


@inlined
def symmetrise(P: Floats, count: int) -> None:
    """Replace the first rows and columns of P by the mean of them and their transpose."""
    for i in range(count):
        for j in range(i):
            mean = 0.5 * (P[i, j] + P[j, i])
            P[i, j] = mean
            P[j, i] = mean


@inlined
def clear(P: Floats, first: int, count: int, variance: float) -> None:
    """Forget what is known of ``count`` states from ``first``: no correlations, the given variance."""
    for i in range(first, first + count):
        for j in range(N):
            P[i, j] = 0.0
            P[j, i] = 0.0
        P[i, i] = variance


@law
def start(P: Floats) -> None:
    """P at initialisation (noise.py)."""
    clear(P, THETA, 3, noise.INITIAL_TILT * noise.INITIAL_TILT)
    clear(P, VEL, 3, noise.INITIAL_VELOCITY * noise.INITIAL_VELOCITY)
    clear(P, POS, 3, noise.INITIAL_POSITION * noise.INITIAL_POSITION)
    clear(P, BG, 3, noise.INITIAL_GYRO_BIAS * noise.INITIAL_GYRO_BIAS)
    clear(P, BA, 3, noise.INITIAL_ACC_BIAS * noise.INITIAL_ACC_BIAS)
    clear(P, BM, 3, noise.INITIAL_MAG_BIAS * noise.INITIAL_MAG_BIAS)


@law
def turn_frame(P: Floats, angle: float) -> None:
    """Turn the horizontal errors of attitude, velocity and position with a jump of yaw by ``angle`` [rad].

    What ties them to the biases is known in the body frame.
    """
    s, c = sincos(angle)
    for n in range(THETA, BG, 3):
        e = n + 1
        for j in range(N):
            a, b = P[n, j], P[e, j]
            P[n, j], P[e, j] = c * a - s * b, s * a + c * b
        for j in range(N):
            a, b = P[j, n], P[j, e]
            P[j, n], P[j, e] = c * a - s * b, s * a + c * b


@inlined
def bound(P: Floats) -> None:
    """Keep variances within bounds and correlations within +-1."""
    for i in range(N):
        low, high = MIN_VARIANCE[i // 3], MAX_VARIANCE[i // 3]
        if P[i, i] > high:
            clear(P, i, 1, high)
        elif not P[i, i] >= low:
            P[i, i] = low
    for i in range(N):
        own = P[i, i]
        for j in range(i):
            product = own * P[j, j]
            if P[i, j] * P[i, j] < 0.99 * product:
                continue  # far within: no need for the root
            limit = math.sqrt(product)
            if abs(P[i, j]) > limit:
                value = limit if P[i, j] > 0.0 else -limit
                P[i, j] = value
                P[j, i] = value
