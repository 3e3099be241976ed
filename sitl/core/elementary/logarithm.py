# SPDX-License-Identifier: BSD-3-Clause
"""Natural logarithm.

x = 2^k m, and with a number c near 1/m from a table, log(x) = k ln(2) - log(c) + log(1 + r), where r = m c - 1 is exact
as a sum of two doubles and at most 1/64 (Tang, "Table-driven implementation of the logarithm function", ACM TOMS 16,
1990). The first sum is exact, too; a minimax polynomial makes log(1 + r) - r
(``benchmarks/elementary_coefficients.py``). Next to 1, c is 1, so that small logarithms are as exact as others. Errors
are at most 0.55 ulp.
"""

from __future__ import annotations

import math

from ..float_bits import bits_float, float_bits
from ..kernels import inlined, law
from .exact import product_rest
from .logarithm_table import INVERSE, LOG, LOG_REST

_LN2, _LN2_REST = 0.6931471805598903, 5.497923018708371e-14
"""ln(2) to a multiple of 2^-42, and the rest."""
_LEAST_BITS = 0x3FE6000000000000
"""Bits of 0.6875, the least m."""
_SMALLEST = 2.2250738585072014e-308

_LOG0 = 0.3333333333333334
_LOG1 = -0.24999999999999303
_LOG2 = 0.1999999999874186
_LOG3 = -0.16666666677702976
_LOG4 = 0.14285746238698033
_LOG5 = -0.12500787868222207
_LOG6 = 0.10899707535311878


@inlined
def _series(r: float) -> float:
    """log(1 + r) - r + r^2/2."""
    z = r * r
    low = (_LOG0 + r * _LOG1) + z * (_LOG2 + r * _LOG3)
    return (r * z) * (low + (z * z) * ((_LOG4 + r * _LOG5) + z * _LOG6))


@inlined
def _parts(x: float, shift: int) -> tuple[float, float, float, float]:
    """(whole, whole_rest, r, r_rest): log(2^shift x) = whole + whole_rest + log(1 + r + r_rest), for x positive and
    normal.

    The first is exact; the rests are small beside the others.
    """
    bits = float_bits(x)
    above = bits - _LEAST_BITS
    k, row = above >> 52, (above >> 46) & 63
    bits -= k << 52
    m, upper = bits_float(bits), bits_float((bits >> 14) << 14)
    inverse = INVERSE(row)
    high, low = upper * inverse - 1.0, (m - upper) * inverse  # 39 bits times 11, and the others
    r = high + low
    exponent = float(k + shift)
    return exponent * _LN2 + LOG(row), exponent * _LN2_REST + LOG_REST(row), r, (high - r) + low


@inlined
def _log_sum(x: float, shift: int, rest: float) -> float:
    """log(2^shift x) + rest, for x positive and normal."""
    whole, low, r, r_rest = _parts(x, shift)
    high = whole + r
    low += ((whole - high) + r) + (r_rest + rest)
    return high + (low + (_series(r) - 0.5 * (r * r)))


@inlined
def log_exactly(x: float) -> tuple[float, float]:
    """log(x) as a sum of two, with 66 bits, for x positive and finite."""
    whole, low, r, r_rest = _parts(x * 2.0**54, -54) if x < _SMALLEST else _parts(x, 0)
    first = whole + r
    low += (whole - first) + r
    square = r * r
    half = 0.5 * square
    second = first - half
    low += ((first - second) - half) + (r_rest - (0.5 * product_rest(r, r, square) + r * r_rest))
    low += _series(r)
    value = second + low
    return value, (second - value) + low


@law
def _log_of_others(x: float) -> float:
    """log(x) of subnormal numbers, and of what has no finite one."""
    if 0.0 < x < _SMALLEST:
        return _log_sum(x * 2.0**54, -54, 0.0)
    return -math.inf if x == 0.0 else (math.inf if x > 0.0 else math.nan)


@law
def log(x: float) -> float:
    """Natural logarithm; minus infinity of zero, NaN of negative numbers."""
    if not _SMALLEST <= x < math.inf:
        return _log_of_others(x)
    return _log_sum(x, 0, 0.0)


@law
def log1p(x: float) -> float:
    """log(1 + x), exact for small x, too."""
    if abs(x) < 0.0078125:
        return x + (_series(x) - 0.5 * (x * x))
    if not -1.0 < x < math.inf:
        return -math.inf if x == -1.0 else (math.inf if x > 0.0 else math.nan)
    one = 1.0 + x
    rest = x - (one - 1.0) if x < 1.0 else 1.0 - (one - x)
    return _log_sum(one, 0, rest / one)
