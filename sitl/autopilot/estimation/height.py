# SPDX-License-Identifier: BSD-3-Clause
"""A height of the barometer or of the GPS receiver is fused (EK3_SRCn_POSZ 1 and 3): one gate and one time-out."""

from __future__ import annotations

import math
from typing import NamedTuple

from ...core.algebra import horizontal, with_down
from ...core.kernels import law
from ...core.vectors import Vec3
from ..params.estimator import Ekf3
from ..state import Estimate
from . import doubt
from .covariance import clear
from .fusion import NIS_HEIGHT, correct, gate_ratio, innovate_position
from .history import shift
from .state import POS, VEL, Ekf

TIMEOUT_US = 5_000_000
"""After this long without an accepted height the filter takes the measured one."""
TIMEOUT_WITH_GPS_US = 10_000_000
"""Likewise, while the receiver's velocity down is there to carry the height."""

UNKNOWN_US = 60_000_000
"""So long ago the last accepted height was, where the next one is to be taken as it is, unless it passes the gate."""


class Height(NamedTuple):
    """A measurement."""

    down: float  # position down of the origin [m]
    age: float  # [s]
    residual: float  # down minus the filter's of that time [m]
    variance: float  # of a healthy sensor [m^2]
    nominal: float  # standard deviation as the EK3_* parameters have it [m]


@law
def fuse(ekf: Ekf, estimate: Estimate, height: Height, params: Ekf3) -> bool:
    """Fuse a height; whether something was fused."""
    variance, nominal = height.variance, height.nominal
    innovation = innovate_position(ekf, 2, height.age, height.residual, variance)
    if doubt.is_odd(ekf, innovation, variance):
        doubt.begin(ekf)
    if doubt.is_doubting(ekf):
        variance, nominal = nominal * nominal, 0.0
        innovation = innovate_position(ekf, 2, height.age, height.residual, variance)
    estimate.innovation_pos_d = -innovation.value
    ekf.innovation_pos = with_down(horizontal(ekf.innovation_pos), innovation.value)
    squared = innovation.value * innovation.value
    ratio = gate_ratio(squared, innovation.variance, nominal, params.HGT_I_GATE)
    estimate.variance_hgt = math.sqrt(ratio)
    if ratio < 1.0:
        correct(ekf, innovation, NIS_HEIGHT)
        ekf.baro_fused_us = ekf.now_us
        return True
    with_gps = ekf.absolute and ekf.now_us - ekf.vel_fused_us < TIMEOUT_US
    if ekf.now_us - ekf.baro_fused_us > (TIMEOUT_WITH_GPS_US if with_gps else TIMEOUT_US):
        reset(ekf, estimate, height.down, variance)
        ekf.baro_fused_us = ekf.now_us
    return False


@law
def reset(ekf: Ekf, estimate: Estimate, down: float, variance: float) -> None:
    """Jump to a position down of the origin [m] of the given variance [m^2]."""
    clear(ekf.P, POS + 2, 1, variance)
    clear(ekf.P, VEL + 2, 1, 1.0)
    shift(ekf, Vec3(0.0, 0.0, down - ekf.pos.z), Vec3(0.0, 0.0, 0.0))
    ekf.pos = with_down(horizontal(ekf.pos), down)
    ekf.lag_pos = with_down(horizontal(ekf.lag_pos), 0.0)
    estimate.reset_pos = with_down(horizontal(estimate.reset_pos), down - estimate.pos.z)
    estimate.reset_vel = with_down(horizontal(estimate.reset_vel), 0.0)
    estimate.reset_d_count += 1
