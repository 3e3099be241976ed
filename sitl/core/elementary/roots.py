# SPDX-License-Identifier: BSD-3-Clause
"""Length of a vector, and the cube root."""

from __future__ import annotations

import math

from ..float_bits import bits_float, float_bits
from ..kernels import law
from .exact import high_half, product_rest, square_error

_LARGE, _SMALL = 2.0**450, 2.0**-450
_DOWN, _UP = 2.0**-600, 2.0**600

_CBRT0 = 0.507659022286262
_CBRT1 = 0.7162227189331754
_CBRT2 = -0.2985951991997005
_CBRT3 = 0.08517408301907363
_CBRT4 = -0.010450347214725708
_CBRT_2, _CBRT_4 = 1.2599210498948732, 1.5874010519681994


@law
def hypot(x: float, y: float) -> float:
    """Length of (x, y) without overflow on the way; that of an infinity is infinite, even beside NaN.

    The square root is corrected by what rounding took from squares and sum, so that the error is about 0.5 ulp
    (Borges, "An improved algorithm for hypot(a, b)", 2019).
    """
    x, y = abs(x), abs(y)
    a, b = (x, y) if x > y else (y, x)
    scale = 1.0
    if not (_SMALL < a < _LARGE):
        if x == math.inf or y == math.inf:
            return math.inf
        scale = _UP if a < 1.0 else _DOWN
        a, b = a * scale, b * scale
    aa, bb = a * a, b * b
    square = aa + bb
    if not square > 0.0:
        return x + y
    length = math.sqrt(square)
    rounded = length * length
    rest = ((aa - rounded) + bb) + (square_error(a, aa) + square_error(b, bb) - square_error(length, rounded))
    return (length + rest * (0.5 / length)) * (1.0 / scale)


@law
def cbrt(x: float) -> float:
    """Cube root.

    A polynomial, one step of Halley's method, and one more from a number of 26 bits, whose square is exact.
    """
    size = abs(x)
    if not 0.0 < size < math.inf:
        return x + x
    size = size * 2.0**54 if size < 2.0**-1000 else size
    bits = float_bits(size)
    exponent = (bits >> 52) - 1023
    thirds = (exponent + 1080) // 3 - 360
    left = exponent - 3 * thirds
    m = bits_float((bits & 0xFFFFFFFFFFFFF) | (1023 << 52))
    t = _CBRT0 + m * (_CBRT1 + m * (_CBRT2 + m * (_CBRT3 + m * _CBRT4)))
    t *= (_CBRT_4 if left == 2 else _CBRT_2) if left else 1.0
    m *= (4.0 if left == 2 else 2.0) if left else 1.0
    cube = t * t * t
    t = high_half(t * (cube + 2.0 * m) / (2.0 * cube + m))
    square = t * t
    cube = square * t
    root = t + t * ((m - cube) - product_rest(square, t, cube)) / (2.0 * cube + m)
    root *= bits_float((thirds + 1023) << 52)
    root = root * 2.0**-18 if abs(x) < 2.0**-1000 else root
    return math.copysign(root, x)
