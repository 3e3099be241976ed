# SPDX-License-Identifier: BSD-3-Clause
"""Fusion of one scalar measurement, and how the error found goes into the state.

Scalars of one step are fused one after the other into ``dx``; each innovation is reduced by what ``dx``
explains already. ``inject`` then moves the nominal state, and with it the past states kept for delayed
measurements.
"""

from __future__ import annotations

from typing import NamedTuple

from ...core.algebra import limit_components, multiply, normalise, quat_from_rotation_vector, vector_at
from ...core.kernels import law
from .history import correct_past
from .state import BA, BG, BM, POS, THETA, VEL, Ekf, N

MAX_GYRO_BIAS = 0.2  # [rad/s]
MAX_MAG_BIAS = 0.1  # [gauss]
NIS_GPS_POSITION, NIS_GPS_VELOCITY, NIS_HEIGHT, NIS_MAGNETOMETER = 0, 1, 2, 3
NO_NIS = -1


class Innovation(NamedTuple):
    """What a measurement shows that the filter did not expect."""

    value: float  # measured minus predicted
    variance: float  # of that


@law
def clear_row(ekf: Ekf) -> None:
    """Begin a measurement row ``h``: the caller then sets the entries that are not zero."""
    for i in range(N):
        ekf.h[i] = 0.0


@law
def innovate(ekf: Ekf, residual: float, variance: float) -> Innovation:
    """Innovation of a measurement with row ``h``; leaves P h' in ``ph``.

    Args:
        ekf: the filter.
        residual: measured minus predicted before this step's fusions.
        variance: of the measurement.
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
    return Innovation(innovation, s)


@law
def innovate_state(ekf: Ekf, k: int, residual: float, variance: float) -> Innovation:
    """Innovation of a direct measurement of error state ``k``."""
    clear_row(ekf)
    ekf.h[k] = 1.0
    return innovate(ekf, residual, variance)


@law
def innovate_position(ekf: Ekf, axis: int, age: float, residual: float, variance: float) -> Innovation:
    """Innovation of the position north (0), east (1) or down (2) [m] ``age`` [s] ago: dp(t - d) = dp(t) - d dv(t)."""
    clear_row(ekf)
    ekf.h[POS + axis] = 1.0
    ekf.h[VEL + axis] = -age
    return innovate(ekf, residual, variance)


@law
def gate_ratio(squares: float, variances: float, nominal: float, gate: float) -> float:
    """Squared innovation by squared gate; below 1 the measurement is taken. EKF_STATUS_REPORT has its root.

    ``nominal``: the EK3_*_M_NSE parameter as it stands, ``gate``: EK3_*_I_GATE. As in ArduPilot the gate is
    that many hundredths of a standard deviation of a sensor with the parameter's noise, wider than
    noise.py's value: a knock on the accelerometer must not lock GPS out.
    """
    k = 0.01 * gate
    return squares / (k * k * (variances + nominal * nominal))


@law
def correct(ekf: Ekf, innovation: Innovation, kind: int) -> None:
    """Fuse the measurement that ``innovate`` looked at; ``kind``: NIS_* or NO_NIS."""
    P, ph = ekf.P, ekf.ph
    inverse = 1.0 / innovation.variance
    for i in range(N):
        gain = ph[i] * inverse
        ekf.dx[i] += gain * innovation.value
        for j in range(N):
            P[i, j] -= gain * ph[j]
    ekf.biases_mirrored = False
    if kind >= 0:
        ekf.nis_sum[kind] += innovation.value * innovation.value * inverse
        ekf.nis_count[kind] += 1


@law
def fuse_state(ekf: Ekf, k: int, residual: float, variance: float) -> None:
    """Fuse a direct measurement of error state ``k`` without a gate."""
    correct(ekf, innovate_state(ekf, k, residual, variance), NO_NIS)


@law
def inject(ekf: Ekf, acc_bias_max: float) -> None:
    """Move ``dx`` into the nominal state, the output lag and the past states; ``acc_bias_max`` [m/s^2]."""
    dx = ekf.dx
    dv, dp = vector_at(dx, VEL), vector_at(dx, POS)
    ekf.q = normalise(multiply(quat_from_rotation_vector(vector_at(dx, THETA)), ekf.q))
    ekf.vel += dv
    ekf.pos += dp
    ekf.lag_vel -= dv
    ekf.lag_pos -= dp
    ekf.gyro_bias = limit_components(ekf.gyro_bias + vector_at(dx, BG), MAX_GYRO_BIAS)
    ekf.acc_bias = limit_components(ekf.acc_bias + vector_at(dx, BA), acc_bias_max)
    ekf.mag_bias = limit_components(ekf.mag_bias + vector_at(dx, BM), MAX_MAG_BIAS)
    correct_past(ekf, dp, dv)
    for i in range(N):
        dx[i] = 0.0
