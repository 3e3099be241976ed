# SPDX-License-Identifier: BSD-3-Clause
"""Largest errors of ``sitl.core.elementary`` in units in the last place, against mpmath.

    python -m benchmarks.elementary_accuracy                # 1,000,000 points a function: many minutes
    python -m benchmarks.elementary_accuracy 20000 sin pow  # fewer, of some functions

Half a unit is what rounding the true value once takes. Points are drawn anew from each of several spans: where flights
are, where methods change, and all exponents. Needs mpmath, which the extra ``test`` brings; with gmpy2 it is faster.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import mpmath
import numpy as np
import numpy.typing as npt

from sitl.core import elementary

Numbers = npt.NDArray[np.float64]
Draw = Callable[[np.random.Generator, int], Numbers]
BITS = 160
"""Precision of the true values; arguments of sine and its like are reduced by mpmath with as many as that takes."""
HARD: dict[str, list[tuple[float, ...]]] = {
    "sin": [(6381956970095103.0 * 2.0**797,), (3.141592653589793,), (355.0,), (5.319372648326541e255,), (103993.0,)],
    "cos": [(6381956970095103.0 * 2.0**797,), (1.5707963267948966,), (11.0,), (5.319372648326541e255,), (52174.0,)],
    "tan": [(6381956970095103.0 * 2.0**797,), (1.5707963267948966,), (11.0,), (803.999,), (804.0,), (804.25,)],
    "asin": [(0.5,), (0.5000000000000001,), (0.9999999999999999,), (-0.9999999999999999,), (1e-300,)],
    "acos": [(0.5,), (0.5000000000000001,), (0.9999999999999999,), (-0.9999999999999999,), (6e-17,)],
    "atan": [(0.25,), (0.721,), (4.0,), (1e16,), (5e-324,), (1.7976931348623157e308,)],
    "exp": [(0.34657359027997264,), (709.782712893384,), (-708.39641853226408,), (-745.1332191019411,), (1e-300,)],
    "expm1": [(37.42994775023705,), (-37.42994775023705,), (39.99999999999999,), (40.0,), (1e-17,), (-1e-300,)],
    "tanh": [(18.714973875118524,), (19.999999999999996,), (20.0,), (1e-9,), (1e-300,)],
    "log": [(0.9999999999999999,), (1.0000000000000002,), (0.7071067811865475,), (1.4142135623730951,), (5e-324,)],
    "log1p": [(-0.9999999999999999,), (-0.29,), (0.41,), (1e-16,), (9007199254740993.0,), (1e-300,)],
    "cbrt": [(5e-324,), (-1e-310,), (2.0,), (27.0,), (1.7976931348623157e308,)],
    "atan2": [(1e-300, -1e300), (5e-324, 1.0), (1.0, 5e-324), (1e-320, 1e-310), (1e308, 1e308), (1.0, 4.0)],
    "hypot": [(1e308, 1e308), (5e-324, 5e-324), (3e-170, 4e-170), (1.0, 1e-9), (1e300, 1e-300), (3.0, 4.0)],
    "pow": [(1.0000000000000002, 1e18), (0.9999999999999999, 6.7e18), (2.0, -1074.0), (2.0, 0.5), (-3.0, 33.0)],
}
"""Arguments where something happens."""


class Span(NamedTuple):
    """How arguments of a function are drawn: one after the other."""

    arguments: tuple[Draw, ...]


def evenly(low: float, high: float) -> Draw:
    """Uniform in [low, high]."""
    return lambda random, count: random.uniform(low, high, count)


def by_exponent(low: int, high: int, signed: bool = True, around: float = 0.0) -> Draw:
    """Binary exponents uniform in [low, high): of the distance to ``around``."""

    def draw(random: np.random.Generator, count: int) -> Numbers:
        sizes = np.ldexp(random.uniform(1.0, 2.0, count), random.integers(low, high, count))
        return around + (sizes * random.choice([-1.0, 1.0], count) if signed else sizes)

    return draw


def _spans(*draws: Draw | tuple[Draw, ...]) -> tuple[Span, ...]:
    return tuple(Span(d if isinstance(d, tuple) else (d,)) for d in draws)


_ANGLES = _spans(evenly(-4.0, 4.0), evenly(-800.0, 800.0), by_exponent(-30, 0), by_exponent(9, 1023))
_UNIT = _spans(evenly(-1.0, 1.0), by_exponent(-30, -1), by_exponent(-52, -1, around=-1.0, signed=False))
SPANS: dict[str, tuple[Span, ...]] = {
    "sin": _ANGLES,
    "cos": _ANGLES,
    "tan": _ANGLES,
    "asin": _UNIT,
    "acos": _UNIT,
    "atan": _spans(evenly(-5.0, 5.0), by_exponent(-30, 30), by_exponent(-1074, 1023)),
    "exp": _spans(evenly(-1.0, 1.0), evenly(-745.0, 709.7), by_exponent(-60, 5)),
    "expm1": _spans(evenly(-1.0, 1.0), evenly(-50.0, 709.7), by_exponent(-60, 5)),
    "tanh": _spans(evenly(-1.0, 1.0), evenly(-20.0, 20.0), by_exponent(-60, 3)),
    "log": _spans(evenly(0.5, 2.0), by_exponent(-1074, 1023, signed=False), by_exponent(-52, -3, around=1.0)),
    "log1p": _spans(evenly(-0.999, 2.0), by_exponent(-1074, 1023, signed=False), by_exponent(-60, -1)),
    "cbrt": _spans(evenly(0.5, 8.0), by_exponent(-1074, 1023)),
    "atan2": _spans(
        (evenly(-1.0, 1.0), evenly(-1.0, 1.0)),
        (by_exponent(-1000, 1000), by_exponent(-1000, 1000)),
        (by_exponent(-1074, -1000), by_exponent(-1074, -1000)),
    ),
    "hypot": _spans(
        (evenly(-1.0, 1.0), evenly(-1.0, 1.0)),
        (by_exponent(-30, 30), by_exponent(-30, 30)),
        (by_exponent(-1074, -1000), by_exponent(-1074, -1000)),
    ),
    "pow": _spans(
        (evenly(0.0, 10.0), evenly(-10.0, 10.0)),
        (by_exponent(-300, 300, signed=False), evenly(-3.0, 3.0)),
        (by_exponent(-20, -2, around=1.0), by_exponent(3, 18)),
    ),
}


def true_value(name: str, arguments: tuple[float, ...]) -> Any:
    """What mpmath gives."""
    exact = [mpmath.mpf(a) for a in arguments]
    if name == "cbrt":
        return mpmath.sign(exact[0]) * mpmath.cbrt(abs(exact[0]))
    return getattr(mpmath, {"pow": "power"}.get(name, name))(*exact)


def error(value: float, true: Any) -> float:
    """Difference in units in the last place of the true value; what is infinite is right if the true value rounds to
    it."""
    _, exponent = mpmath.frexp(true)
    if exponent > 1024:
        return 0.0 if abs(value) == float("inf") else float("inf")
    return float(abs(mpmath.mpf(value) - true) / mpmath.mpf(2) ** max(exponent - 53, -1074))


def draws(name: str, count: int, seed: int) -> Iterator[list[tuple[float, ...]]]:
    """Arguments from each span, ``count`` in all."""
    random = np.random.default_rng(seed)
    for span in SPANS[name]:
        columns = [draw(random, -(-count // len(SPANS[name]))).tolist() for draw in span.arguments]
        yield list(zip(*columns, strict=True))


def worst(name: str, points: list[tuple[float, ...]]) -> tuple[float, tuple[float, ...]]:
    """The largest error of a function, and where it is."""
    function = getattr(elementary, name)
    with mpmath.workprec(BITS):
        return max((error(function(*at), true_value(name, at)), at) for at in points)


def main(arguments: list[str]) -> None:
    """Print the largest error in each span of each function."""
    count = int(arguments[0]) if arguments else 1_000_000
    for name in arguments[1:] or SPANS:
        found = [worst(name, points) for points in [*draws(name, count, 1), HARD[name]]]
        errors = "  ".join(f"{size:.3f}" for size, _ in found)
        size, at = max(found)
        print(f"{name:6} {size:.3f} ulp at {', '.join(map(repr, at))}   (spans: {errors})", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
