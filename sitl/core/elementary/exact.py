# SPDX-License-Identifier: BSD-3-Clause
"""What rounding takes: sums and products of two doubles as two doubles that are exact together.

Sources: Dekker, "A floating-point technique for extending the available precision", Numerische Mathematik 18, 1971;
Knuth, "The Art of Computer Programming" 2, section 4.2.2; Muller and others, "Handbook of Floating-Point Arithmetic",
chapter 4.
"""

from __future__ import annotations

from ..kernels import inlined

_ROUND = 6755399441055744.0
"""1.5 * 2^52: a number below 2^51 in magnitude is rounded to an integer, ties to even, by adding and subtracting it."""


@inlined
def nearest(value: float) -> float:
    """The integer nearest to a number below 2^51 in magnitude; of two, the even one."""
    return (value + _ROUND) - _ROUND


@inlined
def high_half(value: float) -> float:
    """The upper 26 bits of a number's 53 (Veltkamp): products of halves are exact."""
    scaled = 134217729.0 * value  # 2^27 + 1
    return scaled - (scaled - value)


@inlined
def square_error(value: float, square: float) -> float:
    """What rounding took from ``square`` = value * value (Dekker)."""
    high = high_half(value)
    low = value - high
    return ((high * high - square) + 2.0 * high * low) + low * low


@inlined
def product_rest(a: float, b: float, product: float) -> float:
    """What rounding took from ``product`` = a * b (Dekker); the factors are below 2^996."""
    a_high, b_high = high_half(a), high_half(b)
    a_low, b_low = a - a_high, b - b_high
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low


@inlined
def quotient(high: float, low: float, by_high: float, by_low: float) -> tuple[float, float]:
    """(high + low) / (by_high + by_low) as a sum of two, the first of 26 bits; ``low`` and ``by_low`` are small beside
    the others."""
    first = high_half(high / by_high)
    upper = high_half(by_high)
    rest = ((high - first * upper) - first * (by_high - upper)) + (low - first * by_low)
    return first, rest * (1.0 / by_high)
