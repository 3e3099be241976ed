# SPDX-License-Identifier: BSD-3-Clause
"""Fusion of one scalar measurement, and how the error found goes into the state.

Scalars of one step are fused one after the other into ``dx``; each innovation is reduced by what ``dx``
explains already. ``inject`` then moves the nominal state, and with it the past states kept for delayed
measurements: a correction (dp, dv) made now means dp - dv * age for a position of that age.
"""

from __future__ import annotations

from ...core.kernels import law
from ...core.rotations import quat_from_rotation_vector, quat_multiply
from ...core.scalars import constrain
from .state import BA, BG, BM, POS, RING, THETA, VEL, N
from .strapdown import set_attitude

MAX_GYRO_BIAS = 0.2  # [rad/s]
MAX_MAG_BIAS = 0.1  # [gauss]
NIS_GPS_POSITION, NIS_GPS_VELOCITY, NIS_BAROMETER, NIS_MAGNETOMETER = 0, 1, 2, 3


@law
def clear_row(ekf):
    """Begin a measurement row ``h``: the caller then sets the entries that are not zero."""
    for i in range(N):
        ekf.h[i] = 0.0


@law
def innovate(ekf, residual, variance):
    """(innovation, its variance) of a measurement with row ``h``; leaves P h' in ``ph``.

    ``residual``: measured minus predicted before this step's fusions; ``variance``: of the measurement.
    """
    P, h, ph = ekf.P, ekf.h, ekf.ph
    for i in range(N):
        ph[i] = 0.0
    innovation = residual
    for k in range(N):
        a = h[k]
        if a != 0.0:
            innovation -= a * ekf.dx[k]
            for i in range(N):
                ph[i] += a * P[k, i]
    s = variance
    for k in range(N):
        s += h[k] * ph[k]
    return (innovation, s)


@law
def gate_ratio(squares, variances, nominal, gate):
    """Squared innovation by squared gate; below 1 the measurement is taken. EKF_STATUS_REPORT has its root.

    ``nominal``: the EK3_*_M_NSE parameter as it stands, ``gate``: EK3_*_I_GATE. As in ArduPilot the gate is
    that many hundredths of a standard deviation of a sensor with the parameter's noise, wider than
    noise.py's figure: a knock on the accelerometer must not lock GPS out.
    """
    k = 0.01 * gate
    return squares / (k * k * (variances + nominal * nominal))


@law
def correct(ekf, innovation, s, kind):
    """Fuse the measurement that ``innovate`` looked at; ``kind``: NIS_* or -1."""
    P, ph = ekf.P, ekf.ph
    inverse = 1.0 / s
    for i in range(N):
        gain = ph[i] * inverse
        ekf.dx[i] += gain * innovation
        for j in range(N):
            P[i, j] -= gain * ph[j]
    if kind >= 0:
        ekf.nis_sum[kind] += innovation * innovation * inverse
        ekf.nis_count[kind] += 1


@law
def fuse_state(ekf, k, residual, variance):
    """Fuse a direct measurement of error state ``k`` without a gate."""
    clear_row(ekf)
    ekf.h[k] = 1.0
    innovation, s = innovate(ekf, residual, variance)
    correct(ekf, innovation, s, -1)


@law
def inject(ekf, acc_bias_limit, now_us):
    """Move ``dx`` into the nominal state, the output lag and the past states."""
    dx = ekf.dx
    w, x, y, z = quat_from_rotation_vector(dx[THETA], dx[THETA + 1], dx[THETA + 2])
    w, x, y, z = quat_multiply(w, x, y, z, ekf.q[0], ekf.q[1], ekf.q[2], ekf.q[3])
    set_attitude(ekf, w, x, y, z)
    for k in range(3):
        dv, dp = dx[VEL + k], dx[POS + k]
        ekf.vel[k] += dv
        ekf.pos[k] += dp
        ekf.lag_vel[k] -= dv
        ekf.lag_pos[k] -= dp
        ekf.gyro_bias[k] = constrain(ekf.gyro_bias[k] + dx[BG + k], -MAX_GYRO_BIAS, MAX_GYRO_BIAS)
        ekf.acc_bias[k] = constrain(ekf.acc_bias[k] + dx[BA + k], -acc_bias_limit, acc_bias_limit)
        ekf.mag_bias[k] = constrain(ekf.mag_bias[k] + dx[BM + k], -MAX_MAG_BIAS, MAX_MAG_BIAS)
    for n in range(RING):
        age = 1e-6 * (now_us - ekf.ring_us[n])
        for k in range(3):
            ekf.ring_vel[n, k] += dx[VEL + k]
            ekf.ring_pos[n, k] += dx[POS + k] - age * dx[VEL + k]
    for i in range(N):
        dx[i] = 0.0
