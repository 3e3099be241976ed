# SPDX-License-Identifier: BSD-3-Clause
"""Height from the barometer: altitude in the standard atmosphere relative to where the filter started."""

from __future__ import annotations

import math

from ...core.algebra import horizontal, with_down
from ...core.elementary import exp, log
from ...core.kernels import law
from ...core.vectors import Vec3
from ..params.estimator import Ekf3
from ..state import Estimate
from . import doubt, noise
from .covariance import clear
from .fusion import NIS_BAROMETER, correct, gate_ratio, innovate_position
from .history import shift
from .state import POS, VEL, Ekf

FUSE_SAMPLES = 5
"""Samples averaged into one measurement (10 Hz from 50 Hz)."""
TIMEOUT_US = 5_000_000
"""After this long without an accepted height the filter takes the barometer's."""
TIMEOUT_WITH_GPS_US = 10_000_000
"""Likewise, while the receiver's velocity down is there to carry the height."""
_TEMPERATURE_BY_LAPSE = 44330.769  # [m]: 288.15 K / 0.0065 K/m
_EXPONENT = 0.190263  # R L / g


@law
def standard_altitude(pressure: float) -> float:
    """Altitude [m] in the ISA standard atmosphere (ISO 2533) of a pressure [hPa]."""
    return _TEMPERATURE_BY_LAPSE * (1.0 - exp(_EXPONENT * log(pressure / 1013.25)))


@law
def read(ekf: Ekf, count: int, pressure: float) -> None:
    """Add sample ``count`` [hPa] to the sum if it is new; one that makes no sense is passed over."""
    if count == ekf.baro_seen:
        return
    ekf.baro_seen = count
    if 100.0 < pressure < 1200.0:
        ekf.baro_sum += standard_altitude(pressure)
        ekf.baro_us_sum += ekf.now_us
        ekf.baro_n += 1
        ekf.baro_us = ekf.now_us


@law
def _empty(ekf: Ekf) -> None:
    ekf.baro_sum = 0.0
    ekf.baro_us_sum = 0
    ekf.baro_n = 0


@law
def leave_out(ekf: Ekf) -> None:
    """The height comes from elsewhere."""
    _empty(ekf)
    ekf.baro_fused_us = ekf.now_us


@law
def set_ground(ekf: Ekf) -> None:
    """Let the mean since boot be the height zero."""
    ekf.baro_ground = ekf.baro_sum / ekf.baro_n
    _empty(ekf)
    ekf.pos = with_down(horizontal(ekf.pos), 0.0)


@law
def fuse(ekf: Ekf, estimate: Estimate, params: Ekf3) -> bool:
    """Fuse the mean of the samples when there are enough; whether something was fused."""
    if ekf.baro_n < FUSE_SAMPLES:
        return False
    down = ekf.baro_ground - ekf.baro_sum / ekf.baro_n
    sigma = noise.HEIGHT * params.ALT_M_NSE
    variance = sigma * sigma / ekf.baro_n
    age = 1e-6 * (ekf.now_us - ekf.baro_us_sum / ekf.baro_n)
    _empty(ekf)
    residual, nominal = down - (ekf.pos.z - age * ekf.vel.z), params.ALT_M_NSE
    innovation = innovate_position(ekf, 2, age, residual, variance)
    if doubt.is_odd(ekf, innovation, variance):
        doubt.begin(ekf)
    if doubt.is_doubting(ekf):
        variance, nominal = nominal * nominal, 0.0
        innovation = innovate_position(ekf, 2, age, residual, variance)
    estimate.innovation_pos_d = -innovation.value
    ekf.innovation_pos = with_down(horizontal(ekf.innovation_pos), innovation.value)
    squared = innovation.value * innovation.value
    ratio = gate_ratio(squared, innovation.variance, nominal, params.HGT_I_GATE)
    estimate.variance_hgt = math.sqrt(ratio)
    if ratio < 1.0:
        correct(ekf, innovation, NIS_BAROMETER)
        ekf.baro_fused_us = ekf.now_us
        return True
    with_gps = ekf.absolute and ekf.now_us - ekf.vel_fused_us < TIMEOUT_US
    if ekf.now_us - ekf.baro_fused_us > (TIMEOUT_WITH_GPS_US if with_gps else TIMEOUT_US):
        reset_height(ekf, estimate, down, variance)
        ekf.baro_fused_us = ekf.now_us
    return False


@law
def reset_height(ekf: Ekf, estimate: Estimate, down: float, variance: float) -> None:
    """Jump to a position down of the origin [m] of the given variance [m^2]."""
    clear(ekf.P, POS + 2, 1, variance)
    clear(ekf.P, VEL + 2, 1, 1.0)
    shift(ekf, Vec3(0.0, 0.0, down - ekf.pos.z), Vec3(0.0, 0.0, 0.0))
    ekf.pos = with_down(horizontal(ekf.pos), down)
    ekf.lag_pos = with_down(horizontal(ekf.lag_pos), 0.0)
    estimate.reset_pos = with_down(horizontal(estimate.reset_pos), down - estimate.pos.z)
    estimate.reset_vel = with_down(horizontal(estimate.reset_vel), 0.0)
    estimate.reset_d_count += 1
