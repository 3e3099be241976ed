# SPDX-License-Identifier: BSD-3-Clause
"""Height from the barometer: altitude in the standard atmosphere relative to where the filter started."""

from __future__ import annotations

from ...core.algebra import horizontal, with_down
from ...core.elementary import exp, log
from ...core.kernels import law
from ...core.scalars import constrain
from ..params.estimator import Ekf3
from ..state import Estimate
from . import height, noise
from .height import Height
from .state import Ekf

FUSE_SAMPLES = 5
"""Samples averaged into one measurement (10 Hz from 50 Hz)."""
FOLLOWS, FOLLOWS_MAX = 0.1, 5.0
"""Share of a difference that the offset takes up with each measurement, of at most so much [m]."""
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
def _down(ekf: Ekf) -> float:
    """Position down [m] by the mean of the samples."""
    return ekf.baro_ground + ekf.baro_offset - ekf.baro_sum / ekf.baro_n


@law
def _empty(ekf: Ekf) -> None:
    ekf.baro_sum = 0.0
    ekf.baro_us_sum = 0
    ekf.baro_n = 0


@law
def follow(ekf: Ekf) -> None:
    """The height comes from elsewhere: learn how far the barometer's is off, so that it takes over without a jump."""
    if ekf.baro_n < FUSE_SAMPLES:
        return
    age = 1e-6 * (ekf.now_us - ekf.baro_us_sum / ekf.baro_n)
    difference = ekf.pos.z - age * ekf.vel.z - _down(ekf)
    _empty(ekf)
    ekf.baro_offset += FOLLOWS * constrain(difference, -FOLLOWS_MAX, FOLLOWS_MAX)


@law
def set_ground(ekf: Ekf) -> None:
    """Let the mean since boot be the height zero."""
    ekf.baro_ground = ekf.baro_sum / ekf.baro_n
    ekf.baro_offset = 0.0
    _empty(ekf)
    ekf.pos = with_down(horizontal(ekf.pos), 0.0)


@law
def fuse(ekf: Ekf, estimate: Estimate, params: Ekf3) -> bool:
    """Fuse the mean of the samples when there are enough; whether something was fused."""
    if ekf.baro_n < FUSE_SAMPLES:
        return False
    ekf.height_of_gps = False
    down = _down(ekf)
    sigma = noise.HEIGHT * params.ALT_M_NSE
    variance = sigma * sigma / ekf.baro_n
    age = 1e-6 * (ekf.now_us - ekf.baro_us_sum / ekf.baro_n)
    _empty(ekf)
    residual = down - (ekf.pos.z - age * ekf.vel.z)
    return height.fuse(ekf, estimate, Height(down, age, residual, variance, params.ALT_M_NSE), params)
