# SPDX-License-Identifier: BSD-3-Clause
"""Covariance of the error state: prediction, resets and bounds.

The attitude error is a small rotation of the NED frame (true = exp(error) * estimated), so the transition is

    attitude'  = attitude - R dt gyro_bias
    velocity'  = velocity + attitude x dv - R dt acc_bias     (dv: specific force summed over the step, NED)
    position'  = position + dt velocity

and needs no rates. P' = F P F' + Q is two sweeps of rows with a transposition between. Source of the
error-state formulation: Sola, "Quaternion kinematics for the error-state Kalman filter", arXiv:1711.02508,
section 7 (global errors).
"""

from __future__ import annotations

import math

from ...core.kernels import law
from . import noise
from .state import BA, BG, BM, POS, THETA, VEL, N

MAX_VARIANCE = (1.0, 1e4, 1e8, 0.1, 25.0, 1.0)  # attitude, velocity, position, gyro, acc and mag bias
MIN_VARIANCE = (1e-9, 1e-6, 1e-6, 1e-13, 1e-9, 1e-11)


@law
def _rows(ekf):
    """P := F P, rows at a time."""
    P, q, dv, dt = ekf.P, ekf.q, ekf.step_dv, ekf.step_dt
    w, x, y, z = q[0], q[1], q[2], q[3]
    r00, r01, r02 = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)
    r10, r11, r12 = 2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)
    r20, r21, r22 = 2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)
    r00, r01, r02 = r00 * dt, r01 * dt, r02 * dt
    r10, r11, r12 = r10 * dt, r11 * dt, r12 * dt
    r20, r21, r22 = r20 * dt, r21 * dt, r22 * dt
    vn, ve, vd = dv[0], dv[1], dv[2]
    for j in range(N):
        P[6, j] += dt * P[3, j]
        P[7, j] += dt * P[4, j]
        P[8, j] += dt * P[5, j]
    for j in range(N):
        P[3, j] += P[1, j] * vd - P[2, j] * ve - (r00 * P[12, j] + r01 * P[13, j] + r02 * P[14, j])
        P[4, j] += P[2, j] * vn - P[0, j] * vd - (r10 * P[12, j] + r11 * P[13, j] + r12 * P[14, j])
        P[5, j] += P[0, j] * ve - P[1, j] * vn - (r20 * P[12, j] + r21 * P[13, j] + r22 * P[14, j])
    for j in range(N):
        P[0, j] -= r00 * P[9, j] + r01 * P[10, j] + r02 * P[11, j]
        P[1, j] -= r10 * P[9, j] + r11 * P[10, j] + r12 * P[11, j]
        P[2, j] -= r20 * P[9, j] + r21 * P[10, j] + r22 * P[11, j]


@law
def predict(ekf, params):
    """Covariance over the step since the last one: ``step_dt`` seconds, ``step_dv`` m/s."""
    P = ekf.P
    dt = ekf.step_dt
    _rows(ekf)
    for i in range(N):
        for j in range(i):
            P[i, j], P[j, i] = P[j, i], P[i, j]
    _rows(ekf)
    gyro, acc = noise.GYRO * params.EK3.GYRO_P_NSE, noise.ACC * params.EK3.ACC_P_NSE
    gyro_bias, acc_bias = noise.GYRO_BIAS * params.EK3.GBIAS_P_NSE, noise.ACC_BIAS * params.EK3.ABIAS_P_NSE
    mag_bias = noise.MAG_BIAS * params.EK3.MAGB_P_NSE
    for k in range(3):
        P[THETA + k, THETA + k] += gyro * gyro * dt
        P[VEL + k, VEL + k] += acc * acc * dt
        P[BG + k, BG + k] += gyro_bias * gyro_bias * dt
        P[BA + k, BA + k] += acc_bias * acc_bias * dt
        P[BM + k, BM + k] += mag_bias * mag_bias * dt
    symmetrise(ekf)


@law
def symmetrise(ekf):
    """Replace P by the mean of P and its transpose."""
    P = ekf.P
    for i in range(N):
        for j in range(i):
            mean = 0.5 * (P[i, j] + P[j, i])
            P[i, j] = mean
            P[j, i] = mean


@law
def clear(ekf, first, count, variance):
    """Forget what is known of ``count`` states from ``first``: no correlations, the given variance."""
    for i in range(first, first + count):
        for j in range(N):
            ekf.P[i, j] = 0.0
            ekf.P[j, i] = 0.0
        ekf.P[i, i] = variance


@law
def start(ekf):
    """P at initialisation (noise.py)."""
    clear(ekf, THETA, 3, noise.INITIAL_TILT * noise.INITIAL_TILT)
    clear(ekf, VEL, 3, noise.INITIAL_VELOCITY * noise.INITIAL_VELOCITY)
    clear(ekf, POS, 3, noise.INITIAL_POSITION * noise.INITIAL_POSITION)
    clear(ekf, BG, 3, noise.INITIAL_GYRO_BIAS * noise.INITIAL_GYRO_BIAS)
    clear(ekf, BA, 3, noise.INITIAL_ACC_BIAS * noise.INITIAL_ACC_BIAS)
    clear(ekf, BM, 3, noise.INITIAL_MAG_BIAS * noise.INITIAL_MAG_BIAS)


@law
def turn_frame(ekf, angle):
    """Turn the horizontal errors of attitude, velocity and position with a jump of yaw by ``angle`` [rad].

    What ties them to the biases is known in the body frame.
    """
    P = ekf.P
    c, s = math.cos(angle), math.sin(angle)
    for n in range(THETA, BG, 3):
        e = n + 1
        for j in range(N):
            a, b = P[n, j], P[e, j]
            P[n, j], P[e, j] = c * a - s * b, s * a + c * b
        for j in range(N):
            a, b = P[j, n], P[j, e]
            P[j, n], P[j, e] = c * a - s * b, s * a + c * b


@law
def bound(ekf):
    """Keep variances within bounds and correlations within +-1."""
    P = ekf.P
    for i in range(N):
        low, high = MIN_VARIANCE[i // 3], MAX_VARIANCE[i // 3]
        if P[i, i] > high:
            clear(ekf, i, 1, high)
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
