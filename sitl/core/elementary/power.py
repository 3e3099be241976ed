# SPDX-License-Identifier: BSD-3-Clause
"""Powers: the exponential function of a logarithm with 66 bits. Errors are at most 0.6 ulp, and 0.75 below
2.3e-308."""

from __future__ import annotations

import math

from ..kernels import law
from .exact import product_rest
from .exponential import exp_sum
from .logarithm import log_exactly


@law
def pow(x: float, y: float) -> float:
    """x to the power of y, special values as C's Annex F has them; NaN of a negative number with a broken exponent."""
    if y == 0.0 or x == 1.0:
        return 1.0
    if x != x or y != y:
        return math.nan
    size_x, size_y = abs(x), abs(y)
    is_whole = size_y >= 2.0**52 or math.floor(size_y) == size_y
    is_odd = is_whole and size_y < 2.0**53 and int(size_y) & 1 == 1
    if size_y == math.inf:
        if size_x == 1.0:
            return 1.0
        return math.inf if (size_x > 1.0) == (y > 0.0) else 0.0
    sign = -1.0 if is_odd and math.copysign(1.0, x) < 0.0 else 1.0
    if size_x == 0.0 or size_x == math.inf:
        return math.copysign(math.inf if (size_x > 0.0) == (y > 0.0) else 0.0, sign)
    if x < 0.0 and not is_whole:
        return math.nan
    high, low = log_exactly(size_x)
    y = math.copysign(2.0**70, y) if size_y > 2.0**70 else y  # the result is 0 or infinite, but for |x| = 1
    product = high * y
    rest = product_rest(high, y, product) + low * y
    if abs(product) > 746.0:
        product, rest = math.copysign(746.0, product), 0.0
    return sign * exp_sum(product, rest)
