# SPDX-License-Identifier: BSD-3-Clause
"""Sine, cosine and tangent.

The angle is brought to [-pi/4, pi/4] as a sum of two doubles: up to 800 rad by Cody and Waite's method ("Software
Manual for the Elementary Functions", 1980), farther in integers (``far_angles.py``). There the first two terms of the
series are summed exactly, on a grid on which powers are not rounded, and a minimax polynomial makes the rest
(``benchmarks/elementary_coefficients.py``). Errors are at most 0.6 ulp (tangent 0.61).
"""

from __future__ import annotations

from ..kernels import inlined, law
from .exact import nearest, quotient
from .far_angles import reduced_far

_EIGHTH = 0.785
"""Below that, an angle has no quarters [rad]."""
_NEAR = 804.0
"""Below that, products of quarters (9 bits) and the first two parts of pi/2 (33 bits each) are exact [rad]."""
_HALF_PI_1, _HALF_PI_2, _HALF_PI_3 = 1.5707963267341256, 6.077100506303966e-11, 2.0222662487959506e-21
_TWO_OVER_PI = 0.6366197723675814
_GRID = 1649267441664.0
"""1.5 * 2^40: adding and subtracting it rounds to multiples of 2^-12, whose cubes have 36 bits."""
_SIXTH, _SIXTH_REST = 0.16666793823242188, -1.2715657552083333e-06
"""1/6: 16 bits, and the rest."""
_TINY = 2.0**-27
"""Below that the sine and the tangent of an angle are the angle."""

_SIN0 = 0.008333333333329026
_SIN1 = -0.0001984126983417463
_SIN2 = 2.755731499486033e-06
_SIN3 = -2.5050938394013278e-08
_SIN4 = 1.590620744377557e-10
_COS0 = 0.0416666666666666
_COS1 = -0.0013888888888874467
_COS2 = 2.480158728966449e-05
_COS3 = -2.75573143983165e-07
_COS4 = 2.0875728836282702e-09
_COS5 = -1.1359907845909253e-11


@inlined
def _reduced(x: float) -> tuple[int, float, float]:
    """(quarters modulo 4, angle, rest): x less that many quarter turns is angle + rest, about pi/4 at most.

    The rest is below 2^-59 where it is not below half a unit in the last place of the angle.
    """
    if abs(x) < _EIGHTH:  # most angles of flights: the same as below, sooner
        return 0, x, 0.0
    if not abs(x) < _NEAR:
        return reduced_far(x)
    quarters = nearest(x * _TWO_OVER_PI)
    near = x - quarters * _HALF_PI_1
    step = quarters * _HALF_PI_2
    angle = near - step  # exact where the step is the larger of both
    return int(quarters) & 3, angle, ((near - angle) - step) - quarters * _HALF_PI_3


@inlined
def _sine(r: float, rest: float) -> tuple[float, float]:
    """sin(r + rest) as a sum of two, the second below 2^-9 of the first."""
    grid = (r + _GRID) - _GRID
    z, gg = r * r, grid * grid
    cube = gg * grid * _SIXTH
    high = r - cube
    low = (r - high) - cube
    zz = z * z
    series = (_SIN0 + z * _SIN1) + zz * ((_SIN2 + z * _SIN3) + zz * _SIN4)
    off = (r - grid) * ((z + gg) + r * grid) * _SIXTH  # r^3 / 6 less that of the grid
    low += (rest - 0.5 * (z * rest)) - (off + r * z * _SIXTH_REST)
    return high, low + (r * zz) * series


@inlined
def _cosine(r: float, rest: float) -> tuple[float, float]:
    """cos(r + rest) as a sum of two."""
    grid = (r + _GRID) - _GRID
    z = r * r
    half = 0.5 * (grid * grid)
    high = 1.0 - half
    low = ((1.0 - high) - half) - (0.5 * ((r - grid) * (r + grid)) + r * rest)
    zz = z * z
    series = (_COS0 + z * _COS1) + zz * ((_COS2 + z * _COS3) + zz * (_COS4 + z * _COS5))
    return high, low + zz * series


@law
def sin(x: float) -> float:
    """Sine of an angle [rad]; NaN of an infinity."""
    quarters, r, rest = _reduced(x)
    high, low = _cosine(r, rest) if quarters & 1 else _sine(r, rest)
    value = high + low
    value = -value if quarters & 2 else value
    return x if abs(x) < _TINY else value


@law
def cos(x: float) -> float:
    """Cosine of an angle [rad]; NaN of an infinity."""
    quarters, r, rest = _reduced(x)
    high, low = _sine(r, rest) if quarters & 1 else _cosine(r, rest)
    value = high + low
    return -value if (quarters + 1) & 2 else value


@law
def sincos(x: float) -> tuple[float, float]:
    """(sine, cosine) of an angle [rad]: the bits of ``sin`` and ``cos`` for little more than one of them costs."""
    quarters, r, rest = _reduced(x)
    high, low = _sine(r, rest)
    sine = high + low
    high, low = _cosine(r, rest)
    cosine = high + low
    first, second = (cosine, sine) if quarters & 1 else (sine, cosine)
    first = -first if quarters & 2 else first
    second = -second if (quarters + 1) & 2 else second
    return x if abs(x) < _TINY else first, second


@law
def tan(x: float) -> float:
    """Tangent of an angle [rad]; NaN of an infinity."""
    quarters, r, rest = _reduced(x)
    high, low = _sine(r, rest)
    sine = high + low
    sine_rest = (high - sine) + low
    high, low = _cosine(r, rest)
    cosine = high + low
    cosine_rest = (high - cosine) + low
    if quarters & 1:
        sine, sine_rest, cosine, cosine_rest = -cosine, -cosine_rest, sine, sine_rest
    high, low = quotient(sine, sine_rest, cosine, cosine_rest)
    return x if abs(x) < _TINY else high + low
