# SPDX-License-Identifier: BSD-3-Clause
"""Exponential function, and what is made of it.

exp(x) = 2^k exp(r): r is in [-ln(2)/2, ln(2)/2] as a sum of two doubles; exp(r) - 1 is r + r^2/2, summed exactly on a
grid, plus a minimax polynomial (``benchmarks/elementary_coefficients.py``). Errors are at most 0.6 ulp, and
0.75 where a result below 2.3e-308 is rounded twice.
"""

from __future__ import annotations

import math

from ..float_bits import bits_float
from ..kernels import inlined, law
from .exact import nearest, quotient

_LN2_1, _LN2_2 = 0.6931471806019545, -4.2009150726810846e-11
"""ln(2) in 32 bits, and the rest."""
_PER_LN2 = 1.4426950408889634
_GRID = 201326592.0
"""1.5 * 2^27: adding and subtracting it rounds to multiples of 2^-25, whose squares have 48 bits."""
_MOST, _LEAST = 710.0, -746.0
"""Beyond, all is infinite or zero."""

_EXP0 = 0.16666666666666669
_EXP1 = 0.04166666666666667
_EXP2 = 0.008333333333330062
_EXP3 = 0.0013888888888880944
_EXP4 = 0.00019841269863052997
_EXP5 = 2.4801587333948463e-05
_EXP6 = 2.7557268461512093e-06
_EXP7 = 2.755726431956588e-07
_EXP8 = 2.5100384577510395e-08
_EXP9 = 2.0918136198258855e-09


@inlined
def _reduced(x: float, rest: float) -> tuple[float, float, float]:
    """(k, p, q): exp(x + rest) = 2^k (1 + p + q); k is whole, q is small beside p; x is in [-750, 750]."""
    k = nearest(x * _PER_LN2)
    near = x - k * _LN2_1
    off = rest - k * _LN2_2
    r = near + off
    rest = (near - r) + off
    grid = (r + _GRID) - _GRID
    half = 0.5 * (grid * grid)
    p = r + half
    q = ((r - p) + half) + (0.5 * ((r - grid) * (r + grid)) + (rest + r * rest))
    z = r * r
    low = (_EXP0 + r * _EXP1) + z * (_EXP2 + r * _EXP3)
    high = (_EXP4 + r * _EXP5) + z * (_EXP6 + r * _EXP7)
    zz = z * z
    series = low + zz * (high + zz * (_EXP8 + r * _EXP9))
    return k, p, q + (r * z) * series


@inlined
def power_of_two(k: int) -> float:
    """2^k, for k in [-1022, 1023]."""
    return bits_float((k + 1023) << 52)


@inlined
def exp_sum(x: float, rest: float) -> float:
    """exp(x + rest), the second small beside the first; x is in [-746, 746]."""
    k, p, q = _reduced(x, rest)
    high = 1.0 + p
    value = high + (((1.0 - high) + p) + q)
    whole = int(k)
    if -1022 <= whole <= 1023:
        return value * power_of_two(whole)
    half = whole >> 1
    return value * power_of_two(half) * power_of_two(whole - half)


@law
def exp(x: float) -> float:
    """e to the power of x."""
    if x != x:
        return x
    x = _MOST if x > _MOST else x
    return exp_sum(_LEAST if x < _LEAST else x, 0.0)


@inlined
def _less_one(x: float) -> tuple[float, float]:
    """exp(x) - 1 as a sum of two; x is in [-50, 50]."""
    k, p, q = _reduced(x, 0.0)
    scale = power_of_two(int(k))
    whole = scale - 1.0
    back = whole - scale
    whole_rest = (scale - (whole - back)) + (-1.0 - back)
    p *= scale
    high = whole + p
    return high, ((whole - high) + p) + (q * scale + whole_rest)


@law
def expm1(x: float) -> float:
    """exp(x) - 1, exact for small x, too."""
    if not abs(x) < 40.0:
        return exp(x) - 1.0
    high, low = _less_one(x)
    return x if abs(x) < 2.0**-54 else high + low


@law
def tanh(x: float) -> float:
    """Hyperbolic tangent."""
    if x != x:
        return x
    size = abs(x)
    high, low = _less_one(2.0 * (20.0 if size > 20.0 else size))
    total = high + low
    low = (high - total) + low
    under = total + 2.0
    back = under - total
    first, second = quotient(total, low, under, ((total - (under - back)) + (2.0 - back)) + low)
    value = 1.0 if size > 20.0 else first + second
    return x if size < 2.0**-28 else math.copysign(value, x)
