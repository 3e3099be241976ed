# SPDX-License-Identifier: BSD-3-Clause
"""Low-pass filters of body rates and acceleration (INS_GYRO_FILTER, INS_ACCEL_FILTER), as the controllers see them.

A second-order Butterworth filter each, made digital with the bilinear transform. The estimator integrates what the
sensors show and does not see the filters.
"""

from __future__ import annotations

import math

from ..core.constants import TICK_US
from ..core.kernels import inlined, law
from ..core.records import Record
from ..core.scalars import PI, finite
from ..core.vectors import Vec3
from .params.system import Inertial

_DT = TICK_US * 1e-6


class LowPass(Record):
    """A filter of vectors. Zeros are one that does nothing."""

    cutoff: float  # of which the coefficients are [Hz]; 0: no filter
    gain: float  # y + a1 y' + a2 y'' = gain (x + 2 x' + x''), a prime for each tick before
    a1: float
    a2: float
    first: Vec3  # state, transposed direct form II
    second: Vec3


class InertialFilter(Record):
    """The filters."""

    gyro: LowPass
    acc: LowPass


@law
def set_cutoff(f: LowPass, cutoff: float, x: Vec3) -> None:
    """Filter with ``cutoff`` [Hz] from now on, as if ``x`` had been there for long.

    The frequency is not warped: the delay of slow signals, which is what loops feel, is right for any cut-off.
    """
    w = PI * cutoff * _DT
    f.cutoff = cutoff
    f.a1 = f.a2 = f.gain = 0.0
    if cutoff > 0.0:
        scale = 1.0 + math.sqrt(2.0) * w + w * w
        f.gain = w * w / scale
        f.a1 = 2.0 * (w * w - 1.0) / scale
        f.a2 = (1.0 - math.sqrt(2.0) * w + w * w) / scale
    settle(f, x)


@law
def settle(f: LowPass, x: Vec3) -> None:
    """State of a filter in which ``x`` has been for long; zero when ``x`` is not finite."""
    if not finite(x.x + x.y + x.z):
        x = Vec3(0.0, 0.0, 0.0)
    f.second = (f.gain - f.a2) * x
    f.first = (2.0 * f.gain - f.a1) * x + f.second


@inlined
def filtered(f: LowPass, x: Vec3, cutoff: float) -> Vec3:
    """The next output."""
    if cutoff != f.cutoff:
        set_cutoff(f, cutoff, x)
    if cutoff <= 0.0:
        return x
    part = f.gain * x
    y = part + f.first
    f.first = 2.0 * part - f.a1 * y + f.second
    f.second = part - f.a2 * y
    if not finite(y.x + y.y + y.z):
        settle(f, x)
        return x
    return y


@inlined
def smoothed_rates(f: InertialFilter, rates: Vec3, params: Inertial) -> Vec3:
    """Body rates [rad/s] for the controllers."""
    return filtered(f.gyro, rates, params.GYRO_FILTER)


@inlined
def smoothed_acc(f: InertialFilter, acc_ned: Vec3, params: Inertial) -> Vec3:
    """Acceleration NED [m/s^2] for the controllers."""
    return filtered(f.acc, acc_ned, params.ACCEL_FILTER)
