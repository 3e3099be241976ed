# SPDX-License-Identifier: BSD-3-Clause
"""Makes the coefficients and constants of ``sitl.core.elementary``.

    python -m benchmarks.elementary_coefficients     # prints them, with the largest relative error of each polynomial

Polynomials are minimax by Remez' exchange (Cheney, "Introduction to Approximation Theory", 1966, chapter 3) in
arithmetic of 80 digits. Their coefficients are rounded to double one by one from the lowest, and the rest is fitted
anew after each, so that rounding the lowest costs nothing (Brisebarre and Chevillard, "Efficient polynomial
L-approximations", ARITH 2007, go further). Needs mpmath, which the extra ``test`` brings.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import mpmath
from mpmath import mpf

Function = Callable[[mpf], mpf]
DIGITS = 80
_EXCHANGES = 12
_GRID = 400
"""Points between which the error's extrema are looked for."""


class Wanted(NamedTuple):
    """A polynomial: of which function, where, and by what its error is multiplied to be one of the result."""

    name: str
    terms: int
    function: Function
    low: str
    high: str
    weight: Function


def _sin_rest(z: mpf) -> mpf:
    """sin(r) = r - r^3/6 + r^5 rest(r^2)."""
    r = mpmath.sqrt(z)
    return (mpmath.sin(r) - r + r**3 / 6) / r**5


def _cos_rest(z: mpf) -> mpf:
    """cos(r) = 1 - r^2/2 + r^4 rest(r^2)."""
    return (mpmath.cos(mpmath.sqrt(z)) - 1 + z / 2) / z**2


def _atan_rest(z: mpf) -> mpf:
    """atan(q) = q + q^3 rest(q^2)."""
    q = mpmath.sqrt(z)
    return (mpmath.atan(q) - q) / q**3


def _asin_rest(z: mpf) -> mpf:
    """asin(s) = s + s^3 rest(s^2)."""
    s = mpmath.sqrt(z)
    return (mpmath.asin(s) - s) / s**3


def _exp_rest(r: mpf) -> mpf:
    """exp(r) = 1 + r + r^2/2 + r^3 rest(r)."""
    if abs(r) < mpf(10) ** -20:
        return (1 + r / 4) / 6
    return (mpmath.exp(r) - 1 - r - r * r / 2) / r**3


def _log_rest(r: mpf) -> mpf:
    """log(1 + r) = r - r^2/2 + r^3 rest(r)."""
    if abs(r) < mpf(10) ** -20:
        return (1 - 3 * r / 4) / 3
    return (mpmath.log1p(r) - r + r * r / 2) / r**3


def _cbrt_first(m: mpf) -> mpf:
    return mpmath.cbrt(m)


WANTED = (
    Wanted("SIN", 5, _sin_rest, "0", "0.6171", lambda z: z * z),
    Wanted("COS", 6, _cos_rest, "0", "0.6171", lambda z: z * z),
    Wanted("ATAN", 8, _atan_rest, "0", "0.0627", lambda z: z),
    Wanted("ASIN", 13, _asin_rest, "0", "0.25", lambda z: z),
    Wanted("EXP", 10, _exp_rest, "-0.3466", "0.3466", lambda r: mpf(1)),
    Wanted("LOG", 7, _log_rest, "-0.0095", "0.0157", lambda r: mpf(1)),
    Wanted("CBRT", 5, _cbrt_first, "1", "2", lambda m: mpf(1)),
)


def _horner(coefficients: list[mpf], x: mpf) -> mpf:
    value = mpf(0)
    for c in reversed(coefficients):
        value = value * x + c
    return value


def remez(function: Function, weight: Function, low: mpf, high: mpf, terms: int) -> tuple[list[mpf], mpf]:
    """Coefficients of the polynomial whose weighted error is least, and that error.

    The weight may be zero at an end of the interval or in it: there nothing is looked for.
    """
    middle, half = (low + high) / 2, (high - low) / 2
    near = half / 1000
    points = [middle - half * mpmath.cos(mpmath.pi * k / terms) for k in range(terms + 1)]
    grid = [middle - half * mpmath.cos(mpmath.pi * k / _GRID) for k in range(_GRID + 1)]
    grid = [g + near if weight(g) == 0 else g for g in grid]
    values = [(function(g), weight(g)) for g in grid]
    coefficients: list[mpf] = []
    for _ in range(_EXCHANGES):
        points = [p + near if weight(p) == 0 else p for p in points]
        rows = [[weight(p) * p**k for k in range(terms)] + [mpf(-1) ** n] for n, p in enumerate(points)]
        solved = mpmath.lu_solve(mpmath.matrix(rows), mpmath.matrix([weight(p) * function(p) for p in points]))
        coefficients = [solved[k] for k in range(terms)]
        errors = [w * (_horner(coefficients, g) - f) for g, (f, w) in zip(grid, values, strict=True)]
        found: list[int] = []  # the largest error between two changes of sign
        for k, e in enumerate(errors):
            if found and (e > 0) == (errors[found[-1]] > 0):
                if abs(e) > abs(errors[found[-1]]):
                    found[-1] = k
            else:
                found.append(k)
        while len(found) > terms + 1:
            found.pop(0 if abs(errors[found[0]]) < abs(errors[found[-1]]) else -1)
        if len(found) < terms + 1:
            break
        points = [grid[k] for k in found]
    return coefficients, max(abs(w * (_horner(coefficients, g) - f)) for g, (f, w) in zip(grid, values, strict=True))


def rounded(wanted: Wanted) -> tuple[list[float], mpf]:
    """The polynomial's coefficients as doubles, lowest first, and its largest error relative to the result."""
    low, high = mpf(wanted.low), mpf(wanted.high)
    done: list[float] = []

    def rest(x: mpf) -> mpf:
        return (wanted.function(x) - _horner([mpf(c) for c in done], x)) / x ** len(done)

    def weight(x: mpf) -> mpf:
        return wanted.weight(x) * abs(x) ** len(done)

    if low < 0 < high:  # no polynomial has a best one through a point inside
        done.extend(float(c) for c in remez(rest, weight, low, high, wanted.terms)[0])
    for left in range(wanted.terms - len(done), 0, -1):
        fitted, _ = remez(rest, weight, low, high, left)
        done.append(float(fitted[0]))
    points = [low + (high - low) * (2 * k + 1) / (8 * _GRID) for k in range(4 * _GRID)]
    errors = [wanted.weight(x) * (_horner([mpf(c) for c in done], x) - wanted.function(x)) for x in points]
    return done, max(abs(e) for e in errors)


def parts(value: mpf, *bits: int) -> list[float]:
    """A number as a sum of doubles; all but the last have so many significant bits."""
    found: list[float] = []
    for count in bits:
        with mpmath.workprec(count):
            part = float(+value)
        found.append(part)
        value -= mpf(part)
    return [*found, float(value)]


def logarithm_table() -> tuple[list[float], list[float], list[float]]:
    """Of each of 64 intervals of [0.6875, 1.375): a number of 10 bits near the reciprocal of its middle, and minus the
    logarithm of that number, to a multiple of 2^-42 and the rest. The two intervals beside 1 have the reciprocal 1."""
    inverses, logs, rests = [], [], []
    for k in range(64):
        middle = mpf(11) / 16 + (k + mpf(0.5)) / 128 if k < 40 else 1 + (k - 40 + mpf(0.5)) / 64
        inverse = mpf(1) if k in (39, 40) else mpmath.nint(1024 / middle) / 1024
        log = mpmath.nint(-mpmath.log(inverse) * 2**42) / 2**42
        inverses.append(float(inverse))
        logs.append(float(log))
        rests.append(float(-mpmath.log(inverse) - log))
    return inverses, logs, rests


def print_all() -> None:
    """Print all as Python."""
    mpmath.mp.dps = DIGITS
    pi, ln2 = +mpmath.pi, +mpmath.ln2
    for name, value, bits in (
        ("PI/2, to reduce", pi / 2, (33, 33)),
        ("PI/2", pi / 2, (53,)),
        ("PI", pi, (53,)),
        ("2/PI", 2 / pi, ()),
        ("ATAN(1/2)", mpmath.atan(mpf(1) / 2), (53,)),
        ("PI/4", pi / 4, (53,)),
        ("LN2, to reduce", ln2, (32,)),
        ("LN2, with the table", mpmath.nint(ln2 * 2**42) / 2**42, ()),
        ("LN2, rest of it", ln2 - mpmath.nint(ln2 * 2**42) / 2**42, ()),
        ("1/LN2", 1 / ln2, ()),
        ("1/6, in 16 bits and the rest", mpf(1) / 6, (16,)),
    ):
        print(f"# {name}: {parts(value, *bits)!r}")
    with mpmath.workprec(2000):
        whole = int(mpmath.floor(2 / mpmath.pi * mpf(2) ** (30 * 42)))
        limbs = [(whole >> (30 * (41 - k))) & (2**30 - 1) for k in range(42)]
    print(f"# 2/PI in parts of 30 bits: {limbs!r}")
    for name, numbers in zip(("INVERSE", "LOG", "LOG_REST"), logarithm_table(), strict=True):
        print(f"_TABLE_{name} = {tuple(numbers)!r}")
    for wanted in WANTED:
        coefficients, error = rounded(wanted)
        print(f"# {wanted.name}: relative error 2^{float(mpmath.log(error, 2)):.1f}")
        for k, c in enumerate(coefficients):
            print(f"_{wanted.name}{k} = {c!r}")


if __name__ == "__main__":
    print_all()
