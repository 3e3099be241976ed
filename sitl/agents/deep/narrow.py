# SPDX-License-Identifier: BSD-3-Clause
"""Functions at float32 precision, for features and layers: the same bits on any processor, and many at once.

``sitl.core.elementary`` has them at float64 precision, with branches for all cases, which take several times as long.
"""

from __future__ import annotations

import math

import numpy as np

from sitl.core.array_kernels import Kernel, NarrowLine
from sitl.core.float_bits import bits_float, float_bits
from sitl.core.kernels import inlined, law

_SATURATED = 20.0
"""tanh of more is 1 at float32 precision."""
_FRACTION, _ONE, _WHOLE = 0x000FFFFFFFFFFFFF, 0x3FF0000000000000, 0x4330000000000000
"""Of a double's bits: those of the fraction; of 1.0; of 2^52, to which a whole number below is added as it is."""
_BIAS = 4503599627370496.0 + 1023.0


@inlined
def narrow_tanh(x: float) -> float:
    """tanh, right to 1e-13 of itself.

    With e = exp(y) - 1 and y = -2 |x|, tanh |x| = -e / (2 + e). Of y / 64, e is a short series; exp(2 y) - 1 =
    e (2 + e) doubles y without cancellation.
    """
    size = min(abs(x), _SATURATED)
    y = size * -0.03125  # -2 / 64
    e = y * (1.0 + y * (1.0 / 2 + y * (1.0 / 6 + y * (1.0 / 24 + y * (1.0 / 120 + y * (1.0 / 720 + y * (
        1.0 / 5040 + y * (1.0 / 40320 + y * (1.0 / 362880 + y * (1.0 / 3628800))))))))))  # fmt: skip
    e = e * (2.0 + e)
    e = e * (2.0 + e)
    e = e * (2.0 + e)
    e = e * (2.0 + e)
    e = e * (2.0 + e)
    e = e * (2.0 + e)
    return math.copysign(e / (2.0 + e), x)


@inlined
def narrow_log1p(x: float) -> float:
    """log(1 + x) of a number from 0 on, right to 1e-10 of itself or 1e-16.

    1 + x is 2^k m with m in [sqrt(1/2), sqrt(2)); log m is a series of s = (m - 1) / (m + 1).
    """
    bits = float_bits(1.0 + x)
    k = bits_float((bits >> 52) | _WHOLE) - _BIAS
    m = bits_float((bits & _FRACTION) | _ONE)
    is_high = m > 1.4142135623730951
    k = k + 1.0 if is_high else k
    m = 0.5 * m if is_high else m
    s = (m - 1.0) / (m + 1.0)
    z = s * s
    series = 1.0 + z * (1.0 / 3 + z * (1.0 / 5 + z * (1.0 / 7 + z * (1.0 / 9 + z * (1.0 / 11 + z * (1.0 / 13))))))
    found = k * 0.6931471805599453 + 2.0 * s * series
    return found if x < 1e300 else x


@law
def write_tanh(x: NarrowLine, out: NarrowLine) -> None:
    """Of each number."""
    for k in range(len(x)):
        out[k] = np.float32(narrow_tanh(float(x[k])))


@law
def write_log1p(x: NarrowLine, out: NarrowLine) -> None:
    """Of each number."""
    for k in range(len(x)):
        out[k] = np.float32(narrow_log1p(float(x[k])))


tanh_of_all, log1p_of_all = Kernel(write_tanh), Kernel(write_log1p)
