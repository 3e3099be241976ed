# SPDX-License-Identifier: BSD-3-Clause
"""Arc sine, arc cosine, arc tangent.

The arc tangent of a quotient is that of (b - c a) / (a + c b), as a sum of two doubles, plus atan(c), where c is 0, 1/2
or 1; the arc sine beyond 1/2 is pi/2 - 2 asin(sqrt((1 - x) / 2)). What is left are short minimax polynomials
(``benchmarks/elementary_coefficients.py``). Errors are at most 0.65 ulp.
"""

from __future__ import annotations

import math

from ..kernels import inlined, law
from .exact import quotient, square_error

_PI, _PI_REST = 3.141592653589793, 1.2246467991473532e-16
_HALF_PI, _HALF_PI_REST = 1.5707963267948966, 6.123233995736766e-17
_QUARTER_PI, _QUARTER_PI_REST = 0.7853981633974483, 3.061616997868383e-17
_ATAN_HALF, _ATAN_HALF_REST = 0.4636476090008061, 2.2698777452961687e-17
_FIRST, _SECOND = 0.25, 0.721
"""Tangents from which on 1/2 and 1 are nearest, about."""
_HUGE, _SMALL = 2.0**900, 2.0**-900
_DOWN, _UP = 2.0**-200, 2.0**200

_ATAN0 = -0.33333333333332527
_ATAN1 = 0.19999999999580156
_ATAN2 = -0.14285714210988962
_ATAN3 = 0.11111104670323024
_ATAN4 = -0.0909060118682737
_ATAN5 = 0.07683689394098465
_ATAN6 = -0.06525363051905646
_ATAN7 = 0.046058310326993916
_ASIN0 = 0.16666666666666763
_ASIN1 = 0.07499999999970128
_ASIN2 = 0.044642857175257025
_ASIN3 = 0.03038194267672665
_ASIN4 = 0.02237221586359531
_ASIN5 = 0.01735159628800095
_ASIN6 = 0.013981008756911653
_ASIN7 = 0.011397375662470371
_ASIN8 = 0.01078884503324637
_ASIN9 = 0.0036740239389477327
_ASIN10 = 0.021786102954480118
_ASIN11 = -0.02111023661579378
_ASIN12 = 0.032698108059791495


@inlined
def _asin_series(z: float) -> float:
    """(asin(s) - s) / s, where z = s^2 is at most 1/4."""
    zz = z * z
    low = (_ASIN0 + z * _ASIN1) + zz * (_ASIN2 + z * _ASIN3)
    middle = (_ASIN4 + z * _ASIN5) + zz * (_ASIN6 + z * _ASIN7)
    high = (_ASIN8 + z * _ASIN9) + zz * (_ASIN10 + z * _ASIN11)
    fours = zz * zz
    return z * (low + fours * (middle + fours * (high + fours * _ASIN12)))


@inlined
def _half_asin(x: float) -> tuple[float, float]:
    """asin(sqrt((1 - x) / 2)), half the arc cosine, as a sum of two; x is in [1/2, 1]."""
    z = 0.5 * (1.0 - x)
    s = math.sqrt(z)
    square = s * s
    rest = ((z - square) - square_error(s, square)) * (0.5 / (s if s > 0.0 else 1.0))
    return s, rest + s * _asin_series(z)


@law
def asin(x: float) -> float:
    """Arc sine [rad]; NaN beyond [-1, 1]."""
    size = abs(x)
    if size <= 0.5:
        return x + x * _asin_series(x * x)
    if not size <= 1.0:
        return math.nan
    half, rest = _half_asin(size)
    high = _HALF_PI - 2.0 * half
    low = (_HALF_PI - high) - 2.0 * half
    return math.copysign(high + (low + (_HALF_PI_REST - 2.0 * rest)), x)


@law
def acos(x: float) -> float:
    """Arc cosine [rad]; NaN beyond [-1, 1]."""
    size = abs(x)
    if size <= 0.5:
        high = _HALF_PI - x
        low = (_HALF_PI - high) - x
        return high + (low + (_HALF_PI_REST - x * _asin_series(x * x)))
    if not size <= 1.0:
        return math.nan
    half, rest = _half_asin(size)
    if x > 0.0:
        return 2.0 * (half + rest)
    high = _PI - 2.0 * half
    low = (_PI - high) - 2.0 * half
    return high + (low + (_PI_REST - 2.0 * rest))


@law
def atan2(y: float, x: float) -> float:
    """Angle [rad] of the vector (x, y), in [-pi, pi]; zeros and infinities have the angles of C's Annex F."""
    if x != x or y != y:
        return math.nan
    size_x, size_y = abs(x), abs(y)
    is_steep = size_y > size_x
    a = size_y if is_steep else size_x
    b = size_x if is_steep else size_y
    if not _SMALL < a < _HUGE:
        if a == math.inf:
            b = 1.0 if b == math.inf else 0.0
            a = 1.0
        elif a == 0.0:
            a = 1.0
        else:
            scale = _UP if a < 1.0 else _DOWN
            a, b = a * scale, b * scale
    is_first, is_second = b > _FIRST * a, b > _SECOND * a
    near = (1.0 if is_second else 0.5) if is_first else 0.0
    base = (_QUARTER_PI if is_second else _ATAN_HALF) if is_first else 0.0
    base_rest = (_QUARTER_PI_REST if is_second else _ATAN_HALF_REST) if is_first else 0.0
    over = b - near * a  # exact
    step = near * b
    under = a + step
    ratio = over / under
    q, q_rest = quotient(over, 0.0, under, (a - under) + step)
    is_small = abs(ratio) < _SMALL
    q, q_rest = ratio if is_small else q, 0.0 if is_small else q_rest
    z = ratio * ratio
    zz = z * z
    low = (_ATAN0 + z * _ATAN1) + zz * (_ATAN2 + z * _ATAN3)
    high = (_ATAN4 + z * _ATAN5) + zz * (_ATAN6 + z * _ATAN7)
    rest = q_rest + (ratio * z) * (low + zz * zz * high)
    # the angle is whole + turn * (base + q + rest)
    is_back = math.copysign(1.0, x) < 0.0
    turn = -1.0 if is_steep != is_back else 1.0
    whole = _HALF_PI if is_steep else (_PI if is_back else 0.0)
    whole_rest = _HALF_PI_REST if is_steep else (_PI_REST if is_back else 0.0)
    base, q, base_rest = turn * base, turn * q, turn * base_rest
    first = whole + base
    first_rest = (whole - first) + base
    second = first + q
    second_rest = (first - second) + q
    known_rest = (first_rest + (whole_rest + base_rest)) + second_rest
    return math.copysign(second + (known_rest + turn * rest), y)


@law
def atan(x: float) -> float:
    """Arc tangent [rad], in [-pi/2, pi/2]."""
    return atan2(x, 1.0)
