# SPDX-License-Identifier: BSD-3-Clause
"""Height from the barometer: altitude in the standard atmosphere relative to where the filter started."""

from __future__ import annotations

import math

from ...core.kernels import law
from ...core.vectors import Vec3
from . import noise
from .covariance import clear
from .fusion import NIS_BAROMETER, clear_row, correct, gate_ratio, innovate
from .history import shift
from .state import POS, VEL

FUSE_SAMPLES = 5
"""Samples averaged into one measurement (10 Hz from 50 Hz)."""
TIMEOUT_US = 5_000_000
"""After this long without an accepted height the filter takes the barometer's."""
_TEMPERATURE_BY_LAPSE = 44330.769  # [m]: 288.15 K / 0.0065 K/m
_EXPONENT = 0.190263  # R L / g


@law
def standard_altitude(pressure):
    """Altitude [m] in the ISA standard atmosphere (ISO 2533) of a pressure [hPa]."""
    return _TEMPERATURE_BY_LAPSE * (1.0 - math.exp(_EXPONENT * math.log(pressure / 1013.25)))


@law
def read(ekf, sensors, now_us):
    """Add a new sample to the sum; one that makes no sense is passed over."""
    if int(sensors.baro_count) == ekf.baro_seen:
        return
    ekf.baro_seen = int(sensors.baro_count)
    pressure = float(sensors.abs_pressure)
    if 100.0 < pressure < 1200.0:
        ekf.baro_sum += standard_altitude(pressure)
        ekf.baro_us_sum += now_us
        ekf.baro_n += 1
        ekf.baro_us = now_us


@law
def _empty(ekf):
    ekf.baro_sum = 0.0
    ekf.baro_us_sum = 0
    ekf.baro_n = 0


@law
def set_ground(ekf):
    """Let the mean since boot be pos[2] = 0."""
    ekf.baro_ground = ekf.baro_sum / ekf.baro_n
    _empty(ekf)
    ekf.pos[2] = 0.0


@law
def fuse(ap, now_us):
    """Fuse the mean of the samples when there are enough; returns 1 when something was fused."""
    ekf, params = ap.ekf, ap.params
    if ekf.baro_n < FUSE_SAMPLES:
        return 0
    down = ekf.baro_ground - ekf.baro_sum / ekf.baro_n
    sigma = noise.HEIGHT * params.EK3.ALT_M_NSE
    variance = sigma * sigma / ekf.baro_n
    age = 1e-6 * (now_us - ekf.baro_us_sum / ekf.baro_n)
    _empty(ekf)
    clear_row(ekf)
    ekf.h[POS + 2] = 1.0
    ekf.h[VEL + 2] = -age
    residual = down - (ekf.pos[2] - age * ekf.vel[2])
    innovation, s = innovate(ekf, residual, variance)
    ratio = gate_ratio(innovation * innovation, s, params.EK3.ALT_M_NSE, params.EK3.HGT_I_GATE)
    ap.estimate.variance_hgt = math.sqrt(ratio)
    if ratio < 1.0:
        correct(ekf, innovation, s, NIS_BAROMETER)
        ekf.baro_fused_us = now_us
        return 1
    if now_us - ekf.baro_fused_us > TIMEOUT_US:
        reset_height(ap, down, variance)
        ekf.baro_fused_us = now_us
    return 0


@law
def reset_height(ap, down, variance):
    """Jump to a height (pos[2] [m]); its variance [m^2]."""
    ekf, estimate = ap.ekf, ap.estimate
    jump = down - ekf.pos[2]
    clear(ekf, POS + 2, 1, variance)
    clear(ekf, VEL + 2, 1, 1.0)
    ekf.pos[2] = down
    ekf.lag_pos[2] = 0.0
    shift(ekf, 2, jump, 0.0)
    estimate.reset_pos = Vec3(estimate.reset_pos.x, estimate.reset_pos.y, down - estimate.pos.z)
    estimate.reset_vel = Vec3(estimate.reset_vel.x, estimate.reset_vel.y, 0.0)
    estimate.reset_d_count += 1
