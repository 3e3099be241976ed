# SPDX-License-Identifier: BSD-3-Clause
"""An angle far from zero, less multiples of a quarter turn.

All bits that count of the product with 2/pi are formed in integers, 30 bits a digit; whole turns are never formed.
Source of the method: Payne and Hanek, "Radian reduction for trigonometric functions", SIGNUM Newsletter 18, 1983.
Constants: ``benchmarks/elementary_coefficients.py``.
"""

from __future__ import annotations

import math

from ..constant_tables import constant_table
from ..float_bits import float_bits
from ..kernels import law
from .exact import product_rest

_TWO_OVER_PI = constant_table(
    0, 0, 0, 683565275, 618938706, 670080351, 301282525, 808900773, 429114425, 17299781, 598466235, 827878857,
    115581988, 927694873, 154069513, 879003455, 568242635, 78028027, 679622133, 196006177, 244958978, 449936889,
    20550102, 241226958, 524929093, 1043265508, 674963448, 637532033, 427884274, 1011232104, 174923629, 228570057,
    1018207092, 1025047962, 509602349, 491384497, 1052663575, 754195687, 931811986, 983236311, 991033557, 874600460,
    809958523, 451607603, 1002572207,
)  # fmt: skip
"""Digits of 2/pi to the base 2^30: three before the point, 42 after it."""
_DIGIT = (1 << 30) - 1
_HALF_PI, _HALF_PI_REST = 1.5707963267948966, 6.123233995736766e-17


@law
def reduced_far(x: float) -> tuple[int, float, float]:
    """(quarters modulo 4, angle, rest): x less that many quarter turns is angle + rest, at most pi/4 in magnitude.

    For 800 <= \\|x\\|; of an infinity or NaN, the angle is NaN.
    """
    if not abs(x) < math.inf:
        return 0, x - x, 0.0
    bits = float_bits(abs(x))
    exponent = (bits >> 52) - 1075
    digits = (exponent + 90) // 30 - 3  # |x| = fraction * 2^exponent = (a2 a1 a0) * 2^(30 digits)
    shift = exponent - 30 * digits
    fraction = (bits & ((1 << 52) - 1)) | (1 << 52)
    low, high = (fraction & _DIGIT) << shift, (fraction >> 30) << shift
    high += low >> 30
    a0, a1, a2 = low & _DIGIT, high & _DIGIT, high >> 30
    first = digits + 2  # three stand before the point
    t1, t2, t3, t4 = _TWO_OVER_PI(first + 1), _TWO_OVER_PI(first + 2), _TWO_OVER_PI(first + 3), _TWO_OVER_PI(first + 4)
    t5, t6, t7 = _TWO_OVER_PI(first + 5), _TWO_OVER_PI(first + 6), _TWO_OVER_PI(first + 7)
    d6 = a0 * t6 + a1 * t7 + a2 * _TWO_OVER_PI(first + 8)
    d5 = a0 * t5 + a1 * t6 + a2 * t7 + (d6 >> 30)
    d4 = a0 * t4 + a1 * t5 + a2 * t6 + (d5 >> 30)
    d3 = a0 * t3 + a1 * t4 + a2 * t5 + (d4 >> 30)
    d2 = a0 * t2 + a1 * t3 + a2 * t4 + (d3 >> 30)
    d1 = a0 * t1 + a1 * t2 + a2 * t3 + (d2 >> 30)
    quarters = a0 * _TWO_OVER_PI(first) + a1 * t1 + a2 * t2 + (d1 >> 30)
    d1, d2, d3, d4, d5 = d1 & _DIGIT, d2 & _DIGIT, d3 & _DIGIT, d4 & _DIGIT, d5 & _DIGIT
    up = d1 >> 29  # at least half a quarter: the next one is nearer
    quarters += up
    d1 -= up << 30
    a = float((d1 << 20) + (d2 >> 10)) * 2.0**-50
    b = float(((d2 & 1023) << 40) + (d3 << 10) + (d4 >> 20)) * 2.0**-100
    c = float(((d4 & 1048575) << 30) + d5) * 2.0**-150
    turned = a + b
    rest = ((a - turned) + b) + c
    part = turned + rest
    rest = (turned - part) + rest
    product = part * _HALF_PI
    rest = product_rest(part, _HALF_PI, product) + (part * _HALF_PI_REST + rest * _HALF_PI)
    angle = product + rest
    rest = (product - angle) + rest
    if x < 0.0:
        return -quarters & 3, -angle, -rest
    return quarters & 3, angle, rest
